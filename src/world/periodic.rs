//! Periodic meshes. An image has the pose of its body with another translation. If f64 rounds that
//! translation, the image is grown by a bound of the error.

use super::{Body, Meshes, World};
use crate::culler::CullerBuilder;
use crate::periodic::periods::{Periods, margin_about};
use crate::periodic::{ImageSource, Periodic, PeriodicError, PlacedBody, Placement};
use crate::rounding::exp2;
use crate::rounding::narrow::turn_error;
use crate::rounding::period::wrap;
use crate::rounding::query::largest;
use crate::update::offset::{compose, reach_about_pose};
use crate::volume::Shape;

/// 2⁻⁴⁸, as a multiple of the period: more than rounding takes from the ends of a placed body, and
/// from differences of ends.
const PLACE_ERROR: f64 = exp2(-48);

/// 1 + 2⁻⁴⁰: the factor by which a size is taken for larger before it is compared with half of a
/// period, so that of two images that are a period apart one is farther away than
/// [`PLACE_ERROR`].
const SIZE_FACTOR: f64 = 1.0 + exp2(-40);

/// Bodies of less than this share of each period are small. Two of them can't touch in two images,
/// since volumes reach no farther than twice half of a body's size, without what rounding adds.
const SMALL_SHARE: f64 = 0.2;

/// 2⁻⁹: the share of a shape's reach by which its size is taken for larger in that comparison: more
/// than a margin's class adds for rounding.
const REACH_SHARE: f64 = exp2(-9);

/// A long-lived set of posed meshes in space that repeats along some axes.
pub type PeriodicWorld = Periodic<Meshes>;

impl PeriodicWorld {
    /// No bodies yet, culled with all defaults. `None` is an axis without a period.
    ///
    /// # Errors
    /// A period is not a length between 2⁻⁵⁶ and 2⁵⁶, or a shape is outside of the contract.
    pub fn new(shapes: Vec<Shape>, periods: [Option<f64>; 3]) -> Result<Self, PeriodicError> {
        Self::of(World::new(shapes)?, periods)
    }

    /// No bodies yet, culled with the choices of a builder.
    ///
    /// # Errors
    /// As [`Self::new`], or as [`World::with`].
    pub fn with(
        shapes: Vec<Shape>,
        culler: &CullerBuilder,
        periods: [Option<f64>; 3],
    ) -> Result<Self, PeriodicError> {
        Self::of(World::with(shapes, culler)?, periods)
    }
}

impl ImageSource for Meshes {
    type UserBody = Body;

    const IS_EXACT: bool = false;

    fn place(
        set: &World,
        slot: usize,
        body: &Body,
        periods: &Periods,
    ) -> Result<Placement, PeriodicError> {
        set.check(slot, body)?;
        let mut place = Placement::default();
        let mut wrapped = body.translation;
        for (axis, period) in periods.iter() {
            periods.check_position(slot, axis, wrapped[axis])?;
            let (rest, n) = wrap(wrapped[axis], period);
            (wrapped[axis], place.shift[axis]) = (rest, -n);
        }
        let (centre, radius) = set.volumes.ball(body.shape);
        let (middle, error) = compose(body.rotation, wrapped, centre);
        // Twice the bound for the sum that is the centre, and again for roundings of the sum here.
        let turned = turn_error(body.rounded, reach_about_pose(radius, centre));
        let radius = radius + f64::from(body.margin) + 4.0 * error + turned;
        let rounding = REACH_SHARE * (largest(centre) + radius);
        place.is_small = true;
        for (axis, period) in periods.iter() {
            let half = (radius + PLACE_ERROR * period) * SIZE_FACTOR;
            if !(4.0 * half < period) {
                return Err(periods.size_error(slot, axis, 2.0 * half));
            }
            place.is_small &= 2.0 * (half + rounding) < SMALL_SHARE * period;
            let n = if middle[axis].abs() < 0.5 * period {
                0.0
            } else {
                (middle[axis] / period).round()
            };
            periods.check_position(slot, axis, n * period)?;
            place.shift[axis] -= n as i32;
            let middle = middle[axis] - n * period;
            (place.lo[axis], place.hi[axis]) = (middle - half, middle + half);
        }
        Ok(place)
    }

    fn image(body: &Body, shift: [i32; 3], periods: &Periods) -> Body {
        let (translation, errors) = periods.moved(body.translation, shift);
        Body { translation, margin: margin_about(body.margin, errors), ..*body }
    }

    fn may_touch(
        periods: &Periods,
        a: &PlacedBody<Body>,
        b: &PlacedBody<Body>,
        image: [i32; 3],
    ) -> bool {
        let (a, b) = (&a.place, &b.place);
        periods.iter().all(|(axis, period)| {
            let n = image[axis] + a.shift[axis] - b.shift[axis];
            let way = f64::from(n) * period;
            a.lo[axis] - b.hi[axis] <= way && way <= a.hi[axis] - b.lo[axis]
        })
    }
}
