//! Placement, scaling, errors and the fingerprint of shapes.

use glam::{DQuat, Vec3};
use sdop::{
    mesh::TriangleMesh,
    volume::{Axes, DirectionSet, Hull, Origin, Shape, ShapeSpec},
};
use sdop_bench::hash::volumes_sha256;
use sdop_bench::tightness::PolytopeVolume as _;

use crate::volume::meshes::{box_corners, mesh, rotated};

fn spec(origin: Origin, radius: Option<f32>) -> ShapeSpec {
    ShapeSpec { origin, radius, axes: Axes::Model, ..ShapeSpec::default() }
}

fn shifted_box() -> TriangleMesh {
    let corners = box_corners(Vec3::new(2.0, 4.0, 4.0));
    mesh(corners.into_iter().map(|v| v + Vec3::new(10.0, 20.0, 30.0)).collect())
}

/// Its vertices.
fn vectors(shape: &Shape) -> Vec<Vec3> {
    shape.vertices.iter().map(|&v| Vec3::from(v)).collect()
}

#[test]
fn origin_ball_centres_and_scales() {
    let mesh = shifted_box();
    let shape = Shape::build(&mesh, &spec(Origin::Ball, None)).unwrap();
    assert_eq!(vectors(&shape), box_corners(Vec3::new(2.0, 4.0, 4.0)));
    assert_eq!((Vec3::from(shape.ball.centre), shape.ball.radius), (Vec3::ZERO, 3.0_f32.next_up()));
    assert_eq!(shape.reach, shape.ball.radius);
    let scaled = Shape::build(&mesh, &spec(Origin::Ball, Some(0.75))).unwrap();
    assert_eq!(vectors(&scaled), box_corners(Vec3::new(0.5, 1.0, 1.0)));
    assert_eq!(
        (Vec3::from(scaled.ball.centre), scaled.ball.radius),
        (Vec3::ZERO, 0.75_f32.next_up())
    );
}

#[test]
fn origin_file_leaves_coordinates_alone() {
    let mesh = shifted_box();
    let shape = Shape::build(&mesh, &spec(Origin::File, None)).unwrap();
    assert_eq!(shape.vertices, mesh.vertices);
    assert_eq!(Vec3::from(shape.ball.centre), Vec3::new(10.0, 20.0, 30.0));
    assert_eq!(shape.ball.radius, 3.0_f32.next_up());
    let farthest = Vec3::new(11.0, 22.0, 32.0).as_dvec3().length();
    assert!(f64::from(shape.reach) >= farthest && f64::from(shape.reach) < farthest * 1.000_001);
}

#[test]
fn a_radius_scales_about_the_origin() {
    let mesh = shifted_box();
    let shape = Shape::build(&mesh, &spec(Origin::File, Some(1.5))).unwrap();
    assert_eq!((shape.offset, shape.scale), ([0.0; 3], 0.5));
    let halves: Vec<Vec3> = mesh.vertices.iter().map(|v| Vec3::from(*v) / 2.0).collect();
    assert_eq!(vectors(&shape), halves);
    assert_eq!(Vec3::from(shape.ball.centre), Vec3::new(5.0, 10.0, 15.0));
    assert_eq!(shape.ball.radius, 1.5_f32.next_up());
}

/// scale · (point − offset) is the vertex, whatever the origin.
#[test]
fn a_shape_keeps_what_it_applied() {
    let mesh = shifted_box();
    for &origin in Origin::ALL {
        for radius in [None, Some(0.3), Some(7.0)] {
            let shape = Shape::build(&mesh, &spec(origin, radius)).unwrap();
            assert_eq!((shape.pose_offset, shape.rounding), ([0.0; 3], 0.0));
            for (point, vertex) in mesh.vertices.iter().zip(&shape.vertices) {
                for i in 0..3 {
                    let placed = shape.scale * (f64::from(point[i]) - shape.offset[i]);
                    assert_eq!(placed as f32, vertex[i], "{origin}, {radius:?}");
                }
            }
        }
    }
}

/// Directions are exchanged as if built anew.
#[test]
fn exchanged_directions_equal_a_rebuild() {
    for &directions in DirectionSet::ALL {
        let built = ShapeSpec { directions, ..ShapeSpec::default() };
        let built = Shape::build(&shifted_box(), &built).unwrap();
        let exchanged = Shape::build(&shifted_box(), &ShapeSpec::default()).unwrap();
        assert_eq!(exchanged.with_directions(directions), built);
    }
}

#[test]
fn the_obb_has_its_own_axes() {
    let turned = rotated(&box_corners(Vec3::new(3.0, 2.0, 1.0)), DQuat::from_rotation_y(0.4));
    let shape = Shape::build(&mesh(turned), &spec(Origin::Ball, None)).unwrap();
    let obb = shape.obb(&Hull::of(&shape.vertices));
    assert_eq!(obb.directions, DirectionSet::K6);
    assert_ne!(obb.basis, shape.ordop.basis);
    assert!((6.0..6.03).contains(&obb.volume()), "{}", obb.volume());
}

#[test]
fn impossible_shapes_are_refused_by_name() {
    let message = |vertices: Vec<Vec3>, origin, radius| {
        let error = Shape::build(&mesh(vertices), &spec(origin, radius)).unwrap_err();
        let help = error.help().to_owned();
        (error.problem(), help)
    };
    let point = vec![Vec3::ONE];
    let segment = vec![Vec3::ZERO, Vec3::X];
    let cases = [
        (message(vec![], Origin::Ball, None), "no vertices"),
        (
            message(vec![Vec3::ZERO, Vec3::NAN], Origin::File, None),
            "vertex 1 of shape `test` is not finite",
        ),
        (
            message(vec![Vec3::INFINITY], Origin::Ball, None),
            "vertex 0 of shape `test` is not finite",
        ),
        (message(vec![Vec3::X * 1.2e18], Origin::File, None), "beyond the limit of 2⁶⁰"),
        (
            message(vec![Vec3::X * -3e38, Vec3::X * 3e38], Origin::Ball, None),
            "beyond the limit of 2⁶⁰",
        ),
        (message(segment.clone(), Origin::Ball, Some(-1.0)), "radius -1 of shape `test`"),
        (message(segment.clone(), Origin::Ball, Some(0.0)), "radius 0 of shape `test`"),
        (message(segment.clone(), Origin::Ball, Some(f32::NAN)), "radius NaN of shape `test`"),
        (message(segment, Origin::Ball, Some(2e18)), "is not in 0 < radius ≤ 2⁶⁰"),
        (message(point, Origin::Ball, Some(1.0)), "`test` is a single point"),
    ];
    for ((text, help), expected) in cases {
        assert!(text.contains(expected) && text.contains("`test`"), "{text}");
        assert!(!help.is_empty());
    }
    let huge = mesh(vec![Vec3::X * -3e38, Vec3::X * 3e38]);
    let scaled = Shape::build(&huge, &spec(Origin::Ball, Some(1.0))).unwrap();
    assert_eq!(
        vectors(&scaled),
        [-Vec3::X, Vec3::X],
        "a radius brings any finite mesh within the limit"
    );
}

#[test]
fn the_fingerprint_covers_every_number() {
    let shape = Shape::build(&shifted_box(), &spec(Origin::Ball, None)).unwrap();
    let original = volumes_sha256(std::slice::from_ref(&shape));
    // The SHA-256 of 0 0 0 next_up(3), the identity, lo = −1 −2 −2 −3 −3 −3 −3 −4 −4 and hi = −lo,
    // made apart from this code.
    let expected = "8485da5c21992757e15eb9b660ab5ff64d2b41711a54973bb413b91f8aeaaec0";
    assert_eq!(original, expected);
    let mut seen =
        vec![original, volumes_sha256(&[]), volumes_sha256(&[shape.clone(), shape.clone()])];
    let mut change = |edit: &dyn Fn(&mut Shape)| {
        let mut edited = shape.clone();
        edit(&mut edited);
        let hash = volumes_sha256(&[edited]);
        assert!(!seen.contains(&hash));
        seen.push(hash);
    };
    change(&|s| s.ball.centre[1] += 1.0);
    change(&|s| s.ball.radius += 1.0);
    change(&|s| s.ordop.basis.columns[2][0] += 1.0);
    change(&|s| s.ordop.lo[8] += 1.0);
    change(&|s| s.ordop.hi[8] += 1.0);
}
