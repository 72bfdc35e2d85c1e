//! Common points, judged by the second formulation: they lie in both bodies, and one is found
//! whenever the bodies meet.

use dashu_ratio::RBig;

use super::rational::{dot, posed, rational, rational3, sub, unposed};
use super::shapes::{Draws, cuboid, exact_basis, shape, wedge};
use crate::exact::common::{Point, of_balls, of_meshes, of_slabs};
use crate::exact::{meeting, ordop, sphere};
use crate::{Body, DirectionSet, Overlap, Pose, Shape};

fn in_ball(body: &Body, point: &Point) -> bool {
    let centre = posed(&body.pose, &rational3(body.shape.ball.centre));
    let d = sub(&point.0, &centre);
    let radius = rational(f64::from(body.shape.ball.radius));
    dot(&d, &d) <= &radius * &radius
}

fn in_slabs(body: &Body, point: &Point) -> bool {
    let x = unposed(&body.pose, &point.0);
    let slabs = &body.shape.slabs;
    let basis = slabs.basis.map(rational3);
    let ends = slabs.lo.iter().zip(&slabs.hi);
    slabs.directions.coefficients().iter().zip(ends).all(|(c, (lo, hi))| {
        let height = (0..3).map(|j| RBig::from(c[j]) * dot(&basis[j], &x));
        let height = height.fold(RBig::ZERO, |sum, part| sum + part);
        rational(f64::from(*lo)) <= height && height <= rational(f64::from(*hi))
    })
}

/// Whether the point is within the box that a mesh's vertices span in the body frame: exact for a
/// cuboid.
fn in_cuboid(body: &Body, half: [f32; 3], point: &Point) -> bool {
    let x = unposed(&body.pose, &point.0);
    (0..3).all(|i| {
        let half = rational(f64::from(half[i]));
        -&half <= x[i] && x[i] <= half
    })
}

fn body(shape: &Shape, pose: Pose) -> Body<'_> {
    Body { shape, pose, dynamic: true }
}

/// There is a common point whenever bodies meet and it is in both.
#[test]
fn meeting_bodies_have_common_points() {
    let half = [0.5, 0.3, 0.9];
    let shapes = [
        shape(cuboid(half), DirectionSet::K18, exact_basis([1, 2, -3, 5])),
        shape(wedge(0.8), DirectionSet::K14, exact_basis([3, 0, 0, 1])),
    ];
    let mut draws = Draws(5);
    let (mut met, mut apart) = ([0; 3], [0; 3]);
    for n in 0..200 {
        let a = body(&shapes[n % 2], draws.pose(1.5));
        let b = body(&shapes[n / 2 % 2], draws.pose(1.5));
        let answers = [
            (sphere::overlap(&a, &b).value, of_balls(&a, &b)),
            (ordop::overlap(&a, &b, Overlap::Full).value, of_slabs(&a, &b)),
            (meeting::overlap(&a, &b).meets, of_meshes(&a, &b)),
        ];
        for (claim, (meets, point)) in answers.into_iter().enumerate() {
            assert_eq!(meets, point.is_some(), "{n}, {claim}");
            let Some(point) = point else {
                apart[claim] += 1;
                continue;
            };
            met[claim] += 1;
            for (body, which) in [(&a, n % 2), (&b, n / 2 % 2)] {
                match claim {
                    0 => assert!(in_ball(body, &point), "{n}: {point}"),
                    1 => assert!(in_slabs(body, &point), "{n}: {point}"),
                    _ if which == 0 => assert!(in_cuboid(body, half, &point), "{n}: {point}"),
                    _ => {}
                }
            }
        }
    }
    assert!(met.iter().all(|n| *n > 15) && apart.iter().all(|n| *n > 10), "{met:?} {apart:?}");
}

/// Bodies that touch in a corner an edge or a face share a point there.
#[test]
fn touching_bodies_share_the_contact_point() {
    let cube = shape(cuboid([1.0; 3]), DirectionSet::K6, exact_basis([0, 0, 0, 1]));
    for t in [[2.0, 2.0, 2.0], [2.0, 2.0, 0.5], [2.0, 0.5, 0.25], [0.25; 3]] {
        let a = body(&cube, Pose::IDENTITY);
        let b = body(&cube, Pose::new([0.0, 0.0, 0.0, 2.0], t).unwrap());
        let point = of_meshes(&a, &b).unwrap();
        for body in [&a, &b] {
            assert!(in_cuboid(body, [1.0; 3], &point), "{t:?}: {point}");
        }
    }
}
