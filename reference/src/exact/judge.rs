//! Judges whole scenes exactly: the pairs of each strategy, and the pairs whose meshes intersect.

use std::cell::{Cell, OnceCell};

use super::meeting::{self, Meeting};
use super::world::{self, Extents};
use super::{Decision, Tally, ordop, sphere};
use crate::broad_phase::all_pairs;
use crate::linear::largest;
use crate::overlap::Overlap;
use crate::pose::separation;
use crate::shape::Body;
use crate::strategy::{OverlapTests, Strategy, run};
use crate::volume::DirectionSet;

/// The pairs i < j that the strategy reports, sorted, decided exactly, and by which stage.
pub fn pairs(bodies: &[Body], strategy: Strategy, overlap: Overlap) -> (Vec<(u32, u32)>, Tally) {
    let dynamic: Vec<bool> = bodies.iter().map(|body| body.dynamic).collect();
    let judge = Exact::new(bodies, overlap);
    let (pairs, _) = run(&judge, &dynamic, strategy);
    (pairs, judge.tally())
}

/// The exact formulas over one frame of bodies.
pub struct Exact<'a> {
    bodies: &'a [Body<'a>],
    overlap: Overlap,
    extents: [Vec<OnceCell<Extents<'a>>>; 4],
    tally: Cell<Tally>,
}

impl<'a> Exact<'a> {
    /// A judge of these bodies whose or-DOPs are compared by `overlap`.
    pub fn new(bodies: &'a [Body<'a>], overlap: Overlap) -> Self {
        let extents = std::array::from_fn(|_| bodies.iter().map(|_| OnceCell::new()).collect());
        Self { bodies, overlap, extents, tally: Cell::default() }
    }

    /// What was decided so far.
    pub fn tally(&self) -> Tally {
        self.tally.get()
    }

    fn extents(&self, i: u32, directions: DirectionSet) -> &Extents<'a> {
        let body = &self.bodies[i as usize];
        self.extents[directions as usize][i as usize].get_or_init(|| Extents::new(body, directions))
    }

    fn pair(&self, i: u32, j: u32) -> (&Body<'a>, &Body<'a>) {
        (&self.bodies[i as usize], &self.bodies[j as usize])
    }

    fn note(&self, decision: Decision<bool>) -> bool {
        let mut tally = self.tally.get();
        tally.count(decision.path);
        self.tally.set(tally);
        decision.value
    }
}

impl OverlapTests for Exact<'_> {
    fn spheres(&self, i: u32, j: u32) -> bool {
        let (a, b) = self.pair(i, j);
        self.note(sphere::overlap(a, b))
    }

    fn ordops(&self, i: u32, j: u32) -> bool {
        let (a, b) = self.pair(i, j);
        self.note(ordop::overlap(a, b, self.overlap))
    }

    fn world_kdops(&self, i: u32, j: u32, directions: DirectionSet) -> bool {
        self.note(world::overlap_extents(self.extents(i, directions), self.extents(j, directions)))
    }

    fn obbs(&self, i: u32, j: u32) -> bool {
        let (a, b) = self.pair(i, j);
        self.note(ordop::overlap_obb(a, b))
    }
}

/// The pairs i < j, not both static, whose meshes intersect, sorted; with the meetings that were
/// looked at closely.
pub fn meeting_pairs(bodies: &[Body]) -> (Vec<(u32, u32)>, MeetingTally) {
    let dynamic: Vec<bool> = bodies.iter().map(|body| body.dynamic).collect();
    let mut tally = MeetingTally::default();
    let pairs = all_pairs(&dynamic).filter(|&(i, j)| {
        let (a, b) = (&bodies[i as usize], &bodies[j as usize]);
        near(a, b) && tally.note(meeting::overlap(a, b))
    });
    (pairs.collect(), tally)
}

/// Mesh pairs judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeetingTally {
    /// Mesh pairs whose reaches overlap, by the deepest stage that each needed.
    pub meshes: Tally,
    /// Triangle pairs and ray crossings.
    pub triangles: Tally,
}

impl MeetingTally {
    fn note(&mut self, meeting: Meeting) -> bool {
        self.meshes.count(meeting.path);
        self.triangles.add(&meeting.tally);
        meeting.meets
    }
}

/// Can the meshes meet at all? Not when the origins are further apart, on some axis, than both
/// reaches; the factor 2 over √3 and the ulps leaves no doubt.
fn near(a: &Body, b: &Body) -> bool {
    let reach = a.shape.mesh().reach + b.shape.mesh().reach;
    largest(&separation(&a.pose, &b.pose)) <= 2.0 * reach
}
