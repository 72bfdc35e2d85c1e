//! Adding and removing a culler's shapes and their grown models.

use super::{CullError, Culler, check};
use crate::simd::in_default_mode;
use crate::update::ShapeFrame;
use crate::volume::{OrDop, Shape};

impl Culler {
    /// Adds a shape and returns its number. Bodies have it by that number in `bodies.shape`, from
    /// the next [`Self::refresh`] on.
    ///
    /// # Errors
    /// A shape that breaks the contract, that is far from its origin, or that has slab directions
    /// other than those before. Nothing is added.
    pub fn add_shape(&mut self, shape: &Shape) -> Result<u32, CullError> {
        check::near(std::slice::from_ref(shape))?;
        self.add_shape_about_vertices(shape)
    }

    /// As [`Self::add_shape`], for poses that place the origin of the shape's vertices.
    pub(crate) fn add_shape_about_vertices(&mut self, shape: &Shape) -> Result<u32, CullError> {
        in_default_mode(|| {
            check::shape(shape, self.models.directions())?;
            let model = self.models.add(shape);
            self.set_hull(model, shape);
            Ok(model)
        })
    }

    /// Replaces a shape by another under the same number. Models that were grown from the former
    /// one stay as they are, and so do the volumes of static bodies until bodies are exchanged.
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

    /// Removes a shape that no body has and no model is grown from. Its number will be reused.
    pub(crate) fn remove_shape(&mut self, model: u32) {
        let hull = self.models.remove_shape(model);
        if let Some(intervals) = &mut self.volumes.intervals {
            intervals.clear(hull as usize);
        }
    }

    /// Adds a model that is another one grown by `margin` ≥ 0, and returns its number for
    /// `bodies.shape`.
    pub(crate) fn grow(&mut self, model: u32, margin: f32) -> u32 {
        self.models.grow(model, margin)
    }

    /// Removes a grown model that no body has. Its number will be reused.
    pub(crate) fn remove_grown(&mut self, model: u32) {
        self.models.remove(model);
    }

    /// The slabs and the frame of a model.
    pub(crate) fn volumes(&self, model: u32) -> (&OrDop, &ShapeFrame) {
        self.models.volumes(model)
    }

    /// The number of models: one more than the largest model number.
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
