//! Large worlds: f64 translations, culled as f32 about local origins.
//!
//! Where the origins lie is a function of the bodies as they are now, never of earlier frames. Translations that are all f32
//! stay as they are. Otherwise bodies that lie near each other are placed about one origin; bodies in many far-apart places
//! have an [origin per region](super::regions).
//!
//! A translation is subtracted twice in f64 and rounded to f32. Its distance from the exact one is bounded, and the bound
//! joins the body's margin, so that volumes at the rounded place contain what the exact mesh occupies (theorem T).

use super::regions::{Regions, regions};
use crate::rounding::exp2;

/// √3·2⁻²⁴ < 2⁻²³: how far rounding the local translation to f64 and then to f32 moves a body, as a multiple of its largest
/// coordinate.
const MOVED: f64 = exp2(-23);

/// √3·2⁻¹⁵⁰ < 2⁻¹⁴⁹: the same where f32 underflows.
const MOVED_LEAST: f64 = exp2(-149);

/// √3·2⁻⁵³ < 2⁻⁵²: how far rounding the distance from the origin to f64 moves a body, as a multiple of its largest coordinate.
const MOVED_BEFORE: f64 = exp2(-52);

/// Cells across that are placed about one origin without looking for regions: rounding there is below 2⁻¹¹ of the largest body.
const FEW_CELLS: f64 = 64.0;

/// The least cell, for bodies without any extent.
const LEAST_CELL: f64 = exp2(-149);

/// Where the f32 coordinates of a region's bodies count from: `origin` in the world becomes −`corner`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Region {
    pub origin: [f64; 3],
    pub corner: [f64; 3],
}

/// A body as far as it matters here: its slot, its translation, and how far the mesh with its margin reaches from there.
pub(super) type Placed = (usize, [f64; 3], f64);

/// Which region each slot's body belongs to.
#[derive(Clone, Debug, Default)]
pub(super) struct Local {
    whole: Region,
    parts: Option<Regions>,
}

impl Local {
    /// The regions of these bodies, whose translations are at most 2⁶⁰ in size.
    pub fn of(bodies: impl Iterator<Item = Placed> + Clone) -> Self {
        if bodies.clone().all(|(_, t, _)| is_f32(t)) {
            return Self::default();
        }
        let (mut lo, mut hi, mut size) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
        for (_, t, reach) in bodies.clone() {
            for axis in 0..3 {
                lo[axis] = lo[axis].min(t[axis]);
                hi[axis] = hi[axis].max(t[axis]);
            }
            size = size.max(reach);
        }
        // Bodies that can meet are at most 2·size apart, a 32nd of a cell.
        let cell = power_from((64.0 * size).max(LEAST_CELL));
        let half = (0..3).fold(0.0, |m: f64, i| m.max(0.5 * hi[i] - 0.5 * lo[i]));
        let parts = if 2.0 * half > FEW_CELLS * cell {
            regions(bodies, cell).filter(|parts| 2.0 * parts.half < half)
        } else {
            None
        };
        let whole = Region::about(lo, hi, half, cell);
        Self { whole, parts }
    }

    /// The local translation of a slot's body, and how far from the exact one it may be.
    pub fn place(&self, slot: usize, t: [f64; 3]) -> ([f32; 3], f64) {
        let region = self.parts.as_ref().map(|parts| parts.of(slot));
        region.unwrap_or(&self.whole).place(t)
    }
}

impl Region {
    /// One origin for the box from `lo` to `hi`: the world's own, unless the box lies farther out than it is wide. Then the
    /// middle, in steps of about an eighth of the width, so that it seldom changes while bodies move.
    fn about(lo: [f64; 3], hi: [f64; 3], half: f64, cell: f64) -> Self {
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * lo[i] + 0.5 * hi[i]);
        if middle.iter().all(|x| x.abs() <= half) {
            return Self::default();
        }
        let step = power_from(0.125 * half).max(cell);
        Self {
            origin: middle.map(|x| (x / step).round() * step),
            corner: [0.0; 3],
        }
    }

    /// The local translation, and how far from the exact one it may be: 0 where no step is rounded.
    fn place(&self, t: [f64; 3]) -> ([f32; 3], f64) {
        let (mut far, mut near, mut exact) = (0.0_f64, 0.0_f64, true);
        let local = std::array::from_fn(|i| {
            let (first, lost) = difference(t[i], self.origin[i]);
            let (second, lost_again) = difference(first, self.corner[i]);
            let local = second as f32;
            exact &= lost == 0.0 && lost_again == 0.0 && f64::from(local) == second;
            far = far.max(first.abs());
            near = near.max(second.abs());
            local
        });
        if exact {
            return (local, 0.0);
        }
        (local, near * MOVED + far * MOVED_BEFORE + MOVED_LEAST)
    }
}

/// Whether the coordinates are f32.
fn is_f32(t: [f64; 3]) -> bool {
    t.iter().all(|&x| f64::from(x as f32) == x)
}

/// a − b in f64, and what rounding lost of it, exactly (Knuth's two-sum).
fn difference(a: f64, b: f64) -> (f64, f64) {
    let sum = a - b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) - (b + of_b))
}

/// The smallest power of two that is no less than a positive normal number; 0 for 0.
fn power_from(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    f64::from_bits((x.to_bits() + MANTISSA) & !MANTISSA)
}
