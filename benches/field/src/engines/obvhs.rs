//! obvhs: a binary tree of boxes that is updated where bodies move, as avian drives it or leaf by
//! leaf.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::rebuild::compute_rebuild_path_flags;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::tree::{self, BoxTree};
use crate::entry::New;
use crate::frame::{Slabs, lower, upper};

/// avian's margin, for its default unit of length.
const AVIAN_MARGIN: f32 = 0.05;

/// Shares of moved bodies, as avian has them. Below the first one leaves are put back one by one,
/// below the second one the parts of the tree above them are built anew, else all is.
const REINSERTION: f32 = 0.15;
const PARTIAL_REBUILD: f32 = 0.45;
/// From these shares of moved bodies on, all nodes are fitted again at once: where children are in
/// order after their parents, and where they aren't.
const FULL_REFIT: [f32; 2] = [0.06, 0.3];

const PLOC: (PlocSearchDistance, SortPrecision) = (PlocSearchDistance::Minimum, SortPrecision::U64);

/// As avian drives it, without a margin and with avian's; leaf by leaf.
pub const ENGINES: [(&str, New); 3] = [
    ("obvhs, as avian drives it", |setup| tree::new::<AvianTree>(setup, 0.0)),
    ("obvhs, as avian drives it, margin 0.05", |setup| tree::new::<AvianTree>(setup, AVIAN_MARGIN)),
    ("obvhs, leaves moved", |setup| tree::new::<LeafTree>(setup, 0.0)),
];

struct LeafTree(Bvh2);

impl BoxTree for LeafTree {
    fn new(boxes: &[Slabs]) -> Self {
        Self(built(&mut PlocBuilder::new(), boxes))
    }

    fn update(&mut self, moved: &[u32], boxes: &[Slabs]) {
        for &body in moved {
            self.0.move_primitive(aabb(&boxes[body as usize]), body);
        }
    }

    fn search(&self, slabs: &Slabs, found: impl FnMut(u32)) {
        search(&self.0, slabs, found);
    }

    fn tidy(&mut self, _: &[u32], _: usize) {}
}

struct AvianTree {
    bvh: Bvh2,
    builder: PlocBuilder,
    optimizer: ReinsertionOptimizer,
    /// The nodes of moved bodies, and which nodes are built anew.
    leaves: Vec<u32>,
    flags: Vec<bool>,
}

impl BoxTree for AvianTree {
    fn new(boxes: &[Slabs]) -> Self {
        let mut builder = PlocBuilder::new();
        Self {
            bvh: built(&mut builder, boxes),
            builder,
            optimizer: ReinsertionOptimizer::default(),
            leaves: Vec::new(),
            flags: Vec::new(),
        }
    }

    fn update(&mut self, moved: &[u32], boxes: &[Slabs]) {
        let bvh = &mut self.bvh;
        let is_unordered = usize::from(!bvh.children_are_ordered_after_parents);
        let refits_all = moved.len() as f32 >= FULL_REFIT[is_unordered] * boxes.len() as f32;
        for &body in moved {
            let node = bvh.primitives_to_nodes[body as usize] as usize;
            let aabb = aabb(&boxes[body as usize]);
            if refits_all {
                bvh.nodes[node].set_aabb(aabb);
            } else {
                bvh.resize_node(node, aabb);
            }
        }
        if refits_all {
            bvh.refit_all();
        }
    }

    fn search(&self, slabs: &Slabs, found: impl FnMut(u32)) {
        search(&self.bvh, slabs, found);
    }

    fn tidy(&mut self, moved: &[u32], bodies: usize) {
        if moved.is_empty() {
            return;
        }
        let (bvh, builder, (distance, precision)) = (&mut self.bvh, &mut self.builder, PLOC);
        let share = moved.len() as f32 / bodies as f32;
        self.leaves.clear();
        self.leaves.extend(moved.iter().map(|&body| bvh.primitives_to_nodes[body as usize]));
        if share < REINSERTION {
            self.optimizer.run_with_candidates(bvh, &self.leaves, 1);
        } else if share < PARTIAL_REBUILD {
            compute_rebuild_path_flags(bvh, &self.leaves, &mut self.flags);
            let flags = &self.flags;
            builder.partial_rebuild(bvh, |node| flags[node], distance, precision, 0);
        } else {
            builder.full_rebuild(bvh, distance, precision, 0);
        }
        bvh.init_primitives_to_nodes_if_uninit();
        bvh.init_parents_if_uninit();
    }
}

fn built(builder: &mut PlocBuilder, boxes: &[Slabs]) -> Bvh2 {
    let (boxes, bodies): (Vec<Aabb>, Vec<u32>) = boxes.iter().map(aabb).zip(0..).unzip();
    let mut bvh = builder.build(PLOC.0, &boxes, bodies, PLOC.1, 0);
    bvh.init_primitives_to_nodes_if_uninit();
    bvh.init_parents_if_uninit();
    bvh
}

fn search(bvh: &Bvh2, slabs: &Slabs, mut found: impl FnMut(u32)) {
    bvh.aabb_traverse(aabb(slabs), |bvh, node| {
        let node = &bvh.nodes[node as usize];
        let first = node.first_index as usize;
        let bodies = &bvh.primitive_indices[first..first + node.prim_count as usize];
        bodies.iter().for_each(|&body| found(body));
        true
    });
}

fn aabb(slabs: &Slabs) -> Aabb {
    Aabb::new(lower(slabs).into(), upper(slabs).into())
}
