//! Slabs of an or-DOP, inflated once so that the separating-axis test needs no margin: `cull ⇔ τ > fl(h_A + h_B)`.
//!
//! On any axis a, in units of u·(ρ_A + ρ_B)·‖a‖, rounding can favour separation by fewer than 128: the once-rounded axes
//! Q, their f32 product M = Q_Bᵀ·Q_A, the gap Δ, τ = a·(Q_Aᵀ·Δ), and the support by weak duality, whose coefficients
//! combine the slabs to e + δ instead of e. Each slab gains 2⁻¹⁷ρ‖d‖ = 128u·ρ‖d‖, and any nonnegative combination of
//! slab directions that gives e gains at least 128u·ρ‖e‖ by the triangle inequality. If |Δ| > ρ_A + ρ_B the bodies
//! are disjoint and any cull is right, so errors relative to |Δ| are errors relative to ρ_A + ρ_B.

use super::pose::norm;
use super::{down, exp2, up};

/// 2⁻¹⁷ = 128u, a slab's inflation as a multiple of ρ‖d‖. Proof: `sat.g` and its parts.
pub const SLAB_MARGIN: f64 = exp2(-17);

/// 2⁻¹¹⁰, a slab's inflation as a multiple of ‖d‖: more than underflow and flushing take from some thirty operations.
pub const SLAB_FLOOR: f64 = exp2(-110);

/// One slab `lo ≤ d·x ≤ hi` of the body frame as the separating-axis test wants it: about the centre c, in units of the
/// basis norm, inflated, rounded outward, and containing 0.
///
/// `direction` is exact, `scale` is [`norm`] of the basis, and `reach` bounds ‖x‖, ‖x − c‖ and ‖c‖ for every
/// vertex x. All finite. The result `lo' ≤ d·(x − c)/scale ≤ hi'` has a margin of (2⁻¹⁷ρ + 2⁻¹¹⁰)·‖d‖/scale on either side.
pub fn inflate_slab(
    lo: f32,
    hi: f32,
    direction: [f32; 3],
    scale: f64,
    centre: [f32; 3],
    reach: f32,
) -> (f32, f32) {
    let offset: f64 = (0..3)
        .map(|i| f64::from(direction[i]) * f64::from(centre[i]))
        .sum();
    let margin = norm(direction) / scale * (SLAB_MARGIN * f64::from(reach) + SLAB_FLOOR);
    let lo = ((f64::from(lo) - offset) / scale).min(0.0) - margin;
    let hi = ((f64::from(hi) - offset) / scale).max(0.0) + margin;
    (down(lo), up(hi))
}
