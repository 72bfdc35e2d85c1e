//! A pair of colliders as a case.

use super::super::rapier::prelude::*;
use super::super::volume;
use crate::case::CaseBody;

/// Both colliders as they lie; none if one of them has no volume, which can't be dropped.
#[must_use]
pub fn case_of(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Vec<CaseBody> {
    let colliders: Vec<_> = pair.iter().filter_map(|&c| world.colliders.get(c)).collect();
    let Some(first) = colliders.first() else {
        return Vec::new();
    };
    let body = |collider: &&Collider| {
        let parent = collider.parent().and_then(|parent| world.bodies.get(parent));
        Some(CaseBody {
            shape: volume(collider.shape())?,
            fixed: parent.is_none_or(RigidBody::is_fixed),
            rotation: collider.rotation().to_array().map(|x| x as f32),
            translation: (collider.translation() - first.translation())
                .to_array()
                .map(|x| x as f32),
        })
    };
    colliders.iter().filter_map(body).collect()
}
