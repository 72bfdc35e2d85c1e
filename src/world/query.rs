//! How a query index reads a world, and about which origin it keeps the bodies' boxes.

use super::{Body, World};
use crate::posed::{PosedBodies, QueryShape};
use crate::query::{FIXED_TREE, MOVING_TREE, QueryIndex, QuerySource, Sealed};
use crate::rounding::query::largest;

impl Sealed for World {}

impl QuerySource for World {
    fn bring(&self, index: &mut QueryIndex) {
        let places = self.bodies().map(|(_, body)| body.translation);
        let area = BodyExtent::of(places, self.len());
        let mut posed = match index.posed.take() {
            Some(posed) if index.origin == area.origin() => posed,
            _ => {
                index.begin(area.origin(), None);
                PosedBodies::default()
            }
        };
        let renewed = renew(&mut posed.shapes, self);
        let mut next = 0;
        for (row, id, body) in self.rows() {
            index.take_out_all(next..row);
            next = row + 1;
            if posed.bodies.len() < next {
                posed.bodies.resize(next, Body::default());
            }
            let former = std::mem::replace(&mut posed.bodies[row], body);
            let is_unchanged = former == body && index.bounds_of(row, id).is_some();
            if is_unchanged && !renewed[body.shape as usize] {
                continue;
            }
            if let Some(shape) = &posed.shapes[body.shape as usize] {
                let body_there = shape.of_body(&body);
                let tree = if body.motion.is_dynamic() { MOVING_TREE } else { FIXED_TREE };
                index.put(row, id, tree, &body_there.bounds(index.origin));
            }
        }
        index.posed = Some(posed);
        index.end(next);
    }
}

/// Copies the shapes of a world, and returns which have changed.
pub(crate) fn renew(shapes: &mut Vec<Option<QueryShape>>, world: &World) -> Vec<bool> {
    let mut renewed = Vec::new();
    for (number, volumes) in world.volumes.shape_volumes().enumerate() {
        if shapes.len() == number {
            shapes.push(None);
        }
        let shape = &mut shapes[number];
        let is_same = match (&*shape, volumes) {
            (Some(shape), Some(volumes)) => shape.is_of(volumes),
            (None, None) => true,
            _ => false,
        };
        if !is_same {
            *shape = volumes.map(QueryShape::of);
        }
        renewed.push(!is_same);
    }
    shapes.truncate(renewed.len());
    renewed
}

/// The bodies that are drawn to estimate where most are.
const SAMPLE_SIZE: usize = 64;

/// If the extent of all bodies is this many times that of most, the others are left out of it.
const MOST_EXTENT_RATIO: f64 = 1024.0;

/// The extent of the bodies: its middle, and half of its widest side.
struct BodyExtent {
    middle: [f64; 3],
    half: f64,
}

impl BodyExtent {
    fn of(places: impl Iterator<Item = [f64; 3]>, count: usize) -> Self {
        let step = count.div_ceil(SAMPLE_SIZE).max(1);
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut sample = Vec::with_capacity(SAMPLE_SIZE);
        for (number, place) in places.enumerate() {
            for axis in 0..3 {
                lo[axis] = lo[axis].min(place[axis]);
                hi[axis] = hi[axis].max(place[axis]);
            }
            if number % step == 0 {
                sample.push(place);
            }
        }
        if lo[0] > hi[0] {
            ([lo, hi]) = [[0.0; 3]; 2]; // no bodies
        }
        let all = Self::between(lo, hi);
        // Most bodies: without an eighth of them at either end of each axis.
        let ends = [sample.len() / 8, sample.len().saturating_sub(1 + sample.len() / 8)];
        let [lo, hi] = ends.map(|rank| {
            [0, 1, 2].map(|axis| {
                let mut along: Vec<f64> = sample.iter().map(|place| place[axis]).collect();
                along.sort_unstable_by(f64::total_cmp);
                along.get(rank).copied().unwrap_or(0.0)
            })
        });
        let most = Self::between(lo, hi);
        if all.half > MOST_EXTENT_RATIO * most.half { most } else { all }
    }

    fn between(lo: [f64; 3], hi: [f64; 3]) -> Self {
        Self {
            middle: [0, 1, 2].map(|axis| 0.5 * (lo[axis] + hi[axis])),
            half: (0..3).fold(0.0, |half: f64, axis| half.max(0.5 * (hi[axis] - lo[axis]))),
        }
    }

    /// The origin of the f32 boxes. It is a function of the present bodies, so that answers are,
    /// too: the world's origin unless bodies are far from it; otherwise their middle, in steps of
    /// about twice their width, so that it seldom changes while they move.
    fn origin(&self) -> [f64; 3] {
        /// The largest ratio of the bodies' distance from the world's origin to their distance from
        /// each other.
        const MOST_OFFSET_RATIO: f64 = 16.0;
        const MANTISSA: u64 = (1 << 52) - 1;
        let far = largest(self.middle);
        if far <= MOST_OFFSET_RATIO * self.half {
            return [0.0; 3];
        }
        let step = (4.0 * self.half).max(far / f64::from(1 << 24));
        let step = f64::from_bits(step.to_bits() & !MANTISSA); // a power of two
        self.middle.map(|x| (x / step).round() * step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The origin is where most bodies are, however far away a few are.
    #[test]
    fn few_far_bodies_leave_the_origin() {
        let near = |far: &[[f64; 3]]| {
            let all = (0..500).map(|i| [1.0e9 + f64::from(i % 20), f64::from(i / 20), 7.0]);
            let all: Vec<_> = all.chain(far.iter().copied()).collect();
            BodyExtent::of(all.iter().copied(), all.len()).origin()
        };
        for far in [&[][..], &[[0.0; 3]], &[[-1.0e9; 3], [3.0e15, 0.0, 1.0]]] {
            let origin = near(far);
            assert!((origin[0] - 1.0e9).abs() < 100.0, "{far:?}: {origin:?}");
        }
        let about = (0..100).map(|i| [f64::from(i) - 50.0, 0.0, 1.0e12 * f64::from(i / 99)]);
        assert_eq!(BodyExtent::of(about, 100).origin(), [0.0; 3]);
    }
}
