//! A shape's sizes by name: their values, their limits and the errors beyond them.

use super::ProceduralShape;

/// A size of a shape that can be set by name.
enum SizeSlot<'a> {
    Length(&'a mut f32),
    Count(&'a mut u32),
}

/// Why a shape cannot be made from a name and sizes.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// No shape has this name.
    #[error("there is no shape {name:?}; {help}", help = self.help())]
    UnknownShape {
        /// The name as given.
        name: String,
    },
    /// The shape has no such size.
    #[error("the shape {shape:?} has no size {size:?}; {help}", help = self.help())]
    UnknownSize {
        /// The shape's name.
        shape: &'static str,
        /// The size as given.
        size: String,
        /// The sizes that the shape has.
        known: Vec<&'static str>,
    },
    /// The value is outside what the size allows.
    #[error("the size {size:?} of the shape {shape:?} cannot be {value}; {help}", help = self.help())]
    BadSize {
        /// The shape's name.
        shape: &'static str,
        /// The size's name.
        size: &'static str,
        /// The value as given.
        value: f64,
        /// The allowed values.
        allowed: String,
    },
}

crate::problem::errors!(ShapeError);

impl ShapeError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::UnknownShape { .. } => {
                format!("the shapes are {}", ProceduralShape::NAMES.join(", "))
            }
            Self::UnknownSize { known, .. } => format!("its sizes are {}", known.join(", ")),
            Self::BadSize { size, allowed, .. } => format!("{size} must be {allowed}"),
        }
    }
}

/// Sizes by the names of their fields.
macro_rules! sizes {
    ($($kind:ident $size:ident),+) => { vec![$((stringify!($size), SizeSlot::$kind($size))),+] };
}

impl ProceduralShape {
    #[rustfmt::skip]
    fn sizes(&mut self) -> Vec<(&'static str, SizeSlot<'_>)> {
        match self {
            Self::Box { x, y, z } => sizes![Length x, Length y, Length z],
            Self::Icosphere { radius, subdivisions } => sizes![Length radius, Count subdivisions],
            Self::Needle { length, radius, sides } => sizes![Length length, Length radius, Count sides],
            Self::Plate { x, y, thickness } => sizes![Length x, Length y, Length thickness],
            Self::Torus { radius, tube, segments, sides } | Self::Knot { radius, tube, segments, sides } => {
                sizes![Length radius, Length tube, Count segments, Count sides]
            }
            Self::Gear { tip, root, bore, thickness, teeth } => {
                sizes![Length tip, Length root, Length bore, Length thickness, Count teeth]
            }
            Self::LShape { x, y, arm, thickness } => {
                sizes![Length x, Length y, Length arm, Length thickness]
            }
        }
    }

    pub(super) fn set(&mut self, name: &str, value: f64) -> Result<(), ShapeError> {
        let shape = self.name();
        let mut known = Vec::new();
        for (size, slot) in self.sizes() {
            if size != name {
                known.push(size);
                continue;
            }
            match slot {
                SizeSlot::Length(length) => *length = value as f32,
                SizeSlot::Count(count) if value.fract() == 0.0 && value.abs() < 1e9 => {
                    // A negative count saturates to 0, which `check` then rejects if 0 is not
                    // allowed.
                    *count = value as u32;
                }
                SizeSlot::Count(_) => {
                    let allowed = "a whole number".to_owned();
                    return Err(ShapeError::BadSize { shape, size, value, allowed });
                }
            }
            return Ok(());
        }
        Err(ShapeError::UnknownSize { shape, size: name.to_owned(), known })
    }

    pub(super) fn check(mut self) -> Result<(), ShapeError> {
        let shape = self.name();
        let bad =
            |size, value, allowed: String| Err(ShapeError::BadSize { shape, size, value, allowed });
        for (size, slot) in self.sizes() {
            match slot {
                SizeSlot::Length(&mut length) => {
                    if !(MIN_LENGTH..=MAX_LENGTH).contains(&length) {
                        return bad(size, f64::from(length), "from 2^-60 to 2^58".to_owned());
                    }
                }
                SizeSlot::Count(&mut count) => {
                    let (least, most) = match (shape, size) {
                        ("icosphere", _) => (0, 7),
                        ("knot", "segments") => (32, 1024),
                        _ => (3, 1024),
                    };
                    if !(least..=most).contains(&count) {
                        return bad(size, f64::from(count), format!("from {least} to {most}"));
                    }
                }
            }
        }
        for (size, value, limit, meaning) in self.relations() {
            if value >= limit {
                return bad(size, f64::from(value), format!("less than {limit}, {meaning}"));
            }
        }
        Ok(())
    }

    /// Sizes that must be below a limit set by other sizes; otherwise the surface would intersect
    /// itself.
    fn relations(&self) -> Vec<(&'static str, f32, f32, &'static str)> {
        match *self {
            Self::Torus { radius, tube, .. } => vec![("tube", tube, radius, "the ring's radius")],
            Self::Gear { tip, root, bore, .. } => vec![
                ("root", root, tip, "the tips' radius"),
                ("bore", bore, 0.9 * root, "nine tenths of the root's radius"),
            ],
            Self::LShape { x, y, arm, .. } => vec![("arm", arm, x.min(y), "the shorter side")],
            Self::Knot { radius, tube, .. } => {
                vec![("tube", tube, 0.2 * radius, "a fifth of the knot's radius")]
            }
            _ => Vec::new(),
        }
    }
}

/// Shortest length of a procedural shape, 2⁻⁶⁰: halves and squares of it stay far from underflow.
const MIN_LENGTH: f32 = 1.0 / (1_u64 << 60) as f32;

/// Longest length, 2⁵⁸: sums of two lengths stay within a mesh's largest coordinate.
const MAX_LENGTH: f32 = (1_u64 << 58) as f32;
