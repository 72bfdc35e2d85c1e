//! Borders between domains: how far from its ball's centre a body can still be in a pair, and which
//! bodies a domain therefore needs copies of.
//!
//! Many ranks share a world. Each owns the bodies whose ball's f32 centre is in its cell, a box. A
//! pair is reported by the owner of the body with the smaller [`reach`], or with the lower number
//! if both are equal. Therefore the owner of i needs every j with w_j ≥ w_i that may be reported
//! with i. Reported ⇒ |c_i − c_j|∞ ≤ w_i + w_j (below), and c_i lies in the cell, so j is no
//! farther from it than w_i + w_j ≤ w_j + min(w_j, W), where W is the largest reach of a body that
//! the cell's rank owns: the condition of [`may_meet`]. A giant among small bodies is sent to every
//! cell that it reaches, and no body is sent to it.
//!
//! Reported ⇒ |c_i − c_j|∞ ≤ w_i + w_j: for balls and for oriented volumes, which are binned by
//! balls of their own, w is [`widen`]'s radius, and `finder.g` proves |Δ| ≤ (R_i + R_j)(1 + 4u) for
//! each pair that the sphere test reports. Of the 16u there, 12u·(R_i + R_j) are left for the f64
//! arithmetic here, which takes 2⁻⁵¹ of the same sum. World-aligned boxes lie in the ball except
//! for their own rounding, of which [`reach_of_box`] adds twice the amount.

use super::{down, exp2, up, widen};

/// 2⁻²², as a multiple of |t|∞ + ρ: an end of a re-fitted box is at most |t|∞ + ρ, and rounding it
/// outward moves it by 2⁻²³ of that at most; the f64 steps before need less than the rest.
pub const BOX_ERROR: f64 = exp2(-22);

/// 2⁻¹¹⁰: the same where f32 or its results underflow.
pub const BOX_FLOOR: f64 = exp2(-110);

/// 1 − 2⁻²⁰: drifts are measured in f64, from f32 numbers, and held against a little less than the
/// skin.
pub const DRIFT_FACTOR: f64 = 1.0 - exp2(-20);

/// w: the distance from its centre within which a ball of inflated radius R can be in a pair.
pub const fn reach(inflated: f32) -> f32 {
    widen(inflated)
}

/// w for a body at t that is tested by a world-aligned box around vertices within ρ of its origin.
pub fn reach_of_box(inflated: f32, t: [f32; 3], reach_of_shape: f32) -> f32 {
    let size =
        t.iter().fold(0.0, |m: f64, x| m.max(f64::from(x.abs()))) + f64::from(reach_of_shape);
    up(f64::from(widen(inflated)) + BOX_ERROR * size + BOX_FLOOR)
}

/// Whether a body of this reach may be reported with a smaller one of a cell at this distance (in
/// the largest coordinate), whose bodies reach `widest` at most, before any centre moves, or any
/// reach grows, by more than the skin in all.
pub fn may_meet(distance: f64, reach: f32, widest: f32, skin: f32) -> bool {
    let [reach, widest, skin] = [reach, widest, skin].map(f64::from);
    !(distance > reach + reach.min(widest) + 2.0 * skin)
}

/// Whether a ball (centre, w) has drifted, in any coordinate and by growth together, by no more
/// than the skin.
pub fn stays(now: ([f32; 3], f32), then: ([f32; 3], f32), skin: f32) -> bool {
    let further = |now: f32, then: f32| f64::from(now) - f64::from(then);
    // A NaN is not a growth of 0, and never stays.
    let grown = if now.1 <= then.1 { 0.0 } else { further(now.1, then.1) };
    let most = f64::from(skin) * DRIFT_FACTOR;
    (0..3).all(|axis| further(now.0[axis], then.0[axis]).abs() + grown <= most)
}

/// A skin of this share of a reach.
pub fn skin(reach: f32, share: f64) -> f32 {
    down(f64::from(reach) * share).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::sphere::inflate_radius;

    /// Touching balls may meet across a border and balls apart may not.
    #[test]
    fn touching_balls_meet_across_borders() {
        for radius in [0.0, exp2(-80) as f32, 0.3, 1.0, 1.0e9] {
            let w = reach(inflate_radius(radius));
            let touching = 2.0 * f64::from(radius);
            assert!(may_meet(touching, w, w, 0.0), "{radius}");
            // What the sphere test may report at most, and a little more.
            assert!(may_meet(touching * (1.0 + 15.0 * exp2(-24)), w, w, 0.0));
            assert!(!may_meet(touching * 1.001 + 1.0e-9, w, w, 0.0));
        }
    }

    /// A giant goes to the small and not they to it.
    #[test]
    fn giants_go_to_small_bodies() {
        let (giant, small) = (reach(100.0), reach(1.0));
        assert!(may_meet(100.5, giant, small, 0.0) && !may_meet(101.5, giant, small, 0.0));
        assert!(may_meet(1.5, small, giant, 0.0) && !may_meet(2.5, small, giant, 0.0));
        assert!(may_meet(103.5, giant, small, 1.5), "with a skin on either side");
    }

    /// Drift is any coordinate's and growth.
    #[test]
    fn drift_includes_growth() {
        let then = ([1.0, 2.0, 3.0], 1.0);
        assert!(stays(then, then, 0.0), "who doesn't move needs no skin");
        assert!(stays(([1.2, 1.8, 3.2], 1.0), then, 0.25));
        assert!(!stays(([1.0, 2.0, 3.25], 1.0), then, 0.25), "the skin itself is too much");
        assert!(!stays(([1.2, 2.0, 3.0], 1.1), then, 0.25));
        assert!(!stays(([f32::NAN, 2.0, 3.0], 1.0), then, 0.25));
        assert!(!stays(([1.0, 2.0, f32::NAN], 1.0), then, 0.25));
        assert!(!stays(([1.0, 2.0, 3.0], f32::NAN), then, 0.25));
        assert!(!stays(([1.0e9, 2.0, 3.0], 1.0), then, 0.25));
    }

    /// A box reaches by its error and no farther.
    #[test]
    fn box_reach_includes_its_error() {
        for (inflated, farthest, shape) in [(2.5_f32, 3.0e6_f32, 7.0e5_f32), (2.5e-6, 3.0, 0.75)] {
            let t = [0.25, -farthest, 1.5];
            let size = f64::from(farthest) + f64::from(shape);
            let exact = f64::from(reach(inflated)) + BOX_ERROR * size;
            let found = f64::from(reach_of_box(inflated, t, shape));
            assert!(exact <= found && found < exact * (1.0 + exp2(-21)), "{found}");
        }
    }

    /// A skin is its share and no more.
    #[test]
    fn skin_is_its_share() {
        for (reach, share) in [(8.0, 0.25), (0.3, 0.7), (7.0e5, 0.125)] {
            let (skin, exact) = (f64::from(skin(reach, share)), f64::from(reach) * share);
            assert!(exact * (1.0 - exp2(-21)) < skin && skin <= exact, "{skin}");
        }
        assert_eq!(skin(8.0, 0.0), 0.0);
    }

    /// A box reaches farther where its ends are rounded farther.
    #[test]
    fn box_reach_grows_with_rounding() {
        let near = reach_of_box(1.0, [0.0; 3], 1.0);
        let far = reach_of_box(1.0, [0.0, -4.0e6, 0.0], 1.0);
        assert!(reach(1.0) < near && near < 1.00001);
        assert!(far >= reach(1.0) + 0.5, "the f32 next to four million is half a unit away");
    }

    /// What is just within reach may meet.
    #[test]
    fn bodies_just_within_reach_meet() {
        // 2 + min(2, 1) + 2·½.
        assert!(may_meet(4.0, 2.0, 1.0, 0.5) && !may_meet(4.0_f64.next_up(), 2.0, 1.0, 0.5));
    }
}
