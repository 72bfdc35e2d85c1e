//! Periodic boxes, with ends in f64. Their images are f32 boxes that contain them. The f64 ends
//! then decide each pair of images exactly.

use super::PeriodicError;
use super::images::{ImageSource, PlacedBody, Placement};
use super::periods::Periods;
use crate::bodies::contract::refuse;
use crate::bodies::{Groups, Motion};
use crate::boxes::{BoxBody, BoxWorld, Boxes};
use crate::query::QueryVolume;
use crate::rounding::period::{is_below_half, is_within, wrap};
use crate::rounding::{LIMIT, outward_box};

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
        Self { min, max, motion: Motion::Dynamic, groups: Groups::ALL }
    }

    #[inline]
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
}

/// The place of a box that is not within one period about the origin.
fn wrapped(slot: usize, body: &PeriodicBox, periods: &Periods) -> Result<Placement, PeriodicError> {
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

/// Whether a box between two ends meets another one that is moved by whole periods.
fn meets(
    [min, max]: [&[f64; 3]; 2],
    other: &PeriodicBox,
    image: [i32; 3],
    periods: &Periods,
) -> bool {
    let periods = periods.get();
    (0..3).all(|axis| {
        let (n, period) = (image[axis], periods[axis].unwrap_or(0.0)); // n is 0 without one
        is_within(min[axis], other.max[axis], n, period)
            && is_within(other.min[axis], max[axis], -n, period)
    })
}

impl ImageSource for Boxes {
    type UserBody = PeriodicBox;

    const IS_EXACT: bool = true;

    #[inline]
    fn place(
        _: &BoxWorld,
        slot: usize,
        body: &PeriodicBox,
        periods: &Periods,
    ) -> Result<Placement, PeriodicError> {
        body.check(slot)?;
        if periods.contain(&body.min, &body.max) {
            return Ok(Placement { lo: body.min, hi: body.max, ..Placement::default() });
        }
        wrapped(slot, body, periods)
    }

    #[inline]
    fn image(body: &PeriodicBox, shift: [i32; 3], periods: &Periods) -> BoxBody {
        // An end that is moved is where it is half of the period or more, exactly or off by 2⁻⁵³ of
        // itself.
        let [min, max] = [body.min, body.max].map(|ends| periods.moved(ends, shift).0);
        BoxBody { bounds: outward_box(&min, &max), motion: body.motion, groups: body.groups }
    }

    fn may_touch(
        periods: &Periods,
        a: &PlacedBody<PeriodicBox>,
        b: &PlacedBody<PeriodicBox>,
        image: [i32; 3],
    ) -> bool {
        meets([&a.body.min, &a.body.max], &b.body, image, periods)
    }

    fn may_touch_volume(
        periods: &Periods,
        body: &PlacedBody<PeriodicBox>,
        image: [i32; 3],
        volume: &QueryVolume<'_>,
    ) -> bool {
        match volume {
            QueryVolume::Box { min, max } => meets([min, max], &body.body, image, periods),
            _ => true,
        }
    }
}
