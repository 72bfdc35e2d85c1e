//! rapier3d: BroadPhaseBvh with a collider for each box, whose pairs are followed by its events.

use std::collections::{HashMap, HashSet};

use adapters::{Frame, serve};
use rapier3d::prelude::*;

fn main() {
    serve("rapier3d", || {
        let (mut phase, params) = (BroadPhaseBvh::new(), IntegrationParameters::default());
        let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
        let (mut islands, mut soft) = (IslandManager::new(), SoftBodySet::new());
        let mut handles: HashMap<usize, ColliderHandle> = HashMap::new();
        let mut pairs: HashSet<[usize; 2]> = HashSet::new();
        move |frame: &Frame| {
            let mut removed = Vec::new();
            for id in &frame.gone {
                if let Some(handle) = handles.remove(id) {
                    colliders.remove(handle, &mut islands, &mut bodies, &mut soft, false);
                    pairs.retain(|pair| !pair.contains(id));
                    removed.push(handle);
                }
            }
            let mut events = Vec::new();
            // Removals come first: a new collider may have the index of a removed one, and
            // `set_aabb` takes effect at once.
            phase.update(&params, &colliders, &bodies, &[], &removed, &mut events);
            for (&[a, b, c, d, e, f], &id) in frame.boxes.iter().zip(&frame.ids) {
                let handle = *handles.entry(id).or_insert_with(|| {
                    let body = bodies.insert(RigidBodyBuilder::dynamic());
                    let made = ColliderBuilder::ball(1.0).user_data(id as u128);
                    colliders.insert_with_parent(made, body, &mut bodies)
                });
                let corners = Aabb::new(Vector::new(a, b, c), Vector::new(d, e, f));
                phase.set_aabb(&params, handle, corners);
            }
            phase.update(&params, &colliders, &bodies, &[], &[], &mut events);
            let ids = |pair: ColliderPair| {
                let id = |handle| {
                    colliders
                        .get(handle)
                        .map(|it: &Collider| it.user_data as usize)
                };
                let mut ids = [id(pair.collider1)?, id(pair.collider2)?];
                ids.sort_unstable();
                Some(ids)
            };
            for event in events {
                match event {
                    BroadPhasePairEvent::AddPair(pair) => pairs.extend(ids(pair)),
                    BroadPhasePairEvent::DeletePair(pair) => {
                        ids(pair).map(|gone| pairs.remove(&gone));
                    }
                }
            }
            Ok(pairs.iter().copied().collect())
        }
    });
}
