//! What every engine is handed: world-aligned boxes, as the lower and upper end on each axis.
//!
//! Intervals are closed: boxes that touch are a pair. The ends are fl(t − r) and fl(t + r), the same bits for everyone.

use sdop::bodies::Bodies;
use sdop::volume::Shape;

/// The slabs [lo, hi] of a box on the world axes.
pub type Slabs = [[f32; 2]; 3];

/// One frame of a scene.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// The box of every body.
    pub boxes: Vec<Slabs>,
    /// The radius of every body.
    pub radii: Vec<f32>,
    /// The poses, for what culls by more than boxes.
    pub bodies: Bodies,
}

impl Frame {
    /// Takes over the poses. Every shape's ball is about its body's origin.
    pub fn fill(&mut self, bodies: &Bodies, shapes: &[Shape]) {
        self.bodies.clone_from(bodies);
        let radius = |&shape: &u32| shapes[shape as usize].ball.radius;
        self.radii.clear();
        self.radii.extend(bodies.shape.iter().map(radius));
        let slabs = |(t, &r): (&[f32; 3], &f32)| t.map(|x| [x - r, x + r]);
        self.boxes.clear();
        self.boxes
            .extend(bodies.translation.iter().zip(&self.radii).map(slabs));
    }
}

/// The lower corner.
pub fn lower(slabs: &Slabs) -> [f32; 3] {
    slabs.map(|[lo, _]| lo)
}

/// The upper corner.
pub fn upper(slabs: &Slabs) -> [f32; 3] {
    slabs.map(|[_, hi]| hi)
}

/// Whether closed boxes meet. Without a branch: engines that ask have mostly sifted before.
#[inline(always)]
pub fn meet(a: &Slabs, b: &Slabs) -> bool {
    let on = |axis: usize| (a[axis][0] <= b[axis][1]) & (b[axis][0] <= a[axis][1]);
    on(0) & on(1) & on(2)
}
