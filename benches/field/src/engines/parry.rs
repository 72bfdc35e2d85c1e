//! parry3d's `Bvh`: a binary tree of boxes that is refitted, traversed against itself; and a tree
//! that is built at once and asked.

use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhLeafUpdateStatus, BvhNode, BvhWorkspace};
use parry3d::query::{PointQuery as _, Ray, RayCast as _};
use sdop_judge::contestant::Contestant;

use crate::entry::{New, Setup};
use crate::frame::{Frame, Slabs, lower, upper};
use crate::questions::{Question, Questions, RADIUS, Segment, flat};
use crate::threads::Threads;

/// Ways to keep a tree: leaves updated one by one or as a batch, then refitted and improved a
/// little each frame, or built anew. And a tree that rests.
pub const ENGINES: [(&str, New); 4] = [
    ("parry3d refit", |setup| Ok(Box::new(Parry::new(setup, Update::LeafByLeaf)?))),
    ("parry3d batch", |setup| Ok(Box::new(Parry::new(setup, Update::Batch)?))),
    ("parry3d rebuild", |setup| Ok(Box::new(Parry::new(setup, Update::Rebuild)?))),
    ("parry3d", |setup| Ok(Box::new(Asked::new(setup)?))),
];

#[derive(Clone, Copy, PartialEq)]
enum Update {
    LeafByLeaf,
    Batch,
    Rebuild,
}

struct Parry {
    tree: Bvh,
    workspace: BvhWorkspace,
    update: Update,
    batch: Vec<(Aabb, u32, Real)>,
    statuses: Vec<BvhLeafUpdateStatus>,
    threads: Threads,
    pairs: Vec<(u32, u32)>,
}

impl Parry {
    fn new(setup: &Setup<'_>, update: Update) -> miette::Result<Self> {
        let leaves: Vec<Aabb> = setup.first.boxes.iter().map(aabb).collect();
        Ok(Self {
            tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves),
            workspace: BvhWorkspace::default(),
            update,
            batch: Vec::new(),
            statuses: Vec::new(),
            threads: Threads::new(setup.threads)?,
            pairs: Vec::new(),
        })
    }

    fn take(&mut self, frame: &Frame) {
        let Self { tree, batch, statuses, .. } = self;
        let changes = frame.changes().map(|(body, slabs)| (aabb(slabs), body, 0.0));
        if self.update == Update::Batch {
            batch.clear();
            batch.extend(changes);
            self.threads.run(|| tree.insert_or_update_batch_partially_parallel(batch, statuses));
        } else {
            for (aabb, body, margin) in changes {
                tree.insert_or_update_partially(aabb, body, margin);
            }
        }
    }
}

impl Contestant<Frame> for Parry {
    fn frame(&mut self, frame: &Frame) {
        self.take(frame);
        let (tree, workspace, pairs) = (&mut self.tree, &mut self.workspace, &mut self.pairs);
        // As rapier does it: improve first, so that the refit lays the tree out in depth-first
        // order.
        if self.update == Update::Rebuild {
            tree.rebuild(workspace, BvhBuildStrategy::Binned);
        } else {
            tree.optimize_incremental(workspace);
        }
        if self.threads.several() {
            self.threads.run(|| {
                tree.refit_parallel(workspace);
                *pairs = tree.traverse_bvtt_single_tree_parallel::<false>();
            });
        } else {
            tree.refit(workspace);
            pairs.clear();
            tree.traverse_bvtt_single_tree::<false>(workspace, &mut |i, j| pairs.push((i, j)));
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.iter().map(|&(i, j)| [i, j]).collect()
    }
}

/// A tree built at once.
struct Asked {
    boxes: Vec<Aabb>,
    tree: Bvh,
    halves: [Bvh; 2],
    probes: Vec<Aabb>,
    centres: Vec<Vector>,
    rays: Vec<Ray>,
    threads: Threads,
    found: Vec<Vec<u32>>,
    pairs: Vec<(u32, u32)>,
}

impl Asked {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let questions = Questions::of(setup)?;
        let boxes: Vec<Aabb> = questions.boxes.iter().map(aabb).collect();
        let build = |boxes: &[Aabb]| Bvh::from_leaves(BvhBuildStrategy::Binned, boxes);
        let half = |half: Vec<Slabs>| build(&half.iter().map(aabb).collect::<Vec<_>>());
        Ok(Self {
            tree: build(&boxes),
            boxes,
            halves: questions.halves().map(half),
            probes: questions.probes.iter().map(aabb).collect(),
            centres: questions.centres.iter().map(|&centre| Vector::from_array(centre)).collect(),
            rays: questions.segments.iter().map(ray).collect(),
            threads: Threads::new(setup.threads)?,
            found: Vec::new(),
            pairs: Vec::new(),
        })
    }

    fn meets_ball(&self, centre: Vector) -> Vec<u32> {
        let is_near = |node: &BvhNode| node.aabb().distance_to_local_point(centre, true) <= RADIUS;
        self.tree.leaves(is_near).collect()
    }

    fn along(&self, ray: &Ray) -> Vec<u32> {
        let is_met = |node: &BvhNode| node.aabb().intersects_local_ray(ray, 1.0);
        self.tree.leaves(is_met).collect()
    }

    fn first(&self, ray: &Ray) -> Vec<u32> {
        let at = |leaf: u32, last: f32| self.boxes[leaf as usize].cast_local_ray(ray, last, true);
        let first = self.tree.cast_ray(ray, 1.0, at);
        first.into_iter().map(|(leaf, _)| leaf).collect()
    }

    fn answer(&self, question: Question) -> Vec<Vec<u32>> {
        let threads = &self.threads;
        match question {
            Question::Box => {
                threads.each(&self.probes, |probe| self.tree.intersect_aabb(probe).collect())
            }
            Question::Ball => threads.each(&self.centres, |&centre| self.meets_ball(centre)),
            Question::Along => threads.each(&self.rays, |ray| self.along(ray)),
            Question::First => threads.each(&self.rays, |ray| self.first(ray)),
            Question::Sets if threads.several() => {
                let [_, odd] = &self.halves;
                let even: Vec<&Aabb> = self.boxes.iter().step_by(2).collect();
                threads.each(&even, |aabb| {
                    odd.intersect_aabb(aabb).map(|place| 2 * place + 1).collect()
                })
            }
            Question::Sets => Vec::new(), // pairs at once
        }
    }
}

impl Contestant<Frame> for Asked {
    fn frame(&mut self, frame: &Frame) {
        let Some((question, _)) = frame.question else { return };
        self.pairs.clear();
        if question == Question::Sets && !self.threads.several() {
            let [even, odd] = &self.halves;
            let meet = |one: &BvhNode, other: &BvhNode| one.intersects(other);
            self.pairs.extend(even.leaf_pairs(odd, meet));
        }
        self.found = self.answer(question);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let between = self.pairs.iter().map(|&(even, odd)| [even, 2 * odd + 1]);
        flat(&self.found).chain(between).collect()
    }
}

/// The box as parry3d's.
pub fn aabb(slabs: &Slabs) -> Aabb {
    Aabb::new(Vector::from_array(lower(slabs)), Vector::from_array(upper(slabs)))
}

/// The segment as a ray of length 1.
pub fn ray([from, to]: &Segment) -> Ray {
    let [from, to] = [from, to].map(|end| Vector::from_array(*end));
    Ray::new(from, to - from)
}
