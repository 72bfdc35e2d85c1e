//! The paper's strategies (sections 4 and 5) as predicates over a pair, and all pairs of a scene.
//!
//! Strategies share one loop and differ in which volumes must overlap. [`OverlapTests`] decides
//! whether volumes overlap, by the plain f64 formulas here or by the exact ones.

use std::cell::OnceCell;

use crate::broad_phase::all_pairs;
use crate::cost::Counters;
use crate::linear::Vector;
use crate::overlap::ordop::{self, TurnedPolytope};
use crate::overlap::{Overlap, obb, sphere, world};
use crate::pose::separation;
use crate::shape::Body;
use crate::volume::DirectionSet;

/// When a pair is reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strategy<'a> {
    /// Never: the control.
    None,
    /// Spheres overlap.
    Sphere,
    /// or-DOPs overlap; no sphere stage.
    OrDop,
    /// Spheres overlap and or-DOPs overlap, each sphere hit tested at once.
    Sequential,
    /// The same pairs, from a list of the sphere hits.
    Batch,
    /// Spheres overlap and (neither body is of interest, or or-DOPs overlap). One flag per body.
    ObjectOfInterest(&'a [bool]),
    /// Spheres overlap and (untested, or or-DOPs overlap). The sphere hits tested before the budget
    /// ended, sorted.
    TimeCritical(&'a [(u32, u32)]),
    /// World-aligned boxes overlap.
    Aabb,
    /// World-aligned k-DOPs of this k overlap.
    KDop(DirectionSet),
    /// Oriented boxes overlap.
    Obb,
}

/// Decides the volume overlaps of bodies i < j of one scene.
pub trait OverlapTests {
    /// Bounding spheres.
    fn spheres(&self, i: u32, j: u32) -> bool;
    /// or-DOPs.
    fn ordops(&self, i: u32, j: u32) -> bool;
    /// World-aligned k-DOPs.
    fn world_kdops(&self, i: u32, j: u32, directions: DirectionSet) -> bool;
    /// Oriented boxes.
    fn obbs(&self, i: u32, j: u32) -> bool;
}

/// The pairs i < j that the strategy reports, sorted, judged in plain f64.
pub fn pairs(bodies: &[Body], strategy: Strategy, overlap: Overlap) -> Vec<(u32, u32)> {
    let dynamic: Vec<bool> = bodies.iter().map(|body| body.dynamic).collect();
    run(&PlainPredicates::new(bodies, overlap), &dynamic, strategy).0
}

/// The pairs i < j that the strategy reports, sorted, with what was counted.
pub fn run(
    judge: &impl OverlapTests,
    dynamic: &[bool],
    strategy: Strategy,
) -> (Vec<(u32, u32)>, Counters) {
    let mut counters = Counters::default();
    let mut reported = Vec::new();
    if strategy != Strategy::None {
        let found =
            all_pairs(dynamic).filter(|&pair| reports(judge, strategy, pair, &mut counters));
        reported.extend(found);
    }
    counters.reported = reported.len() as u64;
    (reported, counters)
}

fn reports(
    judge: &impl OverlapTests,
    strategy: Strategy,
    (i, j): (u32, u32),
    counters: &mut Counters,
) -> bool {
    match strategy {
        Strategy::None => false,
        Strategy::Sphere => spheres(judge, i, j, counters),
        Strategy::OrDop => ordops(judge, i, j, counters),
        Strategy::Sequential | Strategy::Batch => {
            spheres(judge, i, j, counters) && ordops(judge, i, j, counters)
        }
        Strategy::ObjectOfInterest(interest) => {
            let of_interest = interest[i as usize] || interest[j as usize];
            spheres(judge, i, j, counters) && (!of_interest || ordops(judge, i, j, counters))
        }
        Strategy::TimeCritical(tested) => {
            spheres(judge, i, j, counters) && {
                let untested = tested.binary_search(&(i, j)).is_err();
                counters.untested += u64::from(untested);
                untested || ordops(judge, i, j, counters)
            }
        }
        Strategy::Aabb => volumes(judge.world_kdops(i, j, DirectionSet::K6), counters),
        Strategy::KDop(directions) => volumes(judge.world_kdops(i, j, directions), counters),
        Strategy::Obb => volumes(judge.obbs(i, j), counters),
    }
}

fn spheres(judge: &impl OverlapTests, i: u32, j: u32, counters: &mut Counters) -> bool {
    let hit = judge.spheres(i, j);
    counters.sphere_tests += 1;
    counters.sphere_hits += u64::from(hit);
    hit
}

fn ordops(judge: &impl OverlapTests, i: u32, j: u32, counters: &mut Counters) -> bool {
    let hit = judge.ordops(i, j);
    counters.ordop_tests += 1;
    counters.ordop_hits += u64::from(hit);
    hit
}

fn volumes(hit: bool, counters: &mut Counters) -> bool {
    counters.volume_tests += 1;
    counters.volume_hits += u64::from(hit);
    hit
}

/// The plain f64 formulas over one frame of bodies. What a pose fixes is computed once per body,
/// when first needed.
pub struct PlainPredicates<'a> {
    bodies: &'a [Body<'a>],
    overlap: Overlap,
    ordops: Vec<OnceCell<TurnedPolytope>>,
    obbs: Vec<OnceCell<TurnedPolytope>>,
    extents: [Vec<OnceCell<Vec<[f64; 2]>>>; 4],
}

impl<'a> PlainPredicates<'a> {
    /// A judge of these bodies whose or-DOPs are compared by `overlap`.
    pub fn new(bodies: &'a [Body<'a>], overlap: Overlap) -> Self {
        let none = || vec![OnceCell::new(); bodies.len()];
        let extents = std::array::from_fn(|_| vec![OnceCell::new(); bodies.len()]);
        Self { bodies, overlap, ordops: none(), obbs: none(), extents }
    }

    fn delta(&self, i: u32, j: u32) -> Vector<f64> {
        separation(&self.bodies[i as usize].pose, &self.bodies[j as usize].pose)
    }

    fn ordop(&self, i: u32) -> &TurnedPolytope {
        let body = &self.bodies[i as usize];
        self.ordops[i as usize]
            .get_or_init(|| TurnedPolytope::new(&body.shape.polytope, &body.pose))
    }

    fn obb(&self, i: u32) -> &TurnedPolytope {
        let body = &self.bodies[i as usize];
        self.obbs[i as usize].get_or_init(|| TurnedPolytope::new(&body.shape.obb, &body.pose))
    }

    fn extents(&self, i: u32, directions: DirectionSet) -> &[[f64; 2]] {
        let body = &self.bodies[i as usize];
        self.extents[directions as usize][i as usize]
            .get_or_init(|| world::extents(body, directions))
    }
}

impl OverlapTests for PlainPredicates<'_> {
    fn spheres(&self, i: u32, j: u32) -> bool {
        sphere::overlap(&self.bodies[i as usize], &self.bodies[j as usize])
    }

    fn ordops(&self, i: u32, j: u32) -> bool {
        ordop::overlap_turned(self.ordop(i), self.ordop(j), &self.delta(i, j), self.overlap)
    }

    fn world_kdops(&self, i: u32, j: u32, directions: DirectionSet) -> bool {
        let (a, b) = (self.extents(i, directions), self.extents(j, directions));
        world::overlap_extents(a, b, &self.delta(i, j), directions)
    }

    fn obbs(&self, i: u32, j: u32) -> bool {
        obb::overlap_turned(self.obb(i), self.obb(j), &self.delta(i, j))
    }
}
