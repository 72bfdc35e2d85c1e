//! Excluded pairs end with a body, and a snapshot's are checked.

use super::*;

/// Snapshots of before have no excluded pairs; damaged ones are refused.
#[test]
fn damaged_exclusions_are_refused() {
    let mut world = World::new(shapes()).unwrap();
    let [a, b] = [(); 2].map(|()| world.insert(Body::default()).unwrap());
    world.exclude(a, b).unwrap();
    let saved = serde_json::to_value(world.snapshot()).unwrap();
    let mut without = saved.clone();
    without.as_object_mut().unwrap().remove("excluded");
    world.restore(&serde_json::from_value(without).unwrap()).unwrap();
    assert!(world.excluded().is_empty());
    for bad in [[[1, 0]], [[2, 2]], [[0, 9999]]] {
        let mut damaged = saved.clone();
        damaged["excluded"] = serde_json::json!(bad);
        let damaged = serde_json::from_value(damaged).unwrap();
        let error = world.restore(&damaged).unwrap_err().to_string();
        assert!(error.contains("excluded pairs that there can't be"), "{error}");
    }
}

#[test]
fn removed_bodies_have_no_pairs() {
    let mut world = World::new(shapes()).unwrap();
    let [a, b] = [(); 2].map(|()| world.insert(Body::default()).unwrap());
    world.exclude(a, b).unwrap();
    assert!(world.is_excluded(b, a));
    world.remove(a).unwrap();
    assert!(!world.is_excluded(a, b) && world.excluded().is_empty());
    assert_eq!(world.exclude(a, b), Err(WorldError::Gone(a)));
    assert_eq!(world.include(b, a), Err(WorldError::Gone(a)));
    world.cull().unwrap();
    let next = world.insert(Body::default()).unwrap();
    assert_eq!(next.slot(), a.slot());
    assert_eq!(world.cull().unwrap().len(), 1, "another body in the slot is another pair");
    assert_eq!(world.exclude(next, next), Ok(false));
}
