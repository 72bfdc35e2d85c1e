//! Posed bodies as queries see them: their slabs and ball, in f64, in the body's own frame.
//!
//! Supports are bounded from the slabs alone, by the multipliers of `overlap/ordop/support.rs`
//! (lemma L7), here for one direction at a time and about the body's origin.

use crate::bodies::contract::{ContractError, check_pose};
use crate::bodies::{Aabb, Body, LineTrack};
use crate::rounding::narrow::turn_error;
use crate::rounding::pose::{self, Rotation, rotate_of};
use crate::rounding::query::{
    Course, STILL, crossing, into_body, is_beyond, largest, slack, turn_back,
};
use crate::rounding::{down, up};
use crate::update::ShapeFrame;
use crate::update::offset::{compose, reach_about_pose};
use crate::volume::{DirectionSet, OrDop, Shape};

/// The volumes of a shape.
#[derive(Clone, Copy)]
pub(crate) struct ShapeVolumes<'a> {
    pub ordop: &'a OrDop,
    /// Where or-DOPs are tested alone, its radius is that by which a finder bins them.
    pub frame: &'a ShapeFrame,
    /// The radius of the ball about the shape.
    pub radius: f64,
    /// The position of the vertices' origin relative to the point that poses place.
    pub pose_offset: [f64; 3],
    /// No other shape of any world has it, except in a world's clones.
    pub stamp: u64,
}

/// A shape prepared for queries: its ball and its or-DOP, computed once.
#[derive(Clone, Debug, PartialEq)]
pub struct QueryShape {
    ordop: OrDop,
    /// The slabs' directions, and their lengths.
    directions: Vec<([f64; 3], f64)>,
    /// The end that faces each sum of basis vectors; infinite if no slab does.
    ends: [f64; 27],
    /// One over the squared length of a basis vector.
    over_square: f64,
    centre: [f64; 3],
    radius: f64,
    /// No point is farther from the origin of the vertices.
    reach: f64,
    /// The position of that origin relative to the point that poses place.
    pose_offset: [f64; 3],
    /// That of the world's shape of which it is a copy.
    stamp: u64,
}

impl QueryShape {
    /// Prepares a shape. Its pose and margin are given in each query.
    #[must_use]
    pub fn new(shape: &Shape) -> Self {
        let frame = ShapeFrame::new(shape, &shape.ordop.basis);
        Self::of(ShapeVolumes {
            ordop: &shape.ordop,
            frame: &frame,
            radius: shape.ball.radius.into(),
            pose_offset: shape.pose_offset,
            stamp: 0,
        })
    }

    pub(crate) fn of(volumes: ShapeVolumes<'_>) -> Self {
        let ShapeVolumes { ordop, frame, .. } = volumes;
        let norm = ordop.basis.norm();
        let direction = |&coefficients: &[i8; 3]| {
            let nonzero = coefficients.iter().filter(|&&c| c != 0).count();
            let direction = ordop.basis.direction(coefficients).map(f64::from);
            (direction, norm * (nonzero as f64).sqrt())
        };
        let coefficients = ordop.directions.coefficients();
        let mut ends = [f64::INFINITY; 27];
        for (&facing, (&lo, &hi)) in coefficients.iter().zip(ordop.lo.iter().zip(&ordop.hi)) {
            ends[index_of(facing)] = hi.into();
            ends[index_of(facing.map(|c| -c))] = -f64::from(lo);
        }
        Self {
            directions: coefficients.iter().map(direction).collect(),
            ends,
            over_square: 1.0 / (norm * norm),
            centre: frame.centre().map(f64::from),
            radius: volumes.radius,
            reach: frame.reach().into(),
            pose_offset: volumes.pose_offset,
            stamp: volumes.stamp,
            ordop: ordop.clone(),
        }
    }

    /// Whether it was made from these volumes.
    pub(crate) fn is_of(&self, volumes: ShapeVolumes<'_>) -> bool {
        self.stamp == volumes.stamp
    }

    /// No point is farther from the origin of the vertices.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    pub(crate) fn check_pose(
        &self,
        query: usize,
        rotation: [f32; 4],
        translation: [f64; 3],
    ) -> Result<(), ContractError> {
        check_pose(query, &rotation, &translation)
    }

    /// This shape at a pose, grown by a margin.
    pub(crate) fn at(
        &self,
        rotation: [f32; 4],
        translation: [f64; 3],
        margin: f32,
    ) -> PosedShape<'_> {
        let (translation, error) = compose(rotation, translation, self.pose_offset);
        PosedShape {
            shape: self,
            rotation: pose::rotation(rotation),
            translation,
            margin: f64::from(margin) + error,
        }
    }

    /// This shape as a part of a body: its margin is that of the body, plus the distance that
    /// composed poses are off.
    pub(crate) fn as_part(
        &self,
        (rotation, translation): ([f32; 4], [f64; 3]),
        margin: f32,
        error: f64,
    ) -> PosedShape<'_> {
        let posed = self.at(rotation, translation, margin);
        PosedShape { margin: posed.margin + error, ..posed }
    }

    /// The ball about it, as seen from the point that poses place.
    pub(crate) fn ball(&self) -> ([f64; 3], f64) {
        let centre = [0, 1, 2].map(|axis| self.centre[axis] + self.pose_offset[axis]);
        (centre, self.radius)
    }

    /// This shape as that of a body, grown by its margin and by what the rounding of its rotation
    /// moves.
    pub(crate) fn of_body(&self, body: &Body) -> PosedShape<'_> {
        let error = turn_error(body.rounded, self.radius_about_pose());
        self.as_part((body.rotation, body.translation), body.margin, error)
    }

    /// A bound on the distance of the shape's points from the point that poses place.
    pub(crate) fn radius_about_pose(&self) -> f64 {
        reach_about_pose(self.reach, self.pose_offset)
    }

    /// No less than e·x for each point x.
    fn support(&self, e: [f64; 3]) -> f64 {
        let columns = self.ordop.basis.columns;
        let along = columns.map(|b| {
            let [x, y, z] = b.map(f64::from);
            (e[0] * x + e[1] * y + e[2] * z) * self.over_square
        });
        let sign = along.map(|x| if x < 0.0 { -1 } else { 1_i8 });
        let size = along.map(f64::abs);
        // The axes from the largest size to the smallest.
        let mut order = [0, 1, 2];
        order.sort_unstable_by(|&a, &b| size[b].total_cmp(&size[a]));
        let [high, median, low] = order.map(|axis| size[axis]);
        let [a, b, c] = order;
        // The part of a multiplier of the end that faces the sum of some axes, each with its sign.
        let part = |multiplier: f64, axes: &[usize]| {
            let mut facing = [0; 3];
            axes.iter().for_each(|&axis| facing[axis] = sign[axis]);
            self.part(multiplier, facing)
        };
        match self.ordop.directions {
            DirectionSet::K6 => part(high, &[a]) + part(median, &[b]) + part(low, &[c]),
            DirectionSet::K14 => {
                let mut bent = sign;
                bent[c] = -bent[c];
                let straight = part(0.5 * (median + low), &[a, b, c]);
                straight + self.part(0.5 * (median - low), bent) + part(high - median, &[a])
            }
            DirectionSet::K18 if high > median + low => {
                let excess = ((high - median) - low).max(0.0);
                part(low, &[a, c]) + part(median, &[a, b]) + part(excess, &[a])
            }
            DirectionSet::K18 => {
                part(0.5 * ((high - low) + median), &[a, b])
                    + part(0.5 * ((high - median) + low), &[a, c])
                    + part((0.5 * ((median - high) + low)).max(0.0), &[b, c])
            }
            DirectionSet::K26 => {
                part(low, &[a, b, c]) + part(median - low, &[a, b]) + part(high - median, &[a])
            }
        }
    }

    /// The part that a multiplier of a sum of basis vectors adds to a support.
    fn part(&self, multiplier: f64, facing: [i8; 3]) -> f64 {
        if multiplier == 0.0 {
            return 0.0; // no slab may face there
        }
        multiplier * self.ends[index_of(facing)]
    }
}

/// The index of the end that faces a sum of basis vectors.
fn index_of(facing: [i8; 3]) -> usize {
    facing.iter().fold(0, |index, c| 3 * index + (c + 1) as usize)
}

/// Shapes and poses of bodies that are not boxes.
#[derive(Clone, Debug, Default)]
pub(crate) struct PosedBodies {
    /// The shapes by the numbers that bodies use.
    pub shapes: Vec<Option<QueryShape>>,
    /// The bodies by slot.
    pub bodies: Vec<Body>,
}

impl PosedBodies {
    /// Removes the bodies of all rows from number `rows` on.
    pub fn shorten(&mut self, rows: usize) {
        self.bodies.truncate(rows);
        if self.bodies.capacity() > 4 * rows {
            self.bodies.shrink_to(2 * rows);
        }
    }

    /// The body in a slot.
    #[inline(always)]
    pub fn at(&self, slot: usize) -> Option<PosedShape<'_>> {
        let body = &self.bodies[slot];
        let shape = self.shapes[body.shape as usize].as_ref()?;
        Some(shape.of_body(body))
    }
}

/// A body at its pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PosedShape<'a> {
    pub shape: &'a QueryShape,
    pub rotation: Rotation,
    /// The translation of the vertices' origin.
    pub translation: [f64; 3],
    /// The margin, plus the error of the translation.
    pub margin: f64,
}

impl PosedShape<'_> {
    /// The largest distance of a point from the translation.
    fn size(&self) -> f64 {
        self.shape.reach + self.margin
    }

    /// The slabs: their directions with their lengths, and ends.
    fn slabs(&self) -> impl Iterator<Item = ([f64; 3], f64, [f64; 2])> {
        let ends = self.shape.ordop.lo.iter().zip(&self.shape.ordop.hi);
        let slabs = self.shape.directions.iter().zip(ends);
        slabs.map(|(&(direction, length), (&lo, &hi))| {
            (direction, length, [f64::from(lo), f64::from(hi)])
        })
    }

    /// A box about it, seen from `origin`.
    pub fn bounds(&self, origin: [f64; 3]) -> Aabb {
        let (centre, size) = (rotate_of(&self.rotation, self.shape.centre), self.size());
        let out = self.margin + slack(size + largest(self.translation));
        let ball = self.shape.radius + out;
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let direction = self.rotation[axis];
            let above = self.shape.support(direction) + out;
            let below = self.shape.support(direction.map(|x| -x)) + out;
            let at = self.translation[axis] - origin[axis];
            min[axis] = down(at + (-below).max(centre[axis] - ball));
            max[axis] = up(at + above.min(centre[axis] + ball));
        }
        Aabb { min, max }
    }

    /// Whether a ball may touch it.
    pub fn may_touch_ball(&self, centre: [f64; 3], radius: f64) -> bool {
        let (seen, far) = into_body(&self.rotation, centre, self.translation);
        let out = self.margin + radius;
        let out = out + slack(far + self.size() + radius);
        let c = self.shape.centre;
        !is_beyond(seen, self.shape.radius + out, c, c)
            && self.slabs().all(|(direction, length, [lo, hi])| {
                let at = dot(direction, seen);
                at <= hi + length * out && at >= lo - length * out
            })
    }

    /// Whether a box on the world's axes may touch it.
    pub fn may_touch_box(&self, lo: [f64; 3], hi: [f64; 3]) -> bool {
        let t = self.translation;
        let [from, to] = [lo, hi].map(|end| [0, 1, 2].map(|axis| end[axis] - t[axis]));
        let out = self.margin + slack(largest(from).max(largest(to)) + self.size());
        let centre = rotate_of(&self.rotation, self.shape.centre);
        !is_beyond(centre, self.shape.radius + out, from, to)
            && self.slabs().all(|(direction, length, [lo, hi])| {
                let e = rotate_of(&self.rotation, direction);
                let least = |axis: usize| (e[axis] * from[axis]).min(e[axis] * to[axis]);
                let most = |axis: usize| (e[axis] * from[axis]).max(e[axis] * to[axis]);
                let [lowest, highest] =
                    [least(0) + least(1) + least(2), most(0) + most(1) + most(2)];
                lowest <= hi + length * out && highest >= lo - length * out
            })
    }

    /// Whether another body may touch it: no slab's normal of either separates them.
    pub fn may_touch(&self, other: &PosedShape<'_>) -> bool {
        let (a, b) = (self.shape, other.shape);
        let apart = [0, 1, 2].map(|axis| other.translation[axis] - self.translation[axis]);
        let out = self.margin + other.margin;
        let out = out + slack(largest(apart) + self.size() + other.size());
        let centres =
            [(&self.rotation, a), (&other.rotation, b)].map(|(r, s)| rotate_of(r, s.centre));
        let between = [0, 1, 2].map(|axis| apart[axis] + centres[1][axis]);
        !is_beyond(between, a.radius + b.radius + out, centres[0], centres[0])
            && !self.separates(other, apart, out)
            && !other.separates(self, apart.map(|x| -x), out)
    }

    /// Whether a slab's normal separates another body, seen from this one's translation. Its ball's
    /// centre is within its own slabs, so it can only be beyond the end that is nearer to that.
    fn separates(&self, other: &PosedShape<'_>, apart: [f64; 3], out: f64) -> bool {
        let seen = turn_back(&self.rotation, apart);
        self.slabs().any(|(direction, length, [lo, hi])| {
            let at = dot(direction, seen);
            let e = turn_back(&other.rotation, rotate_of(&self.rotation, direction));
            if 2.0 * (at + dot(e, other.shape.centre)) > lo + hi {
                at - other.shape.support(e.map(|x| -x)) > hi + length * out
            } else {
                at + other.shape.support(e) < lo - length * out
            }
        })
    }

    /// A parameter no greater than any at which a line may touch it, if it may.
    pub fn crossed_by(&self, track: &LineTrack) -> Option<f64> {
        let (from, far) = into_body(&self.rotation, track.from, self.translation);
        let speed = turn_back(&self.rotation, track.speed);
        let out = self.margin + slack(far + self.size());
        let c = self.shape.centre;
        let [mut first, mut last] = [0.0, track.limit];
        let square = dot(speed, speed);
        if square > STILL {
            // The point nearest to the ball's centre, with an error below the slack.
            let towards = [0, 1, 2].map(|axis| c[axis] - from[axis]);
            let nearest = (dot(towards, speed) / square).max(0.0).min(track.limit);
            let there = [0, 1, 2].map(|axis| from[axis] + nearest * speed[axis]);
            if is_beyond(there, self.shape.radius + out, c, c) {
                return None;
            }
        }
        for (direction, length, [lo, hi]) in self.slabs() {
            let course = Course::new(dot(direction, from), dot(direction, speed));
            let out = length * out;
            let [enters, leaves] = crossing(course, [lo - out, hi + out]);
            first = f64::max(first, enters);
            last = f64::min(last, leaves);
        }
        (first <= last).then_some(first)
    }
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
