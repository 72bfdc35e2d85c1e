//! obvhs: a binary tree built anew each frame by PLOC with its fastest settings, asked for every body.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::boxes::{Frame, Slabs, lower, upper};
use crate::peer::{Entry, Peer, Setup, Work};
use crate::threads::{CHUNK, Threads};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "obvhs",
    version: "0.4.0",
    work: Work::Boxes,
    threads: usize::MAX,
    slack: 0,
    new: |setup| Ok(Box::new(Obvhs::new(setup)?)),
}];

struct Obvhs {
    builder: PlocBuilder,
    tree: Bvh2,
    boxes: Vec<Aabb>,
    threads: Threads,
    pairs: Vec<Vec<[u32; 2]>>,
}

impl Obvhs {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let bodies = setup.first.boxes.len();
        Ok(Self {
            builder: PlocBuilder::with_capacity(bodies),
            tree: Bvh2::zeroed(bodies),
            boxes: Vec::with_capacity(bodies),
            threads: Threads::new(setup.threads)?,
            pairs: vec![Vec::new(); bodies.div_ceil(CHUNK)],
        })
    }
}

impl Peer for Obvhs {
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
            pairs.par_iter_mut().enumerate().for_each(|(chunk, pairs)| {
                pairs.clear();
                for i in chunk * CHUNK..boxes.len().min((chunk + 1) * CHUNK) {
                    find(tree, boxes, i as u32, pairs);
                }
            });
        });
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.concat()
    }
}

/// The pairs of body `i` with later ones.
fn find(tree: &Bvh2, boxes: &[Aabb], i: u32, pairs: &mut Vec<[u32; 2]>) {
    tree.aabb_traverse(boxes[i as usize], |tree, node| {
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
