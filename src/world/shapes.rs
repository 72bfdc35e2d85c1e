//! The shapes of a world: how they are added, replaced and removed.
//!
//! A world keeps no meshes: the culler has the volumes of each shape. The number of a removed shape
//! is reused.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use super::{Meshes, World, WorldError};
use crate::bodies::contract::{ContractError, refuse};
use crate::living::Members;
use crate::posed::ShapeVolumes;
use crate::volume::Shape;

/// The next [`ShapeSlot::stamp`].
static NEXT_STAMP: AtomicU64 = AtomicU64::new(1);

/// The data of a shape's number.
#[derive(Clone, Debug)]
pub(super) struct ShapeSlot {
    pub name: String,
    /// The largest distance of a point of the shape from the body origin.
    pub reach: f32,
    /// The position of the origin of the shape's vertices, relative to the point that poses place.
    pub pose_offset: [f64; 3],
    /// The ball about the shape: its centre relative to the point that poses place, and its radius.
    pub ball: ([f64; 3], f64),
    /// Number of bodies with this shape.
    pub bodies: usize,
    pub is_present: bool,
    /// By which copies of the shape know whether they are up to date. Worlds and their clones share
    /// no other stamps.
    pub stamp: u64,
    pub digest: u64,
}

impl ShapeSlot {
    pub fn new(shape: &Shape) -> Self {
        let (ball, offset) = (&shape.ball, shape.pose_offset);
        let centre = [0, 1, 2].map(|axis| f64::from(ball.centre[axis]) + offset[axis]);
        Self {
            name: shape.name.clone(),
            reach: shape.reach,
            pose_offset: offset,
            ball: (centre, ball.radius.into()),
            bodies: 0,
            is_present: true,
            stamp: NEXT_STAMP.fetch_add(1, Relaxed),
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
    /// Adds a shape and returns its number, the lowest free one.
    ///
    /// # Errors
    /// The shape is outside of the contract, or has other slab directions than the present ones.
    /// Nothing is added.
    pub fn add_shape(&mut self, shape: Shape) -> Result<u32, WorldError> {
        let model = self.volumes.culler.add_shape_about_vertices(&shape)?;
        let slot = ShapeSlot::new(&shape);
        let number = self.volumes.shapes.iter().position(|slot| !slot.is_present);
        let number = number.unwrap_or(self.volumes.shapes.len());
        if number == self.volumes.shapes.len() {
            self.volumes.shapes.push(slot);
            self.volumes.models.push(model);
        } else {
            (self.volumes.shapes[number], self.volumes.models[number]) = (slot, model);
        }
        Ok(number as u32)
    }

    /// Removes a shape that no body uses. Its number and memory are reused for the next shape that
    /// is added.
    ///
    /// # Errors
    /// No shape has the number, or a body uses the shape. Nothing is removed.
    pub fn remove_shape(&mut self, shape: u32) -> Result<(), WorldError> {
        let at = self.volumes.shape_at(shape)?;
        if self.volumes.shapes[at].bodies > 0 {
            let has = self.members.ids.filled().find(|&slot| self.volumes.shape[slot] == shape);
            return Err(has.map_or(WorldError::NoShape(shape), |slot| WorldError::ShapeInUse {
                shape,
                name: self.volumes.shapes[at].name.clone(),
                body: self.members.ids.id(slot as u32),
            }));
        }
        self.volumes.remove_grown(self.volumes.models[at]);
        self.volumes.culler.remove_shape(self.volumes.models[at]);
        self.volumes.shapes[at].is_present = false;
        Ok(())
    }

    /// Replaces a shape by another: its bodies have the new shape from the next cull on.
    ///
    /// # Errors
    /// No shape has the number, the new shape is outside of the contract, alone or with the margin
    /// of a body, or it has other slab directions than the other shapes. Nothing is replaced.
    pub fn replace_shape(&mut self, number: u32, shape: &Shape) -> Result<(), WorldError> {
        let at = self.volumes.shape_at(number)?;
        let filled = self.members.ids.filled();
        let with_shape: Vec<usize> =
            filled.filter(|&slot| self.volumes.shape[slot] == number).collect();
        for &slot in &with_shape {
            let body = self.members.ids.id(slot as u32).slot();
            super::check_margin(body, shape.reach, self.volumes.margin[slot])?;
        }
        self.volumes.culler.replace_shape(self.volumes.models[at], shape)?;
        self.volumes.remove_grown(self.volumes.models[at]);
        let bodies = self.volumes.shapes[at].bodies;
        self.volumes.shapes[at] = ShapeSlot { bodies, ..ShapeSlot::new(shape) };
        for slot in with_shape {
            self.members.note(slot, false);
        }
        self.members.replaced = true; // bodies that don't move have it, too
        Ok(())
    }

    /// The numbers of all shapes.
    pub fn shapes(&self) -> impl Iterator<Item = u32> + '_ {
        let slots = (0..).zip(&self.volumes.shapes);
        slots.filter(|(_, slot)| slot.is_present).map(|(number, _)| number)
    }

    /// The digest of a present shape.
    pub(crate) fn shape_digest(&self, number: u32) -> Option<u64> {
        self.volumes.shape_at(number).ok().map(|at| self.volumes.shapes[at].digest)
    }
}

impl Meshes {
    /// One more than the largest shape number.
    pub(super) fn shape_numbers(&self) -> usize {
        let last = self.shapes.iter().rposition(|slot| slot.is_present);
        last.map_or(0, |last| last + 1)
    }

    fn shape_at(&self, number: u32) -> Result<usize, WorldError> {
        let at = number as usize;
        let slot = self.shapes.get(at).filter(|slot| slot.is_present);
        slot.map(|_| at).ok_or(WorldError::NoShape(number))
    }

    /// Removes the models that were grown from this one.
    fn remove_grown(&mut self, model: u32) {
        let culler = &mut self.culler;
        self.margins.remove(model, |grown| culler.remove_grown(grown));
    }

    /// Removes the models of margins that no body uses any more, if there are many. Every body
    /// keeps its model.
    pub(super) fn sweep_margins(&mut self, members: &Members, are_many: bool) {
        if are_many && !self.margins.are_many() {
            return;
        }
        let mut used = vec![false; self.culler.models()];
        for slot in members.ids.filled() {
            used[self.bodies.shape[slot] as usize] = true;
        }
        let culler = &mut self.culler;
        self.margins.sweep(&used, |grown| culler.remove_grown(grown));
    }

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
