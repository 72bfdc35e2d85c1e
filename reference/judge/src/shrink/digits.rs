//! Shorter numbers: periods, boxes and poses of fewer binary digits.

use super::{Search, refit};
use crate::case::Frame;

/// Below it, f32 holds the halves of numbers.
const WHOLE: f32 = 4_194_304.0;

impl Search<'_> {
    /// No period along an axis, or one of fewer binary digits.
    pub(super) fn fewer_periods(&mut self) {
        for (frame, axis) in (0..3 * self.case.frames.len()).map(|at| (at / 3, at % 3)) {
            let periods = self.case.frames[frame].periods;
            let Some(full) = periods.and_then(|periods| periods[axis]).filter(|_| !self.is_over())
            else {
                continue;
            };
            let digits = [2, 4, 8, 12, 16, 20].map(|digits| rounded(full as f32, digits));
            let shorter = digits.map(|period| Some(f64::from(period)));
            for period in [None].into_iter().chain(shorter) {
                let mut case = self.case.clone();
                if let Some(periods) = &mut case.frames[frame].periods {
                    periods[axis] = period;
                }
                let is_sound = case.frames[frame].check_periods().is_ok();
                if period == Some(full) || is_sound && self.try_case(case) {
                    break;
                }
            }
        }
    }

    /// Poses, or boxes, of fewer binary digits.
    pub(super) fn fewer_digits(&mut self) {
        for frame in 0..self.case.frames.len() {
            for body in 0..self.case.frames[frame].bodies.len() {
                if self.is_over() {
                    return;
                }
                if self.case.claim.is_of_boxes() {
                    (0..3).for_each(|axis| self.widen(frame, body, axis));
                    for n in 0..6 {
                        let end = self.case.frames[frame].boxes[body][n];
                        self.shorten(frame, end, &|frame, x| frame.boxes[body][n] = x);
                    }
                } else {
                    self.shorten_pose(frame, body);
                    self.shorten_parts(frame, body);
                }
            }
        }
    }

    /// Whole ends of a box along an axis, at least 1 apart.
    fn widen(&mut self, frame: usize, body: usize, axis: usize) {
        let ends = &self.case.frames[frame].boxes[body];
        let lo = ends[axis].floor();
        let hi = ends[axis + 3].ceil().max(lo + 1.0);
        if [lo, hi] != [ends[axis], ends[axis + 3]] && hi.abs().max(lo.abs()) < WHOLE {
            let mut case = self.case.clone();
            let ends = &mut case.frames[frame].boxes[body];
            (ends[axis], ends[axis + 3]) = (lo, hi);
            if case.frames[frame].check_periods().is_ok() {
                self.try_case(case);
            }
        }
    }

    fn shorten_pose(&mut self, frame: usize, body: usize) {
        let mut unturned = self.case.clone();
        unturned.frames[frame].bodies.rotation[body] = [0.0, 0.0, 0.0, 1.0];
        if refit(&mut unturned, frame).is_none() || !self.try_case(unturned) {
            for n in 0..4 {
                let turn = self.case.frames[frame].bodies.rotation[body][n];
                self.shorten(frame, turn, &|frame, x| {
                    frame.bodies.rotation[body][n] = x;
                });
            }
        }
        for n in 0..3 {
            let place = self.case.frames[frame].bodies.translation[body][n];
            self.shorten(frame, place, &|frame, x| {
                frame.bodies.translation[body][n] = x;
            });
        }
    }

    /// The poses of a body's parts. Other frames have the same parts, unless the set changes.
    fn shorten_parts(&mut self, frame: usize, body: usize) {
        let parts = self.case.frames[0].parts.as_ref();
        let parts = parts.filter(|_| self.case.frames.len() == 1);
        let parts = parts.map_or(Vec::new(), |parts| parts[body].clone());
        for (part, n) in (0..7 * parts.len()).map(|at| (at / 7, at % 7)) {
            self.shorten(frame, parts[part].pose[n], &|frame, x| {
                if let Some(parts) = &mut frame.parts {
                    parts[body][part].pose[n] = x;
                }
            });
        }
    }

    /// Sets one number of a frame to the shortest form with which the pair is still missed.
    fn shorten(&mut self, frame: usize, full: f32, set: &dyn Fn(&mut Frame, f32)) {
        let mut case = self.case.clone();
        for digits in [0, 2, 4, 8, 12, 16, 20] {
            let short = rounded(full, digits);
            if short == full {
                return;
            }
            set(&mut case.frames[frame], short);
            let side = |ends: &[f32; 6], axis: usize| ends[axis + 3] - ends[axis];
            let is_long = |(ends, former): (&[f32; 6], &[f32; 6])| {
                (0..3).all(|axis| side(ends, axis) >= side(former, axis).min(1.0))
            };
            let rotations = &case.frames[frame].bodies.rotation;
            let mut boxes = case.frames[frame].boxes.iter().zip(&self.case.frames[frame].boxes);
            let mut sound = rotations.iter().all(|q| *q != [0.0; 4])
                && (!self.case.claim.is_of_boxes() || boxes.all(is_long));
            sound &= case.frames[frame].check_periods().is_ok();
            if !self.case.claim.is_of_boxes() && sound {
                sound = refit(&mut case, frame).is_some();
            }
            if sound && self.try_case(case.clone()) {
                return;
            }
        }
    }
}

/// A number with this number of binary digits; 0 digits give zero.
fn rounded(x: f32, digits: u32) -> f32 {
    match digits {
        0 => 0.0,
        _ => {
            // 24 digits in all, the first is implied; a carry goes into the exponent, as it should.
            let cut = 24 - digits;
            let half = 1_u32 << (cut - 1);
            let bits = x.to_bits();
            let rounded = f32::from_bits((bits.saturating_add(half)) & !((1 << cut) - 1));
            if rounded.is_finite() { rounded } else { x }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn rounded_numbers_keep_their_size() {
        assert_eq!(rounded(1.999_999_9, 2), 2.0);
        assert_eq!(rounded(-0.3, 0), 0.0);
        assert_eq!(rounded(1.3, 4), 1.25);
        assert_eq!(rounded(-1.3, 4), -1.25);
        assert_eq!(rounded(f32::MAX, 4), f32::MAX);
    }
}
