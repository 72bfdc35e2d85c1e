//! The contract's checks of shapes, and of bodies that have them.

use glam::Vec3;

use super::Shape;
use crate::bodies::Bodies;
use crate::bodies::contract::{ContractError, check_columns, check_poses, refuse, refuse_number};
use crate::rounding::LIMIT;

/// Checks every body against the contract: |t|∞ ≤ 2⁶⁰, 0 < |q|² < ∞, and a shape that exists and is
/// at most 2⁶⁰ in size; and that there are no more bodies than can be numbered.
///
/// # Errors
/// The first body that breaks it, in the first invalid column; columns of unequal length.
pub fn check_bodies(bodies: &Bodies, shapes: &[Shape]) -> Result<(), ContractError> {
    check_columns(bodies)?;
    let sound: Vec<bool> = shapes.iter().map(has_sound_size).collect();
    for (body, &number) in bodies.shape.iter().enumerate() {
        if sound.get(number as usize) != Some(&true) {
            return check_shape(body, number, shapes);
        }
    }
    check_poses(bodies, 0..bodies.len())
}

/// Checks that a body's shape exists and is at most 2⁶⁰ in size.
pub(crate) fn check_shape(body: usize, number: u32, shapes: &[Shape]) -> Result<(), ContractError> {
    let Some(shape) = shapes.get(number as usize) else {
        return refuse_number(body, number, shapes.len());
    };
    if !has_sound_size(shape) {
        let Shape { name, reach, ball, .. } = shape;
        let value = format!("{name} with reach {reach} and {ball:?}");
        return refuse(body, "shape", value, "sizes are finite and at most 2^60");
    }
    Ok(())
}

pub(crate) fn has_sound_size(shape: &Shape) -> bool {
    // The reach bounds the ball's centre and radius, but does not exclude a NaN in them.
    [shape.reach, shape.ball.radius, Vec3::from_array(shape.ball.centre).length()]
        .iter()
        .all(|size| (0.0..=LIMIT).contains(size))
}
