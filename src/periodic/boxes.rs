//! Periodic boxes, with ends in f64. Their images are f32 boxes that contain them. The f64 ends
//! then decide each pair of images exactly.

use super::PeriodicError;
use super::images::{ImageWorld, PlacedBody, Placement, forward_images};
use super::periods::Periods;
use crate::bodies::contract::refuse;
use crate::bodies::{Aabb, Groups, Motion};
use crate::boxes::{BoxBody, BoxWorld};
use crate::rounding::period::{is_below_half, is_within, shifted, wrap};
use crate::rounding::{LIMIT, down, up};
use crate::world::{BodyId, WorldError, WorldPairs};

/// A box of [`PeriodicBoxes`](super::PeriodicBoxes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicBox {
    /// The lower corner.
    pub min: [f64; 3],
    /// The upper corner.
    pub max: [f64; 3],
    /// Whether it is dynamic, resting or fixed. Pairs of two fixed boxes are never reported.
    pub motion: Motion,
    /// Which boxes it may collide with.
    pub groups: Groups,
}

impl PeriodicBox {
    /// A dynamic box between two corners that collides with all.
    #[must_use]
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Self {
        Self {
            min,
            max,
            motion: Motion::Dynamic,
            groups: Groups::ALL,
        }
    }

    fn check(&self, slot: usize) -> Result<(), PeriodicError> {
        let is_sound = |axis: usize| {
            let [lo, hi] = [self.min[axis], self.max[axis]];
            -f64::from(LIMIT) <= lo && lo <= hi && hi <= f64::from(LIMIT)
        };
        if (0..3).all(is_sound) {
            return Ok(());
        }
        let value = format!("from {:?} to {:?}", self.min, self.max);
        let hint =
            "ends are finite and at most 2^60 in size, and `min` is at most `max` on each axis";
        Ok(refuse(slot, "box", value, hint)?)
    }

    /// The box in f32 about this one, moved by whole periods.
    fn image(&self, shift: [i32; 3], periods: &Periods) -> BoxBody {
        let (mut min, mut max) = (self.min, self.max);
        for (axis, period) in periods.iter() {
            // An end is moved by no period, exactly, or to where it is half of the period or more,
            // and the sum is off by 2⁻⁵³ of itself.
            let moved = |end: f64| {
                let (rest, n) = wrap(end, period);
                shifted(rest, n + shift[axis], period).0
            };
            (min[axis], max[axis]) = (moved(min[axis]), moved(max[axis]));
        }
        BoxBody {
            bounds: Aabb::new(min.map(down), max.map(up)),
            motion: self.motion,
            groups: self.groups,
        }
    }
}

impl ImageWorld for BoxWorld {
    type Body = PeriodicBox;

    forward_images!(PeriodicBox, PeriodicBox::image);

    fn place(
        &self,
        slot: usize,
        body: &PeriodicBox,
        periods: &Periods,
    ) -> Result<Placement, PeriodicError> {
        body.check(slot)?;
        let mut place = Placement::default();
        for (axis, period) in periods.iter() {
            let [lo, hi] = [body.min[axis], body.max[axis]];
            if !is_below_half(lo, hi, period) {
                return Err(periods.size_error(slot, axis, hi - lo));
            }
            periods.check_position(slot, axis, lo)?;
            let (rest, n) = wrap(lo, period);
            let size = hi - lo;
            let is_beyond = rest + 0.5 * size > 0.5 * period;
            place.shift[axis] = -n - i32::from(is_beyond);
            place.lo[axis] = if is_beyond { rest - period } else { rest };
            place.hi[axis] = place.lo[axis] + size;
        }
        Ok(place)
    }

    fn may_touch(
        periods: &Periods,
        a: &PlacedBody<PeriodicBox>,
        b: &PlacedBody<PeriodicBox>,
        image: [i32; 3],
    ) -> bool {
        let (a, b) = (&a.body, &b.body);
        periods
            .get()
            .iter()
            .zip(image)
            .enumerate()
            .all(|(axis, (period, n))| {
                let period = period.unwrap_or(0.0); // n is 0
                is_within(a.min[axis], b.max[axis], n, period)
                    && is_within(b.min[axis], a.max[axis], -n, period)
            })
    }
}
