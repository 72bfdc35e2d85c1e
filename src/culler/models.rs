//! Models: what updates and pair tests need of each shape, its frame and its slab table, by model
//! number.
//!
//! The first models are the shapes themselves. A shape with a margin is another model, whose ball
//! and slabs are moved out by the margin. Pair tests therefore need not know of margins.

use crate::overlap::ordop::SlabTables;
use crate::overlap::ordop::reach::reach;
use crate::rounding::up;
use crate::settings::CullSettings;
use crate::update::{ShapeFrame, ShapeFrames};
use crate::volume::{DirectionSet, Hull, OrDop, Shape};

/// Frames and tables of all models. The numbers of removed models are reused.
#[derive(Clone, Debug)]
pub(crate) struct Models {
    pub frames: ShapeFrames,
    pub tables: SlabTables,
    /// The slabs of every model: an or-DOP, or an oriented box.
    ordops: Vec<OrDop>,
    /// Numbers of removed models.
    free: Vec<u32>,
    /// How many hull numbers there are: one per shape, including those of removed shapes.
    hulls: u32,
    free_hulls: Vec<u32>,
    /// Whether an oriented box replaces each or-DOP.
    boxes: bool,
    /// Whether the strategy has no sphere test, so that or-DOPs are binned by balls of their own.
    alone: bool,
}

impl Models {
    /// One model per shape.
    pub fn new(shapes: &[Shape], settings: &CullSettings) -> Self {
        let scheme = settings.strategy.scheme();
        let mut models = Self {
            frames: ShapeFrames::default(),
            tables: SlabTables::new(settings.k, std::iter::empty()),
            ordops: Vec::new(),
            free: Vec::new(),
            hulls: 0,
            free_hulls: Vec::new(),
            boxes: scheme.has_boxes(),
            alone: scheme.is_oriented_alone(),
        };
        for shape in shapes {
            models.add(shape);
        }
        models
    }

    /// The slab directions that another shape must have: those of the existing ones, unless
    /// oriented boxes replace them.
    pub fn directions(&self) -> Option<DirectionSet> {
        (!self.boxes && self.shapes() > 0).then(|| self.tables.directions())
    }

    /// How many models are shapes without a margin.
    fn shapes(&self) -> usize {
        self.hulls as usize - self.free_hulls.len()
    }

    /// The slabs of a model, and its frame.
    pub fn volumes(&self, model: u32) -> (&OrDop, &ShapeFrame) {
        (&self.ordops[model as usize], &self.frames[model as usize])
    }

    /// Adds the model of a shape and returns its number. Its hull has another number
    /// ([`ShapeFrame::hull`]), which counts from 0 in the order of these calls as long as no shape
    /// is removed.
    pub fn add(&mut self, shape: &Shape) -> u32 {
        let ordop = self.ordop_of(shape);
        if self.frames.is_empty() {
            self.tables = SlabTables::new(ordop.directions, std::iter::empty());
        }
        let hull = self.free_hulls.pop().unwrap_or_else(|| {
            self.hulls += 1;
            self.hulls - 1
        });
        let frame = ShapeFrame::new(shape, &ordop.basis).numbered(hull);
        self.put(frame, ordop)
    }

    /// Adds a model that is another one grown by `margin`, and returns its number.
    pub fn grow(&mut self, model: u32, margin: f32) -> u32 {
        let ordop = self.ordops[model as usize].grown(margin);
        let frame = self.frames[model as usize].grown(margin);
        self.put(frame, ordop)
    }

    /// Replaces a shape's model by that of another shape. Models that were grown from it stay as
    /// they are.
    pub fn replace(&mut self, model: u32, shape: &Shape) {
        let ordop = self.ordop_of(shape);
        let hull = self.frames[model as usize].hull();
        let frame = ShapeFrame::new(shape, &ordop.basis).numbered(hull);
        self.set(model as usize, frame, ordop);
    }

    /// Removes a grown model.
    pub fn remove(&mut self, model: u32) {
        self.free.push(model);
    }

    /// Removes the model of a shape, after all models grown from it. Returns the number of its
    /// hull.
    pub fn remove_shape(&mut self, model: u32) -> u32 {
        let hull = self.frames[model as usize].hull();
        self.free_hulls.push(hull);
        self.remove(model);
        if self.shapes() == 0 {
            (self.free, self.ordops) = Default::default();
            (self.frames, self.hulls, self.free_hulls) = Default::default();
            self.tables = SlabTables::new(self.tables.directions(), std::iter::empty());
        }
        hull
    }

    /// Frees the memory of removed models and hulls at the end of the columns. Returns how many
    /// hulls are left.
    pub fn shrink_to_fit(&mut self) -> usize {
        let models = without_last(&mut self.free, self.ordops.len());
        self.ordops.truncate(models);
        self.ordops.shrink_to_fit();
        self.frames.shrink_to(models);
        self.tables.shrink_to(models);
        let hulls = without_last(&mut self.free_hulls, self.hulls as usize);
        self.hulls = hulls as u32;
        hulls
    }

    fn ordop_of(&self, shape: &Shape) -> OrDop {
        if self.boxes { shape.obb(&Hull::of(&shape.vertices)) } else { shape.ordop.clone() }
    }

    /// Adds a model, under the number of a removed one if there is any, and returns its number.
    fn put(&mut self, frame: ShapeFrame, ordop: OrDop) -> u32 {
        if let Some(number) = self.free.pop() {
            self.set(number as usize, frame, ordop);
            return number;
        }
        let number = self.frames.len();
        self.tables.push(&ordop, frame.centre(), frame.reach());
        self.ordops.push(ordop);
        self.frames.push(self.binned(frame, number));
        number as u32
    }

    fn set(&mut self, number: usize, frame: ShapeFrame, ordop: OrDop) {
        self.tables.set(number, &ordop, frame.centre(), frame.reach());
        self.ordops[number] = ordop;
        self.frames.set(number, self.binned(frame, number));
    }

    /// The frame with the radius that a pair finder uses.
    fn binned(&self, frame: ShapeFrame, number: usize) -> ShapeFrame {
        if !self.alone {
            return frame;
        }
        let k = self.tables.directions().k();
        let radius = up(reach(self.tables.shape(number), k, frame.reach()));
        frame.with_radius(radius)
    }
}

/// How many of `all` numbers remain once the free ones at the end are cut off; those are removed
/// from `free`.
fn without_last(free: &mut Vec<u32>, all: usize) -> usize {
    free.sort_unstable();
    let mut left = all;
    while let Some(last) = free.pop() {
        if last as usize + 1 != left {
            free.push(last);
            break;
        }
        left -= 1;
    }
    free.shrink_to_fit();
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free numbers at the end are dropped.
    #[test]
    fn free_tail_numbers_are_dropped() {
        for (mut free, all, left, kept) in [
            (vec![], 5, 5, vec![]),
            (vec![4, 1, 3], 5, 3, vec![1]),
            (vec![0, 1], 2, 0, vec![]),
            (vec![1, 0], 3, 3, vec![0, 1]),
        ] {
            assert_eq!(without_last(&mut free, all), left);
            assert_eq!(free, kept);
        }
    }
}
