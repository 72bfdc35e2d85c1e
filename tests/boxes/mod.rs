//! Given boxes: exactly those that have a point in common, by every finder, in every tier, on any
//! number of threads.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod columns;
mod lives;
mod misuse;
mod movers;
pub mod scenes;

use sdop::boxes::BoxCullerBuilder;
use sdop::{Aabb, BoxCuller, Finder, Groups, Tier};

use scenes::{Kind, boxes, expected, moved};
use sdop_judge::draw::random::Random;

/// Every way to find the same pairs: finders, tiers, threads.
fn ways() -> Vec<(String, BoxCuller)> {
    let mut ways = Vec::new();
    for &finder in Finder::ALL {
        let of = BoxCuller::builder().finder(finder);
        for tier in Tier::available() {
            let culler = of.clone().tier(tier).build().unwrap();
            ways.push((format!("{finder}, {tier}"), culler));
        }
        ways.push((
            format!("{finder}, three threads"),
            of.threads(3).worth_waking(0).build().unwrap(),
        ));
    }
    ways
}

/// Holds each way against the definition while so many boxes move by `step`.
fn assert_exact(kind: Kind, count: usize, frames: usize, step: f32, random: &mut Random) {
    let mut ways = ways();
    let mut now = boxes(kind, count, random);
    for frame in 0..frames {
        let wanted = expected(&now, |_| true, |_| Groups::ALL);
        for (way, culler) in &mut ways {
            let found = culler.cull(&now).unwrap().sorted();
            assert!(found == wanted, "{kind:?}, {count} boxes, frame {frame}, {way}");
        }
        moved(&mut now, step, random);
    }
}

/// Exactly the pairs of the definition are listed.
#[test]
fn pairs_match_definition() {
    let random = &mut Random::new(1);
    for kind in Kind::ALL {
        for (count, frames) in [(0, 2), (1, 2), (2, 3), (7, 4), (64, 6), (65, 24), (300, 24)] {
            let step = if frames % 4 == 0 { 0.05 } else { 0.4 };
            assert_exact(kind, count, frames, step, random);
        }
    }
}

/// The cubes about neighbours touch, and those within don't: each pair is looked up, in runs as in
/// blocks.
#[test]
fn near_cubes_touch_or_miss() {
    let random = &mut Random::new(7);
    let mut ends = |at: usize| {
        let (lo, hi) = (at as f32, at as f32 + 1.0);
        [lo, [hi, hi.next_down(), hi + 0.015_625][random.below(3)]]
    };
    // In twos, a finder hands out a few at a time; in dozens, long runs.
    for (side, boxes) in [(6, 432), (2, 200)] {
        let on_a_lattice: Vec<Aabb> = (0..boxes)
            .map(|n| {
                let [x, y, z] = [n % side, n / side % side, n / side / side % side].map(&mut ends);
                Aabb::new([x[0], y[0], z[0]], [x[1], y[1], z[1]])
            })
            .collect();
        let wanted = expected(&on_a_lattice, |_| true, |_| Groups::ALL);
        for (way, mut culler) in ways() {
            for frame in 0..3 {
                let found = culler.cull(&on_a_lattice).unwrap().sorted();
                assert!(found == wanted, "{side}, {way}, frame {frame}");
            }
        }
    }
}

/// The cubes about long boxes stay as they are where a short side grows, and lists of neighbours
/// are followed meanwhile.
#[test]
fn growing_long_boxes_are_found() {
    let random = &mut Random::new(8);
    for by in [0.05_f32, 0.4, 3.0] {
        let (mut ways, mut now) = (ways(), boxes(Kind::Needles, 300, random));
        for frame in 0..24 {
            let wanted = expected(&now, |_| true, |_| Groups::ALL);
            for (way, culler) in &mut ways {
                let found = culler.cull(&now).unwrap().sorted();
                assert!(found == wanted, "{by}, frame {frame}, {way}");
            }
            for _ in 0..3 {
                let (Aabb { min, max }, axis) = (&mut now[random.below(300)], random.below(3));
                let widest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f32::max);
                let grows = by.min(0.5 * (widest - (max[axis] - min[axis])));
                (min[axis], max[axis]) = (min[axis] - grows, max[axis] + grows);
            }
        }
    }
}

/// Lists are the same in every tier and on any number of threads.
#[test]
fn lists_equal_in_tiers_and_threads() {
    let random = &mut Random::new(2);
    for kind in [Kind::Cubes, Kind::Needles, Kind::Nested, Kind::Crowd] {
        let build = |of: BoxCullerBuilder| of.build().unwrap();
        let mut ways: Vec<BoxCuller> = Tier::available()
            .into_iter()
            .map(|tier| build(BoxCuller::builder().tier(tier)))
            .collect();
        ways.extend(
            [2, 3].map(|threads| build(BoxCuller::builder().threads(threads).worth_waking(0))),
        );
        let mut now = boxes(kind, 3000, random);
        for frame in 0..12 {
            let (first, others) = ways.split_first_mut().unwrap();
            let list: Vec<[u32; 2]> = first.cull(&now).unwrap().iter().collect();
            for culler in others {
                assert!(
                    culler.cull(&now).unwrap().iter().eq(list.iter().copied()),
                    "{kind:?}, frame {frame}"
                );
                assert_eq!(culler.counters(), first.counters());
            }
            moved(&mut now, 0.05, random);
        }
        let counted = *ways[0].counters();
        assert!(
            counted.updates == 12 * 3000 && counted.tests >= counted.hits && counted.hits > 1000
        );
    }
}

/// A crowd comes in portions in the order of the list and takes no memory.
#[test]
fn portions_keep_list_order() {
    let now = vec![boxes(Kind::Crowd, 1, &mut Random::new(4))[0]; 3000];
    let pairs = 3000 * 2999 / 2;
    for threads in [1, 3] {
        let way = BoxCuller::builder().threads(threads).worth_waking(0);
        let (mut whole, mut culler) = (way.build().unwrap(), way.build().unwrap());
        for _ in 0..3 {
            let mut list = whole.cull(&now).unwrap().iter();
            let told = culler.cull_in_portions(&now, |portion| {
                assert!(portion.iter().all(|pair| list.next() == Some(pair)));
            });
            assert_eq!((told.unwrap(), list.next()), (pairs, None));
            assert!(culler.pairs().is_empty());
            let most = 16 * (1 << 16) * 8 * threads;
            assert!(culler.pair_bytes() < most, "{} of {most}", culler.pair_bytes());
        }
        let told = culler.cull_up_to(&now, 1000).unwrap_err().problem();
        assert_eq!(told, format!("the frame has {pairs} pairs, but at most 1000 are allowed"));
        assert!(culler.pairs().is_empty());
        assert_eq!(culler.cull_up_to(&now, pairs as usize).unwrap().len(), pairs as usize);
        culler.shrink_to_fit();
        // The list itself, and a vector after it.
        assert_eq!(culler.pair_bytes(), 8 * (pairs as usize + 16));
    }
}

/// Cubes are answered without a look at many candidates.
#[test]
fn cubes_have_few_candidates() {
    let random = &mut Random::new(5);
    for (kind, most) in [(Kind::Cubes, 8), (Kind::Needles, 400)] {
        let mut culler = BoxCuller::builder().finder(Finder::Grid).build().unwrap();
        let now = boxes(kind, 4000, random);
        culler.cull(&now).unwrap();
        let counted = culler.counters();
        assert!(counted.tests < most * 4000, "{kind:?}: {} of {}", counted.tests, most * 4000);
    }
}

/// Frames of little work stay on the caller's thread.
#[test]
fn small_frames_stay_on_one_thread() {
    let here = std::thread::current().id();
    let now = boxes(Kind::Nested, 90, &mut Random::new(6));
    let mut culler = BoxCuller::builder().finder(Finder::Grid).threads(3).build().unwrap();
    for _ in 0..50 {
        let take = |_: &sdop::PairList| assert_eq!(std::thread::current().id(), here);
        assert!(culler.cull_in_portions(&now, take).unwrap() > 0);
    }
}

/// The same boxes as in `python/tests/test_boxes.py`, and the same hash.
#[test]
fn pairs_are_those_of_python() {
    use sha2::{Digest as _, Sha256};

    let sixteenth = |number: u32| number as f32 / 16.0;
    let of = |i: u32| {
        let min = [7, 131, 577].map(|k| sixteenth(i * k % 1021));
        let sides = [3, 11, 29].map(|k| sixteenth(i * k % 61));
        Aabb::new(min, std::array::from_fn::<f32, 3, _>(|axis| min[axis] + sides[axis]))
    };
    let boxes: Vec<Aabb> = (0..3000).map(of).collect();
    let mut hash = Sha256::new();
    for number in BoxCuller::new().cull(&boxes).unwrap().sorted().as_flattened() {
        hash.update(number.to_le_bytes());
    }
    let hex: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hex, "bf3a97d3cf6860a4eba71ead750f8e5a0928f8a2a647e078928cac46621b6769");
}
