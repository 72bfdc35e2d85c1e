//! The f64 pose: x ↦ R(q)x + t with R(q) the rotation matrix of q over |q|² (poses are rational
//! maps).
//!
//! Products of two f32 are exact in f64. Therefore the numerator of an entry rounds at most three
//! times, |q|² three times, and its reciprocal and their product once each: |δr_ij| ≤ (2 +
//! 6|r_ij|)·2⁻⁵³, and 24·2⁻⁵³·max(|x|∞, |t|∞) bounds a transformed coordinate. One division serves
//! all nine entries: eighteen of them were a third of an or-DOP's update. f64 here costs one matrix
//! per body and frame; in f32 the same bound would be larger than all margins together.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{down, exp2, up};

/// Rows of a rotation matrix.
pub type Rotation = [[f64; 3]; 3];

/// 24·2⁻⁵³: error of one coordinate of [`transform`], as a multiple of max(|x|∞, |t|∞). Found:
/// 9.01·2⁻⁵³. Proofs: `pose_entry.g`, `pose_point.g`.
pub const COORDINATE_ERROR: f64 = 24.0 * exp2(-53);

/// 2⁻⁴⁷ ≥ √3·[`COORDINATE_ERROR`]: how far t + R·o in f64 may lie from the exact point, as a
/// multiple of max(|o|∞, |t|∞) for any o and t in f64. Proof: `pose_offset.g`.
pub const OFFSET_ERROR: f64 = exp2(-47);

/// 2⁻⁴⁶ = 128·2⁻⁵³, the margin of a re-fitted world extent as a multiple of max(ρ, |t|∞): for a
/// direction with coefficients in {−1, 0, 1} the three coordinates bring 3·24, the two sums at most
/// 4 + 6, the addition of the margin 6.
pub const REFIT_MARGIN: f64 = exp2(-46);

/// 2⁻¹²⁰: covers subnormal vertices and translations that are read as zero.
pub const REFIT_FLOOR: f64 = exp2(-120);

/// The numbers in the formulas of a pose: an f64, or several at once.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// `x`, once or as often as there are numbers in `self`.
    fn like(self, x: f64) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        x
    }
}

/// The rotation matrix of a quaternion (x, y, z, w) of any norm with 0 < |q|² < ∞ in f64.
pub fn rotation(q: [f32; 4]) -> Rotation {
    rotation_of(q.map(f64::from))
}

/// The same of numbers that are f32 each.
#[inline(always)]
pub fn rotation_of<N: Real>([x, y, z, w]: [N; 4]) -> [[N; 3]; 3] {
    let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
    let over = x.like(1.0) / (xx + yy + zz + ww);
    [
        [((xx - yy) + (ww - zz)) * over, twice(x * y, -(w * z), over), twice(x * z, w * y, over)],
        [twice(x * y, w * z, over), ((yy - xx) + (ww - zz)) * over, twice(y * z, -(w * x), over)],
        [twice(x * z, -(w * y), over), twice(y * z, w * x, over), ((zz - xx) + (ww - yy)) * over],
    ]
}

#[inline(always)]
fn twice<N: Real>(a: N, b: N, over: N) -> N {
    over.like(2.0) * (a + b) * over
}

/// R·x, each coordinate within (24 − 3)·2⁻⁵³·|x|∞.
pub fn rotate(r: &Rotation, x: [f32; 3]) -> [f64; 3] {
    rotate_of(r, x.map(f64::from))
}

/// The same for numbers that are f32 each.
#[inline(always)]
pub fn rotate_of<N: Real>(r: &[[N; 3]; 3], [x, y, z]: [N; 3]) -> [N; 3] {
    [
        r[0][0] * x + r[0][1] * y + r[0][2] * z,
        r[1][0] * x + r[1][1] * y + r[1][2] * z,
        r[2][0] * x + r[2][1] * y + r[2][2] * z,
    ]
}

/// R·x + t in the world frame, each coordinate within [`COORDINATE_ERROR`]·max(|x|∞, |t|∞).
pub fn transform(r: &Rotation, x: [f32; 3], t: [f32; 3]) -> [f64; 3] {
    let p = rotate(r, x);
    [p[0] + f64::from(t[0]), p[1] + f64::from(t[1]), p[2] + f64::from(t[2])]
}

/// World directions of an orthogonal basis: the columns of R·basis/‖basis‖, each entry rounded once
/// to f32.
///
/// Against the exactly posed orthonormal basis an entry errs by u of itself and an f64 part below
/// 2⁻⁴⁷.
pub fn world_axes(r: &Rotation, basis: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let (unit, basis) = (over_norm(basis[0]), basis.map(|column| column.map(f64::from)));
    axes_of(r, basis, unit).map(|axis| axis.map(|x| x as f32))
}

/// The same before rounding, for numbers that are f32 each; `unit` is 1/‖basis‖, of [`over_norm`].
#[inline(always)]
pub fn axes_of<N: Real>(r: &[[N; 3]; 3], basis: [[N; 3]; 3], unit: N) -> [[N; 3]; 3] {
    let [[a, b, c], [d, e, f], [g, h, i]] =
        [rotate_of(r, basis[0]), rotate_of(r, basis[1]), rotate_of(r, basis[2])];
    [[a * unit, b * unit, c * unit], [d * unit, e * unit, f * unit], [g * unit, h * unit, i * unit]]
}

/// Euclidean norm of an f32 vector, in f64.
pub fn norm(v: [f32; 3]) -> f64 {
    let [x, y, z] = v.map(f64::from);
    (x * x + y * y + z * z).sqrt()
}

/// One over the [`norm`] of an f32 vector that isn't zero.
pub fn over_norm(v: [f32; 3]) -> f64 {
    1.0 / norm(v)
}

/// A world-aligned extent [lo, hi] rounded outward, from the extremes of d·p over points computed
/// by [`transform`], with d's coefficients in {−1, 0, 1}: `hi' = up(hi + 2⁻⁴⁶·max(ρ, |t|∞) +
/// 2⁻¹²⁰)`, lo mirrored; ρ ≥ ‖x‖.
pub fn refit(lo: f64, hi: f64, reach: f32, t: [f32; 3]) -> (f32, f32) {
    let size = t.iter().fold(f64::from(reach), |m, &x| m.max(f64::from(x.abs())));
    let margin = REFIT_MARGIN * size + REFIT_FLOOR;
    (down(lo - margin), up(hi + margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Any norm and sign of a quaternion is the same rotation.
    #[test]
    fn quaternion_norm_and_sign_are_free() {
        let q = [0.5, -0.25, 0.125, 1.0];
        for scale in [-1.0, 2.0f32.powi(60), -(2.0f32.powi(-100))] {
            assert_eq!(rotation(q.map(|x| x * scale)), rotation(q));
        }
    }

    /// A quarter turn about z takes x to y.
    #[test]
    fn quarter_turn_takes_x_to_y() {
        let turn = rotation([0.0, 0.0, 1.0, 1.0]);
        assert_eq!(transform(&turn, [1.0, 2.0, 3.0], [10.0, 0.0, 0.0]), [8.0, 1.0, 3.0]);
        let basis = [[0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]];
        assert_eq!(world_axes(&turn, basis), [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    }

    /// A refitted extent grows with the distance from the origin.
    #[test]
    fn refit_margin_grows_with_distance() {
        let width = |t: f32| {
            let (lo, hi) = refit(-1.0, 1.0, 1.0, [0.0, t, 0.0]);
            f64::from(hi) - f64::from(lo)
        };
        assert!(width(0.0) < 2.000_001);
        // 2⁶⁰ away the f64 coordinates themselves are 2⁷ apart.
        assert!(width(-(2.0f32.powi(60))) > 2.0 * exp2(60) * REFIT_MARGIN);
    }

    /// An extent of nothing at the origin grows by the floor.
    #[test]
    fn empty_extent_grows_by_floor() {
        let (lo, hi) = refit(0.0, 0.0, 0.0, [0.0; 3]);
        assert!(f64::from(lo) <= -REFIT_FLOOR && REFIT_FLOOR <= f64::from(hi));
    }
}
