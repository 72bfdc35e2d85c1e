//! Settings of a culler: strategy, finder, tests and budget. Scene files have them as the table
//! `[cull]`, and the command line has them as flags, with the same names.

use thiserror::Error;

use super::{Axes, DirectionSet, Finder, Flow, HAS_CLOCK};
use crate::choice::choices;

choices! {
    /// Which volumes are tested, and in which order.
    Strategy, "strategy", {
        /// The control: nothing is culled, nothing is reported.
        None = "none",
        /// Bounding spheres alone.
        Sphere = "sphere",
        /// or-DOPs alone, without the sphere stage.
        OrDop = "or-dop",
        /// Spheres, and each hit's or-DOPs at once.
        SDopSequential = "s-dop-sequential",
        /// Spheres, the potentially colliding set listed, then the or-DOPs of the list.
        SDopBatch = "s-dop-batch",
        /// As sequential for pairs with a body of interest; for other pairs the spheres decide.
        SDopObjectOfInterest = "s-dop-object-of-interest",
        /// Spheres, then or-DOPs until the budget is spent; pairs that are left untested are
        /// reported.
        SDopTimeCritical = "s-dop-time-critical",
        /// World-aligned boxes, re-fitted each frame.
        Aabb = "aabb",
        /// World-aligned k-DOPs, re-fitted each frame.
        KDop = "k-dop",
        /// Oriented boxes, 15 axes.
        Obb = "obb",
    }
}

choices! {
    /// Which separating axes the or-DOP test tries.
    Overlap, "overlap test", {
        /// The first body's slab normals: the paper's "interval pairs in local space". First is the
        /// body with the lower number, or in the lower slot of a world.
        OneSided = "one-sided",
        /// Both bodies' slab normals.
        TwoSided = "two-sided",
        /// Both bodies' normals and every edge × edge axis.
        Full = "full",
    }
}

choices! {
    /// When or-DOP poses are updated.
    Updates, "update mode", {
        /// Every frame updates the or-DOP of every dynamic body: before any pair is tested or, for
        /// many bodies in a batch, together with the pairs that need them. Either way each counts
        /// as one update.
        Eager = "eager",
        /// Only the or-DOPs of bodies in the potentially colliding set are updated.
        Lazy = "lazy",
    }
}

choices! {
    /// In which order time-critical culling spends its budget.
    Order, "refinement order", {
        /// As the pair finder lists them.
        AsFound = "as-found",
        /// Pairs with a body of interest first.
        InterestFirst = "interest-first",
        /// Largest relative sphere overlap first.
        LargestOverlap = "largest-overlap",
        /// Pairs that were not tested for the longest time first.
        OldestAnswer = "oldest-answer",
    }
}

/// Which bodies are of interest, for example those in view: only their pairs are refined.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(untagged))]
pub enum Interest {
    /// The bodies with these indices.
    Bodies(Vec<u32>),
    /// The bodies whose sphere centre is in the cone.
    Cone(ViewCone),
}

/// A view cone: bodies whose sphere centre is in it are of interest. With `body` it moves and turns
/// with that body; with `apex` it does not move.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ViewCone {
    /// The body to which the cone is attached. Its translation is the apex, and `direction` is in
    /// its frame. The body itself is of interest if its sphere's centre is in the cone, as a centre
    /// at its origin is.
    pub body: Option<u32>,
    /// The fixed apex, world frame, instead of `body`.
    pub apex: Option<[f32; 3]>,
    /// The cone's axis, any non-zero length; world frame with `apex`.
    pub direction: [f32; 3],
    /// Angle between the axis and the rim in degrees, in (0, 180]. Points on the rim are in the
    /// cone.
    pub half_angle: f32,
    /// The length of the cone from the apex; `None` is unlimited.
    pub range: Option<f32>,
}

/// The budget per frame of time-critical culling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case")
)]
pub enum Budget {
    /// A number of or-DOP tests. Results are reproducible.
    Tests(u64),
    /// Wall time, in microseconds. An error on `wasm32-unknown-unknown`, which has no clock.
    Microseconds(u64),
}

/// All settings of a culler. The defaults are sequential S-DOP and the finder `auto`. A scene
/// file's `[cull]` table has the same keys and defaults.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields, default)
)]
pub struct CullSettings {
    /// The culling strategy.
    pub strategy: Strategy,
    /// The pair finder.
    pub pairs: Finder,
    /// The or-DOP's slab directions, written as k = 6, 14, 18 or 26.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "super::text::write_k", deserialize_with = "super::text::read_k")
    )]
    pub k: DirectionSet,
    /// The or-DOP's axes.
    pub axes: Axes,
    /// The or-DOP test.
    pub overlap: Overlap,
    /// When or-DOP poses are updated.
    pub updates: Updates,
    /// The bodies of interest.
    pub interest: Option<Interest>,
    /// The budget per frame of time-critical culling.
    pub budget: Option<Budget>,
    /// How time-critical culling spends it.
    pub order: Order,
}

impl Default for CullSettings {
    fn default() -> Self {
        Self {
            strategy: Strategy::SDopSequential,
            pairs: Finder::Auto,
            k: DirectionSet::K18,
            axes: Axes::Principal,
            overlap: Overlap::TwoSided,
            updates: Updates::Eager,
            interest: None,
            budget: None,
            order: Order::AsFound,
        }
    }
}

/// The error for invalid settings.
#[derive(Clone, PartialEq, Error)]
pub enum SettingsError {
    /// The strategy needs a budget or an interest that is not set.
    #[error("strategy {strategy} needs `{key}`; {help}", help = self.help())]
    Missing {
        /// The strategy.
        strategy: &'static str,
        /// The missing `[cull]` key.
        key: &'static str,
        /// How to mend it.
        hint: &'static str,
    },
    /// A budget of time on a target without a clock.
    #[error("budget: this target has no clock; {help}", help = self.help())]
    NoClock,
    /// An interest in a body that doesn't exist, or an invalid cone.
    #[error("interest: {problem}; {help}", help = self.help())]
    Interest {
        /// What is wrong.
        problem: String,
        /// How to mend it.
        hint: &'static str,
    },
}

crate::problem::errors!(SettingsError);

impl Budget {
    fn check(self, has_clock: bool) -> Result<(), SettingsError> {
        match self {
            Self::Microseconds(_) if !has_clock => Err(SettingsError::NoClock),
            _ => Ok(()),
        }
    }
}

impl SettingsError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Missing { hint, .. } | Self::Interest { hint, .. } => hint,
            Self::NoClock => "give a number of tests, budget = { tests = 1000 }",
        }
    }
}

impl CullSettings {
    /// The defaults, but with the finder `all-pairs`, as in the paper.
    #[must_use]
    pub fn all_pairs() -> Self {
        Self { pairs: Finder::AllPairs, ..Self::default() }
    }

    /// Checks that the settings fit together and suit a scene of `bodies` bodies.
    ///
    /// # Errors
    /// A strategy without its interest or budget; a budget of time on a target without a clock; an
    /// interest in a body that doesn't exist.
    pub fn check(&self, bodies: usize) -> Result<(), SettingsError> {
        let missing =
            |key, hint| SettingsError::Missing { strategy: self.strategy.name(), key, hint };
        let flow = self.strategy.scheme().flow;
        let needs_interest = flow == Flow::OfInterest
            || (flow == Flow::TimeCritical && self.order == Order::InterestFirst);
        if needs_interest && self.interest.is_none() {
            return Err(missing(
                "interest",
                "list body indices, interest = [0], or a cone, interest = { body = 0, direction = [0, 0, 1], half_angle = 30 }",
            ));
        }
        if flow == Flow::TimeCritical && self.budget.is_none() {
            return Err(missing(
                "budget",
                "give budget = { tests = 1000 } or budget = { microseconds = 500 }",
            ));
        }
        self.budget.map_or(Ok(()), |budget| budget.check(HAS_CLOCK))?;
        self.interest.as_ref().map_or(Ok(()), |interest| interest.check(bodies))
    }
}

impl Interest {
    /// Checks the interest against a scene of `bodies` bodies.
    ///
    /// # Errors
    /// A body index out of range; a cone without exactly one apex, without a direction, or with an
    /// invalid angle or range.
    pub fn check(&self, bodies: usize) -> Result<(), SettingsError> {
        let wrong = |problem, hint| Err(SettingsError::Interest { problem, hint });
        let named: &[u32] = match self {
            Self::Bodies(list) => list,
            Self::Cone(cone) => cone.body.as_slice(),
        };
        if let Some(body) = named.iter().find(|&&body| body as usize >= bodies) {
            return wrong(
                format!("body {body} of a scene of {bodies}"),
                "bodies are counted from 0",
            );
        }
        let Self::Cone(cone) = self else {
            return Ok(());
        };
        if cone.body.is_some() == cone.apex.is_some() {
            return wrong("a cone has one apex".to_owned(), "give `body` or `apex`, not both");
        }
        let all_finite = |v: &[f32; 3]| v.iter().all(|x| x.is_finite());
        if !all_finite(&cone.direction) || cone.direction == [0.0; 3] {
            return wrong(format!("direction {:?}", cone.direction), "any finite vector but zero");
        }
        if let Some(apex) = cone.apex.filter(|apex| !all_finite(apex)) {
            return wrong(format!("apex {apex:?}"), "coordinates are finite");
        }
        if !(cone.half_angle > 0.0 && cone.half_angle <= 180.0) {
            return wrong(
                format!("half_angle {}", cone.half_angle),
                "degrees, above 0 and up to 180",
            );
        }
        if let Some(range) = cone.range.filter(|range| range.is_nan() || *range <= 0.0) {
            return wrong(format!("range {range}"), "a length above 0, or leave it out");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_of_time_need_a_clock() {
        for (budget, has_clock, is_sound) in [
            (Budget::Microseconds(5), true, true),
            (Budget::Microseconds(5), false, false),
            (Budget::Tests(5), false, true),
        ] {
            assert_eq!(budget.check(has_clock).is_ok(), is_sound, "{budget:?}");
        }
    }
}
