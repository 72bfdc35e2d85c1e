//! Does an axis separate two posed polytopes, exactly? Supports are those of the corners.
//!
//! In A's slab coordinates, B's corners are M ξ + w and A's are s ξ ([`Relative::over`]). The axis
//! a separates when s max a·A < min a·B or the other way round. An axis may be any vector: the
//! normals of a body, or a guess of the linear program in [`super::ordop`].

use std::cmp::Ordering;

use dashu_int::IBig;

use super::polytope::{DENOMINATOR, Polytope};
use super::relative::{Approximate, Relative};
use super::{Decision, Interval, any, cascade, either};
use crate::linear::{Vector, add, apply, dot, integers, largest, scale};
use crate::number::{Number, unit_of};
use crate::pose::Pose;

/// A polytope and where it is.
pub type Posed<'a> = (&'a Pose, &'a Polytope);

/// Whether no face normal of A separates A and B: the one-sided test.
pub fn overlap_one_sided(a: Posed, b: Posed) -> Decision<bool> {
    cascade(
        || any_normal(a.1, &Rounded::new(a, b)),
        || one_sided::<Interval>(a, b),
        || one_sided::<IBig>(a, b),
    )
    .map(|separated| !separated)
}

/// Whether no face normal of A or of B separates A and B: the two-sided test.
pub fn overlap_two_sided(a: Posed, b: Posed) -> Decision<bool> {
    let rounded = |a, b: Posed| any_normal(b.1, &Rounded::new(b, a));
    cascade(
        || either(rounded(b, a), || rounded(a, b)),
        || two_sided::<Interval>(a, b),
        || two_sided::<IBig>(a, b),
    )
    .map(|separated| !separated)
}

pub(crate) fn one_sided<N: Number>(a: Posed, b: Posed) -> Option<bool> {
    any_normal(a.1, &Corners::<N>::new(a, b))
}

pub(crate) fn two_sided<N: Number>(a: Posed, b: Posed) -> Option<bool> {
    either(one_sided::<N>(a, b), || one_sided::<N>(b, a))
}

/// Two point sets along one axis.
pub trait Separation {
    /// The numbers that an axis is made of.
    type Number: Number;
    /// Whether the axis separates the sets, `None` when this stage cannot tell.
    fn separates(&self, axis: &Vector<Self::Number>) -> Option<bool>;
}

fn any_normal<S: Separation>(polytope: &Polytope, sets: &S) -> Option<bool> {
    any(polytope.normals.iter().map(|normal| sets.separates(&integers(*normal))))
}

/// Both polytopes' corners as 12 s ξ in A's slab coordinates, in intervals or integers.
pub struct Corners<N> {
    a: Vec<Vector<N>>,
    b: Vec<Vector<N>>,
}

impl<N: Number> Corners<N> {
    /// The corners of A and B as A sees them.
    pub fn new(a: Posed, b: Posed) -> Self {
        let unit = common_unit(a, b);
        let relative = Relative::<N>::between(a.0, b.0, unit).over(a.1, b.1);
        let offset = scale(&N::integer(DENOMINATOR), &relative.offset);
        let (own, others) = (a.1.lift_corners(unit), b.1.lift_corners(unit));
        let map = |xi| add(&apply(&relative.matrix, xi), &offset);
        Self {
            a: own.iter().map(|xi| scale(&relative.scale, xi)).collect(),
            b: others.iter().map(map).collect(),
        }
    }
}

impl<N: Number> Separation for Corners<N> {
    type Number = N;

    fn separates(&self, axis: &Vector<N>) -> Option<bool> {
        let (Some(a), Some(b)) = (extent(axis, &self.a), extent(axis, &self.b)) else {
            return Some(true);
        };
        let positive = |gap: N| gap.sign().map(|sign| sign == Ordering::Greater);
        either(positive(b[0].minus(&a[1])), || positive(a[0].minus(&b[1])))
    }
}

/// The interval that points cover along an axis, `None` of no points.
fn extent<N: Number>(axis: &Vector<N>, points: &[Vector<N>]) -> Option<[N; 2]> {
    let heights = points.iter().map(|p| dot(axis, p)).map(|h| [h.clone(), h]);
    heights.reduce(|[lo, hi], [h, _]| [lo.smaller(&h), hi.larger(&h)])
}

/// The filter's corners: A's rounded ξ, B's mapped to A's coordinates.
///
/// A corner of A is off by 2u|ξ|, one of B by [`Approximate::error`]; a height adds 3u|a|₁|ξ|∞ at
/// most.
pub struct Rounded<'a> {
    a: &'a [Vector<f64>],
    b: Vec<Vector<f64>>,
    error: f64,
}

impl<'a> Rounded<'a> {
    /// The corners of A and B as A sees them.
    pub fn new(a: Posed<'a>, b: Posed) -> Self {
        let map = Approximate::over(a, b);
        let reach = |p: &Polytope| p.rounded.iter().map(largest).fold(0.0, f64::max);
        Self {
            a: &a.1.rounded,
            b: b.1.rounded.iter().map(|xi| map.map(xi)).collect(),
            error: 2.0 * map.error(reach(b.1)) + 8.0 * f64::EPSILON * reach(a.1),
        }
    }
}

impl Separation for Rounded<'_> {
    type Number = f64;

    fn separates(&self, axis: &Vector<f64>) -> Option<bool> {
        let (Some(a), Some(b)) = (extent(axis, self.a), extent(axis, &self.b)) else {
            return Some(true);
        };
        let bound = self.error * axis.iter().map(|x| x.abs()).sum::<f64>();
        match (b[0] - a[1]).max(a[0] - b[1]) {
            gap if gap > bound => Some(true),
            gap if gap < -bound => Some(false),
            _ => None,
        }
    }
}

/// The largest unit of length such that both translations and all slab ends are multiples of it.
pub fn common_unit(a: Posed, b: Posed) -> i32 {
    let unit = |(pose, polytope): Posed| polytope.length_unit().min(unit_of(pose.translation()));
    unit(a).min(unit(b))
}
