//! `box3d-rust`: a port of Box3D to Rust in scalar arithmetic, on one thread, of the commit efca0c1
//! with its new tree, which is driven as [Box3D's](super::tree).

use box3d_rust::dynamic_tree::DynamicTree;
use box3d_rust::math_functions::aabb_contains;
use box3d_rust::{Aabb, Vec3};

use super::tree::{self, BoxTree};
use crate::entry::New;
use crate::frame::{Slabs, lower, upper};

/// The margin of a box of Box3D: an eighth of the extent, at most this, for lengths in metres.
const MARGIN: f32 = 0.05;
/// All categories.
const ALL: u64 = u64::MAX;

/// Without a margin, and with Box3D's.
pub const ENGINES: [(&str, New); 2] = [
    ("box3d-rust", |setup| tree::new::<Tree>(setup, 0.0)),
    ("box3d-rust, margin 0.05", |setup| tree::new::<Tree>(setup, MARGIN)),
];

struct Tree {
    tree: DynamicTree,
    proxies: Vec<i32>,
}

impl BoxTree for Tree {
    fn new(boxes: &[Slabs]) -> Self {
        let mut tree = DynamicTree::new(boxes.len() as i32);
        let proxies = (0..).zip(boxes);
        let proxies = proxies.map(|(body, slabs)| tree.create_proxy(aabb(slabs), ALL, body));
        let proxies = proxies.collect();
        tree.rebuild(true);
        Self { tree, proxies }
    }

    fn update(&mut self, moved: &[u32], boxes: &[Slabs]) {
        for &body in moved {
            let (proxy, aabb) = (self.proxies[body as usize], aabb(&boxes[body as usize]));
            // A box that became smaller can't enlarge its leaf.
            if aabb_contains(self.tree.aabb(proxy), aabb) {
                self.tree.move_proxy(proxy, aabb);
            } else {
                self.tree.enlarge_proxy(proxy, aabb);
            }
        }
    }

    fn search(&self, slabs: &Slabs, mut found: impl FnMut(u32)) {
        self.tree.query(aabb(slabs), ALL, false, |_, body| {
            found(body as u32);
            true
        });
    }

    fn tidy(&mut self, _: &[u32], _: usize) {
        self.tree.rebuild(false);
    }
}

fn aabb(slabs: &Slabs) -> Aabb {
    let corner = |[x, y, z]: [f32; 3]| Vec3 { x, y, z };
    Aabb { lower_bound: corner(lower(slabs)), upper_bound: corner(upper(slabs)) }
}
