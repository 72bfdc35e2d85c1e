//! Large worlds: f64 translations, culled as f32 about local origins.
//!
//! Where the origins lie is a function of the bodies as they are now, never of earlier frames. Translations that are all f32
//! stay as they are. Otherwise bodies that lie near each other are placed about one origin; bodies in many far-apart places
//! have an [origin per region](super::regions).

use super::region::{Placed, Region};
use super::regions::{Regions, regions};
use crate::rounding::exp2;

/// Cells across that are placed about one origin without looking for regions: rounding there is below 2⁻¹⁰ of the largest body.
const FEW_CELLS: f64 = 64.0;

/// The least cell, for bodies without any extent.
const LEAST_CELL: f64 = exp2(-149);

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
        let whole = Self::about(lo, hi, half, cell);
        Self { whole, parts }
    }

    /// The local translation of a slot's body, and how far from the exact one it may be.
    pub fn place(&self, slot: usize, t: [f64; 3]) -> ([f32; 3], f64) {
        let region = self.parts.as_ref().map(|parts| parts.of(slot));
        region.unwrap_or(&self.whole).place(t)
    }

    /// One origin for the box from `lo` to `hi`: the world's own, unless the box lies farther out than it is wide. Then the
    /// middle, in steps of about an eighth of the width, so that it seldom changes while bodies move.
    fn about(lo: [f64; 3], hi: [f64; 3], half: f64, cell: f64) -> Region {
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * lo[i] + 0.5 * hi[i]);
        if middle.iter().all(|x| x.abs() <= half) {
            return Region::default();
        }
        let step = power_from(0.125 * half).max(cell);
        Region {
            origin: middle.map(|x| (x / step).round() * step),
            corner: [0.0; 3],
        }
    }
}

/// Whether the coordinates are f32.
fn is_f32(t: [f64; 3]) -> bool {
    t.iter().all(|&x| f64::from(x as f32) == x)
}

/// The smallest power of two that is no less than a positive normal number; 0 for 0.
fn power_from(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    f64::from_bits((x.to_bits() + MANTISSA) & !MANTISSA)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies of size 1 at these places, in slots that begin at 3.
    fn local(places: &[[f64; 3]]) -> Local {
        Local::of(places.iter().zip(3..).map(|(&t, slot)| (slot, t, 1.0)))
    }

    #[test]
    fn f32_translations_stay() {
        let far = [[1.0e9, -3.5, 0.0], [1.0e15, 7.25, 2.0f64.powi(-149)]];
        let local = local(&far);
        assert_eq!(local.place(3, far[0]), ([1.0e9, -3.5, 0.0], 0.0));
        assert_eq!(local.place(4, far[1]).1, 0.0);
    }

    #[test]
    fn far_bodies_get_an_origin() {
        let far = [[1.0e9 + 0.1, 0.0, 0.0], [1.0e9 + 8.3, 1.0, 0.0]];
        let local = local(&far);
        let [a, b] = [0, 1].map(|i| local.place(3 + i, far[i]));
        // Within 64 of an origin, instead of 10⁹ from it.
        assert!(a.0[0].abs() <= 64.0 && a.1 < 1.0e-5, "{a:?}");
        assert!((b.0[0] - a.0[0] - 8.2).abs() < 1.0e-5, "{b:?}");
    }

    #[test]
    fn bodies_about_the_origin_keep_it() {
        let near = [[-900.1, 3.0, 0.5], [1000.0, 0.25, 0.0]];
        let local = local(&near);
        assert_eq!(local.place(4, near[1]), ([1000.0, 0.25, 0.0], 0.0));
        assert_eq!(local.place(3, near[0]).0, near[0].map(|x| x as f32));
    }

    #[test]
    fn far_regions_are_brought_together() {
        let places: Vec<[f64; 3]> = (0..1000_u32)
            .map(|i| [f64::from(i) * 1.0e9 + 0.1, f64::from(i % 7) * -3.0e11, 0.7])
            .collect();
        let local = local(&places);
        let placed: Vec<[f32; 3]> = (0..1000)
            .map(|i| {
                let (place, moved) = local.place(3 + i, places[i]);
                assert!(moved < 2.0_f64.powi(-10), "{moved}");
                place
            })
            .collect();
        for (i, a) in placed.iter().enumerate() {
            for b in &placed[i + 1..] {
                let apart = (0..3).fold(0.0_f32, |m, i| m.max((a[i] - b[i]).abs()));
                assert!(apart >= 60.0, "{a:?} {b:?}");
            }
        }
    }
}
