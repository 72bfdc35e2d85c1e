//! rstar: an R*-tree, loaded in bulk each frame and joined with itself.
//!
//! The join yields every pair both ways round and every body with itself; the later half is kept.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, lower, upper};
use crate::entry::{Entry, Setup, Work};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "rstar",
    version: "0.14.0",
    work: Work::Boxes,
    threads: 1,
    slack: 0,
    ages: false,
    new: |_: &Setup<'_>| Ok(Box::<Rstar>::default()),
}];

type Body = GeomWithData<Rectangle<[f32; 3]>, u32>;

#[derive(Default)]
struct Rstar {
    tree: RTree<Body>,
    pairs: Vec<[u32; 2]>,
}

impl Contestant<Frame> for Rstar {
    fn frame(&mut self, frame: &Frame) {
        let body = |(number, slabs): (usize, &_)| {
            let rectangle = AABB::from_bounds(lower(slabs), upper(slabs)).into();
            GeomWithData::new(rectangle, number as u32)
        };
        self.tree = RTree::bulk_load(frame.boxes.iter().enumerate().map(body).collect());
        let join = self
            .tree
            .intersection_candidates_with_other_tree(&self.tree);
        let later = join.filter(|(a, b)| a.data < b.data);
        self.pairs.clear();
        self.pairs.extend(later.map(|(a, b)| [a.data, b.data]));
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }
}
