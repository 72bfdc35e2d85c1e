//! One pair at a time: the verdicts are those of a world with only these two bodies.

use sdop::culler::Culler;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::DirectionSet;
use sdop::world::{Body, PairTest, World};

use super::{Random, shapes};

/// A pair has the same verdict as in a world of two bodies.
#[test]
fn pair_test_equals_world() {
    let mut random = Random::new(11);
    let mut seen = [0; 2];
    for &k in DirectionSet::ALL {
        let shapes: Vec<_> = shapes().into_iter().map(|shape| shape.with_directions(k)).collect();
        let settings = CullSettings { strategy: Strategy::OrDop, k, ..CullSettings::default() };
        let mut test = PairTest::new(k);
        let numbers: Vec<u32> = shapes.iter().map(|shape| test.add(shape).unwrap()).collect();
        // What a world makes of 0.375: the next of eight steps an octave.
        let grown: Vec<u32> = numbers.iter().map(|&n| test.grown(n, 0.40625).unwrap()).collect();
        for round in 0..400 {
            let [a, b] = [random.below(3) as usize, random.below(3) as usize];
            let body = super::drawn(&mut random, 3);
            let translation = body.translation.map(|t| (t * 0.5) as f32);
            let margin = [0.0, 0.375][round % 2];
            let mut world =
                World::with(shapes.clone(), &Culler::builder().settings(&settings)).unwrap();
            world.insert(Body { shape: a as u32, margin, ..Body::default() }).unwrap();
            let second = Body {
                shape: b as u32,
                rotation: body.rotation,
                translation: translation.map(f64::from),
                ..Body::default()
            };
            world.insert(second).unwrap();
            world.cull().unwrap();
            let first = if margin > 0.0 { grown[a] } else { numbers[a] };
            let found = test.may_touch(first, numbers[b], body.rotation, translation);
            assert_eq!(found, world.pairs().len() == 1, "k = {}, {second:?}", k.k());
            seen[usize::from(found)] += 1;
        }
    }
    assert!(seen[0] > 200 && seen[1] > 200, "{seen:?}: both verdicts");
}

#[test]
fn what_cannot_be_judged_may_touch() {
    let mut test = PairTest::new(DirectionSet::K18);
    let shape = test.add(&shapes()[0]).unwrap();
    let unturned = [0.0, 0.0, 0.0, 1.0];
    let far = [100.0, 0.0, 0.0];
    assert!(!test.may_touch(shape, shape, unturned, far));
    assert!(test.may_touch(shape, 7, unturned, far));
    assert!(test.may_touch(shape, shape, [0.0; 4], far));
    assert!(test.may_touch(shape, shape, unturned, [f32::NAN, 0.0, 0.0]));
    assert!(test.may_touch(shape, shape, unturned, [f32::INFINITY, 0.0, 0.0]));
    for margin in [-0.1, f32::NAN, f32::INFINITY] {
        assert!(test.grown(shape, margin).is_err(), "{margin}");
    }
    assert!(test.grown(9, 0.1).is_err());
}
