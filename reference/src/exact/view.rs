//! Two posed meshes in the frame of the first, at each stage of the cascade.

use std::cell::OnceCell;

use dashu_int::IBig;

use super::mesh::Mesh;
use super::orientation::{Bounded, Known, Triangle};
use super::relative::{Approximate, Relative};
use super::triangle;
use super::{Decision, Interval, cascade};
use crate::linear::Vector;
use crate::number::{Number, unit_of};
use crate::pose::Pose;

/// A mesh and where it is.
pub type Posed<'a> = (&'a Mesh, &'a Pose);

/// A in its own frame, with B mapped into it. Intervals and integers are computed only when needed.
pub struct View<'a> {
    /// Body A's mesh.
    pub a: &'a Mesh,
    /// Body B's mesh.
    pub b: &'a Mesh,
    /// B → A in f64.
    pub map: Approximate,
    /// Bound on the error of B's mapped coordinates.
    pub error: f64,
    poses: [Pose; 2],
    unit: i32,
    intervals: OnceCell<Relative<Interval>>,
    integers: OnceCell<Relative<IBig>>,
}

impl<'a> View<'a> {
    /// B as A sees it.
    pub fn new(a: Posed<'a>, b: Posed<'a>) -> Self {
        let map = Approximate::between(a.1, b.1);
        let unit =
            |(mesh, pose): Posed| mesh.unit.min(mesh.ray_unit()).min(unit_of(pose.translation()));
        Self {
            a: a.0,
            b: b.0,
            error: map.error(b.0.reach),
            map,
            poses: [*a.1, *b.1],
            unit: unit(a).min(unit(b)),
            intervals: OnceCell::new(),
            integers: OnceCell::new(),
        }
    }

    fn intervals(&self) -> &Relative<Interval> {
        self.intervals.get_or_init(|| Relative::between(&self.poses[0], &self.poses[1], self.unit))
    }

    fn integers(&self) -> &Relative<IBig> {
        self.integers.get_or_init(|| Relative::between(&self.poses[0], &self.poses[1], self.unit))
    }

    /// Whether triangle `a` of A meets triangle `b` of B, whose mapped corners are `mapped`.
    pub fn triangles_meet(&self, a: u32, b: u32, mapped: &Triangle<Vector<f64>>) -> Decision<bool> {
        let rounded = [&self.a.triangles[a as usize], mapped];
        let (interval, exact) =
            (|| self.corners(self.intervals(), a, b), || self.corners(self.integers(), a, b));
        triangle::meet(rounded, self.error, interval, exact)
    }

    /// Both triangles' corners at a stage, as A sees them, times its scale.
    fn corners<N: Number>(&self, map: &Relative<N>, a: u32, b: u32) -> [Triangle<Vector<N>>; 2] {
        let (a, b) = (&self.a.triangles[a as usize], &self.b.triangles[b as usize]);
        [a.each_ref().map(|p| map.own(p, self.unit)), b.each_ref().map(|p| map.seen(p, self.unit))]
    }

    /// Whether the segment from a point of B's frame, mapped to `mapped`, to a point of A's frame
    /// crosses triangle `t` of A. `None` when it touches an edge or a corner or lies in the plane:
    /// another segment may tell.
    pub fn crosses(
        &self,
        from: &Vector<f64>,
        mapped: &Vector<f64>,
        to: &Vector<f64>,
        t: u32,
    ) -> Decision<Option<bool>> {
        let t = &self.a.triangles[t as usize];
        cascade(
            || {
                let sides = Bounded::new(&t[0], t.iter().chain([mapped, to]), self.error);
                triangle::crossing(&sides, [mapped, to], t)
            },
            || self.crosses_at(self.intervals(), [from, to], t),
            || self.crosses_at(self.integers(), [from, to], t),
        )
    }

    fn crosses_at<N: Number>(
        &self,
        map: &Relative<N>,
        [from, to]: [&Vector<f64>; 2],
        t: &Triangle<Vector<f64>>,
    ) -> Option<Option<bool>> {
        let segment = [&map.seen(from, self.unit), &map.own(to, self.unit)];
        triangle::crossing(&Known::stage(), segment, &t.each_ref().map(|p| map.own(p, self.unit)))
    }
}
