//! Number types of a scene file. They are checked while they are read, so that an error points at
//! the number.

use std::fmt;

use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

use sdop::rounding::LIMIT;

/// A finite number of size at most 2⁶⁰.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Real(pub f32);

/// A number above zero, at most 2⁶⁰.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Positive(pub f32);

/// A part of a whole, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Share(pub f32);

/// A range of values ≥ 0, written as one number or as `[min, max]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub min: f32,
    /// The upper end, not below `min`.
    pub max: f32,
}

/// One kind of number: what it is called and which values it takes.
trait NumberKind: Sized {
    const EXPECTED: &'static str;
    fn accept(value: f32) -> Option<Self>;
}

impl NumberKind for Real {
    const EXPECTED: &'static str = "a number of size at most 2^60";
    fn accept(value: f32) -> Option<Self> {
        (value.abs() <= LIMIT).then_some(Self(value))
    }
}

impl NumberKind for Positive {
    const EXPECTED: &'static str = "a number above 0, at most 2^60";
    fn accept(value: f32) -> Option<Self> {
        (value > 0.0 && value <= LIMIT).then_some(Self(value))
    }
}

impl NumberKind for Share {
    const EXPECTED: &'static str = "a number from 0 to 1";
    fn accept(value: f32) -> Option<Self> {
        (0.0..=1.0).contains(&value).then_some(Self(value))
    }
}

impl NumberKind for Interval {
    const EXPECTED: &'static str = "a number or [min, max], from 0 to 2^60";
    fn accept(value: f32) -> Option<Self> {
        (0.0..=LIMIT).contains(&value).then_some(Self { min: value, max: value })
    }
}

struct NumberVisitor<T>(std::marker::PhantomData<T>);

impl<'de, T: NumberKind + IntervalEnds> Visitor<'de> for NumberVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    // Both casts round to the nearest f32; beyond its range they give an infinity, which no kind
    // accepts.
    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        T::accept(value as f32).ok_or_else(|| E::invalid_value(Unexpected::Float(value), &self))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        T::accept(value as f32).ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut ends: A) -> Result<T, A::Error> {
        let mut list = Vec::new();
        while let Some(Real(end)) = ends.next_element()? {
            list.push(end);
        }
        T::from_ends(&list).ok_or_else(|| {
            let found = format!("{list:?}");
            A::Error::invalid_value(Unexpected::Other(&found), &self)
        })
    }
}

/// Kinds that can also be written as a list; none but [`Interval`] can.
trait IntervalEnds: Sized {
    fn from_ends(_ends: &[f32]) -> Option<Self> {
        None
    }
}
impl IntervalEnds for Real {}
impl IntervalEnds for Positive {}
impl IntervalEnds for Share {}
impl IntervalEnds for Interval {
    fn from_ends(ends: &[f32]) -> Option<Self> {
        match *ends {
            [min, max] if min >= 0.0 && min <= max => Some(Self { min, max }),
            _ => None,
        }
    }
}

macro_rules! deserialize_number {
    ($($kind:ident),+) => {$(
        impl<'de> Deserialize<'de> for $kind {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(NumberVisitor(std::marker::PhantomData))
            }
        }
    )+};
}
deserialize_number!(Real, Positive, Share, Interval);

/// Factors of x, y and z, written as one number for all or as `[x, y, z]`: not zero, of size at
/// most 2⁶⁰. In f64, since 0.001 is no f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors(pub [f64; 3]);

impl Factors {
    fn of(factors: &[f64]) -> Option<Self> {
        let all = match *factors {
            [factor] => [factor; 3],
            [x, y, z] => [x, y, z],
            _ => return None,
        };
        let fits = |factor: &f64| *factor != 0.0 && factor.abs() <= f64::from(LIMIT);
        all.iter().all(fits).then_some(Self(all))
    }
}

struct FactorsVisitor;

impl<'de> Visitor<'de> for FactorsVisitor {
    type Value = Factors;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a factor or [x, y, z], none of them 0")
    }

    fn visit_f64<E: Error>(self, factor: f64) -> Result<Factors, E> {
        let found = Unexpected::Float(factor);
        Factors::of(&[factor]).ok_or_else(|| E::invalid_value(found, &self))
    }

    fn visit_i64<E: Error>(self, factor: i64) -> Result<Factors, E> {
        let found = Unexpected::Signed(factor);
        Factors::of(&[factor as f64]).ok_or_else(|| E::invalid_value(found, &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut factors: A) -> Result<Factors, A::Error> {
        let mut list: Vec<f64> = Vec::new();
        while let Some(factor) = factors.next_element()? {
            list.push(factor);
        }
        let three = (list.len() == 3).then(|| Factors::of(&list)).flatten();
        three.ok_or_else(|| {
            let found = format!("{list:?}");
            A::Error::invalid_value(Unexpected::Other(&found), &self)
        })
    }
}

impl<'de> Deserialize<'de> for Factors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FactorsVisitor)
    }
}

/// The plain vector of three checked numbers.
#[must_use]
pub fn vector(v: [Real; 3]) -> [f32; 3] {
    v.map(|Real(x)| x)
}
