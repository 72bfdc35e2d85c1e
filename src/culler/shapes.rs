//! Shapes and their grown models, from the first body that takes them to the last.

use super::{CullError, Culler, check};
use crate::simd::in_default_mode;
use crate::update::ShapeFrame;
use crate::volume::{OrDop, Shape};

impl Culler {
    /// Adds a shape. Bodies take it by the returned number in `bodies.shape`, from the next
    /// [`Self::refresh`] on.
    ///
    /// # Errors
    /// A shape beyond the contract, far from its origin, or with other slab directions than those
    /// before; nothing is added.
    pub fn add_shape(&mut self, shape: &Shape) -> Result<u32, CullError> {
        check::near(std::slice::from_ref(shape))?;
        self.add_shape_about_vertices(shape)
    }

    /// The same of poses that place the origin of the shape's vertices.
    pub(crate) fn add_shape_about_vertices(&mut self, shape: &Shape) -> Result<u32, CullError> {
        in_default_mode(|| {
            check::shape(shape, self.models.directions())?;
            let model = self.models.add(shape);
            self.set_hull(model, shape);
            Ok(model)
        })
    }

    /// Puts a shape in the place of another, whose number it takes. Models that were grown of the
    /// other one stay as they are, and so do the volumes of bodies that don't move, until bodies
    /// are exchanged.
    ///
    /// # Errors
    /// As [`Self::add_shape`]; nothing is replaced.
    pub(crate) fn replace_shape(&mut self, model: u32, shape: &Shape) -> Result<(), CullError> {
        in_default_mode(|| {
            check::shape(shape, self.models.directions())?;
            self.models.replace(model, shape);
            self.set_hull(model, shape);
            Ok(())
        })
    }

    /// Removes a shape that no body takes, and of which no model is grown any more. Its number is
    /// given again.
    pub(crate) fn remove_shape(&mut self, model: u32) {
        let hull = self.models.remove_shape(model);
        if let Some(intervals) = &mut self.volumes.intervals {
            intervals.clear(hull as usize);
        }
    }

    /// Adds a model: another grown by `margin` ≥ 0. A body takes it when `bodies.shape` has the
    /// returned number.
    pub(crate) fn grow(&mut self, model: u32, margin: f32) -> u32 {
        self.models.grow(model, margin)
    }

    /// Removes a grown model that no body takes. Its number is given again.
    pub(crate) fn remove_grown(&mut self, model: u32) {
        self.models.remove(model);
    }

    /// The slabs and the frame of a model.
    pub(crate) fn volumes(&self, model: u32) -> (&OrDop, &ShapeFrame) {
        self.models.volumes(model)
    }

    /// One above the number of every model.
    pub(crate) fn models(&self) -> usize {
        self.models.frames.len()
    }

    fn set_hull(&mut self, model: u32, shape: &Shape) {
        let hull = self.models.frames[model as usize].hull();
        if let Some(intervals) = &mut self.volumes.intervals {
            intervals.set(hull as usize, shape);
        }
    }
}
