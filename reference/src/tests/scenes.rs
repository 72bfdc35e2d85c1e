//! Whole scenes: compares the exact judge with the plain one, checks the promise, and compares
//! world-aligned volumes with rationals.

use super::rational::{self, posed, rational3};
use super::shapes::{Draws, cuboid, exact_basis, shape, torus, wedge};
use crate::exact::judge::{self, meeting_pairs};
use crate::exact::{Tally, world};
use crate::number::power_of_two;
use crate::{Body, DirectionSet, Overlap, Shape, Strategy, pairs};

fn strategies<'a>(interest: &'a [bool], tested: &'a [(u32, u32)]) -> [Strategy<'a>; 10] {
    [
        Strategy::Sphere,
        Strategy::OrDop,
        Strategy::Sequential,
        Strategy::Batch,
        Strategy::ObjectOfInterest(interest),
        Strategy::TimeCritical(tested),
        Strategy::Aabb,
        Strategy::KDop(DirectionSet::K18),
        Strategy::KDop(DirectionSet::K26),
        Strategy::Obb,
    ]
}

fn forms(directions: DirectionSet) -> Vec<Shape> {
    vec![
        shape(torus(0.7, 0.3, 16, 8), directions, exact_basis([1, 2, -3, 5])),
        shape(wedge(0.8), directions, exact_basis([0, 0, 0, 1])),
        shape(cuboid([1.2, 0.05, 0.02]), directions, exact_basis([3, 0, 0, 1])),
    ]
}

/// Plain and exact agree and no mesh pair is missed.
#[test]
fn plain_and_exact_agree() {
    let mut draws = Draws(17);
    for directions in DirectionSet::ALL {
        let shapes = forms(directions);
        let bodies: Vec<Body> = (0..40)
            .map(|n| Body { shape: &shapes[n % 3], pose: draws.pose(2.0), dynamic: n % 4 != 0 })
            .collect();
        let (meeting, tally) = meeting_pairs(&bodies);
        assert!(meeting.len() > 20 && tally.meshes.total() > 100, "{} {tally:?}", meeting.len());
        let interest: Vec<bool> = (0..40).map(|n| n % 5 == 0).collect();
        for strategy in strategies(&interest, &[(0, 1), (3, 7)]) {
            for overlap in Overlap::ALL {
                let (exact, _) = judge::pairs(&bodies, strategy, overlap);
                assert_eq!(exact, pairs(&bodies, strategy, overlap), "{strategy:?} {overlap:?}");
                let missed = meeting.iter().find(|pair| !exact.contains(pair));
                assert_eq!(missed, None, "{strategy:?} {overlap:?} {directions:?}");
            }
        }
        assert_eq!(judge::pairs(&bodies, Strategy::None, Overlap::Full).0, []);
    }
}

#[test]
fn world_volumes_agree_with_rationals() {
    let mut draws = Draws(19);
    let (mut overlaps, mut tally) = (0, Tally::default());
    for n in 0..800 {
        let case = draws.hard_case();
        let scale = power_of_two(case.size) as f32;
        let directions = DirectionSet::ALL[n % 4];
        let shapes = [(); 2].map(|()| {
            let half = [(); 3].map(|()| (draws.signed(3.0).trunc().abs() + 1.0) / 4.0 * scale);
            let (mut vertices, triangles) = cuboid(half);
            // Off-centre, so that heights are not symmetric.
            vertices.iter_mut().for_each(|v| v[n % 3] += 0.5 * scale);
            (vertices, triangles)
        });
        let world = [(&shapes[0], &case.a), (&shapes[1], &case.b)].map(|((vertices, _), pose)| {
            vertices.iter().map(|v| posed(pose, &rational3(*v))).collect::<Vec<_>>()
        });
        let axes = directions.coefficients().into_iter().map(|c| rational3(c.map(|x| x as f32)));
        let truth = !axes.into_iter().any(|axis| rational::separates(&axis, &world[0], &world[1]));
        let shapes = shapes.map(|mesh| shape(mesh, DirectionSet::K6, exact_basis([0, 0, 0, 1])));
        let [a, b] = [(&shapes[0], case.a), (&shapes[1], case.b)].map(|(shape, pose)| Body {
            shape,
            pose,
            dynamic: true,
        });
        let decision = world::overlap(&a, &b, directions);
        assert_eq!(decision.value, truth, "{case:?} {:?}", decision.path);
        assert_eq!(world::overlap(&b, &a, directions).value, truth, "{case:?}");
        overlaps += u32::from(truth);
        tally.count(decision.path);
    }
    assert!((100..700).contains(&overlaps) && tally.exact > 10, "{overlaps} {tally:?}");
}
