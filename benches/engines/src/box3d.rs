//! Box3D's dynamic tree, used as Box3D's broad phase uses it: a moved box that leaves its leaf
//! enlarges it, all moved boxes are searched, and the parts of the tree above enlarged leaves are
//! rebuilt. Box3D's broad phase is part of its worlds and reports no pairs, so a user of the tree
//! keeps them ([`Partners`]).
//!
//! The binding has Box3D's commit 781673be of 24 July 2026, before its tree was rewritten in
//! September 2026.

#![allow(unsafe_code, reason = "Box3D is C")]

use std::ffi::{c_int, c_void};

use boxddd_sys::ffi::{
    b3AABB, b3DynamicTree, b3DynamicTree_Create, b3DynamicTree_CreateProxy, b3DynamicTree_Destroy,
    b3DynamicTree_EnlargeProxy, b3DynamicTree_Query, b3DynamicTree_Rebuild, b3Vec3,
};

use crate::boxes::{Slabs, lower, meet, upper};
use crate::entry::{Setup, Work};
use crate::incremental::{Extras, Found, HUNDRED_THOUSAND, Incremental, MoverEntry, Moves};
use crate::partners::Partners;

/// Box3D's margin: an eighth of the extent, at most this, for lengths in metres.
const MARGIN: f32 = 0.05;
/// All categories.
const ALL: u64 = u64::MAX;

const WITHOUT_MARGIN: MoverEntry = MoverEntry {
    name: "Box3D",
    version: "781673be (boxddd-sys 0.4.0)",
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: usize::MAX,
    new: |setup| Ok(Box::new(Tree::new(setup, 0.0))),
};

/// Without a margin, and with Box3D's.
pub const MOVERS: [MoverEntry; 2] = [
    WITHOUT_MARGIN,
    MoverEntry {
        name: "Box3D, margin 0.05",
        margin: MARGIN,
        extras: Extras::Within(4.0 * MARGIN),
        most_bodies: HUNDRED_THOUSAND,
        new: |setup| Ok(Box::new(Tree::new(setup, MARGIN))),
        ..WITHOUT_MARGIN
    },
];

struct Tree {
    tree: b3DynamicTree,
    margin: f32,
    proxies: Vec<c_int>,
    /// The box of each leaf.
    boxes: Vec<Slabs>,
    moved: Vec<u32>,
    is_moved: Vec<bool>,
    partners: Partners,
}

impl Tree {
    fn new(setup: &Setup<'_>, margin: f32) -> Self {
        let boxes = setup.first.boxes.iter();
        let boxes: Vec<Slabs> = boxes.map(|slabs| grown(slabs, margin)).collect();
        // SAFETY: a tree is a plain value, which owns what it allocates.
        let mut tree = unsafe { b3DynamicTree_Create(boxes.len() as c_int) };
        let proxy = |(body, slabs): (u64, &Slabs)| {
            // SAFETY: a tree that was made, and a box of finite ends.
            unsafe { b3DynamicTree_CreateProxy(&raw mut tree, aabb(slabs), ALL, body) }
        };
        let proxies = (0..).zip(&boxes).map(proxy).collect();
        // SAFETY: a tree that was made.
        unsafe { b3DynamicTree_Rebuild(&raw mut tree, true) };
        let mut tree = Self {
            tree,
            margin,
            proxies,
            moved: (0..boxes.len() as u32).collect(),
            is_moved: vec![true; boxes.len()],
            partners: Partners::new(boxes.len()),
            boxes,
        };
        tree.find();
        tree
    }

    fn take(&mut self, moves: &Moves) {
        for body in self.moved.drain(..) {
            self.is_moved[body as usize] = false;
        }
        for (body, slabs) in moves.iter() {
            let at = body as usize;
            let leaf = &self.boxes[at];
            let is_inside = (0..3)
                .all(|axis| leaf[axis][0] <= slabs[axis][0] && slabs[axis][1] <= leaf[axis][1]);
            if self.margin == 0.0 || !is_inside {
                self.boxes[at] = grown(slabs, self.margin);
                self.is_moved[at] = true;
                self.moved.push(body);
                let (tree, aabb) = (&raw mut self.tree, aabb(&self.boxes[at]));
                // SAFETY: a proxy of this tree.
                unsafe { b3DynamicTree_EnlargeProxy(tree, self.proxies[at], aabb) };
            }
        }
    }

    fn find(&mut self) {
        self.partners.begin_frame();
        for &body in &self.moved {
            let own = &self.boxes[body as usize];
            let boxes = &self.boxes;
            self.partners.end(body, |other| meet(own, &boxes[other as usize]));
        }
        for &body in &self.moved {
            let mut search =
                Search { body, is_moved: &self.is_moved, partners: &mut self.partners };
            // SAFETY: the callback gets the search, which lives until the query has ended.
            unsafe {
                b3DynamicTree_Query(
                    &raw const self.tree,
                    aabb(&self.boxes[body as usize]),
                    ALL,
                    false,
                    Some(found),
                    (&raw mut search).cast(),
                );
            }
        }
    }
}

/// One moved body's search.
struct Search<'a> {
    body: u32,
    is_moved: &'a [bool],
    partners: &'a mut Partners,
}

unsafe extern "C" fn found(_: c_int, other: u64, search: *mut c_void) -> bool {
    // SAFETY: what the query was given, and nobody else uses it meanwhile.
    let search = unsafe { &mut *search.cast::<Search<'_>>() };
    let other = other as u32;
    // A pair of two moved bodies is found from the lower one.
    if other > search.body || !search.is_moved[other as usize] {
        search.partners.begin(search.body, other);
    }
    true
}

impl Incremental for Tree {
    fn frame(&mut self, moves: &Moves) {
        self.take(moves);
        self.find();
        // SAFETY: a tree that was made.
        unsafe { b3DynamicTree_Rebuild(&raw mut self.tree, false) };
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(self.partners.changes())
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        // SAFETY: made once, ended once.
        unsafe { b3DynamicTree_Destroy(&raw mut self.tree) };
    }
}

fn grown(slabs: &Slabs, margin: f32) -> Slabs {
    slabs.map(|[lo, hi]| [lo - margin, hi + margin])
}

fn aabb(slabs: &Slabs) -> b3AABB {
    let corner = |[x, y, z]: [f32; 3]| b3Vec3 { x, y, z };
    b3AABB { lowerBound: corner(lower(slabs)), upperBound: corner(upper(slabs)) }
}
