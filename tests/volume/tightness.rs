//! Volumes as numbers: known solids, nesting, and means over orientations.

use sdop_bench::tightness::{PolytopeVolume as _, mean_world_aligned_volume};
use std::f64::consts::PI;

use glam::Vec3;
use proptest::prelude::*;
use sdop::{
    mesh::shapes::ProceduralShape,
    volume::{Ball, Basis, DirectionSet, Hull, OrDop},
};

use crate::volume::meshes::{box_corners, rotation, vertices};

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

/// The dops of an octahedron are known solids.
#[test]
fn octahedron_dops_are_known_solids() {
    let octahedron = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    // Box, the octahedron itself, rhombic dodecahedron, the octahedron itself.
    for (&directions, expected) in DirectionSet::ALL.iter().zip([8.0, 4.0 / 3.0, 2.0, 4.0 / 3.0]) {
        let ordop = OrDop::build(&octahedron, Basis::MODEL, directions);
        assert!(near(ordop.volume(), expected, 1e-12), "{directions}: {}", ordop.volume());
    }
    assert!(near(Hull::of(&octahedron).volume(&octahedron), 4.0 / 3.0, 1e-12));
    assert!(near(Ball::smallest(&octahedron).volume(), 4.0 / 3.0 * PI, 1e-6));
}

#[test]
fn flat_volumes_are_zero() {
    for size in [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 2.0, 0.0)] {
        for &directions in DirectionSet::ALL {
            let ordop = OrDop::build(&box_corners(size), Basis::MODEL, directions);
            assert!(ordop.volume() < 1e-12, "{size} {directions}: {}", ordop.volume());
        }
    }
}

/// A ball is alike from all sides.
#[test]
fn ball_is_symmetric() {
    let mesh = ProceduralShape::default_of("icosphere").unwrap().build().unwrap();
    let ball = Ball::smallest(&mesh.vertices).volume();
    let cube = mean_world_aligned_volume(&mesh.vertices, DirectionSet::K6, 20);
    assert!(near(cube / ball, 6.0 / PI, 0.01), "{}", cube / ball);
}

/// A turning cube needs its mean box.
#[test]
fn turning_cube_needs_mean_box() {
    // 3.4087 ± .0012: an average over 4·10⁵ orthonormalised Gaussian frames, made apart from this
    // code.
    let cube = mean_world_aligned_volume(&box_corners(Vec3::ONE), DirectionSet::K6, 4000);
    assert!(near(cube, 3.409, 0.01), "{cube}");
}

proptest! {
    #[test]
    fn more_slabs_never_enlarge_the_polytope(points in vertices(), rotation in rotation()) {
        let basis = Basis::snapped(rotation);
        let volume = |directions| OrDop::build(&points, basis, directions).volume();
        let [k6, k14, k18, k26] = [0, 1, 2, 3].map(|i| volume(DirectionSet::ALL[i]));
        let hull = Hull::of(&points).volume(&points);
        let slack = 1e-5 * k6; // f32 slab ends
        prop_assert!(k14 <= k6 + slack && k18 <= k6 + slack, "{k6} {k14} {k18}");
        prop_assert!(k26 <= k14 + slack && k26 <= k18 + slack, "{k14} {k18} {k26}");
        prop_assert!(hull <= k26 + slack, "{hull} {k26}");
    }
}
