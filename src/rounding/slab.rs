//! Slabs of an or-DOP, inflated once so that the separating-axis test needs no margin: `cull ⇔ τ >
//! fl(h_A + h_B)`.
//!
//! On any axis a, in units of u·(ρ_A + ρ_B)·‖a‖, rounding can favour separation by fewer than 112:
//! the once-rounded axes Q, their f32 product M = Q_Bᵀ·Q_A, the gap Δ, τ = a·(Q_Aᵀ·Δ), and the
//! support by weak duality, whose coefficients combine the slab directions to e + δ instead of e.
//! Each slab gains 2⁻¹⁷ρ‖d‖ = 128u·ρ‖d‖, and any nonnegative combination of slab directions that
//! gives e gains at least 128u·ρ‖e‖ by the triangle inequality. Errors grow with
//! the length of Δ, but if it exceeds a few ρ_A + ρ_B, the slabs' polytopes are certainly apart
//! (`paper/proofs/LEMMAS.md`).

use super::pose::norm;
use super::{down, exp2, up};

/// 2⁻¹⁷ = 128u, a slab's inflation as a multiple of ρ‖d‖. Found: 17.2u along normals, 14.1u along
/// edge × edge. Proofs: `sat_budget_normals.g`, `sat_budget_edges.g`.
pub const SLAB_MARGIN: f64 = exp2(-17);

/// 2⁻¹¹⁰, a slab's inflation as a multiple of ‖d‖: more than underflow and flushing take from some
/// thirty operations. Found: 16.1·2⁻¹²⁶ of its 65536·2⁻¹²⁶. Proofs: the φ of `sat_dot.g` and
/// `support_sum.g`, which are 2⁻³⁰ of 2⁻⁹³ = 2⁻¹¹⁰/2⁻¹⁷.
pub const SLAB_FLOOR: f64 = exp2(-110);

/// |(δ)| ≤ K·u·‖e‖: how far the computed support coefficients combine from e, for k = 6, 14, 18, 26. With k = 6 they are |e|.
/// Found: 0, 1.00, 2.12, 1.00.
/// Proofs: `support_14.g`, `support_18_triangle.g` and `support_18_excess.g`, `support_26.g`.
pub const SUPPORT_ERROR: [(usize, f64); 4] = [(6, 0.0), (14, 1.74), (18, 3.5), (26, 1.42)];

/// One slab `lo ≤ d·x ≤ hi` of the body frame as the separating-axis test wants it: about the
/// centre c, in units of the basis norm, containing 0, inflated, rounded outward.
///
/// `direction` is exact, `scale` is [`norm`] of a basis vector, `reach` bounds ‖x‖ for every vertex
/// x; all finite. The slab is tight: its ends are at most reach·‖d‖ to an ulp, as those of a vertex
/// are.
///
/// The result `lo' ≤ d·(x − c)/scale ≤ hi'` has a margin of (2⁻¹⁷ρ + 2⁻¹¹⁰)·‖d‖/scale on either
/// side, ρ = reach + ‖c‖, which bounds ‖x − c‖ whatever c is.
pub fn inflate_slab(
    lo: f32,
    hi: f32,
    direction: [f32; 3],
    scale: f64,
    centre: [f32; 3],
    reach: f32,
) -> (f32, f32) {
    let offset: f64 = (0..3).map(|i| f64::from(direction[i]) * f64::from(centre[i])).sum();
    let (length, reach) = (norm(direction) / scale, f64::from(reach) + norm(centre));
    let margin = length * (SLAB_MARGIN * reach + SLAB_FLOOR);
    let lo = ((f64::from(lo) - offset) / scale).min(0.0) - margin;
    let hi = ((f64::from(hi) - offset) / scale).max(0.0) + margin;
    (down(lo), up(hi))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends gain the margin about the centre.
    #[test]
    fn both_slab_ends_gain_margin() {
        let (direction, scale, centre, reach) = ([0.5, 0.5, 0.0], 0.5, [0.25, -0.5, 3.0], 4.0);
        let (lo, hi) = inflate_slab(-1.0, 2.0, direction, scale, centre, reach);
        // d·c = −⅛, so the exact ends are (−1 + ⅛)/½ and (2 + ⅛)/½; ‖d‖/scale = √2.
        let margin = 2.0f64.sqrt() * SLAB_MARGIN * (4.0 + norm(centre));
        for (end, exact) in [(-f64::from(lo), 1.75), (f64::from(hi), 4.25)] {
            let gained = end - exact;
            assert!(margin < gained && gained < margin + 1e-6, "{gained:e}, {margin:e}");
        }
    }

    /// A slab that misses its centre is widened to it.
    #[test]
    fn slab_is_widened_to_its_centre() {
        let (lo, hi) = inflate_slab(1.0, 2.0, [1.0, 0.0, 0.0], 1.0, [3.0, 0.0, 0.0], 2.0);
        assert!(lo < -2.0 && hi > 0.0);
        let (lo, hi) = inflate_slab(1.0, 2.0, [1.0, 0.0, 0.0], 1.0, [0.0; 3], 2.0);
        assert!(lo < 0.0 && hi > 2.0);
    }

    /// A point at the origin keeps the floor.
    #[test]
    fn point_slab_keeps_the_floor() {
        let (lo, hi) = inflate_slab(0.0, 0.0, [1.0, 0.0, 0.0], 1.0, [0.0; 3], 0.0);
        assert!(f64::from(hi) > SLAB_FLOOR && lo == -hi);
    }
}
