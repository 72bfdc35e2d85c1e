//! The parts of a shape number, and the parts of a body at its pose.

use super::Part;
use crate::bodies::{Body, UNTURNED};
use crate::posed::{PosedShape, QueryShape};
use crate::rounding::compose::{TURN_ERROR, product};
use crate::rounding::narrow::turn_error;
use crate::rounding::pose::{rotate_of, rotation};
use crate::rounding::query::{is_beyond, largest, slack};
use crate::update::offset::{compose, reach_about_pose};
use crate::volume::Shape;

/// The parts of a shape number: those of a compound, or a shape alone.
#[derive(Clone, Debug)]
pub(super) struct PartSet {
    shapes: Vec<QueryShape>,
    parts: Vec<Part>,
    /// The ball about each part, in the frame of the body.
    balls: Vec<([f64; 3], f64)>,
    /// No point of a ball is farther from the body's origin.
    reach: f64,
}

impl PartSet {
    pub fn new(shapes: &[Shape], parts: &[Part]) -> Self {
        Self::of(shapes.iter().map(QueryShape::new).collect(), parts.to_vec())
    }

    /// A shape that is not a compound: one part, where the body is.
    pub fn alone(shape: QueryShape) -> Self {
        Self::of(vec![shape], vec![Part::default()])
    }

    fn of(shapes: Vec<QueryShape>, parts: Vec<Part>) -> Self {
        let ball = |part: &Part| {
            let (centre, radius) = shapes[part.shape as usize].ball();
            let (centre, error) = compose(part.rotation, part.translation, centre);
            let turned = turn_error(part.rounded, shapes[part.shape as usize].radius_about_pose());
            (centre, radius + 2.0 * error + turned) // twice, for the sum in `ball`
        };
        let balls: Vec<_> = parts.iter().map(ball).collect();
        let reach = balls.iter().map(|(c, radius)| 2.0 * largest(*c) + radius);
        Self { reach: reach.fold(0.0, f64::max), shapes, parts, balls }
    }

    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// A part at the pose of its body.
    fn posed(&self, body: &Body, number: u32) -> PosedShape<'_> {
        let part = &self.parts[number as usize];
        let shape = &self.shapes[part.shape as usize];
        let (turn, product_error) = if part.rotation == UNTURNED {
            (body.rotation, 0.0)
        } else {
            let error = TURN_ERROR * shape.radius_about_pose();
            (product(body.rotation, part.rotation), error)
        };
        let (place, error) = compose(body.rotation, body.translation, part.translation);
        let reach = shape.radius_about_pose();
        let about_body = reach_about_pose(reach, part.translation);
        let rounded = turn_error(part.rounded, reach) + turn_error(body.rounded, about_body);
        shape.as_part((turn, place), body.margin, error + product_error + rounded)
    }
}

/// A body whose parts are tested against those of another.
#[derive(Debug)]
pub(super) struct PosedParts<'a> {
    set: &'a PartSet,
    body: Body,
    /// The balls of all parts, as seen from a point near the body, and a box about these.
    balls: Vec<([f64; 3], f64)>,
    bounds: Bounds,
    near: Vec<NearPart<'a>>,
}

/// A part that is near another body.
#[derive(Debug)]
struct NearPart<'a> {
    number: u32,
    centre: [f64; 3],
    radius: f64,
    /// Once it was needed.
    posed: Option<PosedShape<'a>>,
}

/// A box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    lo: [f64; 3],
    hi: [f64; 3],
}

impl Bounds {
    const EMPTY: Self = Self { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3] };

    #[inline(always)]
    fn add_ball(&mut self, centre: [f64; 3], radius: f64) {
        for (axis, at) in centre.into_iter().enumerate() {
            self.lo[axis] = self.lo[axis].min(at - radius);
            self.hi[axis] = self.hi[axis].max(at + radius);
        }
    }

    #[inline(always)]
    fn has_ball(&self, centre: [f64; 3], radius: f64) -> bool {
        let mut meets = true;
        for (axis, at) in centre.into_iter().enumerate() {
            meets &= at + radius >= self.lo[axis];
            meets &= at - radius <= self.hi[axis];
        }
        meets
    }

    fn common(&self, other: &Self) -> Self {
        Self {
            lo: [0, 1, 2].map(|axis| self.lo[axis].max(other.lo[axis])),
            hi: [0, 1, 2].map(|axis| self.hi[axis].min(other.hi[axis])),
        }
    }
}

impl<'a> PosedParts<'a> {
    /// The parts of a body with balls as seen from `origin`.
    pub fn new(set: &'a PartSet, body: Body, origin: [f64; 3]) -> Self {
        let mut parts =
            Self { set, body, balls: Vec::new(), bounds: Bounds::EMPTY, near: Vec::new() };
        parts.place(origin);
        parts
    }

    /// The same memory for another body.
    pub fn reset(&mut self, set: &'a PartSet, body: Body, origin: [f64; 3]) {
        (self.set, self.body) = (set, body);
        self.place(origin);
    }

    /// Places the balls. They contain the parts with their margins as seen from `origin` exactly:
    /// a computed centre is within 64·2⁻⁵³ of the sum of its terms, and radii are widened by
    /// 256·2⁻⁵³ of all sizes ([`slack`]).
    fn place(&mut self, origin: [f64; 3]) {
        let turn = rotation(self.body.rotation);
        let apart = [0, 1, 2].map(|axis| self.body.translation[axis] - origin[axis]);
        let rounded = turn_error(self.body.rounded, self.set.reach);
        let margin = f64::from(self.body.margin) + rounded;
        let out = margin + slack(self.set.reach + margin + largest(apart));
        let mut bounds = Bounds::EMPTY;
        self.balls.clear();
        self.balls.extend(self.set.balls.iter().map(|&(centre, radius)| {
            let turned = rotate_of(&turn, centre);
            let centre = [0, 1, 2].map(|axis| turned[axis] + apart[axis]);
            bounds.add_ball(centre, radius + out);
            (centre, radius + out)
        }));
        self.bounds = bounds;
    }

    /// Lists the parts whose balls meet a box.
    fn list_near(&mut self, common: &Bounds) {
        self.near.clear();
        let near = (0..).zip(&self.balls);
        let near = near.filter(|(_, (centre, radius))| common.has_ball(*centre, *radius));
        self.near.extend(near.map(|(number, &(centre, radius))| NearPart {
            number,
            centre,
            radius,
            posed: None,
        }));
    }

    /// Calls `take` with each pair of parts of two bodies that may touch, sorted. The balls of both
    /// are seen from the same point.
    pub fn each_pair(&mut self, other: &mut Self, mut take: impl FnMut([u32; 2])) {
        let common = self.bounds.common(&other.bounds);
        self.list_near(&common);
        if self.near.is_empty() {
            return;
        }
        other.list_near(&common);
        for a in &mut self.near {
            for b in &mut other.near {
                if is_beyond(a.centre, a.radius + b.radius, b.centre, b.centre) {
                    continue;
                }
                let one = a.posed.get_or_insert_with(|| self.set.posed(&self.body, a.number));
                let two = b.posed.get_or_insert_with(|| other.set.posed(&other.body, b.number));
                if one.may_touch(two) {
                    take([a.number, b.number]);
                }
            }
        }
    }
}
