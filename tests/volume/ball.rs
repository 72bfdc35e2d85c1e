//! The ball is the smallest one: against all subsets of up to four points, and on sets that defeat
//! naive solvers.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;
use sdop::volume::Ball;

use crate::volume::{exact::ball_contains, meshes};

/// The smallest ball that some subset of up to four points spans and that contains all points, to
/// 10⁻⁹.
fn brute_force(points: &[DVec3]) -> f64 {
    let mut best = f64::INFINITY;
    let n = points.len();
    for mask in 1_u32..1 << n {
        if mask.count_ones() > 4 {
            continue;
        }
        let subset: Vec<DVec3> = (0..n).filter(|i| mask >> i & 1 == 1).map(|i| points[i]).collect();
        let Some(centre) = equidistant(&subset) else {
            continue;
        };
        let radius = centre.distance(subset[0]);
        if points.iter().all(|p| p.distance(centre) <= radius + 1e-9) {
            best = best.min(radius);
        }
    }
    best
}

/// Solves 2(p_i − p_0)·x = |p_i − p_0|² in the affine hull, whose normals fill up the three rows.
fn equidistant(points: &[DVec3]) -> Option<DVec3> {
    let edges: Vec<DVec3> = points[1..].iter().map(|p| p - points[0]).collect();
    let rows = match *edges {
        [] => return Some(points[0]),
        [a] => {
            let (b, c) = a.normalize().any_orthonormal_pair();
            [a, b, c]
        }
        [a, b] => [a, b, a.cross(b)],
        [a, b, c] => [a, b, c],
        _ => return None,
    };
    let matrix = DMat3::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
    let right: Vec<f64> =
        (0..3).map(|i| edges.get(i).map_or(0.0, |e| e.length_squared() / 2.0)).collect();
    let volume = matrix.determinant().abs();
    (volume > 1e-9).then(|| points[0] + matrix.inverse() * DVec3::from_slice(&right))
}

fn coordinates() -> impl Strategy<Value = Vec<Vec3>> {
    let any = prop::array::uniform3(-1.0..1.0_f32);
    // A small lattice is full of duplicate, collinear and cospherical points.
    let lattice = prop::array::uniform3((-1..=1_i8).prop_map(f32::from));
    let points =
        prop_oneof![prop::collection::vec(any, 1..9), prop::collection::vec(lattice, 1..9),];
    points.prop_map(|list| list.into_iter().map(Vec3::from_array).collect())
}

proptest! {
    #[test]
    fn no_smaller_ball_exists(points in coordinates()) {
        let ball = Ball::smallest(&points);
        let wide: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let expected = brute_force(&wide);
        prop_assert!((f64::from(ball.radius) - expected).abs() < 5e-7, "{ball:?} against {expected}");
        prop_assert!(ball_contains(&ball, &points));
    }

    /// The order of vertices does not matter.
    #[test]
    fn vertex_order_does_not_matter(points in coordinates(), shift in 0..8_usize) {
        let mut turned = points.clone();
        turned.rotate_left(shift % points.len());
        let (a, b) = (Ball::smallest(&points), Ball::smallest(&turned));
        prop_assert!((a.radius - b.radius).abs() <= 2e-7 && Vec3::from(a.centre).distance(Vec3::from(b.centre)) <= 2e-7);
    }
}

#[test]
fn known_sets_have_their_known_balls() {
    let cube = meshes::box_corners(Vec3::ONE);
    let with_centre: Vec<Vec3> = cube.iter().copied().chain([Vec3::ZERO; 9]).collect();
    let segment = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::X * 0.3];
    // Obtuse: the longest side spans the ball, the third corner is inside.
    let triangle = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(2.0, 0.5, 0.0)];
    let cases: [(&[Vec3], Vec3, f64); 6] = [
        (&[Vec3::ONE; 5], Vec3::ONE, 0.0),
        (&segment, Vec3::X, 1.0),
        (&triangle, Vec3::X * 2.0, 2.0),
        (&cube, Vec3::ZERO, 0.75_f64.sqrt()),
        (&with_centre, Vec3::ZERO, 0.75_f64.sqrt()),
        (&[], Vec3::ZERO, 0.0),
    ];
    for (points, centre, radius) in cases {
        let ball = Ball::smallest(points);
        assert_eq!(Vec3::from(ball.centre), centre);
        assert!((f64::from(ball.radius) - radius).abs() <= 2e-7 * radius, "{ball:?}");
    }
    assert_eq!(Ball::smallest(&[Vec3::ONE; 5]).radius, 0.0, "one point needs no rounding");
}

#[test]
fn many_cospherical_vertices_end_the_search() {
    let points: Vec<Vec3> = (0..40_000)
        .map(|i| {
            let (z, turn) = (f64::from(i) / 20_000.0 - 1.0, f64::from(i) * 2.399_963);
            let r = (1.0 - z * z).max(0.0).sqrt();
            DVec3::new(r * turn.cos(), r * turn.sin(), z).as_vec3()
        })
        .collect();
    let ball = Ball::smallest(&points);
    assert!(
        (ball.radius - 1.0).abs() < 3e-7 && Vec3::from(ball.centre).length() < 3e-7,
        "{ball:?}"
    );
    assert!(ball_contains(&ball, &points));
}
