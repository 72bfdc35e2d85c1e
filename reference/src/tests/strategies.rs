//! Relations between strategies that hold for any scene.

use proptest::prelude::*;

use super::shapes::{Draws, cuboid, exact_basis, poses, shape, torus, wedge};
use crate::overlap::{obb, ordop, sphere};
use crate::strategy::{PlainPredicates, run};
use crate::{Body, DirectionSet, Overlap, Pose, Shape, Strategy, pairs};

fn forms() -> Vec<Shape> {
    let basis = exact_basis([1, 2, -3, 5]);
    vec![
        shape(wedge(0.8), DirectionSet::K18, basis),
        shape(torus(0.8, 0.2, 12, 6), DirectionSet::K26, basis),
        shape(cuboid([1.0, 0.01, 0.01]), DirectionSet::K14, exact_basis([0, 0, 0, 1])),
    ]
}

fn scene(shapes: &[Shape], poses: Vec<Pose>) -> Vec<Body<'_>> {
    let body = |(n, pose)| Body { shape: &shapes[n % shapes.len()], pose, dynamic: n % 3 != 0 };
    poses.into_iter().enumerate().map(body).collect()
}

fn both(a: &[(u32, u32)], b: &[(u32, u32)]) -> Vec<(u32, u32)> {
    a.iter().filter(|pair| b.contains(pair)).copied().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn strategies_combine_their_volumes(poses in prop::collection::vec(poses(2.0), 24)) {
        let shapes = forms();
        let bodies = scene(&shapes, poses);
        let of = |strategy| pairs(&bodies, strategy, Overlap::TwoSided);
        let (spheres, ordops) = (of(Strategy::Sphere), of(Strategy::OrDop));
        let sequential = of(Strategy::Sequential);
        prop_assert_eq!(&sequential, &both(&spheres, &ordops));
        prop_assert_eq!(&sequential, &of(Strategy::Batch));
        let interest: Vec<bool> = (0..bodies.len()).map(|n| n == 5).collect();
        let of_interest = of(Strategy::ObjectOfInterest(&interest));
        let touches = |pair: &&(u32, u32)| pair.0 == 5 || pair.1 == 5;
        let expected: Vec<_> =
            spheres.iter().filter(|pair| !touches(pair) || sequential.contains(pair)).copied().collect();
        prop_assert_eq!(of_interest, expected);
        prop_assert_eq!(of(Strategy::TimeCritical(&[])), spheres.clone());
        prop_assert_eq!(of(Strategy::TimeCritical(&spheres)), sequential);
        prop_assert_eq!(of(Strategy::None), vec![]);
        prop_assert!(spheres.iter().all(|&(i, j)| i < j && (bodies[i as usize].dynamic || bodies[j as usize].dynamic)));
    }

    #[test]
    fn more_axes_report_fewer(poses in prop::collection::vec(poses(1.5), 16)) {
        let shapes = forms();
        let bodies = scene(&shapes, poses);
        let of = |overlap| pairs(&bodies, Strategy::OrDop, overlap);
        let (one, two, full) = (of(Overlap::OneSided), of(Overlap::TwoSided), of(Overlap::Full));
        prop_assert_eq!(&two, &both(&two, &one));
        prop_assert_eq!(&full, &both(&full, &two));
    }
}

#[test]
fn counters_follow_the_stages() {
    let shapes = forms();
    let at = |x: f32| Pose::new([0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]).unwrap();
    let bodies = scene(&shapes[2..], vec![at(0.0), at(1.5), at(1.75), at(9.0)]);
    let dynamic = [true, true, false, false];
    let tested = [(0, 1)];
    let (found, counters) = run(
        &PlainPredicates::new(&bodies, Overlap::TwoSided),
        &dynamic,
        Strategy::TimeCritical(&tested),
    );
    assert_eq!(found, [(0, 1), (0, 2), (1, 2)]);
    assert_eq!((counters.sphere_tests, counters.sphere_hits), (5, 3));
    assert_eq!((counters.ordop_tests, counters.ordop_hits), (1, 1));
    assert_eq!((counters.untested, counters.reported), (2, 3));
}

#[test]
fn unrotated_intervals_are_not_compared() {
    // A needle along x and one turned to lie along y, crossing at the end: the second's own
    // x-interval is [−1, 1].
    let shapes = forms();
    let needle = &shapes[2];
    let along_x = Pose::new([0.0, 0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    let along_y = |x: f32| Pose::new([0.0, 0.0, 1.0, 1.0], [x, 0.0, 0.0]).unwrap();
    let body = |pose| Body { shape: needle, pose, dynamic: true };
    for test in Overlap::ALL {
        assert!(ordop::overlap(&body(along_x), &body(along_y(1.0)), test));
        assert!(!ordop::overlap(&body(along_x), &body(along_y(1.05)), test));
    }
    assert!(sphere::overlap(&body(along_x), &body(along_y(1.05))));
    assert!(!obb::overlap(&body(along_x), &body(along_y(1.05))));
}

/// Two unit cubes at random orientations, centres uniform where the spheres overlap: analytic P =
/// .505 for exact boxes.
#[test]
fn cube_survival_matches_the_integral() {
    let cube = shape(cuboid([1.0; 3]), DirectionSet::K6, exact_basis([0, 0, 0, 1]));
    let (mut draws, mut spheres, mut boxes) = (Draws(1), 0_u32, 0_u32);
    let a = Body {
        shape: &cube,
        pose: Pose::new([0.0, 0.0, 0.0, 1.0], [0.0; 3]).unwrap(),
        dynamic: true,
    };
    while spheres < 6000 {
        let b = Body { shape: &cube, pose: draws.pose(3.5), dynamic: true };
        spheres += u32::from(sphere::overlap(&a, &b));
        boxes += u32::from(sphere::overlap(&a, &b) && obb::overlap(&a, &b));
    }
    let share = f64::from(boxes) / f64::from(spheres);
    assert!((share - 0.505).abs() < 0.02, "{share}");
}
