//! [`CullerBuilder`]: settings first, then the shapes and bodies.

use super::{CullError, Culler, check};
use crate::bodies::Bodies;
use crate::settings::{
    Budget, CullSettings, DirectionSet, Finder, Interest, Order, Overlap, Strategy, Updates,
};
use crate::simd::{Tier, in_default_mode};
use crate::threads::{FrameThreads, Threads, WORTH_WAKING};
use crate::volume::Shape;

/// Settings of a [`Culler`], and the function that builds it from shapes and bodies. The defaults
/// are those of [`CullSettings`], the caller's thread and the fastest tier of this CPU.
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
    /// Replaces all settings at once.
    pub fn settings(self, settings: &CullSettings) -> Self {
        let settings = settings.clone();
        Self { settings, ..self }
    }

    /// Which volumes are tested, and in which order.
    pub fn strategy(mut self, strategy: Strategy) -> Self {
        self.settings.strategy = strategy;
        self
    }

    /// Which pair finder finds the candidates. The reported set doesn't depend on it.
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

    /// When or-DOPs are updated to the bodies' poses.
    pub fn updates(mut self, updates: Updates) -> Self {
        self.settings.updates = updates;
        self
    }

    /// The bodies of interest, for the strategies that need them.
    pub fn interest(mut self, interest: Interest) -> Self {
        self.settings.interest = Some(interest);
        self
    }

    /// The budget per frame of [`Strategy::SDopTimeCritical`].
    pub fn budget(mut self, budget: Budget) -> Self {
        self.settings.budget = Some(budget);
        self
    }

    /// In which order [`Strategy::SDopTimeCritical`] spends its budget.
    pub fn order(mut self, order: Order) -> Self {
        self.settings.order = order;
        self
    }

    /// Number of threads, including the caller's: at most 1,024, otherwise [`Self::build`] fails; 0
    /// counts as 1. Frames of little work run on the caller's thread alone. Lists, counters and
    /// hashes don't depend on it.
    pub fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The least work of a frame for which other threads are woken, in nanoseconds of one thread,
    /// estimated from the previous frame's counters. The default is a millisecond (2²⁰ ns); 0 wakes
    /// them always. Lists, counters and hashes don't depend on it.
    pub fn worth_waking(self, nanoseconds: u64) -> Self {
        let worth_waking = Some(nanoseconds);
        Self { worth_waking, ..self }
    }

    /// The SIMD tier, instead of the fastest. Lists, counters and hashes don't depend on it.
    pub fn tier(self, tier: Tier) -> Self {
        let tier = Some(tier);
        Self { tier, ..self }
    }

    /// Builds the culler of these bodies. The volumes of static bodies are computed here, once.
    ///
    /// `bodies.shape` has indices into `shapes`. For [`Strategy::Obb`] each shape's oriented box
    /// replaces its or-DOP.
    ///
    /// # Errors
    /// Bodies or shapes that break the contract
    /// ([`check_bodies`](crate::volume::check_bodies)); invalid settings (a missing
    /// interest or budget, a body that doesn't exist); threads that the system refuses to start; a
    /// shape far from its origin ([`Shape::pose_offset`]).
    pub fn build(&self, shapes: &[Shape], bodies: &Bodies) -> Result<Culler, CullError> {
        check::near(shapes)?;
        self.build_about_vertices(shapes, bodies)
    }

    /// As [`Self::build`], for poses that place the origin of each shape's vertices, however far
    /// that is from the mesh's own.
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
