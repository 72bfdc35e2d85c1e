//! The shipped meshes: contained exactly, the same volumes on every CPU, and as tight as recorded.

use sdop::{
    mesh::{ReadOptions, read},
    volume::{Axes, Ball, Basis, DirectionSet, Hull, OrDop, Origin, Shape, ShapeSpec},
};
use sdop_bench::hash::volumes_sha256;
use sdop_bench::tightness::{PolytopeVolume as _, mean_world_aligned_volume};

use crate::volume::{
    exact::{ball_contains, slabs_contain},
    hull::assert_hull,
};

fn shape(name: &str, axes: Axes) -> Shape {
    let path = format!("{}/data/meshes/{name}.tri", env!("CARGO_MANIFEST_DIR"));
    let mesh = read(path, &ReadOptions::default()).unwrap();
    let spec =
        ShapeSpec { origin: Origin::Ball, radius: Some(1.0), directions: DirectionSet::K26, axes };
    Shape::build(&mesh, &spec).unwrap()
}

#[test]
fn shipped_meshes_are_contained() {
    for name in ["spot", "teapot", "bunny"] {
        let shape = shape(name, Axes::Principal);
        assert!(ball_contains(&shape.ball, &shape.vertices), "{name}");
        assert!(slabs_contain(&shape.ordop, &shape.vertices), "{name}");
        assert!((shape.ball.radius - 1.0).abs() < 3e-7, "{:?}", shape.ball);
    }
}

#[test]
fn the_hull_of_spot_is_exact() {
    let shape = shape("spot", Axes::Model);
    assert_eq!(assert_hull(&shape.vertices).facets.len(), 606);
}

/// The eigenvectors' last bits differ between CPUs; the snapped bases and all that follows must
/// not.
#[test]
fn principal_volumes_are_the_same_everywhere() {
    let shapes = ["spot", "teapot", "bunny"].map(|name| shape(name, Axes::Principal));
    let expected = "b48edb5879127c3d5f8b6eb6a880f5f537d711a661ddf93f7c0cbbe2ac9c000b";
    assert_eq!(volumes_sha256(&shapes), expected);
}

/// Volume over hull volume, to one percent.
#[test]
fn spot_is_as_tight_as_recorded() {
    let shape = shape("spot", Axes::Model);
    let hull = Hull::of(&shape.vertices);
    let (points, size) = (hull.points(&shape.vertices), hull.volume(&shape.vertices));
    let principal = Basis::principal(&hull, &shape.vertices);
    let dop = |basis, directions| OrDop::build(&points, basis, directions).volume() / size;
    let cases = [
        ("ball", Ball::smallest(&points).volume() / size, 3.61),
        ("AABB, mean", mean_world_aligned_volume(&points, DirectionSet::K6, 200) / size, 2.86),
        ("or-6, model", dop(Basis::MODEL, DirectionSet::K6), 2.16),
        ("or-6, principal", dop(principal, DirectionSet::K6), 1.90),
        ("or-14, model", dop(Basis::MODEL, DirectionSet::K14), 1.46),
        ("or-18, model", dop(Basis::MODEL, DirectionSet::K18), 1.44),
        ("or-26, model", dop(Basis::MODEL, DirectionSet::K26), 1.33),
    ];
    for (name, ratio, expected) in cases {
        assert!((ratio / expected - 1.0).abs() < 0.01, "{name}: {ratio} against {expected}");
    }
}
