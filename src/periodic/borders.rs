//! The borders of the period: which bodies need images beyond the upper ones, and when a body is
//! wrapped.

use super::images::Placement;
use super::periods::Periods;
use crate::rounding::exp2;

/// The factor by which the widest body counts as wider than it is, so that bodies of nearly the
/// same size don't all become the widest so far.
const WIDEST_FACTOR: f64 = 1.0 + 1.0 / 64.0;

/// Bodies may leave the period by this share of the widest body's half before they are wrapped, so
/// that in most frames no body jumps from border to border and no image comes or goes. Lists of
/// neighbours then serve for many frames.
const SLACK_SHARE: f64 = 0.5;

/// 2⁻⁴⁰, as a multiple of the period: more than rounding takes from the ends of placed bodies. A
/// body that is nearer to the border than that has an image across it.
const BORDER_ERROR: f64 = exp2(-40);

/// The borders, seen from the widest body so far.
#[derive(Clone, Copy, Debug)]
pub struct Borders {
    /// Along each axis, no body is wider than twice this; infinite along axes without a period.
    widest: [f64; 3],
    /// How far the middles of bodies may be outside of the period.
    slack: [f64; 3],
    /// Bodies with their lower end at most here have an image across the upper border.
    near: [f64; 3],
}

impl Borders {
    /// Before any body.
    pub fn new(periods: &Periods) -> Self {
        let mut borders =
            Self { widest: [f64::INFINITY; 3], slack: [0.0; 3], near: [f64::NEG_INFINITY; 3] };
        for (axis, period) in periods.iter() {
            borders.set(axis, period, 0.0);
        }
        borders
    }

    fn set(&mut self, axis: usize, period: f64, widest: f64) {
        self.widest[axis] = widest;
        self.slack[axis] = SLACK_SHARE * widest;
        self.near[axis] = widest + self.slack[axis] - (0.5 - BORDER_ERROR) * period;
    }

    /// Notes a body with these ends, and returns whether it is wider than all before.
    #[inline]
    pub fn grow(&mut self, lo: &[f64; 3], hi: &[f64; 3], periods: &Periods) -> bool {
        let is_wider = |axis: usize| 0.5 * (hi[axis] - lo[axis]) > self.widest[axis];
        if !(is_wider(0) | is_wider(1) | is_wider(2)) {
            return false;
        }
        for (axis, period) in periods.iter() {
            let half = 0.5 * (hi[axis] - lo[axis]);
            if half > self.widest[axis] {
                self.set(axis, period, half * WIDEST_FACTOR);
            }
        }
        true
    }

    /// How far bodies may reach from the middle of the period, along each periodic axis.
    pub fn reach(&self, periods: &Periods) -> [f64; 3] {
        let mut reach = [0.0; 3];
        for (axis, period) in periods.iter() {
            reach[axis] = 0.5 * period + self.slack[axis] + self.widest[axis];
        }
        reach
    }

    /// The axes along which a body with this lower end is so near to the lower border that one at
    /// the upper border may touch it, or farther away by at most some slacks.
    #[inline]
    pub fn near(&self, lo: &[f64; 3], slacks: f64) -> u8 {
        let is_near = |axis: usize| lo[axis] <= self.near[axis] + slacks * self.slack[axis];
        u8::from(is_near(0)) | u8::from(is_near(1)) << 1 | u8::from(is_near(2)) << 2
    }

    /// Moves a body's place by a period to the side where its lower end was before, on the axes
    /// along which it is then outside of the period by the slack at most.
    pub fn keep(&self, place: &mut Placement, former: &[f64; 3], periods: &Periods) {
        for (axis, period) in periods.iter() {
            let side = (former[axis] - place.lo[axis]).signum();
            let [lo, hi] = [place.lo, place.hi].map(|end| end[axis] + side * period);
            let is_back = (lo - former[axis]).abs() <= 0.5 * period;
            if is_back && (0.5 * (lo + hi)).abs() <= 0.5 * period + self.slack[axis] {
                place.shift[axis] += side as i32;
                (place.lo[axis], place.hi[axis]) = (lo, hi);
            }
        }
    }
}
