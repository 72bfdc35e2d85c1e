//! Bases are exact: orthogonal, of one norm, and with exact sums.

use dashu_int::IBig;
use glam::DMat3;
use proptest::prelude::*;
use sdop::volume::{Basis, DirectionSet};

use crate::volume::{
    exact::{dot, integer, point},
    meshes::rotation,
};

fn assert_exact(basis: &Basis) {
    let columns = basis.columns.map(point);
    let squared = dot(&columns[0], &columns[0]);
    for i in 0..3 {
        assert_eq!(dot(&columns[i], &columns[i]), squared);
        assert_eq!(dot(&columns[i], &columns[(i + 1) % 3]), IBig::ZERO);
    }
    let norm = basis.norm();
    assert!(0.5 < norm && norm <= 1.0, "{norm}");
    let norm = integer(norm as f32);
    assert_eq!(&norm * &norm, squared, "the norm is exact");
    for &c in DirectionSet::K26.coefficients() {
        let direction = point(basis.direction(c));
        for k in 0..3 {
            let sum: IBig = (0..3).map(|j| &columns[j][k] * IBig::from(c[j])).sum();
            assert_eq!(direction[k], sum, "{c:?}");
        }
    }
}

proptest! {
    #[test]
    fn integer_quaternions_make_exact_bases(q in prop::array::uniform4(-1024..=1024_i32)) {
        prop_assume!(q != [0; 4]);
        assert_exact(&Basis::from_integer_quaternion(q).unwrap());
    }

    #[test]
    fn small_quaternions_too(q in prop::array::uniform4(-3..=3_i32)) {
        prop_assume!(q != [0; 4]);
        assert_exact(&Basis::from_integer_quaternion(q).unwrap());
    }

    #[test]
    fn snapping_stays_within_a_thousandth(rotation in rotation()) {
        let basis = Basis::snapped(rotation);
        assert_exact(&basis);
        let off = DMat3::from_cols_array_2d(&basis.rotation()) * DMat3::from_quat(rotation).transpose();
        let trace = off.x_axis.x + off.y_axis.y + off.z_axis.z;
        let angle = ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos();
        prop_assert!(angle < 1e-3, "{angle}");
    }
}

/// Quaternions out of range have no basis.
#[test]
fn large_quaternions_have_no_basis() {
    assert_eq!(Basis::from_integer_quaternion([0; 4]), None);
    assert_eq!(Basis::from_integer_quaternion([2048, 1, 0, 0]), None);
    assert_eq!(Basis::from_integer_quaternion([i32::MIN, 0, 0, 1]), None);
    assert_eq!(Basis::from_integer_quaternion([i32::MIN; 4]), None);
    assert_eq!(Basis::from_integer_quaternion([0, 0, 0, 2048]), Some(Basis::MODEL));
    assert_eq!(Basis::snapped(glam::DQuat::IDENTITY), Basis::MODEL);
}
