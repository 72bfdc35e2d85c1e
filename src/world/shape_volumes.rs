//! The shapes of a world, for queries.

use super::Meshes;
use crate::update::ShapeFrame;
use crate::volume::OrDop;

pub(crate) use super::offset::{compose, reach_about_pose};

/// The volumes of a shape.
#[derive(Clone, Copy)]
pub(crate) struct ShapeVolumes<'a> {
    pub ordop: &'a OrDop,
    /// Where or-DOPs are tested alone, its radius is that by which a finder bins them.
    pub frame: &'a ShapeFrame,
    /// The radius of the ball about the shape.
    pub radius: f64,
    /// The position of the vertices' origin relative to the point that poses place.
    pub pose_offset: [f64; 3],
    /// No other shape of any world has it, except in a world's clones.
    pub stamp: u64,
}

impl Meshes {
    /// The ball about a present shape: its centre relative to the point that poses place, and its
    /// radius.
    pub(crate) fn ball(&self, shape: u32) -> ([f64; 3], f64) {
        self.shapes[shape as usize].ball
    }

    /// The volumes of each shape number, or `None` if it is free.
    pub(crate) fn shape_volumes(&self) -> impl Iterator<Item = Option<ShapeVolumes<'_>>> {
        let slots = self.shapes.iter().zip(&self.models);
        slots.map(|(slot, &model)| {
            slot.is_present.then(|| {
                let (ordop, frame) = self.culler.volumes(model);
                ShapeVolumes {
                    ordop,
                    frame,
                    radius: slot.ball.1,
                    pose_offset: slot.pose_offset,
                    stamp: slot.stamp,
                }
            })
        })
    }
}
