//! Spheres: world placement and inflation, so that `cull ⇔ d² > s·s`, s = fl(R_A + R_B), never
//! loses a touching pair.
//!
//! With d² = ((Δx²+Δy²)+Δz²) in f32, rounding can favour d² over s² by 8u in all (5 in d², 3 in
//! s²); R ≥ r(1+6u) gives 12u. The floor 2⁻⁷⁰ makes s² exceed every amount that underflow or
//! flushing takes. Overflow is sound by monotonicity.

use super::exp2;
use super::pose::{Rotation, transform};
use super::up;
use crate::simd::Lanes;

/// 1 + 8u, at least 1 + 6u once rounded; 1 + 2u misses. Found: 7.986u of the 8u by which rounding
/// can favour d² over s². Proofs: `sphere_decision.g`, `sphere_radius.g`.
pub const RADIUS_FACTOR: f32 = (1.0 + 8.0 * super::U) as f32;

/// 2⁻⁷⁰; 2⁻⁷⁸ misses with subnormal products. Found: no
/// touching pair culled. Proofs: `sphere_underflow.g`, `sphere_flush.g`.
pub const RADIUS_FLOOR: f32 = exp2(-70) as f32;

/// 2⁻⁴⁷ ≥ √3·[`COORDINATE_ERROR`](super::pose::COORDINATE_ERROR): how far the f64 centre may lie
/// from the exact one, as a multiple of max(|c|∞, |t|∞). Found: 12.45·2⁻⁵³ of 64·2⁻⁵³.
pub const CENTRE_ERROR: f64 = exp2(-47);

/// 2⁻¹²⁵ > √3·2⁻¹²⁶: a subnormal translation read as zero.
pub const CENTRE_FLOOR: f64 = exp2(-125);

/// R = fl(fl(r(1+8u)) + 2⁻⁷⁰), the radius that the sphere test adds and squares.
///
/// Reported ⇒ d ≤ (r_A + r_B)(1 + 15u) + 2⁻⁶⁸.
pub const fn inflate_radius(r: f32) -> f32 {
    r * RADIUS_FACTOR + RADIUS_FLOOR
}

/// World ball (centre, radius) that contains the posed ball (c, r) exactly; not inflated for the
/// test.
///
/// The centre is the f64 image rounded to f32; with c = 0 it is t to the bit and r is unchanged.
/// Otherwise the radius absorbs the rounding, `up(r + 1.0001‖w64 − w‖ + 2⁻⁴⁷·max(|c|∞, |t|∞) +
/// 2⁻¹²⁵)`.
pub fn world_ball(rotation: &Rotation, t: [f32; 3], c: [f32; 3], r: f32) -> ([f32; 3], f32) {
    if c == [0.0; 3] {
        return (t, r);
    }
    rounded_ball(transform(rotation, c, t), t, c, r)
}

/// The ball of [`world_ball`] about a centre in f64 that is not the translation.
#[inline(always)]
pub fn rounded_ball(exact: [f64; 3], t: [f32; 3], c: [f32; 3], r: f32) -> ([f32; 3], f32) {
    let centre = exact.map(|x| x as f32);
    let moved = (0..3).map(|i| (exact[i] - f64::from(centre[i])).powi(2)).sum::<f64>().sqrt();
    let size = c.iter().chain(&t).fold(0.0, |m: f64, &x| m.max(f64::from(x.abs())));
    (centre, up(f64::from(r) + 1.0001 * moved + CENTRE_ERROR * size + CENTRE_FLOOR))
}

/// Whether balls are apart whose centres differ by d and whose radii add up to s: d² > s².
#[inline(always)]
pub fn apart<L: Lanes>(l: L, [dx, dy, dz]: [L::F; 3], s: L::F) -> L::M {
    l.gt((dx * dx + dy * dy) + dz * dz, s * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Inflation is eight u and the floor.
    #[test]
    fn inflation_is_factor_plus_floor() {
        assert_eq!(inflate_radius(0.0), RADIUS_FLOOR);
        assert_eq!(inflate_radius(1.0), 1.0 + 4.0 * f32::EPSILON);
        assert!(inflate_radius(f32::NAN).is_nan());
    }

    /// A ball at the body origin moves as a copy.
    #[test]
    fn centred_ball_copies_translation() {
        let turn = crate::rounding::pose::rotation([0.3, -0.2, 0.9, 0.1]);
        let t = [1.0e-40, -7.25, 3.0e17];
        assert_eq!(world_ball(&turn, t, [0.0, -0.0, 0.0], 1.5), (t, 1.5));
    }

    /// A ball off the origin includes the rounding of its centre.
    #[test]
    fn eccentric_ball_covers_centre_rounding() {
        let turn = crate::rounding::pose::rotation([0.0, 0.0, 0.0, 1.0]);
        let (centre, radius) = world_ball(&turn, [16_777_216.0, 0.0, 0.0], [0.75, 0.0, 0.0], 1.0);
        // 2²⁴ + ¾ rounds to 2²⁴: the ball must reach ¾ farther to stay around the exact one.
        assert_eq!(centre, [16_777_216.0, 0.0, 0.0]);
        assert!((1.75..1.751).contains(&radius), "{radius}");
    }

    /// A ball stays around a translation that is read as zero.
    #[test]
    fn ball_covers_flushed_translation() {
        let turn = crate::rounding::pose::rotation([0.0, 0.0, 0.0, 1.0]);
        let subnormal = f32::from_bits(0x007f_ffff);
        let (_, radius) = world_ball(&turn, [subnormal; 3], [1e-45, 0.0, 0.0], 0.0);
        assert!(f64::from(radius) >= 3_f64.sqrt() * f64::from(subnormal), "{radius:e}");
    }

    /// A far small ball includes the f64 rounding of its centre.
    #[test]
    fn far_ball_covers_f64_rounding() {
        let turn = crate::rounding::pose::rotation([0.0, 0.0, 0.0, 1.0]);
        let far = exp2(30) as f32;
        let (centre, radius) = world_ball(&turn, [far, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0);
        assert_eq!(centre, [far, 1.0, 0.0]);
        assert!(f64::from(radius) >= CENTRE_ERROR * exp2(30), "{radius}");
    }
}
