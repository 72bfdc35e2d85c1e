//! A stage, stepped in one of the modes.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use sdop::mesh::TriangleMesh;

use super::super::rapier::math::Vector;
use super::super::rapier::prelude::*;
use super::super::{Cost, Filter, HOOKS};
use super::calls::{Calls, CountingDispatcher, Filtering};
use super::scenes::Stage;
use crate::plan::{Mode, Plan};

/// One run.
pub struct Sim {
    /// The world.
    pub stage: Stage,
    /// How it is stepped.
    pub mode: Mode,
    counted: CountingDispatcher,
    filter: Filter,
    /// A bug for the check to see: the filter gets a prediction distance of zero, and a step
    /// without length.
    without_margin: bool,
}

/// Milliseconds of one step, by rapier's own counters.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepMs {
    /// All of it.
    pub step: f64,
    /// The narrow phase, with the filter in it.
    pub narrow: f64,
    /// The broad phase, before and after.
    pub broad: f64,
}

/// A pair of colliders after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    /// Number of points in all manifolds.
    pub points: usize,
    /// Whether one of them was given to the solver.
    pub active: bool,
    /// A hash of every point's place, distance and impulses, to the bit.
    pub bits: u64,
}

/// All pairs of colliders that have points, by handle.
pub type Touches = HashMap<[ColliderHandle; 2], Touch>;

impl Sim {
    /// Sets the scene up.
    #[must_use]
    pub fn new(plan: Plan, forms: &[TriangleMesh], mode: Mode) -> Self {
        let hooks = if mode == Mode::Hook { HOOKS } else { ActiveHooks::empty() };
        let mut stage = Stage::new(plan, forms, hooks);
        let counted = CountingDispatcher::default();
        stage.world.narrow_phase = NarrowPhase::with_query_dispatcher(counted.clone());
        stage.world.integration_parameters.contact_recycling = mode.recycles();
        for shape in stage.shapes() {
            counted.culling.add(shape);
        }
        if mode.dispatches() {
            counted.calls.set_filtering(Filtering::On);
        }
        Self { stage, mode, counted, filter: Filter::default(), without_margin: false }
    }

    /// The same with a bug planted: margins are left out.
    #[must_use]
    pub fn without_margin(mut self) -> Self {
        self.without_margin = true;
        self.counted.calls.leave_margin_out();
        self
    }

    /// Steps, filtered if the mode says so.
    pub fn step(&mut self) -> StepMs {
        self.stage.between_steps();
        self.step_only();
        let counters = &self.stage.world.physics_pipeline.counters;
        StepMs {
            step: counters.step_time_ms(),
            narrow: counters.cd.narrow_phase_time.time_ms(),
            broad: counters.cd.broad_phase_time.time_ms()
                + counters.cd.final_broad_phase_time.time_ms(),
        }
    }

    fn step_only(&mut self) {
        let world = &mut self.stage.world;
        if self.mode == Mode::Hook {
            let mut parameters = world.integration_parameters;
            if self.without_margin {
                parameters.normalized_prediction_distance = 0.0;
                parameters.dt = 0.0;
            }
            world.step_with_events(self.filter.for_step(&parameters), &());
        } else {
            world.step();
        }
    }

    /// The state that the next step begins with, and what becomes of it without the filter.
    #[must_use]
    pub fn unfiltered(&self) -> [Stage; 2] {
        let mut start = self.stage.fork();
        start.between_steps();
        let mut fork = start.fork();
        let calls = &self.counted.calls;
        calls.set_filtering(Filtering::Off); // both have the same dispatcher
        fork.world.step();
        if self.mode.dispatches() {
            calls.set_filtering(Filtering::On);
        }
        [start, fork]
    }

    /// What reached the narrow phase.
    #[must_use]
    pub fn calls(&self) -> &Arc<Calls> {
        &self.counted.calls
    }

    /// What the filter in the hook took.
    pub fn cost(&self) -> Cost {
        self.filter.cost()
    }
}

/// The pairs of a world that have contact points.
#[must_use]
pub fn touches(world: &PhysicsWorld) -> Touches {
    let mut touches = Touches::new();
    for pair in world.narrow_phase.contact_pairs() {
        let manifolds = pair.manifolds().iter().chain(pair.solver_manifolds());
        let points: Vec<_> = manifolds.flat_map(|manifold| &manifold.points).collect();
        if points.is_empty() {
            continue;
        }
        let mut hash = DefaultHasher::new();
        for point in &points {
            let impulses = Vector::new(
                point.data.impulse,
                point.data.tangent_impulse.x,
                point.data.tangent_impulse.y,
            );
            let places = [point.local_p1, point.local_p2, impulses];
            places.map(|v| v.to_array().map(|x| x.to_bits())).hash(&mut hash);
            point.dist.to_bits().hash(&mut hash);
        }
        let touch = Touch {
            points: pair.manifolds().iter().map(|manifold| manifold.points.len()).sum(),
            active: pair.has_any_active_contact(),
            bits: hash.finish(),
        };
        touches.insert([pair.collider1, pair.collider2], touch);
    }
    touches
}

/// The pairs of a sensor and what overlaps it.
#[must_use]
pub fn overlaps(world: &PhysicsWorld) -> HashSet<[ColliderHandle; 2]> {
    let pairs = world.narrow_phase.intersection_pairs();
    pairs.filter(|(.., overlap)| *overlap).map(|(a, b, _)| [a, b]).collect()
}

/// Bodies whose pose or velocities differ in a bit.
#[must_use]
pub fn bodies_that_differ(a: &RigidBodySet, b: &RigidBodySet) -> usize {
    let bits = |body: &RigidBody| {
        let pose = body.position();
        let vectors = [pose.translation, body.linvel(), body.angvel()];
        (
            vectors.map(|v| v.to_array().map(|x| x.to_bits())),
            pose.rotation.to_array().map(|x| x.to_bits()),
            body.is_sleeping(),
        )
    };
    let differs = |(handle, body): &(RigidBodyHandle, &RigidBody)| {
        b.get(*handle).is_none_or(|other| bits(other) != bits(body))
    };
    a.iter().filter(differs).count() + b.iter().filter(|(handle, _)| !a.contains(*handle)).count()
}
