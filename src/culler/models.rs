//! What updates and pair tests know of each shape: its frame and its slab table, by model number.
//!
//! The first models are the shapes themselves. A shape with a margin is a further model: the ball, and each slab, moved
//! out by the margin, so that the pair tests need not know of margins.

use crate::overlap::ordop::SlabTables;
use crate::overlap::ordop::reach::reach;
use crate::rounding::up;
use crate::settings::{CullSettings, Strategy};
use crate::update::ShapeFrame;
use crate::volume::{DirectionSet, Hull, OrDop, Shape};

/// Frames and tables of all models.
#[derive(Debug)]
pub(crate) struct Models {
    pub frames: Vec<ShapeFrame>,
    pub tables: SlabTables,
    /// The slabs of every shape: its or-DOP, or its oriented box.
    ordops: Vec<OrDop>,
    /// Whether the or-DOP decides without a sphere, and is binned by its own ball.
    alone: bool,
}

impl Models {
    /// One model a shape. For [`Strategy::Obb`] a box takes the place of the or-DOP.
    pub fn new(shapes: &[Shape], settings: &CullSettings) -> Self {
        let boxes = settings.strategy == Strategy::Obb;
        let slabs = |shape: &Shape| {
            if boxes {
                shape.obb(&Hull::of(&shape.vertices))
            } else {
                shape.ordop.clone()
            }
        };
        let ordops: Vec<OrDop> = shapes.iter().map(slabs).collect();
        let directions = if boxes {
            DirectionSet::K6
        } else {
            ordops.first().map_or(settings.k, |ordop| ordop.directions)
        };
        let mut models = Self {
            frames: Vec::new(),
            tables: SlabTables::new(directions, shapes.iter().zip(&ordops)),
            ordops,
            alone: boxes || settings.strategy == Strategy::OrDop,
        };
        for (number, (shape, ordop)) in shapes.iter().zip(&models.ordops).enumerate() {
            let frame = ShapeFrame::new(shape, &ordop.basis).numbered(number as u32);
            models.frames.push(models.binned(frame, number));
        }
        models
    }

    /// Adds the model of a shape grown by `margin`; returns its number.
    pub fn grow(&mut self, shape: u32, margin: f32) -> u32 {
        let number = self.frames.len();
        let ordop = self.ordops[shape as usize].grown(margin);
        let frame = self.frames[shape as usize].grown(margin);
        self.tables.push(&ordop, frame.centre(), frame.reach());
        self.frames.push(self.binned(frame, number));
        number as u32
    }

    /// The frame with the radius that a pair finder needs.
    fn binned(&self, frame: ShapeFrame, number: usize) -> ShapeFrame {
        if !self.alone {
            return frame;
        }
        let k = self.tables.directions().k();
        let radius = up(reach(self.tables.shape(number), k, frame.reach()));
        frame.with_radius(radius)
    }
}
