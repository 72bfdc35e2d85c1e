//! What queries know of a world's shapes.

use super::World;
use crate::update::ShapeFrame;
use crate::volume::OrDop;

pub(crate) use super::offset::compose;

/// The volumes of a shape, and where the origin of its vertices lies, seen from the point that
/// poses refer to.
pub(crate) type ShapeVolumes<'a> = (&'a OrDop, &'a ShapeFrame, [f64; 3]);

impl World {
    /// The volumes of each number that a shape may have.
    pub(crate) fn shape_volumes(&self) -> impl Iterator<Item = Option<ShapeVolumes<'_>>> {
        let slots = self.shapes.iter().zip(&self.models);
        slots.map(|(slot, &model)| {
            slot.is_present.then(|| {
                let (ordop, frame) = self.culler.volumes(model);
                (ordop, frame, slot.pose_offset)
            })
        })
    }
}
