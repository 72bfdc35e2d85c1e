//! Excluded pairs of boxes, in frames in which few boxes change and in those that find all pairs.

use std::collections::BTreeSet;

use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, BoxWorld, Groups, Motion};

use crate::boxes::scenes::Random;

fn sorted(a: BodyId, b: BodyId) -> [BodyId; 2] {
    [a.min(b), a.max(b)]
}

fn draw(random: &mut Random) -> BoxBody {
    let min = [(); 3].map(|()| random.within(5.0));
    let mut body = BoxBody::from(Aabb::new(min, min.map(|x| x + 2.0)));
    if random.below(4) == 0 {
        body.motion = Motion::Fixed;
    }
    if random.below(4) == 0 {
        body.groups = Groups { member: 1, mask: 2 };
    }
    body
}

/// By the definition.
fn expected(world: &BoxWorld, excluded: &BTreeSet<[BodyId; 2]>) -> BTreeSet<[BodyId; 2]> {
    let bodies: Vec<_> = world.bodies().collect();
    let mut pairs = BTreeSet::new();
    for (n, (a, one)) in bodies.iter().enumerate() {
        for (b, other) in &bodies[n + 1..] {
            let may_move = one.motion != Motion::Fixed || other.motion != Motion::Fixed;
            let meet = one.bounds.meets(&other.bounds) && one.groups.collide(other.groups);
            if may_move && meet && !excluded.contains(&sorted(*a, *b)) {
                pairs.insert([*a, *b]);
            }
        }
    }
    pairs
}

/// Excluded pairs are left out, and events follow.
#[test]
fn exclusions_change_pairs_and_events() {
    let random = &mut Random(47);
    let mut world = BoxWorld::new();
    let mut ids: Vec<BodyId> = (0..300).map(|_| world.insert(draw(random)).unwrap()).collect();
    let mut excluded = BTreeSet::new();
    let mut before = BTreeSet::new();
    let mut left_out = 0;
    for frame in 0..120 {
        let changes = if frame % 20 == 7 { 200 } else { random.below(5) };
        for _ in 0..changes {
            let [a, b] = [(); 2].map(|()| ids[random.below(ids.len())]);
            match random.below(8) {
                0 => {
                    world.remove(a).unwrap();
                    ids.retain(|&id| id != a);
                    excluded.retain(|pair: &[BodyId; 2]| !pair.contains(&a));
                    ids.push(world.insert(draw(random)).unwrap());
                }
                1 => world.set(a, draw(random)).unwrap(),
                2 if !excluded.is_empty() => {
                    let at = random.below(excluded.len());
                    let [a, b] = *excluded.iter().nth(at).unwrap();
                    excluded.remove(&[a, b]);
                    assert!(world.include(b, a).unwrap() && !world.include(b, a).unwrap());
                }
                3..6 if !before.is_empty() => {
                    // One that is reported, as long as both are there.
                    let at = random.below(before.len());
                    let [a, b]: [BodyId; 2] = *before.iter().nth(at).unwrap();
                    if world.contains(a) && world.contains(b) {
                        assert_eq!(world.exclude(a, b).unwrap(), excluded.insert([a, b]));
                    }
                }
                _ => {
                    let is_new = a != b && excluded.insert(sorted(a, b));
                    assert_eq!(world.exclude(b, a).unwrap(), is_new);
                }
            }
        }
        if frame % 30 == 19 {
            let saved = serde_json::to_string(&world.snapshot()).unwrap();
            let restored = &mut BoxWorld::new();
            restored.restore(&serde_json::from_str(&saved).unwrap()).unwrap();
            assert_eq!(restored.excluded(), world.excluded());
            world = restored.clone();
        }
        let wanted = expected(&world, &excluded);
        left_out += expected(&world, &BTreeSet::new()).len() - wanted.len();
        world.cull().unwrap();
        assert!(world.pairs().eq(wanted.iter().copied()), "frame {frame}");
        let events = world.events();
        let begun: Vec<_> = wanted.difference(&before).copied().collect();
        let ended: Vec<_> = before.difference(&wanted).copied().collect();
        assert_eq!(events.begun().collect::<Vec<_>>(), begun, "frame {frame}");
        assert_eq!(events.ended().collect::<Vec<_>>(), ended, "frame {frame}");
        assert_eq!(world.excluded(), Vec::from_iter(excluded.iter().copied()));
        before = wanted;
    }
    assert!(left_out > 2000, "{left_out}");
}

#[test]
fn damaged_exclusions_are_refused() {
    let mut world = BoxWorld::new();
    let aabb = Aabb::new([0.0; 3], [1.0; 3]);
    let [a, b, gone] = [(); 3].map(|()| world.insert(aabb).unwrap());
    world.exclude(b, a).unwrap();
    world.exclude(gone, a).unwrap();
    world.remove(gone).unwrap();
    let saved = serde_json::to_value(world.snapshot()).unwrap();
    assert_eq!(saved["excluded"], serde_json::json!([[0, 1]]));
    for bad in [vec![[1, 0]], vec![[0, 2]], vec![[0, 1], [0, 1]]] {
        let mut damaged = saved.clone();
        damaged["excluded"] = serde_json::json!(bad);
        let error = world.restore(&serde_json::from_value(damaged).unwrap()).unwrap_err();
        assert!(error.to_string().contains("excluded pairs"), "{error}");
    }
    assert!(world.is_excluded(a, b));
}
