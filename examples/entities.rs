//! A broad phase for an engine of entities and components, in the shape of a plugin that takes the
//! place of avian's `BvhBroadPhasePlugin`. Each function is a system: the first three keep a
//! [`BoxWorld`] in step with the components, the last one adds contact pairs and removes them.
//!
//! Avian's types are stood in for by those at the end, so that this runs without Bevy. In a plugin,
//! [`BroadPhase`] is a `Resource`, and slices of changes are queries with `Added`, `Changed` or
//! `RemovedComponents`.
use std::collections::{BTreeSet, HashMap};

use sdop::boxes::BoxBody;
use sdop::living::{BodyId, WorldError};
use sdop::{Aabb, BoxWorld, Groups, Motion};

/// The boxes of all colliders, and whose they are.
#[derive(Default)]
struct BroadPhase {
    world: BoxWorld,
    ids: HashMap<Entity, BodyId>,
    entities: HashMap<BodyId, Entity>,
    /// Boxes whose pairs have yet to end.
    removed: Vec<BodyId>,
}

/// Colliders that are new.
fn add_colliders(phase: &mut BroadPhase, added: &[Collider]) -> Result<(), WorldError> {
    for collider in added {
        let id = phase.world.insert(BoxBody {
            bounds: collider.aabb,
            motion: collider.body.into(),
            groups: Groups { member: collider.layers.memberships, mask: collider.layers.filters },
        })?;
        phase.ids.insert(collider.entity, id);
        phase.entities.insert(id, collider.entity);
    }
    Ok(())
}

/// Colliders that have moved. Those that haven't cost nothing.
fn update_colliders(phase: &mut BroadPhase, moved: &[(Entity, Aabb)]) -> Result<(), WorldError> {
    for (entity, aabb) in moved {
        phase.world.set_bounds(phase.ids[entity], *aabb)?;
    }
    Ok(())
}

/// Colliders that are gone. Their pairs have ended by the next [`collect_collision_pairs`].
fn remove_colliders(phase: &mut BroadPhase, removed: &[Entity]) -> Result<(), WorldError> {
    for entity in removed {
        if let Some(id) = phase.ids.remove(entity) {
            phase.world.remove(id)?;
            phase.removed.push(id);
        }
    }
    Ok(())
}

/// Adds an edge for each pair whose boxes have begun to overlap, and removes those that have ended.
/// Pairs that overlapped before cost nothing.
fn collect_collision_pairs(
    phase: &mut BroadPhase,
    graph: &mut ContactGraph,
) -> Result<(), Box<dyn std::error::Error>> {
    phase.world.cull()?;
    let events = phase.world.events();
    let of = |pair: [BodyId; 2]| pair.map(|id| phase.entities[&id]);
    for pair in events.ended() {
        graph.edges.remove(&of(pair));
    }
    for pair in events.begun() {
        graph.edges.insert(of(pair));
    }
    for id in phase.removed.drain(..) {
        phase.entities.remove(&id);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut phase, mut graph) = (BroadPhase::default(), ContactGraph::default());
    let cube = |x: f32| Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
    let collider = |n: u8, body| Collider {
        entity: Entity(n.into()),
        aabb: cube(2.0 * f32::from(n)),
        body,
        layers: CollisionLayers { memberships: 1, filters: u32::MAX },
    };
    let mut row: Vec<_> = (1..5).map(|n| collider(n, RigidBody::Static)).collect();
    row.push(collider(0, RigidBody::Dynamic));
    add_colliders(&mut phase, &row)?;
    for step in 0..=8_u8 {
        update_colliders(&mut phase, &[(Entity(0), cube(f32::from(step)))])?;
        if step == 5 {
            remove_colliders(&mut phase, &[Entity(2)])?; // while a contact lasts
            add_colliders(&mut phase, &[collider(5, RigidBody::Static)])?;
        }
        collect_collision_pairs(&mut phase, &mut graph)?;
        println!("step {step}: {:?}", graph.edges);
    }
    Ok(())
}

#[derive(Clone, Copy, Debug, Hash, PartialEq, Eq, PartialOrd, Ord)]
struct Entity(u64);

#[derive(Clone, Copy)]
enum RigidBody {
    Dynamic,
    Static,
}

impl From<RigidBody> for Motion {
    fn from(body: RigidBody) -> Self {
        match body {
            RigidBody::Dynamic => Self::Dynamic,
            RigidBody::Static => Self::Fixed, // a body with `Sleeping` is `Resting`
        }
    }
}

struct CollisionLayers {
    memberships: u32,
    filters: u32,
}

struct Collider {
    entity: Entity,
    aabb: Aabb,
    body: RigidBody,
    layers: CollisionLayers,
}

#[derive(Default)]
struct ContactGraph {
    edges: BTreeSet<[Entity; 2]>,
}
