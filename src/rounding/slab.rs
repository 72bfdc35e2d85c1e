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
/// basis norm, containing 0, inflated, rounded outward.
///
/// `direction` is exact, `scale` is [`norm`] of a basis vector, `reach` bounds ‖x‖ for every vertex x; all finite. The
/// result `lo' ≤ d·(x − c)/scale ≤ hi'` has a margin of (2⁻¹⁷ρ + 2⁻¹¹⁰)·‖d‖/scale on either side, ρ = reach + ‖c‖, which
/// bounds ‖x − c‖ too, whatever c is. A slab end beyond ρ‖d‖ is cut to it: the proof takes ends to be at most that.
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
    let (length, reach) = (norm(direction) / scale, f64::from(reach) + norm(centre));
    let end = |x: f32| (f64::from(x) - offset) / scale;
    let (limit, margin) = (length * reach, length * (SLAB_MARGIN * reach + SLAB_FLOOR));
    let lo = end(lo).min(0.0).max(-limit) - margin;
    let hi = end(hi).max(0.0).min(limit) + margin;
    (down(lo), up(hi))
}
