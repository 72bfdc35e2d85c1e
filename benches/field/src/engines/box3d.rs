//! Box3D's dynamic tree, used as Box3D's broad phase uses it: a moved box that leaves its leaf
//! enlarges it, all moved boxes are searched, and the parts of the tree above enlarged leaves are
//! rebuilt. Box3D's broad phase is part of its worlds and reports no pairs.
//!
//! The binding has Box3D's commit 781673be of 24 July 2026, before its tree was rewritten in
//! September 2026.

#![allow(unsafe_code, reason = "Box3D is C")]

use std::ffi::{c_int, c_void};

use boxddd_sys::ffi::{
    b3AABB, b3DynamicTree, b3DynamicTree_Create, b3DynamicTree_CreateProxy, b3DynamicTree_Destroy,
    b3DynamicTree_EnlargeProxy, b3DynamicTree_Query, b3DynamicTree_Rebuild, b3Vec3,
};

use super::tree::{self, BoxTree};
use crate::entry::New;
use crate::frame::{Slabs, lower, upper};

/// Box3D's margin: an eighth of the extent, at most this, for lengths in metres.
pub const MARGIN: f32 = 0.05;
/// All categories.
const ALL: u64 = u64::MAX;

/// Without a margin, and with Box3D's.
pub const ENGINES: [(&str, New); 2] = [
    ("Box3D", |setup| tree::new::<Tree>(setup, 0.0)),
    ("Box3D, margin 0.05", |setup| tree::new::<Tree>(setup, MARGIN)),
];

struct Tree {
    tree: b3DynamicTree,
    proxies: Vec<c_int>,
}

impl BoxTree for Tree {
    fn new(boxes: &[Slabs]) -> Self {
        // SAFETY: a tree is a plain value, which owns what it allocates.
        let mut tree = unsafe { b3DynamicTree_Create(boxes.len() as c_int) };
        let proxy = |(body, slabs): (u64, &Slabs)| {
            // SAFETY: a tree that was made, and a box of finite ends.
            unsafe { b3DynamicTree_CreateProxy(&raw mut tree, aabb(slabs), ALL, body) }
        };
        let proxies = (0..).zip(boxes).map(proxy).collect();
        // SAFETY: a tree that was made.
        unsafe { b3DynamicTree_Rebuild(&raw mut tree, true) };
        Self { tree, proxies }
    }

    fn update(&mut self, moved: &[u32], boxes: &[Slabs]) {
        for &body in moved {
            let (tree, at) = (&raw mut self.tree, body as usize);
            // SAFETY: a proxy of this tree.
            unsafe { b3DynamicTree_EnlargeProxy(tree, self.proxies[at], aabb(&boxes[at])) };
        }
    }

    fn search(&self, slabs: &Slabs, mut found: impl FnMut(u32)) {
        let mut found: &mut dyn FnMut(u32) = &mut found;
        // SAFETY: the callback gets `found`, which lives until the query has ended.
        unsafe {
            let (tree, context) = (&raw const self.tree, (&raw mut found).cast());
            b3DynamicTree_Query(tree, aabb(slabs), ALL, false, Some(call), context);
        }
    }

    fn tidy(&mut self, _: &[u32], _: usize) {
        // SAFETY: a tree that was made.
        unsafe { b3DynamicTree_Rebuild(&raw mut self.tree, false) };
    }
}

unsafe extern "C" fn call(_: c_int, body: u64, found: *mut c_void) -> bool {
    // SAFETY: what the query was given, and nobody else uses it meanwhile.
    let found = unsafe { &mut *found.cast::<&mut dyn FnMut(u32)>() };
    found(body as u32);
    true
}

impl Drop for Tree {
    fn drop(&mut self) {
        // SAFETY: made once, ended once.
        unsafe { b3DynamicTree_Destroy(&raw mut self.tree) };
    }
}

fn aabb(slabs: &Slabs) -> b3AABB {
    let corner = |[x, y, z]: [f32; 3]| b3Vec3 { x, y, z };
    b3AABB { lowerBound: corner(lower(slabs)), upperBound: corner(upper(slabs)) }
}
