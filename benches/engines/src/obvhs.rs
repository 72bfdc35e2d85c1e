//! obvhs: a binary tree of boxes that is updated where bodies move.
//!
//! It keeps no pairs. As in avian, which uses it as its broad phase, the boxes of moved bodies are
//! searched in the tree, and the user keeps the pairs ([`Partners`]).

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::rebuild::compute_rebuild_path_flags;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::boxes::{Slabs, lower, upper};
use crate::entry::{Setup, Work};
use crate::incremental::{Extras, Found, HUNDRED_THOUSAND, Incremental, MoverEntry, Moves};
use crate::partners::Partners;

/// avian's margin, for its default unit of length.
const AVIAN_MARGIN: f32 = 0.05;
/// A grown box is at most two margins larger on each side than the box, on both bodies.
const AVIAN_EXTRAS: f32 = 4.0 * AVIAN_MARGIN;

/// Shares of moved bodies, as avian has them. Below the first one leaves are put back one by one,
/// below the second one the parts of the tree above them are built anew, else all is.
const REINSERTION: f32 = 0.15;
const PARTIAL_REBUILD: f32 = 0.45;
/// From these shares of moved bodies on, all nodes are fitted again at once: where children are in
/// order after their parents, and where they aren't.
const FULL_REFIT: [f32; 2] = [0.06, 0.3];

const AS_AVIAN: MoverEntry = MoverEntry {
    name: "obvhs, as avian drives it",
    version: "0.4.0",
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: usize::MAX,
    new: |setup| Ok(Box::new(Tree::new(setup, Drive::AsAvian, 0.0))),
};

/// As avian drives it, without a margin and with avian's; leaf by leaf.
pub const MOVERS: [MoverEntry; 3] = [
    AS_AVIAN,
    MoverEntry {
        name: "obvhs, as avian drives it, margin 0.05",
        margin: AVIAN_MARGIN,
        extras: Extras::Within(AVIAN_EXTRAS),
        most_bodies: HUNDRED_THOUSAND,
        new: |setup| Ok(Box::new(Tree::new(setup, Drive::AsAvian, AVIAN_MARGIN))),
        ..AS_AVIAN
    },
    MoverEntry {
        name: "obvhs, leaves moved",
        new: |setup| Ok(Box::new(Tree::new(setup, Drive::LeafByLeaf, 0.0))),
        ..AS_AVIAN
    },
];

/// How the tree is updated.
#[derive(Clone, Copy, PartialEq)]
enum Drive {
    AsAvian,
    LeafByLeaf,
}

struct Tree {
    bvh: Bvh2,
    builder: PlocBuilder,
    optimizer: ReinsertionOptimizer,
    drive: Drive,
    margin: f32,
    /// The box of each leaf.
    boxes: Vec<Aabb>,
    /// Bodies whose leaves change in this frame.
    moved: Vec<u32>,
    is_moved: Vec<bool>,
    /// Their nodes, and which nodes are built anew.
    leaves: Vec<u32>,
    flags: Vec<bool>,
    partners: Partners,
}

impl Tree {
    fn new(setup: &Setup<'_>, drive: Drive, margin: f32) -> Self {
        let boxes = setup.first.boxes.iter();
        let boxes: Vec<Aabb> = boxes.map(|slabs| grown(slabs, margin)).collect();
        let mut builder = PlocBuilder::new();
        let bodies: Vec<u32> = (0..boxes.len() as u32).collect();
        let (distance, precision) = (PlocSearchDistance::Minimum, SortPrecision::U64);
        let bvh = builder.build(distance, &boxes, bodies.clone(), precision, 0);
        let mut tree = Self {
            bvh,
            builder,
            optimizer: ReinsertionOptimizer::default(),
            drive,
            margin,
            is_moved: vec![true; boxes.len()],
            leaves: Vec::new(),
            flags: Vec::new(),
            partners: Partners::new(boxes.len()),
            boxes,
            moved: bodies,
        };
        tree.find();
        tree
    }

    /// Takes over the boxes that leave their leaves.
    fn take(&mut self, moves: &Moves) {
        for body in self.moved.drain(..) {
            self.is_moved[body as usize] = false;
        }
        for (body, slabs) in moves.iter() {
            let (at, exact) = (body as usize, grown(slabs, 0.0));
            let leaf = self.boxes[at];
            let is_inside = leaf.min.cmple(exact.min).all() && exact.max.cmple(leaf.max).all();
            if self.margin == 0.0 || !is_inside {
                self.boxes[at] = grown(slabs, self.margin);
                self.is_moved[at] = true;
                self.moved.push(body);
            }
        }
    }

    fn share(&self) -> f32 {
        self.moved.len() as f32 / self.boxes.len() as f32
    }

    /// Makes the leaves and what is above them large enough.
    fn update(&mut self) {
        let Self { bvh, boxes, .. } = self;
        bvh.init_primitives_to_nodes_if_uninit();
        bvh.init_parents_if_uninit();
        if self.drive == Drive::LeafByLeaf {
            for &body in &self.moved {
                bvh.move_primitive(boxes[body as usize], body);
            }
            return;
        }
        let is_unordered = usize::from(!bvh.children_are_ordered_after_parents);
        let refits_all = self.moved.len() as f32 >= FULL_REFIT[is_unordered] * boxes.len() as f32;
        for &body in &self.moved {
            let node = bvh.primitives_to_nodes[body as usize] as usize;
            if refits_all {
                bvh.nodes[node].set_aabb(boxes[body as usize]);
            } else {
                bvh.resize_node(node, boxes[body as usize]);
            }
        }
        if refits_all {
            bvh.refit_all();
        }
    }

    /// Searches the moved bodies.
    fn find(&mut self) {
        let Self { bvh, boxes, partners, is_moved, .. } = self;
        partners.begin_frame();
        for &body in &self.moved {
            let own = boxes[body as usize];
            partners.end(body, |other| own.intersect_aabb(&boxes[other as usize]));
        }
        for &body in &self.moved {
            bvh.aabb_traverse(boxes[body as usize], |bvh, node| {
                let node = &bvh.nodes[node as usize];
                let first = node.first_index as usize;
                for &other in &bvh.primitive_indices[first..first + node.prim_count as usize] {
                    // A pair of two moved bodies is found from the lower one.
                    if other > body || !is_moved[other as usize] {
                        partners.begin(body, other);
                    }
                }
                true
            });
        }
    }

    /// Makes the tree fast again where leaves have changed.
    fn optimize(&mut self) {
        if self.drive == Drive::LeafByLeaf || self.moved.is_empty() {
            return;
        }
        let share = self.share();
        let (bvh, builder) = (&mut self.bvh, &mut self.builder);
        let nodes = self.moved.iter();
        let nodes = nodes.map(|&body| bvh.primitives_to_nodes[body as usize]);
        self.leaves.clear();
        self.leaves.extend(nodes);
        let (distance, precision) = (PlocSearchDistance::Minimum, SortPrecision::U64);
        if share < REINSERTION {
            self.optimizer.run_with_candidates(bvh, &self.leaves, 1);
        } else if share < PARTIAL_REBUILD {
            compute_rebuild_path_flags(bvh, &self.leaves, &mut self.flags);
            let flags = &self.flags;
            builder.partial_rebuild(bvh, |node| flags[node], distance, precision, 0);
        } else {
            builder.full_rebuild(bvh, distance, precision, 0);
        }
    }
}

impl Incremental for Tree {
    fn frame(&mut self, moves: &Moves) {
        self.take(moves);
        self.update();
        self.find();
        self.optimize();
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(self.partners.changes())
    }
}

fn grown(slabs: &Slabs, margin: f32) -> Aabb {
    Aabb::new(lower(slabs).map(|x| x - margin).into(), upper(slabs).map(|x| x + margin).into())
}
