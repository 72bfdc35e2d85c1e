//! Ball and slabs contain every vertex in exact arithmetic: all k, axes and origins, all scales,
//! any degeneracy.

use glam::Vec3;
use proptest::prelude::*;
use sdop::volume::{Axes, Ball, Basis, DirectionSet, OrDop, Origin, Shape, ShapeSpec};

use crate::volume::{
    exact::{ball_contains, slabs_contain},
    meshes::{box_corners, extended, mesh, rotated, rotation, vertices},
};

const LIMIT: f32 = 1_152_921_504_606_846_976.0; // 2⁶⁰

fn check(vertices: &[Vec3], radius: Option<f32>) -> Result<(), TestCaseError> {
    for &origin in Origin::ALL {
        for &axes in Axes::ALL {
            let spec = ShapeSpec { origin, radius, directions: DirectionSet::K26, axes };
            let shape = Shape::build(&mesh(vertices.to_vec()), &spec).unwrap();
            prop_assert!(ball_contains(&shape.ball, &shape.vertices), "{shape:?}");
            let about_origin = Ball { centre: [0.0; 3], radius: shape.reach };
            prop_assert!(ball_contains(&about_origin, &shape.vertices), "{shape:?}");
            for &directions in DirectionSet::ALL {
                let shape = shape.clone().with_directions(directions);
                prop_assert!(slabs_contain(&shape.ordop, &shape.vertices), "{shape:?}");
            }
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn every_volume_contains_its_vertices_exactly(vertices in vertices()) {
        check(&vertices, None)?;
    }

    #[test]
    fn scaled_shapes_contain_their_rounded_vertices(vertices in extended(), exponent in -149..60_i32) {
        check(&vertices, Some(2.0_f64.powi(exponent) as f32 * 0.7 + f32::from_bits(1)))?;
    }

    /// Neither slab ends nor radii are more than two steps of f32 from the exact ones, so moving an
    /// end inward by two must expel a vertex. (The slabs could also be missed by a check that
    /// always says yes: this one would notice.)
    #[test]
    fn volumes_are_tight_to_two_steps(vertices in extended(), rotation in rotation()) {
        let basis = Basis::snapped(rotation);
        let ordop = OrDop::build(&vertices, basis, DirectionSet::K26);
        for i in 0..ordop.directions.slabs() {
            let mut cut = ordop.clone();
            cut.hi[i] = cut.hi[i].next_down().next_down();
            prop_assert!(!slabs_contain(&cut, &vertices), "slab {i} of {ordop:?}");
            let mut cut = ordop.clone();
            cut.lo[i] = cut.lo[i].next_up().next_up();
            prop_assert!(!slabs_contain(&cut, &vertices), "slab {i} of {ordop:?}");
        }
        let mut ball = Ball::smallest(&vertices);
        ball.radius = ball.radius.next_down().next_down();
        prop_assert!(!ball_contains(&ball, &vertices));
    }

    /// Ends that are f32 numbers are kept to the bit: no box or plate is inflated at build time.
    #[test]
    fn representable_ends_are_exact(size in prop::array::uniform3(0.0..10.0_f32)) {
        let size = Vec3::from_array(size);
        let ordop = OrDop::build(&box_corners(size), Basis::MODEL, DirectionSet::K6);
        prop_assert_eq!(ordop.hi, (size / 2.0).to_array());
        prop_assert_eq!(ordop.lo, (-size / 2.0).to_array());
    }
}

/// Meshes at the limit and of subnormal size are contained.
#[test]
fn extreme_meshes_are_contained() {
    for size in [LIMIT / 2.0, 1e-38, 1e-44, f32::from_bits(2)] {
        let corners = box_corners(Vec3::splat(size));
        check(&corners, None).unwrap();
        check(&rotated(&corners, glam::DQuat::from_rotation_x(0.3)), None).unwrap();
    }
    let far = [Vec3::ZERO, Vec3::new(0.99 * LIMIT, 0.0, 0.0), Vec3::new(0.0, 1e-45, 1.0)];
    check(&far, None).unwrap();
}
