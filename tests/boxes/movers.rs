//! Worlds in which few boxes change per frame: whatever the history, pairs and events are those of
//! the definition.

use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, BoxWorld, Groups, Motion};

use crate::boxes::scenes::{Kind, boxes, expected, moved};
use sdop_judge::draw::random::Random;

fn cube(x: f32) -> Aabb {
    Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
}

/// A world of cubes in a row, each of which meets the next, culled.
fn row(count: u16, motion: Motion) -> (BoxWorld, Vec<BodyId>) {
    let mut world = BoxWorld::new();
    let of = |i: u16| BoxBody { motion, ..cube(f32::from(i)).into() };
    let ids = (0..count).map(|i| world.insert(of(i)).unwrap()).collect();
    world.cull().unwrap();
    assert_eq!(world.events().begun().count(), usize::from(count) - 1);
    (world, ids)
}

/// Pairs at rest stay until a box leaves.
#[test]
fn resting_pairs_end_with_a_box() {
    let (mut world, ids) = row(100, Motion::Dynamic);
    for &id in &ids {
        world.set_motion(id, Motion::Resting).unwrap();
    }
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 99);
    assert_eq!(world.events().ended().count(), 0);
    // Set where it is, moved and woken: its pairs stay as long as it touches.
    let before = world.counters().updates;
    world.set_bounds(ids[7], cube(7.0)).unwrap();
    world.set_motion(ids[7], Motion::Dynamic).unwrap();
    world.cull().unwrap();
    assert_eq!(world.counters().updates, before, "nothing has changed");
    assert_eq!(world.events().iter().count(), 99);
    world.set_bounds(ids[20], cube(20.5)).unwrap();
    world.cull().unwrap();
    assert_eq!(world.counters().updates, before + 1);
    assert!(world.events().ended().eq([[ids[19], ids[20]]]));
    assert_eq!(world.body(ids[20]).unwrap().motion, Motion::Resting);
    // Two fixed boxes are in no pair, one and another at rest are.
    world.set_motion(ids[50], Motion::Fixed).unwrap();
    world.cull().unwrap();
    assert_eq!(world.events().iter().count(), 98);
    world.set_motion(ids[51], Motion::Fixed).unwrap();
    world.cull().unwrap();
    assert!(world.events().ended().eq([[ids[50], ids[51]]]));
    world.set_motion(ids[50], Motion::Resting).unwrap();
    world.cull().unwrap();
    assert!(world.events().begun().eq([[ids[50], ids[51]]]));
}

/// The box was moved after the cull that the snapshot has the pairs of, and the world has seen that
/// since.
#[test]
fn rollback_finds_all_anew() {
    let (mut world, ids) = row(100, Motion::Dynamic);
    world.set_bounds(ids[20], cube(20.5)).unwrap();
    let saved = world.snapshot();
    for _ in 0..2 {
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), 98);
        world.restore(&saved).unwrap();
        assert_eq!(world.pairs().len(), 99);
    }
}

/// Groups change the pairs of boxes that stay.
#[test]
fn groups_change_resting_pairs() {
    let (mut world, ids) = row(100, Motion::Resting);
    let mut body = world.body(ids[30]).unwrap();
    body.groups = Groups { member: 1, mask: 2 };
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    assert_eq!(world.events().ended().count(), 0, "others are in all groups");
    body.groups = Groups { member: 1, mask: 0 };
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    let ended = [[ids[29], ids[30]], [ids[30], ids[31]]];
    assert!(world.events().ended().eq(ended));
    body.groups = Groups::ALL;
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    assert!(world.events().begun().eq(ended));
}

/// Counted, not timed: what is looked at doesn't depend on how many boxes there are.
#[test]
fn a_frame_costs_what_changes() {
    let random = &mut Random::new(5);
    let tests_of = |count: usize, random: &mut Random| {
        let mut world = BoxWorld::new();
        let all = boxes(Kind::Cubes, count, random);
        let ids: Vec<BodyId> = all.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
        world.cull().unwrap();
        let before = *world.counters();
        for frame in 0..50 {
            let id = ids[random.below(ids.len())];
            let aabb = all[random.below(ids.len())];
            match frame % 3 {
                0 => world.set_bounds(id, aabb).unwrap(),
                1 => drop(world.insert(aabb).unwrap()),
                _ => world.set(id, BoxBody { motion: Motion::Fixed, ..aabb.into() }).unwrap(),
            }
            world.cull().unwrap();
        }
        let counted = world.counters().since(&before);
        assert_eq!(counted.updates, 50);
        counted.tests
    };
    let [few, many] = [500, 8000].map(|count| tests_of(count, random));
    assert!(few < 50 * 200 && many < 2 * few, "{few}, {many}");
}

/// Boxes that collide with none are compared with none.
#[test]
fn boxes_without_groups_are_not_compared() {
    let mut world = BoxWorld::new();
    let groups =
        |at: u32| [Groups { member: 1, mask: 0 }, Groups { member: 0, mask: 1 }][at as usize % 2];
    let ids: Vec<BodyId> = (0..3000)
        .map(|i| world.insert(BoxBody { groups: groups(i), ..cube(0.0).into() }).unwrap())
        .collect();
    for frame in 0..4 {
        ids.iter().for_each(|&id| world.set_bounds(id, cube(frame as f32)).unwrap());
        world.cull().unwrap();
        assert!(world.pairs().len() == 0 && world.counters().tests < 30_000);
    }
    for &id in &ids[..2] {
        world.set(id, cube(3.0)).unwrap();
    }
    world.cull().unwrap();
    assert!(world.pairs().eq([[ids[0], ids[1]]]));
}

/// Fixed boxes at one place, some of which are set per frame: no frame compares them with each
/// other, nor finds all pairs anew.
#[test]
fn parked_boxes_cost_their_changes() {
    let (mut world, count) = (BoxWorld::new(), 5000);
    let place = |step: usize| cube(1.0e-3 * (step % 100) as f32);
    let parked = |step| BoxBody { motion: Motion::Fixed, ..place(step).into() };
    let ids: Vec<BodyId> = (0..count).map(|i| world.insert(parked(i)).unwrap()).collect();
    let visitor = world.insert(cube(0.5)).unwrap();
    world.cull().unwrap();
    for frame in 0..20 {
        let before = (*world.counters(), world.rest_counters().queried);
        for i in (frame..count).step_by(17) {
            world.set_bounds(ids[i], place(i + frame + 1)).unwrap();
        }
        world.cull().unwrap();
        let changed = (frame..count).step_by(17).len() as u64;
        assert_eq!(world.rest_counters().queried - before.1, changed, "frame {frame}");
        // The cells near each box, and the visitor.
        let tests = world.counters().since(&before.0).tests;
        assert!(tests <= 64 * changed, "frame {frame}: {tests}");
        assert_eq!(world.pairs().len(), count);
        assert!(world.pairs().all(|pair| pair[1] == visitor));
    }
}

/// A giant that moves looks at more than all boxes are worth: then all pairs are found anew, and
/// they are the same.
#[test]
fn moving_giants_stay_cheap() {
    let random = &mut Random::new(6);
    let all = boxes(Kind::Cubes, 2000, random);
    let mut world = BoxWorld::new();
    let mut bounds: Vec<Aabb> = all;
    bounds.extend((0..40).map(|_| Aabb::new([-30.0; 3], [30.0; 3])));
    let ids: Vec<BodyId> = bounds.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
    world.cull().unwrap();
    for frame in 0..6 {
        for at in 2000..2000 + 10 * frame.min(4) {
            moved(std::slice::from_mut(&mut bounds[at]), 3.0, random);
            world.set_bounds(ids[at], bounds[at]).unwrap();
        }
        world.cull().unwrap();
        let wanted = expected(&bounds, |_| true, |_| Groups::ALL);
        let wanted = wanted.iter().map(|pair| pair.map(|i| ids[i as usize]));
        assert!(world.pairs().eq(wanted), "frame {frame}");
    }
}
