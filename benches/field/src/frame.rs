//! The input of every engine: a frame with world-aligned boxes, as lower and upper ends on each
//! axis.
//!
//! Intervals are closed: boxes that touch are a pair. The ends are fl(t − r) and fl(t + r), the
//! same bits for everyone.

use std::sync::Arc;

use sdop::Aabb;
use sdop::bodies::Bodies;
use sdop::volume::Shape;

use crate::questions::{Question, Questions};

/// A world-aligned box as [lo, hi] on each axis.
pub type Slabs = [[f32; 2]; 3];

/// One frame of a scene.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The bodies that have changed since the last frame, sorted; `None` if all have. The columns
    /// below are theirs.
    pub changed: Option<Vec<u32>>,
    /// The boxes.
    pub boxes: Vec<Slabs>,
    /// The boxes as corners, for engines that take those.
    pub corners: Vec<Aabb>,
    /// The radii.
    pub radii: Vec<f32>,
    /// The poses, for what culls by more than boxes.
    pub bodies: Bodies,
    /// What is asked of the boxes, instead of their pairs.
    pub question: Option<(Question, Arc<Questions>)>,
}

impl Frame {
    /// Takes over the poses. Every shape's ball is about its body's origin.
    pub fn fill(&mut self, bodies: &Bodies, shapes: &[Shape]) {
        self.take(bodies, shapes);
        let boxes = bodies.translation.iter().zip(&self.radii);
        let boxes = boxes.map(|(t, &r)| t.map(|x| [x - r, x + r])).collect();
        self.set_boxes(boxes);
    }

    /// Copies the poses and makes boxes with [`LONG_SIDES`] instead of balls; the body's shape
    /// number selects the order of the sides.
    pub fn fill_long(&mut self, bodies: &Bodies, shapes: &[Shape]) {
        self.take(bodies, shapes);
        let boxes = bodies.translation.iter().zip(&bodies.shape);
        let boxes = boxes.map(|(t, &shape)| {
            let order = ORDERS[shape as usize % ORDERS.len()];
            [0, 1, 2]
                .map(|axis| [t[axis] - LONG_SIDES[order[axis]], t[axis] + LONG_SIDES[order[axis]]])
        });
        self.set_boxes(boxes.collect());
    }

    fn take(&mut self, bodies: &Bodies, shapes: &[Shape]) {
        self.bodies.clone_from(bodies);
        let radius = |&shape: &u32| shapes[shape as usize].ball.radius;
        self.radii.clear();
        self.radii.extend(bodies.shape.iter().map(radius));
    }

    /// Takes over boxes.
    pub fn set_boxes(&mut self, boxes: Vec<Slabs>) {
        self.boxes = boxes;
        let corners = |slabs| Aabb::new(lower(slabs), upper(slabs));
        self.corners = self.boxes.iter().map(corners).collect();
    }

    /// The number of a column's body.
    pub fn body(&self, at: usize) -> u32 {
        self.changed.as_ref().map_or(at as u32, |changed| changed[at])
    }

    /// Each changed body with its box.
    pub fn changes(&self) -> impl Iterator<Item = (u32, &Slabs)> {
        self.boxes.iter().enumerate().map(|(at, slabs)| (self.body(at), slabs))
    }
}

/// Half sides of a long box, 1 : 8 : 64, with the volume of a cube of half side 1.
pub const LONG_SIDES: [f32; 3] = [0.125, 1.0, 8.0];

/// All orders of three sides.
pub const ORDERS: [[usize; 3]; 6] =
    [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0], [1, 0, 2], [0, 2, 1]];

/// The lower corner.
pub fn lower(slabs: &Slabs) -> [f32; 3] {
    slabs.map(|[lo, _]| lo)
}

/// The upper corner.
pub fn upper(slabs: &Slabs) -> [f32; 3] {
    slabs.map(|[_, hi]| hi)
}

/// Whether closed boxes meet. Without a branch, because callers have already rejected most pairs.
#[inline(always)]
pub fn meet(a: &Slabs, b: &Slabs) -> bool {
    let on = |axis: usize| (a[axis][0] <= b[axis][1]) & (b[axis][0] <= a[axis][1]);
    on(0) & on(1) & on(2)
}
