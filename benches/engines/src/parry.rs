//! parry3d's `Bvh`: a binary tree of boxes that is refitted, traversed against itself.

use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, Slabs, lower, upper};
use crate::entry::{Entry, Setup, Work};
use crate::threads::Threads;

pub const VERSION: &str = "0.31.1";

/// Two ways to keep a tree: refitted and improved a little each frame, or built anew.
pub const ENTRIES: [Entry; 2] = [
    Entry {
        name: "parry3d refit",
        version: VERSION,
        work: Work::Boxes,
        threads: usize::MAX,
        ages: true,
        new: |setup| Ok(Box::new(Parry::new(setup, false)?)),
    },
    Entry {
        name: "parry3d rebuild",
        version: VERSION,
        work: Work::Boxes,
        threads: usize::MAX,
        ages: true,
        new: |setup| Ok(Box::new(Parry::new(setup, true)?)),
    },
];

struct Parry {
    tree: Bvh,
    workspace: BvhWorkspace,
    rebuilt: bool,
    threads: Threads,
    pairs: Vec<(u32, u32)>,
}

impl Parry {
    fn new(setup: &Setup<'_>, rebuilt: bool) -> miette::Result<Self> {
        let leaves: Vec<Aabb> = setup.first.boxes.iter().map(aabb).collect();
        Ok(Self {
            tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves),
            workspace: BvhWorkspace::default(),
            rebuilt,
            threads: Threads::new(setup.threads)?,
            pairs: Vec::new(),
        })
    }
}

impl Contestant<Frame> for Parry {
    fn frame(&mut self, frame: &Frame) {
        let (tree, workspace, pairs) = (&mut self.tree, &mut self.workspace, &mut self.pairs);
        for (i, slabs) in frame.boxes.iter().enumerate() {
            tree.insert_or_update_partially(aabb(slabs), i as u32, 0.0);
        }
        // As rapier does it: improve first, so that the refit lays the tree out in depth-first
        // order.
        if self.rebuilt {
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

/// The box as parry3d's.
pub fn aabb(slabs: &Slabs) -> Aabb {
    Aabb::new(Vector::from_array(lower(slabs)), Vector::from_array(upper(slabs)))
}
