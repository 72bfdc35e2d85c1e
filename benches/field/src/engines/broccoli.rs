//! broccoli: a k-d tree of sweeps in two dimensions, built again in each frame; the third dimension
//! is compared pair by pair.
//!
//! Its intervals are closed, as ours.

use broccoli::aabb::ManySwappable;
use broccoli::axgeom::Rect;
use broccoli::{Tree, rect};
use sdop_judge::contestant::Contestant;

use crate::entry::New;
use crate::frame::Frame;

/// One way to drive it.
pub const ENGINES: [(&str, New); 1] = [("broccoli", |_| Ok(Box::new(Broccoli::default())))];

/// What the tree swaps about: the rectangle, the third interval and the body.
type Body = ManySwappable<(Rect<f32>, ([f32; 2], u32))>;

#[derive(Default)]
struct Broccoli {
    bodies: Vec<Body>,
    pairs: Vec<[u32; 2]>,
}

impl Contestant<Frame> for Broccoli {
    fn frame(&mut self, frame: &Frame) {
        let body = |(number, &[x, y, z]): (u32, &[[f32; 2]; 3])| {
            ManySwappable((rect(x[0], x[1], y[0], y[1]), (z, number)))
        };
        self.bodies.clear();
        self.bodies.extend(frame.changes().map(body));
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
