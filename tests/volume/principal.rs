//! Principal axes: of the hull's surface, longest first, and the model's own where rounding alone
//! would choose.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;
use sdop::volume::{Basis, Hull, Shape, ShapeSpec};
use sdop_bench::tightness::PolytopeVolume as _;

use crate::volume::meshes::{box_corners, box_grid, mesh, rotated, rotation};

fn principal(points: &[Vec3]) -> Basis {
    Basis::principal(&Hull::of(points), points)
}

proptest! {
    /// A turned 3 × 2 × 1 box has its edges as axes, but for the snapping; its OBB is the box.
    #[test]
    fn a_turned_box_is_found(rotation in rotation()) {
        let points = rotated(&box_corners(Vec3::new(1.0, 3.0, 2.0)), rotation);
        let axes = DMat3::from_cols_array_2d(&principal(&points).rotation());
        for (axis, edge) in [(axes.x_axis, DVec3::Y), (axes.y_axis, DVec3::Z), (axes.z_axis, DVec3::X)] {
            prop_assert!(axis.dot(rotation * edge).abs() > 1.0 - 1e-6, "{axes:?}");
        }
        prop_assert!(axes.determinant() > 0.0);
        let shape = Shape::build(&mesh(points.clone()), &ShapeSpec::default()).unwrap();
        let volume = shape.obb(&Hull::of(&shape.vertices)).volume();
        prop_assert!((6.0..6.03).contains(&volume), "{volume}");
    }

    /// Interior points and a finer surface leave the axes where they are: the hull's surface alone
    /// counts.
    #[test]
    fn sampling_does_not_turn_the_axes(extra in prop::collection::vec(prop::array::uniform3(-0.49..0.49_f32), 0..50)) {
        let size = Vec3::new(3.0, 2.0, 1.0);
        let mut points = box_corners(size);
        points.extend(extra.into_iter().map(|p| size * Vec3::from_array(p)));
        prop_assert_eq!(principal(&points), Basis::MODEL);
        prop_assert_eq!(principal(&box_grid(size, 7)), Basis::MODEL);
    }

    /// A cube and a square column have no three axes of their own, however they are turned.
    #[test]
    fn ties_use_model_axes(rotation in rotation(), height in prop_oneof![Just(1.0), Just(4.0_f32)]) {
        let points = rotated(&box_corners(Vec3::new(1.0, 1.0, height)), rotation);
        prop_assert_eq!(principal(&points), Basis::MODEL);
    }
}

#[test]
fn flat_meshes_use_the_model_axes() {
    let plate = box_corners(Vec3::new(3.0, 1.0, 0.0));
    for points in [vec![Vec3::ONE], vec![Vec3::X, Vec3::Y], plate] {
        assert_eq!(principal(&points), Basis::MODEL);
        let shape = Shape::build(&mesh(points), &ShapeSpec::default()).unwrap();
        assert_eq!(shape.ordop.basis, Basis::MODEL);
    }
}
