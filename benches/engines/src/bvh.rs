//! The crate `bvh`: a binary tree by the surface area heuristic, built anew each frame and asked for every body.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, rayon_executor};
use nalgebra::Point3;

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, lower, upper};
use crate::entry::{Entry, Setup, Work};
use crate::threads::{Queries, Threads};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "bvh",
    version: "0.13.0",
    work: Work::Boxes,
    threads: usize::MAX,
    slack: 0,
    ages: false,
    new: |setup| Ok(Box::new(Tree::new(setup)?)),
}];

#[derive(Clone)]
struct Body {
    slabs: Aabb<f32, 3>,
    number: u32,
    node: usize,
}

impl Bounded<f32, 3> for Body {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.slabs
    }
}

impl BHShape<f32, 3> for Body {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

struct Tree {
    bodies: Vec<Body>,
    threads: Threads,
    pairs: Queries,
}

impl Tree {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let bodies = setup.first.boxes.len();
        Ok(Self {
            bodies: Vec::with_capacity(bodies),
            threads: Threads::new(setup.threads)?,
            pairs: Queries::new(bodies),
        })
    }
}

impl Contestant<Frame> for Tree {
    fn frame(&mut self, frame: &Frame) {
        self.bodies.clear();
        let body = |(number, slabs): (usize, &_)| {
            let corners = [lower(slabs), upper(slabs)].map(Point3::from);
            Body {
                slabs: Aabb::with_bounds(corners[0], corners[1]),
                number: number as u32,
                node: 0,
            }
        };
        self.bodies.extend(frame.boxes.iter().enumerate().map(body));
        let (bodies, pairs) = (&mut self.bodies, &mut self.pairs);
        let several = self.threads.several();
        self.threads.run(|| {
            let tree = if several {
                Bvh::build_with_executor(bodies, rayon_executor)
            } else {
                Bvh::build(bodies)
            };
            pairs.ask(bodies, |_, body, pairs| find(&tree, bodies, body, pairs));
        });
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.pairs()
    }
}

/// The pairs of a body with later ones. The iterator's leaves may lie beside the box that was asked for, so each is tested.
fn find(tree: &Bvh<f32, 3>, bodies: &[Body], body: &Body, pairs: &mut Vec<[u32; 2]>) {
    let found = tree.traverse_iterator(&body.slabs, bodies);
    let later = found
        .filter(|other| other.number > body.number && other.slabs.intersects_aabb(&body.slabs));
    pairs.extend(later.map(|other| [body.number, other.number]));
}
