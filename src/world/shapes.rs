//! The shapes of a world, from the call that adds them to the call that removes them.
//!
//! A world keeps no meshes: the culler has what it needs of each shape, and a number of a shape
//! that is gone is given again.

use super::{World, WorldError};
use crate::bodies::contract::{ContractError, refuse};
use crate::volume::Shape;

/// What a world knows of a shape's number.
#[derive(Clone, Debug)]
pub(super) struct ShapeSlot {
    pub name: String,
    /// No point of the shape is farther from the body origin.
    pub reach: f32,
    /// Where the origin of the shape's vertices lies, seen from the point that poses refer to.
    pub pose_offset: [f64; 3],
    /// How many bodies have it.
    pub bodies: usize,
    pub is_present: bool,
    #[cfg(feature = "serde")]
    pub digest: u64,
}

impl ShapeSlot {
    pub fn new(shape: &Shape) -> Self {
        Self {
            name: shape.name.clone(),
            reach: shape.reach,
            pose_offset: shape.pose_offset,
            bodies: 0,
            is_present: true,
            #[cfg(feature = "serde")]
            digest: super::digest::of(shape),
        }
    }
}

/// Checks that the shape of a body is in the world; returns its reach.
pub(super) fn check_shape(
    body: usize,
    number: u32,
    shapes: &[ShapeSlot],
) -> Result<f32, ContractError> {
    match shapes.get(number as usize) {
        Some(slot) if slot.is_present => return Ok(slot.reach),
        Some(slot) => {
            let value = format!("{number} (`{}`) was removed", slot.name);
            refuse(body, "shape", value, "add it again, or take another")?;
        }
        None => {
            let value = format!("{number} of {}", shapes.len());
            refuse(body, "shape", value, "shapes are counted from 0")?;
        }
    }
    Ok(0.0)
}

impl World {
    /// Adds a shape. Bodies take it by the returned number: the lowest that no shape has.
    ///
    /// # Errors
    /// A shape beyond the contract, or with other slab directions than those before; nothing is
    /// added.
    pub fn add_shape(&mut self, shape: Shape) -> Result<u32, WorldError> {
        let model = self.culler.add_shape_about_vertices(&shape)?;
        let slot = ShapeSlot::new(&shape);
        let number = self.shapes.iter().position(|slot| !slot.is_present);
        let number = number.unwrap_or(self.shapes.len());
        if number == self.shapes.len() {
            self.shapes.push(slot);
            self.models.push(model);
        } else {
            (self.shapes[number], self.models[number]) = (slot, model);
        }
        Ok(number as u32)
    }

    /// Removes a shape that no body has. Its number is given to the next shape that is added, and
    /// its memory serves again.
    ///
    /// # Errors
    /// A number that no shape has, a shape that some body has; nothing is removed.
    pub fn remove_shape(&mut self, shape: u32) -> Result<(), WorldError> {
        let at = self.shape_at(shape)?;
        if self.shapes[at].bodies > 0 {
            let mut bodies = self.ids();
            let has = bodies.find(|id| self.shape[id.slot()] == shape);
            return Err(
                has.map_or(WorldError::NoShape(shape), |body| WorldError::ShapeInUse {
                    shape,
                    name: self.shapes[at].name.clone(),
                    body,
                }),
            );
        }
        self.remove_grown(self.models[at]);
        self.culler.remove_shape(self.models[at]);
        self.shapes[at].is_present = false;
        Ok(())
    }

    /// Puts a shape in the place of another: the bodies that have the other one have this one from
    /// the next cull on.
    ///
    /// # Errors
    /// A number that no shape has, a shape beyond the contract, or so large that with the margin of
    /// some body it is; other slab directions than the other shapes have. Nothing is replaced.
    pub fn replace_shape(&mut self, number: u32, shape: &Shape) -> Result<(), WorldError> {
        let at = self.shape_at(number)?;
        let with_shape = self.ids.iter().map(|id| id.slot());
        let with_shape: Vec<usize> = with_shape
            .filter(|&slot| self.shape[slot] == number)
            .collect();
        for &slot in &with_shape {
            super::check_margin(slot, shape.reach, self.margin[slot])?;
        }
        self.culler.replace_shape(self.models[at], shape)?;
        self.remove_grown(self.models[at]);
        let bodies = self.shapes[at].bodies;
        self.shapes[at] = ShapeSlot {
            bodies,
            ..ShapeSlot::new(shape)
        };
        for slot in with_shape {
            self.movers.note(slot, &self.ids);
        }
        self.replaced = true; // bodies that don't move have it, too
        Ok(())
    }

    /// The numbers that shapes have.
    pub fn shapes(&self) -> impl Iterator<Item = u32> + '_ {
        let slots = (0..).zip(&self.shapes);
        slots
            .filter(|(_, slot)| slot.is_present)
            .map(|(number, _)| number)
    }

    /// One above the number of every shape.
    pub(super) fn shape_numbers(&self) -> usize {
        let last = self.shapes.iter().rposition(|slot| slot.is_present);
        last.map_or(0, |last| last + 1)
    }

    fn shape_at(&self, number: u32) -> Result<usize, WorldError> {
        let at = number as usize;
        let slot = self.shapes.get(at).filter(|slot| slot.is_present);
        slot.map(|_| at).ok_or(WorldError::NoShape(number))
    }

    /// Removes the models that were grown of one.
    fn remove_grown(&mut self, model: u32) {
        let culler = &mut self.culler;
        self.margins
            .remove(model, |grown| culler.remove_grown(grown));
    }

    /// Removes the models of margins that no body has any more, if they are many. Every body has
    /// the model that it needs.
    pub(super) fn sweep_margins(&mut self, are_many: bool) {
        if are_many && !self.margins.are_many() {
            return;
        }
        let mut used = vec![false; self.culler.models()];
        for id in self.ids.iter() {
            used[self.bodies.shape[id.slot()] as usize] = true;
        }
        let culler = &mut self.culler;
        self.margins
            .sweep(&used, |grown| culler.remove_grown(grown));
    }
}
