//! The cost of frames in which few boxes change, by counters.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, BoxCuller, BoxWorld, Groups, Motion};

use crate::boxes::scenes::{Kind, boxes};
use sdop_judge::draw::random::Random;

fn cube(x: f32) -> Aabb {
    Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
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

/// In each frame a few boxes drift, drawn anew. Each is listed now and then, and between that not.
#[test]
fn fresh_movers_keep_their_pairs() {
    let (count, movers) = (1000, 50);
    let side = (64.0_f64 / 3.0 * count as f64).cbrt() as f32;
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut unit = || (random.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut places: Vec<[f32; 3]> =
        (0..count).map(|_| [0; 3].map(|_| (unit() - 0.5) * side)).collect();
    let mut steps: Vec<[f32; 3]> =
        (0..count).map(|_| [0; 3].map(|_| 0.16 * (unit() - 0.5))).collect();
    let bounds = |at: [f32; 3]| Aabb::new(at.map(|x| x - 1.0), at.map(|x| x + 1.0));
    let mut boxes: Vec<Aabb> = places.iter().map(|&at| bounds(at)).collect();
    let (mut world, mut culler) = (BoxWorld::new(), BoxCuller::new());
    let ids: Vec<BodyId> = boxes.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
    for frame in 0..600 {
        for _ in 0..movers {
            let i = (unit() * count as f32) as usize;
            for (x, step) in places[i].iter_mut().zip(&mut steps[i]) {
                *x += *step;
                *step = if x.abs() > side / 2.0 { -x.signum() * step.abs() } else { *step };
            }
            boxes[i] = bounds(places[i]);
            world.set_bounds(ids[i], boxes[i]).unwrap();
        }
        world.cull().unwrap();
        let wanted = culler.cull(&boxes).unwrap().sorted();
        let pairs = world.pairs().map(|pair| pair.map(|id| id.slot() as u32));
        assert!(pairs.eq(wanted), "frame {frame}");
    }
    assert!(world.rest_counters().queried > 500 * movers as u64 / 2);
}
