//! The filter in rapier's contact hook: pairs that can't touch in this step don't reach the narrow
//! phase.
//!
//! Every collider that has a [`volume`] is a body of an sdop [`World`]; others pass unfiltered. A
//! pair is rejected if the world's cull doesn't report it and both colliders still have the pose,
//! shape, groups and margin that were culled. Otherwise all colliders are copied and culled again
//! immediately, so that no teleport, substep or forgotten call can make a verdict out of date.

use std::collections::hash_map::Entry;
use std::sync::{Arc, RwLock};
use std::time::Instant;

use rustc_hash::FxHashMap;
use sdop::world::{Body, BodyId, Groups, Motion, PairLookup, World};

use super::rapier::math::Pose;
use super::rapier::prelude::*;
use super::volumes::{Step, volume};
use sdop::volume::Shape as Volume;

/// The hooks that a collider must have so that its pairs are filtered. One collider of a pair is
/// enough.
pub const HOOKS: ActiveHooks =
    ActiveHooks::FILTER_CONTACT_PAIRS.union(ActiveHooks::FILTER_INTERSECTION_PAIR);

/// The filter, to be passed to each step as its hooks. If you have hooks of your own, call
/// [`Filter::may_touch`] in them.
#[derive(Default)]
pub struct Filter {
    step: Step,
    mirror: RwLock<Mirror>,
}

impl Filter {
    /// The filter for the next step; `parameters` are those of that step.
    pub fn for_step(&mut self, parameters: &IntegrationParameters) -> &Self {
        self.step = Step::new(parameters);
        self
    }

    /// False only if rapier's narrow phase would find no contact for this pair in this step, or no
    /// overlap of a sensor.
    pub fn may_touch(&self, pair: &PairFilterContext) -> bool {
        let body = |handle: Option<_>| handle.and_then(|handle| pair.bodies.get(handle));
        let bodies = [body(pair.rigid_body1), body(pair.rigid_body2)];
        // Continuous collision detection asks the same hook, about motions that are longer than any
        // margin.
        if bodies.iter().flatten().any(|body| body.is_ccd_active()) {
            return true;
        }
        let verdict = |mirror: &Mirror| mirror.verdict(pair, bodies, self.step);
        let known = self.mirror.read().ok().and_then(|mirror| verdict(&mirror));
        let asked = || {
            let mut mirror = self.mirror.write().ok()?;
            verdict(&mirror).or_else(|| {
                mirror.follow(pair.colliders, pair.bodies, self.step);
                verdict(&mirror)
            })
        };
        known.or_else(asked).unwrap_or(true)
    }

    /// What it has cost so far.
    pub fn cost(&self) -> Cost {
        self.mirror.read().map(|mirror| mirror.cost).unwrap_or_default()
    }
}

impl PhysicsHooks for Filter {
    fn filter_contact_pair(&self, pair: &PairFilterContext) -> Option<SolverFlags> {
        self.may_touch(pair).then(SolverFlags::default)
    }

    fn filter_intersection_pair(&self, pair: &PairFilterContext) -> bool {
        self.may_touch(pair)
    }
}

/// The filter's time apart from its look-ups.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// How often all colliders were copied and culled.
    pub culls: u64,
    /// Seconds of copying colliders.
    pub mirror: f64,
    /// Culling.
    pub cull: f64,
}

/// The colliders as they were culled.
#[derive(Default)]
struct Mirror {
    world: Option<World>,
    volumes: Vec<Volume>,
    /// Which of them each shape has, by address; holding the shape keeps the address its own.
    shapes: FxHashMap<usize, (SharedShape, Option<u32>)>,
    seats: Vec<Option<Seat>>,
    reported: PairLookup,
    cost: Cost,
}

/// A collider as it was culled, at its slot in rapier's arena.
struct Seat {
    handle: ColliderHandle,
    shape: SharedShape,
    pose: Pose,
    groups: InteractionGroups,
    margin: f64,
    reach: f64,
    awake: bool,
    /// `None` for a collider that passes unfiltered.
    id: Option<BodyId>,
    /// The last cull that it was in.
    cull: u64,
}

impl Seat {
    /// Whether the collider is where and what it was, and still within its margin.
    fn is(
        &self,
        handle: ColliderHandle,
        now: &Collider,
        body: Option<&RigidBody>,
        step: Step,
    ) -> bool {
        self.handle == handle
            && Arc::ptr_eq(&self.shape.0, &now.shared_shape().0)
            && self.pose == *now.position()
            && self.groups == now.collision_groups()
            && step.margin(now, body, self.reach) <= self.margin
    }
}

impl Mirror {
    /// Whether the pair was reported, if both colliders are still as they were culled.
    fn verdict(
        &self,
        pair: &PairFilterContext,
        bodies: [Option<&RigidBody>; 2],
        step: Step,
    ) -> Option<bool> {
        let seat = |handle: ColliderHandle, body| {
            let seat = self.seats.get(slot(handle))?.as_ref()?;
            let current = || Some(seat.is(handle, pair.colliders.get(handle)?, body, step));
            (seat.id.is_none() || current()?).then_some(seat)
        };
        let (a, b) = (seat(pair.collider1, bodies[0])?, seat(pair.collider2, bodies[1])?);
        match (a.id, b.id) {
            // Two that were at rest weren't culled against each other.
            (Some(first), Some(second)) if a.awake || b.awake => {
                Some(self.reported.contains(first, second))
            }
            _ => Some(true),
        }
    }

    /// Takes all colliders over and culls them. What the world refuses passes unfiltered.
    fn follow(&mut self, colliders: &ColliderSet, bodies: &RigidBodySet, step: Step) {
        let start = Instant::now();
        self.cost.culls += 1;
        for (_, collider) in colliders.iter_enabled() {
            self.learn(collider.shared_shape());
        }
        if self.world.is_none() {
            self.seats.clear();
            self.world = World::new(self.volumes.clone()).ok();
        }
        for (handle, collider) in colliders.iter_enabled() {
            let body = collider.parent().and_then(|handle| bodies.get(handle));
            self.take_over(handle, collider, body, step);
        }
        let Some(world) = &mut self.world else { return };
        for seat in &mut self.seats {
            if let Some(gone) = seat.take_if(|seat| seat.cull != self.cost.culls) {
                gone.id.map(|id| world.remove(id));
            }
        }
        let mirrored = Instant::now();
        if world.cull().is_ok() {
            self.reported.refill(world);
        } else {
            self.seats.clear(); // too far apart for one world: nothing is known
            self.world = None;
        }
        self.cost.cull += mirrored.elapsed().as_secs_f64();
        self.cost.mirror += (mirrored - start).as_secs_f64();
    }

    /// Builds the shape's volume where it is new. The world is made anew with it.
    fn learn(&mut self, shape: &SharedShape) {
        if let Entry::Vacant(entry) = self.shapes.entry(address(shape)) {
            let number = volume(shape.as_ref()).map(|volume| {
                self.world = None;
                self.volumes.push(volume);
                self.volumes.len() as u32 - 1
            });
            entry.insert((shape.clone(), number));
        }
    }

    fn take_over(
        &mut self,
        handle: ColliderHandle,
        collider: &Collider,
        body: Option<&RigidBody>,
        step: Step,
    ) {
        let Some(world) = &mut self.world else { return };
        if self.seats.len() <= slot(handle) {
            self.seats.resize_with(slot(handle) + 1, || None);
        }
        let seat = &mut self.seats[slot(handle)];
        let awake = body.is_some_and(|body| !body.is_fixed() && !body.is_sleeping());
        let shape = collider.shared_shape();
        let number = self.shapes.get(&address(shape)).and_then(|(_, number)| *number);
        let reach = number.map_or(0.0, |number| self.volumes[number as usize].reach.into());
        let needed = step.margin(collider, body, reach);
        if let Some(seat) = seat
            && seat.is(handle, collider, body, step)
            && seat.awake == awake
            && seat.margin <= 2.0 * needed
        {
            seat.cull = self.cost.culls;
            return;
        }
        let old = seat.take();
        // A slower body keeps its margin for a while: another margin is another model for the
        // culler.
        let margin = match &old {
            Some(old) if needed <= old.margin && old.margin <= 2.0 * needed => old.margin as f32,
            _ => (1.25 * needed) as f32,
        };
        let groups = collider.collision_groups();
        let now = number.map(|shape| Body {
            shape,
            motion: if awake { Motion::Dynamic } else { Motion::Fixed },
            rotation: collider.rotation().to_array().map(|x| x as f32),
            translation: collider.translation().to_array().map(|x| x as f64),
            groups: match groups.test_mode {
                InteractionTestMode::And => {
                    Groups { member: groups.memberships.bits(), mask: groups.filter.bits() }
                }
                InteractionTestMode::Or => Groups::ALL,
            },
            margin,
            ..Body::default() // what rounding the rotation moves is in the margin
        });
        let id = match (old.and_then(|old| old.id), now) {
            (Some(id), Some(now)) if world.set(id, now).is_ok() => Some(id),
            (old, now) => {
                old.map(|id| world.remove(id));
                now.and_then(|now| world.insert(now).ok())
            }
        };
        *seat = Some(Seat {
            handle,
            shape: shape.clone(),
            pose: *collider.position(),
            groups,
            margin: margin.into(),
            reach,
            awake,
            id,
            cull: self.cost.culls,
        });
    }
}

fn slot(handle: ColliderHandle) -> usize {
    handle.into_raw_parts().0 as usize
}

fn address(shape: &SharedShape) -> usize {
    Arc::as_ptr(&shape.0).cast::<()>() as usize
}
