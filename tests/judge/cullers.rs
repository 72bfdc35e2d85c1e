//! Cullers with one flaw each, and some without.

use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::rounding::pose::{rotation, transform};
use sdop::settings::Strategy;
use sdop::volume::Shape;
use sdop::{Aabb, BoxCuller};
use sdop_judge::{Contestant, Frame, Scene, WorldBox};

/// Our own culler.
pub struct Ours {
    culler: Culler,
    pairs: Vec<[u32; 2]>,
}

impl Ours {
    pub fn new(scene: &Scene<'_>, strategy: Strategy) -> Self {
        let culler = Culler::builder().strategy(strategy).build(scene.shapes, scene.bodies);
        Self { culler: culler.unwrap(), pairs: Vec::new() }
    }
}

impl Contestant for Ours {
    fn frame(&mut self, bodies: &Bodies) {
        self.pairs = self.culler.cull(bodies).unwrap().sorted();
    }
    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }
}

/// Our culler of given boxes, which all may move for it.
#[derive(Default)]
pub struct Boxes {
    culler: BoxCuller,
    boxes: Vec<Aabb>,
}

impl Contestant for Boxes {
    fn frame(&mut self, _bodies: &Bodies) {
        self.culler.cull(&self.boxes).unwrap();
    }
    fn boxes(&mut self, boxes: &[WorldBox]) {
        let aabb = |&[x0, y0, z0, x1, y1, z1]: &WorldBox| Aabb::new([x0, y0, z0], [x1, y1, z1]);
        self.boxes = boxes.iter().map(aabb).collect();
    }
    fn pairs(&self) -> Vec<[u32; 2]> {
        self.culler.pairs().iter().collect()
    }
    fn change(&mut self, _bodies: &Bodies, _was: &[Option<u32>]) -> bool {
        true
    }
}

/// Where a ball is, in f64, and its radius.
fn ball(shapes: &[Shape], bodies: &Bodies, i: usize) -> ([f64; 3], f64) {
    let ball = shapes[bodies.shape[i] as usize].ball;
    let pose = rotation(bodies.rotation[i]);
    let centre = transform(&pose, ball.centre, bodies.translation[i]);
    (centre, f64::from(ball.radius))
}

/// Balls in f64 with a margin: right.
pub fn balls_meet(shapes: &[Shape], frame: &Frame, pair: [usize; 2]) -> bool {
    let [(a, ra), (b, rb)] = pair.map(|i| ball(shapes, &frame.bodies, i));
    let size = a.iter().chain(&b).fold(ra + rb, |m: f64, x| m.max(x.abs()));
    let d2: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum();
    d2.sqrt() <= ra + rb + 1e-13 * size
}

/// Balls in f32 without a margin: wrong by an ulp here and there.
pub fn balls_meet_without_margin(shapes: &[Shape], frame: &Frame, pair: [usize; 2]) -> bool {
    let [(a, ra), (b, rb)] = pair.map(|i| ball(shapes, &frame.bodies, i));
    let d = [0, 1, 2].map(|axis| a[axis] as f32 - b[axis] as f32);
    let r = ra as f32 + rb as f32;
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= r * r
}

/// What is wrong with a culler that reports all pairs.
#[derive(Clone, Copy, PartialEq)]
pub enum Flaw {
    None,
    /// Holds no more than so many pairs.
    Buffer(usize),
    /// Reports a pair of the frame before last.
    Stale,
    /// Leaves out what it need not report, the pairs without body 4, when it runs a second time.
    Fickle,
    SelfPair,
    Twice,
    Reversed,
    NoBody,
    Panics,
}

/// All pairs, with a flaw.
pub struct All {
    pub flaw: Flaw,
    pub bodies: usize,
    pub runs: usize,
}

impl Contestant for All {
    fn frame(&mut self, bodies: &Bodies) {
        assert!(self.flaw != Flaw::Panics || bodies.is_empty(), "as planned");
        if self.flaw != Flaw::Stale || self.bodies == 0 {
            self.bodies = bodies.len();
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let n = self.bodies as u32;
        let mut pairs: Vec<[u32; 2]> = (0..n).flat_map(|j| (0..j).map(move |i| [i, j])).collect();
        match self.flaw {
            Flaw::Buffer(room) => pairs.truncate(room),
            Flaw::Fickle if self.runs % 2 == 1 => pairs.retain(|pair| pair.contains(&4)),
            Flaw::SelfPair if n > 0 => pairs.push([0, 0]),
            Flaw::Twice if n > 1 => pairs.push([0, 1]),
            Flaw::Reversed if n > 1 => pairs[0] = [1, 0],
            Flaw::NoBody if n > 0 => pairs.push([0, n]),
            _ => {}
        }
        pairs
    }

    fn change(&mut self, _bodies: &Bodies, _was: &[Option<u32>]) -> bool {
        true
    }
}
