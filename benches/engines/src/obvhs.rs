//! obvhs: a binary tree built anew each frame by PLOC with its fastest settings, asked for every body.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, Slabs, lower, upper};
use crate::entry::{Entry, Setup, Work};
use crate::threads::{Queries, Threads};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "obvhs",
    version: "0.4.0",
    work: Work::Boxes,
    threads: usize::MAX,
    slack: 0,
    ages: false,
    new: |setup| Ok(Box::new(Obvhs::new(setup)?)),
}];

struct Obvhs {
    builder: PlocBuilder,
    tree: Bvh2,
    boxes: Vec<Aabb>,
    threads: Threads,
    pairs: Queries,
}

impl Obvhs {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let bodies = setup.first.boxes.len();
        Ok(Self {
            builder: PlocBuilder::with_capacity(bodies),
            tree: Bvh2::zeroed(bodies),
            boxes: Vec::with_capacity(bodies),
            threads: Threads::new(setup.threads)?,
            pairs: Queries::new(bodies),
        })
    }
}

impl Contestant<Frame> for Obvhs {
    fn frame(&mut self, frame: &Frame) {
        self.boxes.clear();
        self.boxes.extend(frame.boxes.iter().map(aabb));
        let Self {
            builder,
            tree,
            boxes,
            pairs,
            ..
        } = self;
        self.threads.run(|| {
            builder.build_with_bvh(
                tree,
                PlocSearchDistance::Minimum,
                boxes,
                (0..boxes.len() as u32).collect(),
                SortPrecision::U64,
                0,
            );
            pairs.ask(boxes, |i, one, pairs| find(tree, i, *one, pairs));
        });
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.pairs()
    }
}

/// The pairs of body `i` with later ones.
fn find(tree: &Bvh2, i: u32, one: Aabb, pairs: &mut Vec<[u32; 2]>) {
    tree.aabb_traverse(one, |tree, node| {
        // With one body a leaf, the leaf's box is the body's.
        let j = tree.primitive_indices[tree.nodes[node as usize].first_index as usize];
        if j > i {
            pairs.push([i, j]);
        }
        true
    });
}

fn aabb(slabs: &Slabs) -> Aabb {
    Aabb::new(lower(slabs).into(), upper(slabs).into())
}
