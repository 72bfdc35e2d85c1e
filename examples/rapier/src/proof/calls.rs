//! Parry's own dispatcher, counted: what reaches the narrow phase, and what it costs.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use super::super::rapier::geometry::ContactManifold;
use super::super::rapier::math::{Pose, Real, Vector};
use super::super::rapier::parry::query::details::{NormalConstraints, ShapeCastOptions};
use super::super::rapier::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, DefaultQueryDispatcher,
    NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit,
    ShapeDistance, ShapeIntersection, Unsupported,
};
use super::super::rapier::parry::shape::Shape;
use super::super::rapier::prelude::{ContactData, ContactManifoldData};

/// Pairs of colliders that reached the narrow phase.
#[derive(Debug, Default)]
pub struct Calls {
    /// Pairs with contact points afterwards.
    pub hits: Timed,
    /// Pairs without.
    pub misses: Timed,
    /// Pairs of which one is a sensor.
    pub sensors: Timed,
    /// Whether to time them.
    pub timing: AtomicBool,
}

/// A number of calls and their nanoseconds.
#[derive(Debug, Default)]
pub struct Timed {
    count: AtomicU64,
    ns: AtomicU64,
}

impl Timed {
    /// Calls so far.
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// Nanoseconds per call, if timed.
    pub fn mean_ns(&self) -> f64 {
        self.ns.load(Ordering::Relaxed) as f64 / self.count().max(1) as f64
    }

    fn add(&self, start: Option<Instant>) {
        self.count.fetch_add(1, Ordering::Relaxed);
        if let Some(start) = start {
            self.ns.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        }
    }
}

impl Calls {
    /// All pairs that reached the narrow phase.
    pub fn count(&self) -> u64 {
        self.hits.count() + self.misses.count() + self.sensors.count()
    }

    fn start(&self) -> Option<Instant> {
        self.timing.load(Ordering::Relaxed).then(Instant::now)
    }
}

/// [`DefaultQueryDispatcher`] with [`Calls`].
#[derive(Clone, Debug, Default)]
pub struct Counted(pub Arc<Calls>);

type Manifold = ContactManifold;

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for Counted {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<Manifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let start = self.0.start();
        let done = DefaultQueryDispatcher.contact_manifolds(
            pos12, g1, g2, prediction, manifolds, workspace,
        );
        let hit = manifolds.iter().any(|manifold| !manifold.points.is_empty());
        if hit { &self.0.hits } else { &self.0.misses }.add(start);
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
        DefaultQueryDispatcher.contact_manifold_convex_convex(
            pos12, g1, g2, normals1, normals2, prediction, manifold,
        )
    }
}

impl QueryDispatcher for Counted {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        let start = self.0.start();
        let found = DefaultQueryDispatcher.intersection_test(pos12, g1, g2);
        self.0.sensors.add(start);
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
            motion1, g1, motion2, g2, start_time, end_time, stop_at_penetration,
        )
    }
}
