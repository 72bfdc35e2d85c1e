//! A box around bodies, which determines the origin of their f32 coordinates.

use super::region::{PlacedBody, Region};
use crate::rounding::{LIMIT, exp2};

/// The largest width, in cells, of a box whose bodies are placed about one origin without a search
/// for regions. Rounding is then below 2⁻¹⁰ of the largest body.
const CELLS_PER_ORIGIN: f64 = 64.0;

/// The smallest cell, for bodies without extent.
const LEAST_CELL: f64 = exp2(-149);

/// The range of translations of some bodies, `lo` to `hi`, and the largest reach of a body, `size`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BodyBounds {
    lo: [f64; 3],
    hi: [f64; 3],
    size: f64,
    /// Whether all translations can stay as they are.
    pub are_placed: bool,
}

/// A cube that contains the bodies of a region. `lowest` is its lowest corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cube {
    pub lowest: [f64; 3],
    /// A power of two.
    pub side: f64,
}

impl BodyBounds {
    /// The bounds of no body.
    pub const EMPTY: Self =
        Self { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3], size: 0.0, are_placed: true };

    pub fn of(bodies: impl Iterator<Item = PlacedBody>) -> Self {
        let alone =
            |(_, t, size): PlacedBody| Self { lo: t, hi: t, size, are_placed: is_placed(t) };
        bodies.map(alone).fold(Self::EMPTY, Self::union)
    }

    /// The bounds of both sets.
    pub fn union(self, other: Self) -> Self {
        Self {
            lo: std::array::from_fn(|i| self.lo[i].min(other.lo[i])),
            hi: std::array::from_fn(|i| self.hi[i].max(other.hi[i])),
            size: self.size.max(other.size),
            are_placed: self.are_placed && other.are_placed,
        }
    }

    /// The cell width, a power of two: bodies that can meet are at most a 32nd of it apart.
    pub fn cell(&self) -> f64 {
        power_from((64.0 * self.size).max(LEAST_CELL))
    }

    /// Half the widest side.
    pub fn half(&self) -> f64 {
        (0..3).fold(0.0, |half: f64, i| half.max(0.5 * self.hi[i] - 0.5 * self.lo[i]))
    }

    /// Whether one origin is too coarse for all.
    pub fn is_wide(&self) -> bool {
        2.0 * self.half() > CELLS_PER_ORIGIN * self.cell()
    }

    /// One origin for all: the world's origin, unless the box is farther from it than it is wide.
    /// Then it is the middle of the box, rounded to steps of about an eighth of the width, so that
    /// it seldom changes while bodies move.
    pub fn region(&self) -> Region {
        let (half, middle) = (self.half(), self.middle());
        if middle.iter().all(|x| x.abs() <= half) {
            return Region::default();
        }
        let step = power_from(0.125 * half).max(self.cell());
        Region { origin: middle.map(|x| (x / step).round() * step), corner: [0.0; 3] }
    }

    /// A cube that contains all bodies and, around them, space for four of the largest. Its lowest
    /// corner is a multiple of a quarter of the side, so that it seldom changes while bodies move.
    pub fn cube(&self) -> Cube {
        let room = 4.0 * self.size;
        let mut side = power_from((2.0 * (self.half() + room)).max(LEAST_CELL));
        loop {
            let step = 0.25 * side;
            let lowest = self.lo.map(|x| ((x - room) / step).floor() * step);
            if (0..3).all(|i| self.hi[i] + room - lowest[i] <= side) {
                return Cube { lowest, side };
            }
            side *= 2.0;
        }
    }

    fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|i| 0.5 * self.lo[i] + 0.5 * self.hi[i])
    }
}

/// Whether a translation can stay as it is: f32, and within the contract.
pub(super) fn is_placed(t: [f64; 3]) -> bool {
    t.iter().all(|&x| f64::from(x as f32) == x && x.abs() <= f64::from(LIMIT))
}

/// The smallest power of two that is at least `x`, a positive normal number; 0 for 0.
fn power_from(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    f64::from_bits((x.to_bits() + MANTISSA) & !MANTISSA)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(places: &[[f64; 3]], size: f64) -> BodyBounds {
        BodyBounds::of(places.iter().map(|&t| (0, t, size)))
    }

    #[test]
    fn cells_are_powers_of_two() {
        let cell = |size| bounds(&[[0.0; 3]], size).cell();
        assert_eq!([cell(1.0), cell(1.01), cell(0.0)], [64.0, 128.0, LEAST_CELL]);
        assert_eq!(power_from(3.0), 4.0);
        assert_eq!(power_from(0.0), 0.0);
    }

    #[test]
    fn far_boxes_have_an_origin() {
        let half_wide = |x: f64| [[-x, 0.0, 0.0], [x, 1.0, 0.0]];
        assert_eq!(bounds(&half_wide(1.0e9), 1.0).region(), Region::default());
        let region = bounds(&[[1.0e9, 0.0, 0.0], [1.0e9 + 8.0, 1.0, 0.0]], 1.0).region();
        assert!((region.origin[0] - 1.0e9).abs() <= 64.0, "{region:?}");
        assert_eq!(region.origin[1..], [0.0; 2]);
    }

    #[test]
    fn cubes_hold_bodies_and_room() {
        for (far, wide, size) in
            [(0.0, 3.0, 1.0), (1.0e9 + 0.1, 300.7, 0.25), (-7.7e17, 1.0e5, 1.0e3), (-3.3, 0.0, 0.0)]
        {
            let places = [[far; 3], [far, far + wide, far]];
            let Cube { lowest, side } = bounds(&places, size).cube();
            for place in places {
                for i in 0..3 {
                    let room = [place[i] - lowest[i], lowest[i] + side - place[i]];
                    assert!(room[0] >= 4.0 * size && room[1] >= 4.0 * size, "{far}");
                }
            }
            assert!(side <= 8.0 * (wide + 8.0 * size).max(LEAST_CELL), "{side}");
        }
    }
}
