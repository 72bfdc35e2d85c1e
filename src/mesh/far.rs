//! Meshes far from their origin: coordinates in f64 are kept as f32 about a point near the mesh.
//!
//! Rounding the coordinates of a wall on a map to f32 would move them by a large part of the wall's
//! size. If it would move a vertex by more than 2⁻²⁰ of the mesh's size, the mesh is re-centred in
//! f64 first. The offset has few bits, so that offset + vertex is exact in f64: a mesh that is
//! written and read again is the same. For that reason the offset, and the decision whether to use
//! one, are computed from the coordinates that result, with a margin of a sixteenth.

use crate::rounding::{exp2, two_sum, up};

/// 15/16 of 2⁻²⁰: how far rounding may move a point of a mesh that stays where it is, as a multiple
/// of the mesh's largest extent. The sixteenth is what re-centring moves at most.
const MOST_ROUNDING: f64 = 15.0 * exp2(-24);

/// The least step of an offset. Below it, another origin does not help f32.
const LEAST_STEP: f64 = exp2(-126);

/// Points stored as f32 vertices about an offset.
pub(super) struct PlacedPoints {
    pub vertices: Vec<[f32; 3]>,
    pub offset: [f64; 3],
    /// An upper bound on the distance of each point from offset + vertex.
    pub rounding: f32,
}

/// Rounds points to f32; about an offset if rounding would otherwise move them too far.
pub(super) fn place(points: &[[f64; 3]]) -> PlacedPoints {
    let round = |offset: [f64; 3]| points.iter().map(|&p| vertex(p, offset)).collect();
    let bounds = PointBounds::of(points.iter().copied());
    let moved = moved(points.iter().copied());
    if moved <= 0.5 * MOST_ROUNDING * bounds.size() {
        return PlacedPoints { vertices: round([0.0; 3]), offset: [0.0; 3], rounding: 0.0 };
    }
    let offset = bounds.settled_offset();
    let kept = || points.iter().map(|&p| kept(p, offset));
    let far = self::moved(kept()) > MOST_ROUNDING * PointBounds::of(kept()).size();
    let offset = if far { offset } else { [0.0; 3] };
    let tiny = bounds.size() < LEAST_STEP; // no offset mends what f32 can't hold of it
    PlacedPoints {
        vertices: round(offset),
        offset,
        rounding: if far || tiny { rounding(points, offset) } else { 0.0 },
    }
}

/// A point relative to an offset, in f32.
fn vertex(point: [f64; 3], offset: [f64; 3]) -> [f32; 3] {
    std::array::from_fn(|i| (point[i] - offset[i]) as f32)
}

/// The position that a point gets as a vertex about an offset.
fn kept(point: [f64; 3], offset: [f64; 3]) -> [f64; 3] {
    let vertex = vertex(point, offset);
    std::array::from_fn(|i| offset[i] + f64::from(vertex[i]))
}

/// The largest distance by which rounding to f32 moves one of the points.
fn moved(points: impl Iterator<Item = [f64; 3]>) -> f64 {
    let squared = |point: [f64; 3]| {
        let moved = point.map(|x| (f64::from(x as f32) - x).powi(2));
        moved[0] + moved[1] + moved[2]
    };
    points.map(squared).fold(0.0, f64::max).sqrt()
}

/// The largest distance of a point from its offset + vertex, rounded up; 0 where all are exact.
pub(super) fn rounding(points: &[[f64; 3]], offset: [f64; 3]) -> f32 {
    let squared = |&point: &[f64; 3]| {
        let vertex = vertex(point, offset);
        let moved = |i: usize| {
            let (difference, lost) = two_sum(point[i], -offset[i]);
            (difference - f64::from(vertex[i])) + lost
        };
        (0..3).map(|i| moved(i).powi(2)).sum::<f64>()
    };
    // Squares below 2⁻¹⁰²² are lost, and `up` exceeds their roots.
    let squared = points.iter().map(squared).fold(0.0, f64::max);
    if squared == 0.0 && points.iter().all(|&p| kept(p, offset) == p) {
        return 0.0;
    }
    up(squared.sqrt() * (1.0 + exp2(-40)))
}

/// A box about points.
#[derive(Clone, Copy)]
struct PointBounds {
    lo: [f64; 3],
    hi: [f64; 3],
}

impl PointBounds {
    fn of(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let none = Self { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3] };
        points.fold(none, |Self { lo, hi }, p| Self {
            lo: std::array::from_fn(|i| lo[i].min(p[i])),
            hi: std::array::from_fn(|i| hi[i].max(p[i])),
        })
    }

    /// The largest extent.
    fn size(&self) -> f64 {
        (0..3).fold(0.0, |most, i| most.max(self.hi[i] - self.lo[i]))
    }

    /// The middle, as a multiple of a power of two near an eighth of the size, so that nothing
    /// rounds.
    fn offset(&self) -> [f64; 3] {
        let size = self.size();
        let power = f64::from_bits(size.to_bits() & f64::INFINITY.to_bits());
        let step = (0.25 * power).max(LEAST_STEP);
        std::array::from_fn(|i| {
            let middle = 0.5 * self.lo[i] + 0.5 * self.hi[i];
            (middle / step).round() * step
        })
    }

    /// An offset that the points, once stored about it, would get again.
    fn settled_offset(mut self) -> [f64; 3] {
        let mut offset = self.offset();
        for _ in 0..8 {
            self = Self { lo: kept(self.lo, offset), hi: kept(self.hi, offset) };
            let next = self.offset();
            if next == offset {
                break;
            }
            offset = next;
        }
        offset
    }
}
