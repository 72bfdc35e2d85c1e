//! Segments and rays against an index: all bodies along them, and the first.

use super::answers::Answers;
use super::index::{QueryIndex, SolidBody, TREES};
use super::tree::{BOXES_PER_GROUP, BoxGroup, LaneContent, MOST_WAITING, Node, lanes_of};
use super::volume::{Line, QueryError};
use crate::bodies::LineTrack;
use crate::living::BodyId;
use crate::rounding::query::{ALL, Course, earlier, later};
use crate::simd::{Kernel, Lanes, dispatch, in_default_mode};

/// A body that a line may meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineHit {
    /// The body.
    pub body: BodyId,
    /// A parameter at or before the first point that the line shares with the body.
    pub at: f64,
}

impl LineHit {
    /// Whether this one comes before another along the line. At equal parameters the lower slot
    /// comes first.
    fn is_before(&self, other: &Self) -> bool {
        (self.at, self.body) < (other.at, other.body)
    }
}

/// The direction of a line along each axis.
#[derive(Clone, Copy, Debug)]
struct LineCourses {
    axes: [Course; 3],
    limit: f64,
}

impl LineCourses {
    fn new(track: &LineTrack, origin: [f64; 3]) -> Self {
        let axes =
            [0, 1, 2].map(|axis| Course::new(track.from[axis] - origin[axis], track.speed[axis]));
        let limit = track.limit;
        Self { axes, limit }
    }

    /// The lanes of a group that the line may meet up to `limit`, and the parameters at which it
    /// enters their boxes.
    #[inline(always)]
    fn meeting(&self, group: &BoxGroup, limit: f64) -> (u32, [f64; BOXES_PER_GROUP]) {
        let mut first = [-ALL; BOXES_PER_GROUP];
        let mut last = [ALL; BOXES_PER_GROUP];
        for axis in 0..3 {
            let (course, lo, hi) = (self.axes[axis], &group.lo[axis], &group.hi[axis]);
            let [near, far] = if course.is_falling() { [hi, lo] } else { [lo, hi] };
            for lane in 0..BOXES_PER_GROUP {
                let [enters, leaves] = course.between([near[lane], far[lane]].map(f64::from));
                first[lane] = larger(enters, first[lane]);
                last[lane] = smaller(leaves, last[lane]);
            }
        }
        let mut meeting = 0;
        for lane in 0..BOXES_PER_GROUP {
            first[lane] = larger(earlier(first[lane]), 0.0);
            let is_met = first[lane] <= smaller(later(last[lane]), limit);
            meeting |= u32::from(is_met) << lane;
        }
        (meeting & group.present, first)
    }
}

/// The larger of two numbers, as one instruction.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller of two numbers, as one instruction.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl QueryIndex {
    /// The bodies that a line may meet, sorted by parameter, and by slot at equal parameters.
    ///
    /// # Errors
    /// A line outside of the contract ([`Line`]), or an index that was never updated.
    pub fn along(&self, line: &Line) -> Result<Vec<LineHit>, QueryError> {
        self.check_updated()?;
        line.check(0)?;
        let mut found = Vec::new();
        in_default_mode(|| self.follow(line, &mut found));
        Ok(found)
    }

    /// [`Self::along`] for many lines, on all threads.
    ///
    /// # Errors
    /// As [`Self::along`], for the first such line.
    pub fn along_all(&self, lines: &[Line]) -> Result<Answers<LineHit>, QueryError> {
        self.check_updated()?;
        for (query, line) in lines.iter().enumerate() {
            line.check(query)?;
        }
        self.each_of(lines, |line, found| self.follow(line, found))
    }

    /// The body whose volume a line may meet first: no body is met at a parameter below its `at`.
    /// Volumes are larger than meshes; if that matters, use [`Self::first_judged`].
    ///
    /// # Errors
    /// As [`Self::along`].
    pub fn first(&self, line: &Line) -> Result<Option<LineHit>, QueryError> {
        self.first_judged(line, |hit| Some(hit.at))
    }

    /// [`Self::first`] for many lines, on all threads. An answer has one entry, or is empty.
    ///
    /// # Errors
    /// As [`Self::along_all`].
    pub fn first_all(&self, lines: &[Line]) -> Result<Answers<LineHit>, QueryError> {
        self.check_updated()?;
        for (query, line) in lines.iter().enumerate() {
            line.check(query)?;
        }
        self.each_of(lines, |line, found| {
            found.extend(self.find_first(line, |hit| Some(hit.at)));
        })
    }

    /// The first body along a line, judged exactly by the caller: `judge` returns the parameter at
    /// which the line meets a body's mesh, or `None` if it misses. It is called for bodies that the
    /// line may meet before the nearest hit known so far, in about the order of their boxes, and
    /// for every body that could be first. At equal parameters the lowest slot wins.
    ///
    /// # Errors
    /// As [`Self::along`].
    pub fn first_judged(
        &self,
        line: &Line,
        judge: impl FnMut(LineHit) -> Option<f64>,
    ) -> Result<Option<LineHit>, QueryError> {
        self.check_updated()?;
        line.check(0)?;
        Ok(in_default_mode(|| self.find_first(line, judge)))
    }

    fn follow(&self, line: &Line, found: &mut Vec<LineHit>) {
        let start = found.len();
        self.walk(line, |hit, limit| {
            found.push(hit);
            limit
        });
        found[start..]
            .sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then_with(|| a.body.cmp(&b.body)));
    }

    fn find_first(
        &self,
        line: &Line,
        mut judge: impl FnMut(LineHit) -> Option<f64>,
    ) -> Option<LineHit> {
        let mut best: Option<LineHit> = None;
        self.walk(line, |hit, limit| {
            let judged = judge(hit).filter(|at| *at <= limit);
            let judged = judged.map(|at| LineHit { at, ..hit });
            if let Some(judged) = judged
                && best.is_none_or(|best| judged.is_before(&best))
            {
                best = Some(judged);
            }
            best.map_or(limit, |best| best.at)
        });
        best
    }

    /// Calls `take` with each body that a line may meet up to the limit, nearer boxes first. `take`
    /// returns the new limit.
    fn walk(&self, line: &Line, take: impl FnMut(LineHit, f64) -> f64) {
        let track = line.track();
        let walk =
            LineSearch { index: self, courses: LineCourses::new(&track, self.origin), track, take };
        dispatch(self.tier, walk);
    }
}

/// A group that is still to be searched.
#[derive(Clone, Copy)]
struct WaitingGroup {
    enters: f64,
    tree: usize,
    node: Node,
}

struct LineSearch<'a, T> {
    index: &'a QueryIndex,
    courses: LineCourses,
    track: LineTrack,
    take: T,
}

impl<T: FnMut(LineHit, f64) -> f64> Kernel for LineSearch<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self, _: L) {
        let nothing = WaitingGroup { enters: 0.0, tree: 0, node: Node::default() };
        let mut waiting = [nothing; MOST_WAITING + TREES];
        let mut count = 0;
        for tree in (0..TREES).rev() {
            if let Some(node) = self.index.trees[tree].top() {
                waiting[count] = WaitingGroup { enters: 0.0, tree, node };
                count += 1;
            }
        }
        let mut limit = self.courses.limit;
        while count > 0 {
            count -= 1;
            let WaitingGroup { enters, tree, node } = waiting[count];
            if enters > limit {
                continue;
            }
            let (meeting, first) = self.courses.meeting(self.index.trees[tree].group(node), limit);
            let start = count;
            for lane in lanes_of(meeting) {
                match node.below(lane) {
                    LaneContent::Place(place) => self.meet(tree, place, first[lane], &mut limit),
                    LaneContent::Node(node) => {
                        waiting[count] = WaitingGroup { enters: first[lane], tree, node };
                        count += 1;
                    }
                }
            }
            waiting[start..count].sort_unstable_by(|a, b| b.enters.total_cmp(&a.enters));
        }
    }
}

impl<T: FnMut(LineHit, f64) -> f64> LineSearch<'_, T> {
    /// Tests the body in a place, whose box the line enters at `enters`.
    #[inline(always)]
    fn meet(&mut self, tree: usize, place: usize, enters: f64, limit: &mut f64) {
        if enters > *limit {
            return;
        }
        let at = match self.index.solid(tree, place) {
            SolidBody::Box(_) => Some(enters),
            // A body is not met before its box is. Without that, whether a body is reached before
            // the limit would depend on the order in which boxes are searched.
            SolidBody::Shape(body) => body.crossed_by(&self.track).map(|at| larger(at, enters)),
        };
        if let Some(at) = at.filter(|at| at <= limit) {
            let body = self.index.id_at(tree, place);
            *limit = (self.take)(LineHit { body, at }, *limit);
        }
    }
}
