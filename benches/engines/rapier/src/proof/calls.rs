//! Counts and times calls of parry's dispatcher: which pairs reach the narrow phase, and at what
//! cost.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::time::Instant;

use super::super::CullingDispatcher;
use super::super::rapier::geometry::ContactManifold;
use super::super::rapier::math::{Pose, Real, Vector};
use super::super::rapier::parry::query::details::{NormalConstraints, ShapeCastOptions};
use super::super::rapier::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, DefaultQueryDispatcher,
    NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance,
    ShapeIntersection, Unsupported,
};
use super::super::rapier::parry::shape::Shape;
use super::super::rapier::prelude::{ContactData, ContactManifoldData};

/// Pairs that reached the narrow phase, and pairs that were kept from it.
#[derive(Debug, Default)]
pub struct Calls {
    /// Pairs with contact points afterwards.
    pub hits: CallTimes,
    /// Pairs without.
    pub misses: CallTimes,
    /// Of the misses, those that the filter rejects. In [`Filtering::Shadow`] they are checked all
    /// the same.
    pub culled: CallTimes,
    /// Pairs that the filter was asked about: the time is its own.
    pub asked: CallTimes,
    /// Pairs of which one is a sensor.
    pub sensors: CallTimes,
    filtering: AtomicU8,
    timing: AtomicBool,
    without_margin: AtomicBool,
}

/// What the filter is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filtering {
    /// Not asked.
    Off = 0,
    /// Asked and heeded.
    On = 1,
    /// Asked, but the pair is checked all the same: what would the rejected ones have cost?
    Shadow = 2,
}

/// A number of calls and their nanoseconds.
#[derive(Debug, Default)]
pub struct CallTimes {
    count: AtomicU64,
    timed: AtomicU64,
    ns: AtomicU64,
}

/// A call that took longer was interrupted by another process, and is not timed.
const INTERRUPTED_NS: u64 = 2_000_000;

impl CallTimes {
    /// Calls so far.
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// Nanoseconds per call, if timed.
    pub fn mean_ns(&self) -> f64 {
        self.ns.load(Ordering::Relaxed) as f64 / self.timed.load(Ordering::Relaxed).max(1) as f64
    }

    fn add(&self, ns: Option<u64>) {
        self.count.fetch_add(1, Ordering::Relaxed);
        if let Some(ns) = ns.filter(|&ns| ns < INTERRUPTED_NS) {
            self.timed.fetch_add(1, Ordering::Relaxed);
            self.ns.fetch_add(ns, Ordering::Relaxed);
        }
    }
}

impl Calls {
    /// Pairs that reached the narrow phase.
    pub fn narrow(&self) -> u64 {
        self.hits.count() + self.misses.count() + self.sensors.count()
    }

    /// What the filter in the dispatcher does from now on.
    pub fn set_filtering(&self, filtering: Filtering) {
        self.filtering.store(filtering as u8, Ordering::Relaxed);
    }

    /// Whether calls are timed from now on.
    pub fn set_timing(&self, timing: bool) {
        self.timing.store(timing, Ordering::Relaxed);
    }

    /// Plants a bug: the filter gets a prediction distance of zero.
    pub fn leave_margin_out(&self) {
        self.without_margin.store(true, Ordering::Relaxed);
    }

    fn is(&self, filtering: Filtering) -> bool {
        self.filtering.load(Ordering::Relaxed) == filtering as u8
    }

    fn start(&self) -> Option<Instant> {
        self.timing.load(Ordering::Relaxed).then(Instant::now)
    }
}

fn since(start: Option<Instant>) -> Option<u64> {
    start.map(|start| start.elapsed().as_nanos() as u64)
}

/// A [`CullingDispatcher`] followed by the [`DefaultQueryDispatcher`], with [`Calls`].
#[derive(Clone, Default)]
pub struct CountingDispatcher {
    /// The counts.
    pub calls: Arc<Calls>,
    /// The filter.
    pub culling: CullingDispatcher,
}

type Manifold = ContactManifold;

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for CountingDispatcher {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<Manifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let calls = &self.calls;
        let mut rejected = false;
        if !calls.is(Filtering::Off) {
            let told = if calls.without_margin.load(Ordering::Relaxed) { 0.0 } else { prediction };
            let start = calls.start();
            let answer = self.culling.contact_manifolds(pos12, g1, g2, told, manifolds, workspace);
            calls.asked.add(since(start));
            rejected = answer.is_ok();
            if rejected && calls.is(Filtering::On) {
                calls.culled.add(None);
                return Ok(());
            }
        }
        let start = calls.start();
        let done = DefaultQueryDispatcher
            .contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        let ns = since(start);
        if rejected {
            calls.culled.add(ns);
        }
        let hit = manifolds.iter().any(|manifold| !manifold.points.is_empty());
        if hit { &calls.hits } else { &calls.misses }.add(ns);
        done
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normals1: Option<&dyn NormalConstraints>,
        normals2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut Manifold,
    ) -> Result<(), Unsupported> {
        DefaultQueryDispatcher
            .contact_manifold_convex_convex(pos12, g1, g2, normals1, normals2, prediction, manifold)
    }
}

impl QueryDispatcher for CountingDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        let calls = &self.calls;
        if calls.is(Filtering::On) {
            let answer = self.culling.intersection_test(pos12, g1, g2);
            calls.asked.add(None);
            if answer.is_ok() {
                calls.culled.add(None);
                return answer;
            }
        }
        let start = calls.start();
        let found = DefaultQueryDispatcher.intersection_test(pos12, g1, g2);
        calls.sensors.add(since(start));
        found
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        DefaultQueryDispatcher.distance(pos12, g1, g2)
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        DefaultQueryDispatcher.contact(pos12, g1, g2, prediction)
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist)
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes_nonlinear(
            motion1,
            g1,
            motion2,
            g2,
            start_time,
            end_time,
            stop_at_penetration,
        )
    }
}
