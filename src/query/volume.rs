//! The volumes and lines of queries, and their checks.

use thiserror::Error;

use crate::bodies::Aabb;
use crate::bodies::LineTrack;
use crate::posed::QueryShape;
use crate::rounding::narrow::{narrow, turn_error};
use crate::rounding::{LIMIT, exp2, query::largest, up};
use crate::simd::in_default_mode;

/// The least size of a ray's direction.
const LEAST_DIRECTION: f64 = exp2(-60);

/// The volume of a query, in the world frame. Coordinates and sizes are finite and at most 2⁶⁰.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryVolume<'a> {
    /// A box on the world's axes, between two corners.
    Box {
        /// The lower ends.
        min: [f64; 3],
        /// The upper ends, each at least the lower one.
        max: [f64; 3],
    },
    /// A ball, or a point if the radius is 0.
    Ball {
        /// Its centre.
        centre: [f64; 3],
        /// Its radius, 0 or more.
        radius: f64,
    },
    /// A shape at a pose, grown by a margin. Its ball and its or-DOP are tested.
    Shape {
        /// The shape.
        shape: &'a QueryShape,
        /// Orientation quaternion (x, y, z, w) of any non-zero norm.
        rotation: [f32; 4],
        /// Translation of its origin.
        translation: [f64; 3],
        /// The margin, a length of 0 or more.
        margin: f32,
    },
}

impl<'a> QueryVolume<'a> {
    /// A shape at a pose in f64, grown by a margin: the rotation is a quaternion (x, y, z, w) of
    /// any non-zero norm. If f32 doesn't hold it, the margin also covers what rounding may move.
    #[must_use]
    pub fn shape(
        shape: &'a QueryShape,
        rotation: impl Into<[f64; 4]>,
        translation: impl Into<[f64; 3]>,
        margin: f32,
    ) -> Self {
        let (rotation, translation) = (rotation.into(), translation.into());
        in_default_mode(|| {
            let (rotation, is_rounded) = narrow(rotation);
            let error = turn_error(is_rounded, shape.radius_about_pose());
            let is_grown = error > 0.0 && margin >= 0.0; // an invalid margin stays invalid
            let margin = if is_grown { up(f64::from(margin) + error) } else { margin };
            Self::Shape { shape, rotation, translation, margin }
        })
    }
}

impl From<Aabb> for QueryVolume<'_> {
    fn from(aabb: Aabb) -> Self {
        let [min, max] = [aabb.min, aabb.max].map(|corner| corner.map(f64::from));
        Self::Box { min, max }
    }
}

/// A segment or a ray in the world frame: the points of parameter s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// from + s·(to − from) for 0 ≤ s ≤ 1. Both ends may be one point. Coordinates are finite and
    /// at most 2⁶⁰ in size.
    Segment {
        /// The point of s = 0.
        from: [f64; 3],
        /// The point of s = 1.
        to: [f64; 3],
    },
    /// origin + s·direction for 0 ≤ s.
    Ray {
        /// The point of s = 0.
        origin: [f64; 3],
        /// The unit of s. The largest coordinate is 2⁻⁶⁰ to 2⁶⁰ in size.
        direction: [f64; 3],
    },
}

/// The error of a query outside of the contract. No query was answered.
#[derive(Clone, PartialEq, Error)]
#[error("query {query}: {quantity} {value}; {help}", help = self.help())]
pub struct QueryError {
    /// The query's number in its batch, from 0.
    pub query: usize,
    /// The invalid quantity.
    pub quantity: &'static str,
    /// Its value.
    pub value: String,
    hint: &'static str,
}

crate::problem::errors!(QueryError);

impl QueryError {
    pub(crate) fn new(
        query: usize,
        quantity: &'static str,
        value: String,
        hint: &'static str,
    ) -> Self {
        Self { query, quantity, value, hint }
    }

    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        self.hint
    }
}

const VECTOR_HELP: &str = "coordinates are finite and at most 2^60 in size";

/// Checks a query and reports the first problem.
struct QueryCheck(usize);

impl QueryCheck {
    fn that(
        &self,
        is_sound: bool,
        quantity: &'static str,
        value: &dyn std::fmt::Debug,
        hint: &'static str,
    ) -> Result<(), QueryError> {
        if is_sound {
            return Ok(());
        }
        Err(QueryError::new(self.0, quantity, format!("{value:?}"), hint))
    }

    fn vector(&self, quantity: &'static str, v: [f64; 3]) -> Result<(), QueryError> {
        // NaN is not at most anything.
        let is_sound = v.iter().all(|x| x.abs() <= f64::from(LIMIT));
        self.that(is_sound, quantity, &v, VECTOR_HELP)
    }

    fn length(&self, quantity: &'static str, length: f64) -> Result<(), QueryError> {
        let is_sound = (0.0..=f64::from(LIMIT)).contains(&length);
        self.that(is_sound, quantity, &length, "a length of 0 or more, at most 2^60")
    }
}

impl QueryVolume<'_> {
    pub(crate) fn check(&self, query: usize) -> Result<(), QueryError> {
        let check = QueryCheck(query);
        match *self {
            Self::Box { min, max } => {
                check.vector("min", min)?;
                check.vector("max", max)?;
                let is_sound = (0..3).all(|axis| min[axis] <= max[axis]);
                let hint = "`min` is at most `max` on each axis";
                check.that(is_sound, "box", &(min, max), hint)
            }
            Self::Ball { centre, radius } => {
                check.vector("centre", centre)?;
                check.length("radius", radius)
            }
            Self::Shape { shape, rotation, translation, margin } => {
                check.length("shape's size", shape.reach())?;
                check.length("margin", margin.into())?;
                let pose = shape.check_pose(query, rotation, translation);
                pose.map_err(|error| {
                    QueryError::new(query, error.quantity, error.value, error.hint)
                })
            }
        }
    }
}

impl Line {
    pub(super) fn check(&self, query: usize) -> Result<(), QueryError> {
        let check = QueryCheck(query);
        match *self {
            Self::Segment { from, to } => {
                check.vector("from", from)?;
                check.vector("to", to)
            }
            Self::Ray { origin, direction } => {
                check.vector("origin", origin)?;
                check.vector("direction", direction)?;
                let is_sound = largest(direction) >= LEAST_DIRECTION;
                let hint = "the largest coordinate of a direction is 2^-60 to 2^60 in size";
                check.that(is_sound, "direction", &direction, hint)
            }
        }
    }

    /// Its start, the unit of s, and the largest s.
    pub(super) fn track(&self) -> LineTrack {
        match *self {
            Self::Segment { from, to } => {
                LineTrack { from, speed: [0, 1, 2].map(|axis| to[axis] - from[axis]), limit: 1.0 }
            }
            Self::Ray { origin, direction } => {
                LineTrack { from: origin, speed: direction, limit: f64::INFINITY }
            }
        }
    }
}
