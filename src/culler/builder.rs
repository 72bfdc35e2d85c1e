//! How a culler is made: settings first, then the shapes and bodies.

use super::{CullError, Culler, check};
use crate::bodies::Bodies;
use crate::settings::{
    Budget, CullSettings, DirectionSet, Finder, Interest, Order, Overlap, Strategy, Updates,
};
use crate::simd::{Tier, in_default_mode};
use crate::threads::{FrameThreads, Threads, WORTH_WAKING};
use crate::volume::Shape;

/// Everything about a [`Culler`] that isn't its shapes and bodies. What isn't set has the default
/// of [`CullSettings`], the caller's thread and the fastest tier of this CPU.
///
/// ```
/// # use sdop::{Bodies, Culler, Finder, ProceduralShape, Shape, ShapeSpec, Strategy};
/// # let mesh = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build()?;
/// # let shapes = [Shape::build(&mesh, &ShapeSpec::default())?];
/// # let bodies = Bodies::default();
/// let spheres = Culler::builder().strategy(Strategy::Sphere).finder(Finder::Grid).threads(2);
/// let culler = spheres.build(&shapes, &bodies)?; // and as often as wanted, for other bodies too
/// assert_eq!(culler.finder(), Finder::Grid);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use = "a builder does nothing before `build`"]
pub struct CullerBuilder {
    pub(crate) settings: CullSettings,
    threads: usize,
    worth_waking: Option<u64>,
    tier: Option<Tier>,
}

impl CullerBuilder {
    /// All settings at once, in place of those set so far.
    pub fn settings(self, settings: &CullSettings) -> Self {
        let settings = settings.clone();
        Self { settings, ..self }
    }

    /// Which volumes are tested, and in which order.
    pub fn strategy(mut self, strategy: Strategy) -> Self {
        self.settings.strategy = strategy;
        self
    }

    /// Who finds the candidates; the reported set doesn't depend on it.
    pub fn finder(mut self, finder: Finder) -> Self {
        self.settings.pairs = finder;
        self
    }

    /// The slab directions of [`Strategy::KDop`]; those of or-DOPs are chosen with their shapes
    /// ([`ShapeSpec`](crate::volume::ShapeSpec)).
    pub fn k(mut self, k: DirectionSet) -> Self {
        self.settings.k = k;
        self
    }

    /// Which separating axes the or-DOP test tries.
    pub fn overlap(mut self, overlap: Overlap) -> Self {
        self.settings.overlap = overlap;
        self
    }

    /// When or-DOP poses are updated.
    pub fn updates(mut self, updates: Updates) -> Self {
        self.settings.updates = updates;
        self
    }

    /// The bodies of interest, for the strategies that need them.
    pub fn interest(mut self, interest: Interest) -> Self {
        self.settings.interest = Some(interest);
        self
    }

    /// What a frame of [`Strategy::SDopTimeCritical`] may cost.
    pub fn budget(mut self, budget: Budget) -> Self {
        self.settings.budget = Some(budget);
        self
    }

    /// In which order [`Strategy::SDopTimeCritical`] spends its budget.
    pub fn order(mut self, order: Order) -> Self {
        self.settings.order = order;
        self
    }

    /// Number of threads, the caller's included, at most 1,024 or the culler isn't built; 0 is
    /// taken as 1. Frames of little work stay on the caller's. Lists, counters and hashes don't
    /// depend on it.
    pub fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The least work of a frame, in nanoseconds of one thread as counters tell them, for which
    /// threads besides the caller's are woken: a millisecond (2²⁰ ns) by default, 0 for always.
    /// Lists, counters and hashes don't depend on it.
    pub fn worth_waking(self, nanoseconds: u64) -> Self {
        let worth_waking = Some(nanoseconds);
        Self {
            worth_waking,
            ..self
        }
    }

    /// A tier of SIMD in place of the fastest. Lists, counters and hashes don't depend on it.
    pub fn tier(self, tier: Tier) -> Self {
        let tier = Some(tier);
        Self { tier, ..self }
    }

    /// The culler of these bodies. Static bodies' volumes are placed here, once.
    ///
    /// `bodies.shape` counts in `shapes`. For [`Strategy::Obb`] each shape's own box replaces its
    /// or-DOP.
    ///
    /// # Errors
    /// Bodies or shapes outside of the contract
    /// ([`check_bodies`](crate::bodies::contract::check_bodies)); settings that can't be carried
    /// out (a missing interest or budget, a body that doesn't exist); threads that the system
    /// refuses; a shape far from its origin ([`Shape::pose_offset`]).
    pub fn build(&self, shapes: &[Shape], bodies: &Bodies) -> Result<Culler, CullError> {
        check::near(shapes)?;
        self.build_about_vertices(shapes, bodies)
    }

    /// The same of poses that place the origin of each shape's vertices, however far that is from
    /// the mesh's own.
    pub(crate) fn build_about_vertices(
        &self,
        shapes: &[Shape],
        bodies: &Bodies,
    ) -> Result<Culler, CullError> {
        let tier = self.tier.unwrap_or_else(Tier::detect);
        let worth_waking = self.worth_waking.unwrap_or(WORTH_WAKING);
        let threads = FrameThreads::new(Threads::new(self.threads)?, worth_waking);
        in_default_mode(|| Culler::build(shapes, bodies, &self.settings, tier, threads))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_builder_keeps_each_choice_and_no_other() {
        let built = Culler::builder()
            .threads(3)
            .worth_waking(7)
            .tier(Tier::SCALAR)
            .finder(Finder::Sweep);
        let wanted = CullerBuilder {
            settings: CullSettings {
                pairs: Finder::Sweep,
                ..CullSettings::default()
            },
            threads: 3,
            worth_waking: Some(7),
            tier: Some(Tier::SCALAR),
        };
        assert_eq!(built, wanted);
        let other = CullerBuilder {
            threads: 5,
            ..wanted
        };
        assert_eq!(built.threads(5), other);
    }
}
