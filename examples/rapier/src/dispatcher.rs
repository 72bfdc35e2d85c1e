//! The filter in rapier's query dispatcher. rapier calls it at the start of its narrow phase, with
//! two shapes, their relative pose and the distance up to which it needs contacts, so nothing has
//! to be copied and nothing can be out of date.
//!
//! Unlike a hook, it does not disable rapier's reuse of contacts. Continuous collision detection
//! does not call it.

use std::sync::{Arc, RwLock};

use rustc_hash::FxHashMap;
use sdop::volume::DirectionSet;
use sdop::world::PairTest;

use super::rapier::geometry::{ContactData, ContactManifold, ContactManifoldData, SharedShape};
use super::rapier::math::{Pose, Real, Vector};
use super::rapier::parry::query::details::{NormalConstraints, ShapeCastOptions};
use super::rapier::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use super::rapier::parry::shape::Shape;
use super::volumes::{rounding, volume};

/// Answers for pairs of known shapes that can't touch, and passes all others to the next
/// dispatcher: `NarrowPhase::with_query_dispatcher(culling.clone().chain(DefaultQueryDispatcher))`.
/// Clones know the same shapes.
#[derive(Clone)]
pub struct CullingDispatcher(Arc<RwLock<KnownShapes>>);

struct KnownShapes {
    enabled: bool,
    test: PairTest,
    /// By address. Holding the shape prevents the address from being reused.
    shapes: FxHashMap<usize, Entry>,
}

struct Entry {
    _held: SharedShape,
    number: u32,
    reach: f64,
    /// Its models grown by margins.
    grown: Vec<(f32, u32)>,
}

impl Default for CullingDispatcher {
    fn default() -> Self {
        let test = PairTest::new(DirectionSet::K18);
        Self(Arc::new(RwLock::new(KnownShapes { enabled: true, test, shapes: FxHashMap::default() })))
    }
}

impl CullingDispatcher {
    /// Switches the filter, also of clones, on or off: all pairs pass while it is off.
    pub fn set_enabled(&self, enabled: bool) {
        if let Ok(mut known) = self.0.write() {
            known.enabled = enabled;
        }
    }

    /// Adds a collider's shape. Returns whether its pairs can be filtered (see [`volume`]); if not,
    /// they pass.
    pub fn add(&self, shape: &SharedShape) -> bool {
        let Ok(mut known) = self.0.write() else {
            return false;
        };
        if known.find(shape.as_ref()).is_some() {
            return true;
        }
        let Some(volume) = volume(shape.as_ref()) else {
            return false;
        };
        let Ok(number) = known.test.add(&volume) else {
            return false;
        };
        let entry =
            Entry { _held: shape.clone(), number, reach: volume.reach.into(), grown: Vec::new() };
        known.shapes.insert(address(shape.as_ref()), entry);
        true
    }

    /// False only if the two shapes are farther apart than `distance`.
    fn may_touch(&self, pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, distance: Real) -> bool {
        let Ok(known) = self.0.read() else {
            return true;
        };
        let Some((first, second)) =
            known.find(g1).zip(known.find(g2)).filter(|_| known.enabled)
        else {
            return true;
        };
        // 1 % for parry's GJK, which stops within 0.1 % of a distance.
        let size = first.reach + second.reach + pos12.translation.length() as f64;
        let margin = (1.01 * distance as f64 + rounding(size)) as f32;
        let rotation = pos12.rotation.to_array().map(|x| x as f32);
        let translation = pos12.translation.to_array().map(|x| x as f32);
        match first.model(margin) {
            Some(model) => known.test.may_touch(model, second.number, rotation, translation),
            None => {
                drop(known);
                self.grow(g1, margin); // for the next time
                true
            }
        }
    }

    /// Makes a model of the shape with a margin that serves this one and those a little larger.
    fn grow(&self, shape: &dyn Shape, margin: f32) {
        let Ok(mut known) = self.0.write() else {
            return;
        };
        let KnownShapes { test, shapes, .. } = &mut *known;
        if let Some(entry) = shapes.get_mut(&address(shape))
            && let Ok(model) = test.grown(entry.number, margin * WIDER)
        {
            entry.grown.push((margin * WIDER, model));
        }
    }
}

/// A new margin is this much larger than the one that required it, and serves margins down to
/// itself divided by the square of this factor.
const WIDER: f32 = 1.125;

impl KnownShapes {
    fn find(&self, shape: &dyn Shape) -> Option<&Entry> {
        self.shapes.get(&address(shape))
    }
}

impl Entry {
    /// The model with at least this margin and not much more.
    fn model(&self, margin: f32) -> Option<u32> {
        let fits = |&&(grown, _): &&(f32, u32)| margin <= grown && grown <= margin * WIDER * WIDER;
        self.grown.iter().find(fits).map(|&(_, model)| model)
    }
}

fn address(shape: &dyn Shape) -> usize {
    std::ptr::from_ref(shape).cast::<()>() as usize
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for CullingDispatcher {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold>,
        _workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        // Points of earlier steps are for parry to keep or to drop.
        let touched = manifolds.iter().any(|manifold| !manifold.points.is_empty());
        if touched || self.may_touch(pos12, g1, g2, prediction) { Err(Unsupported) } else { Ok(()) }
    }

    fn contact_manifold_convex_convex(
        &self,
        _pos12: &Pose,
        _g1: &dyn Shape,
        _g2: &dyn Shape,
        _normals1: Option<&dyn NormalConstraints>,
        _normals2: Option<&dyn NormalConstraints>,
        _prediction: Real,
        _manifold: &mut ContactManifold,
    ) -> Result<(), Unsupported> {
        Err(Unsupported)
    }
}

/// Whether a sensor overlaps; everything else is for the next dispatcher.
impl QueryDispatcher for CullingDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        if self.may_touch(pos12, g1, g2, 0.0) {
            Err(Unsupported)
        } else {
            Ok(ShapeIntersection::new(false))
        }
    }

    fn distance(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        Err(Unsupported)
    }

    fn contact(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        Err(Unsupported)
    }

    fn closest_points(
        &self,
        _: &Pose,
        _: &dyn Shape,
        _: &dyn Shape,
        _max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        Err(Unsupported)
    }

    fn cast_shapes(
        &self,
        _: &Pose,
        _: Vector,
        _: &dyn Shape,
        _: &dyn Shape,
        _: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }

    fn cast_shapes_nonlinear(
        &self,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _start_time: Real,
        _end_time: Real,
        _stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }
}
