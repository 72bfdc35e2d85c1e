//! Contacts stay what they were: each step is taken by two worlds in the same state, in one of
//! which the filter rejects pairs.

use std::collections::BTreeMap;

use sdop::mesh::{ProceduralShape, TriangleMesh};

use super::rapier::math::{Pose, Real, Rotation, Vector};
use super::rapier::parry::query::{DefaultQueryDispatcher, QueryDispatcher as _};
use super::rapier::prelude::*;
use super::{CullingDispatcher, Filter, HOOKS};

/// Where the filter is. The twin has the same dispatcher switched off, or a hook that rejects
/// nothing, because a dispatcher or a hook alone changes what rapier computes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Dispatcher,
    Hook,
}

/// What bodies are made of.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Hull,
    Mesh,
    Compound,
}

/// A hook that rejects nothing.
struct EveryPair;

impl PhysicsHooks for EveryPair {
    fn filter_contact_pair(&self, _: &PairFilterContext) -> Option<SolverFlags> {
        Some(SolverFlags::default())
    }
}

/// Twenty-seven bodies that fall and collide in an open box.
fn world(place: Place, kind: Kind, culling: &CullingDispatcher) -> PhysicsWorld {
    let (mut world, forms) = (PhysicsWorld::new(), shapes(kind));
    let hooks = if place == Place::Hook { HOOKS } else { ActiveHooks::empty() };
    if place == Place::Dispatcher {
        assert!(forms.iter().all(|shape| culling.add(shape)));
    }
    let dispatcher = culling.clone().chain(DefaultQueryDispatcher);
    world.narrow_phase = NarrowPhase::with_query_dispatcher(dispatcher);
    for side in [-Vector::Y, Vector::X, -Vector::X, Vector::Z, -Vector::Z] {
        let half = Vector::splat(6.0) - side.abs() * 5.5;
        let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
        world.insert_collider(wall.translation(side * 2.3), None);
    }
    for i in 0..27 {
        let cell = [i % 3, i / 9, i / 3 % 3].map(|cell| cell as Real - 1.0);
        let turn = Rotation::from_scaled_axis(Vector::new(i as Real, 0.3, -0.7 * i as Real));
        let body = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(Vector::from_array(cell) * 1.1, turn))
            .linvel(Vector::new(cell[2], -3.0, -cell[0]));
        let body = world.insert_body(body);
        let collider = ColliderBuilder::new(forms[i % forms.len()].clone());
        world.insert_collider(collider.active_hooks(hooks), Some(body));
    }
    world
}

/// The same world in the same state.
fn twin(from: &PhysicsWorld) -> PhysicsWorld {
    PhysicsWorld {
        gravity: from.gravity,
        integration_parameters: from.integration_parameters,
        islands: from.islands.clone(),
        broad_phase: from.broad_phase.clone(),
        narrow_phase: from.narrow_phase.clone(),
        bodies: from.bodies.clone(),
        colliders: from.colliders.clone(),
        ..PhysicsWorld::new()
    }
}

/// All contact points of each pair, and all poses, to the bit.
fn state(world: &PhysicsWorld) -> (BTreeMap<[u32; 2], Vec<String>>, Vec<Pose>) {
    let number = |collider: ColliderHandle| collider.into_raw_parts().0;
    let pairs = world.narrow_phase.contact_pairs().map(|pair| {
        let manifolds = pair.manifolds().iter().chain(pair.solver_manifolds());
        let points = manifolds.flat_map(|manifold| &manifold.points);
        let points = points.map(|point| format!("{point:?}")).collect::<Vec<_>>();
        ([pair.collider1, pair.collider2].map(number), points)
    });
    let contacts = pairs.filter(|(_, points)| !points.is_empty()).collect();
    (contacts, world.bodies.iter().map(|(_, body)| *body.position()).collect())
}

fn shapes(kind: Kind) -> Vec<SharedShape> {
    let forms = [
        ProceduralShape::Torus { radius: 0.35, tube: 0.15, segments: 12, sides: 6 },
        ProceduralShape::LShape { x: 0.8, y: 0.8, arm: 0.25, thickness: 0.3 },
        ProceduralShape::Needle { length: 1.0, radius: 0.15, sides: 8 },
    ];
    let corners = |mesh: &TriangleMesh| -> Vec<Vector> {
        let corner = |v: &[f32; 3]| Vector::from_array(v.map(|x| x as Real));
        mesh.vertices.iter().map(corner).collect()
    };
    let hull = |points: &[Vector]| SharedShape::convex_hull(points).expect("it has a volume");
    let shape = |form: ProceduralShape| {
        let mesh = form.build().expect("a form is a mesh");
        let points = corners(&mesh);
        match kind {
            Kind::Hull => hull(&points),
            Kind::Mesh => SharedShape::trimesh(points, mesh.triangles).expect("it has triangles"),
            Kind::Compound => {
                let part = |x: Real| (Pose::from_translation(Vector::X * x), hull(&points));
                SharedShape::compound(vec![part(-0.05), part(0.05)])
            }
        }
    };
    forms.into_iter().map(shape).collect()
}

/// The first step in which the twins differ, and the contacts of all steps before it.
fn first_difference(place: Place, kind: Kind, is_margin_planted: bool) -> (Option<usize>, usize) {
    let (culling, mut filter) = (CullingDispatcher::default(), Filter::default());
    let (mut filtered, mut contacts) = (world(place, kind, &culling), 0);
    for step in 0..60 {
        let mut whole = twin(&filtered);
        let mut parameters = filtered.integration_parameters;
        if is_margin_planted {
            (parameters.normalized_prediction_distance, parameters.dt) = (0.0, 0.0);
        }
        if place == Place::Hook {
            whole.step_with_events(&EveryPair, &());
            filtered.step_with_events(filter.for_step(&parameters), &());
        } else {
            culling.set_enabled(false);
            whole.step();
            culling.set_enabled(true);
            filtered.step();
        }
        let whole = state(&whole);
        if state(&filtered) != whole {
            return (Some(step), contacts);
        }
        contacts += whole.0.len();
    }
    (None, contacts)
}

#[test]
fn contacts_are_unchanged() {
    for place in [Place::Dispatcher, Place::Hook] {
        for kind in [Kind::Hull, Kind::Mesh, Kind::Compound] {
            let (step, contacts) = first_difference(place, kind, false);
            assert!(step.is_none() && contacts > 500, "{place:?}, {kind:?}: {step:?}, {contacts}");
        }
    }
}

/// A filter that drops touching pairs is seen: it gets a prediction distance of zero.
#[test]
fn missing_margins_are_seen() {
    assert!(first_difference(Place::Hook, Kind::Hull, true).0.is_some());
}
