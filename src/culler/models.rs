//! What updates and pair tests know of each shape: its frame and its slab table, by model number.
//!
//! The first models are the shapes themselves. A shape with a margin is a further model: the ball, and each slab, moved
//! out by the margin, so that the pair tests need not know of margins.

use crate::overlap::ordop::SlabTables;
use crate::overlap::ordop::reach::reach;
use crate::rounding::up;
use crate::settings::CullSettings;
use crate::update::{Frames, ShapeFrame};
use crate::volume::{DirectionSet, Hull, OrDop, Shape};

/// Frames and tables of all models.
#[derive(Debug)]
pub(crate) struct Models {
    pub frames: Frames,
    pub tables: SlabTables,
    /// The slabs of every model: an or-DOP, or an oriented box.
    ordops: Vec<OrDop>,
    /// How many of the models are shapes as they were given.
    shapes: u32,
    /// Whether an oriented box takes the place of each or-DOP.
    boxes: bool,
    /// Whether the or-DOP decides without a sphere, and is binned by its own ball.
    alone: bool,
}

impl Models {
    /// One model per shape. For oriented boxes a box takes the place of the or-DOP.
    pub fn new(shapes: &[Shape], settings: &CullSettings) -> Self {
        let scheme = settings.strategy.scheme();
        let mut models = Self {
            frames: Frames::default(),
            tables: SlabTables::new(settings.k, std::iter::empty()),
            ordops: Vec::new(),
            shapes: 0,
            boxes: scheme.has_boxes(),
            alone: scheme.is_oriented_alone(),
        };
        for shape in shapes {
            models.add(shape);
        }
        models
    }

    /// The slab directions that a further shape must have: those of the first, unless its own box is taken.
    pub fn directions(&self) -> Option<DirectionSet> {
        (!self.boxes && self.shapes > 0).then(|| self.tables.directions())
    }

    /// Adds the model of a shape; returns its number. The shapes' hulls are counted apart, from 0 in the order of these calls.
    pub fn add(&mut self, shape: &Shape) -> u32 {
        let ordop = if self.boxes {
            shape.obb(&Hull::of(&shape.vertices))
        } else {
            shape.ordop.clone()
        };
        if self.frames.is_empty() {
            self.tables = SlabTables::new(ordop.directions, std::iter::empty());
        }
        let frame = ShapeFrame::new(shape, &ordop.basis).numbered(self.shapes);
        self.shapes += 1;
        self.push(frame, ordop)
    }

    /// Adds the model of another grown by `margin`; returns its number.
    pub fn grow(&mut self, model: u32, margin: f32) -> u32 {
        let ordop = self.ordops[model as usize].grown(margin);
        let frame = self.frames[model as usize].grown(margin);
        self.push(frame, ordop)
    }

    fn push(&mut self, frame: ShapeFrame, ordop: OrDop) -> u32 {
        let number = self.frames.len();
        self.tables.push(&ordop, frame.centre(), frame.reach());
        self.ordops.push(ordop);
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
