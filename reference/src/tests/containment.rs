//! Containment: a volume that fits to the bit contains its mesh, one that is a float smaller does
//! not, in the body frame and under poses.

use proptest::prelude::*;

use super::rational::{self, posed, rational, rational3};
use super::shapes::{Draws, cuboid, exact_basis, exact_slabs, poses, shape, slabs, torus};
use crate::containment::{
    Breach, ball_in_ball, check_ball, check_directions, check_shape, check_slabs,
};
use crate::number::power_of_two;
use crate::{Ball, DirectionSet, Pose, Slabs};

/// Fitted volumes contain and shrunk ones do not.
#[test]
fn shrunk_volumes_fail_containment() {
    for directions in DirectionSet::ALL {
        for mesh in [cuboid([0.3, 0.2, 0.7]), torus(1.0, 0.3, 12, 8)] {
            let good = shape(mesh, directions, exact_basis([1, 2, -3, 5]));
            assert_eq!(check_shape(&good), Ok(()));
            for slab in 0..good.slabs.lo.len() {
                let mut bad = good.clone();
                bad.slabs.hi[slab] = bad.slabs.hi[slab].next_down().next_down();
                assert!(
                    matches!(check_shape(&bad), Err(Breach::Slab { slab: s, .. }) if s == slab)
                );
                let mut bad = good.clone();
                bad.slabs.lo[slab] = bad.slabs.lo[slab].next_up().next_up();
                assert!(
                    matches!(check_shape(&bad), Err(Breach::Slab { slab: s, .. }) if s == slab)
                );
            }
            let mut bad = good.clone();
            bad.ball.radius = bad.ball.radius.next_down().next_down();
            assert!(matches!(check_shape(&bad), Err(Breach::Ball { .. })));
        }
    }
}

#[test]
fn contact_is_containment_to_the_bit() {
    // (2, 3, 6) has norm 7; scaled far up and down the answer is the same.
    for exponent in [-147, 0, 57] {
        let scale = power_of_two(exponent) as f32;
        let vertex = [[2.0, 3.0, 6.0].map(|x: f32| x * scale)];
        let ball = |radius: f32| Ball { centre: [0.0; 3], radius };
        let turned = Pose::new([1e-18, 2e-18, 0.0, -1e-18], [0.0; 3]).unwrap();
        for pose in [Pose::IDENTITY, turned] {
            assert_eq!(check_ball(&ball(7.0 * scale), &vertex, &pose), Ok(()));
            let less = (7.0 * scale).next_down();
            assert_eq!(check_ball(&ball(less), &vertex, &pose), Err(Breach::Ball { vertex: 0 }));
        }
        let inner = Ball { centre: vertex[0], radius: scale };
        assert!(ball_in_ball(&ball(8.0 * scale), &inner, &turned));
        assert!(!ball_in_ball(&ball((8.0 * scale).next_down()), &inner, &turned));
        let concentric = Ball { radius: 2.0 * scale, ..ball(0.0) };
        assert!(!ball_in_ball(&ball(scale), &concentric, &turned));
        assert!(ball_in_ball(&concentric, &concentric, &turned));
        for direction in DirectionSet::ALL {
            let mut tight = exact_slabs(direction, exact_basis([0, 0, 0, 1]), &vertex);
            assert_eq!(check_slabs(&tight, &vertex, &Pose::IDENTITY), Ok(()));
            tight.hi[2] = tight.hi[2].next_down();
            assert_eq!(
                check_slabs(&tight, &vertex, &Pose::IDENTITY),
                Err(Breach::Slab { vertex: 0, slab: 2 })
            );
        }
    }
}

#[test]
fn directions_that_round_are_named() {
    let with =
        |basis| Slabs { directions: DirectionSet::K18, basis, lo: vec![0.0; 9], hi: vec![0.0; 9] };
    assert_eq!(check_directions(&with(exact_basis([3, 1, -2, 11]))), Ok(()));
    // Exact columns, but their sum needs 25 bits.
    let long = with([[1.0, 0.0, 0.0], [power_of_two(-24) as f32, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(check_directions(&long), Err(Breach::Direction { slab: 3 }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn posed_slabs_agree_with_rationals(pose in poses(4.0), seed in any::<u64>()) {
        let mut draws = Draws(seed);
        let vertices: Vec<[f32; 3]> = (0..4).map(|_| draws.vector(1.0)).collect();
        let world: Vec<_> = vertices.iter().map(|v| posed(&pose, &rational3(*v))).collect();
        let rounded: Vec<[f32; 3]> = world.iter().map(|p| p.each_ref().map(|x| x.to_f32().value())).collect();
        // Slabs about the rounded posed vertices: whether the exact ones are inside is a matter of
        // last bits.
        let fitted = slabs(DirectionSet::K6, exact_basis([0, 0, 0, 1]), &rounded);
        for tighten in [false, true] {
            let mut fitted = fitted.clone();
            if tighten {
                fitted.hi[1] = fitted.hi[1].next_down();
                fitted.lo[2] = fitted.lo[2].next_up();
            }
            let outside = |p: &rational::Rational3| (0..3).any(|i| {
                p[i] < rational(f64::from(fitted.lo[i])) || p[i] > rational(f64::from(fitted.hi[i]))
            });
            let expected = world.iter().position(outside);
            let found = match check_slabs(&fitted, &vertices, &pose) {
                Err(Breach::Slab { vertex, .. }) => Some(vertex),
                _ => None,
            };
            prop_assert_eq!(found, expected);
        }
    }
}
