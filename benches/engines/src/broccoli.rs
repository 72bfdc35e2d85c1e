//! broccoli: a k-d tree of sweeps in two dimensions, built again in each frame; the third dimension
//! is compared pair by pair.
//!
//! Its intervals are closed, as ours.

use broccoli::aabb::ManySwappable;
use broccoli::axgeom::Rect;
use broccoli::{Tree, rect};

use sdop_judge::contestant::Contestant;

use crate::boxes::Frame;
use crate::entry::{Entry, Setup, Work};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "broccoli",
    version: "6.3.0",
    work: Work::Boxes,
    threads: 1,
    ages: false,
    new: |setup| Ok(Box::new(Broccoli::new(setup))),
}];

/// What the tree swaps about: the rectangle, the third interval and the body.
type Body = ManySwappable<(Rect<f32>, ([f32; 2], u32))>;

struct Broccoli {
    bodies: Vec<Body>,
    pairs: Vec<[u32; 2]>,
}

impl Broccoli {
    fn new(setup: &Setup<'_>) -> Self {
        let mut broccoli = Self { bodies: Vec::new(), pairs: Vec::new() };
        broccoli.take(setup.first);
        broccoli
    }

    fn take(&mut self, frame: &Frame) {
        let body = |(number, &[x, y, z]): (usize, &[[f32; 2]; 3])| {
            ManySwappable((rect(x[0], x[1], y[0], y[1]), (z, number as u32)))
        };
        self.bodies.clear();
        self.bodies.extend(frame.boxes.iter().enumerate().map(body));
    }
}

impl Contestant<Frame> for Broccoli {
    fn frame(&mut self, frame: &Frame) {
        self.take(frame);
        let pairs = &mut self.pairs;
        pairs.clear();
        Tree::new(&mut self.bodies).find_colliding_pairs(|a, b| {
            let (a, b) = (a.unpack_inner(), b.unpack_inner());
            if a.0[0] <= b.0[1] && b.0[0] <= a.0[1] {
                pairs.push([a.1, b.1]);
            }
        });
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }
}
