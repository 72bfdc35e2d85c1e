//! The contract between bodies and culling (design, section 4): within it, no strategy misses a pair.
//!
//! Checked where bodies enter and again after every effects step, so that a NaN is reported with its body's
//! number at the step that made it, and not as a wrong pair list frames later.

use miette::Diagnostic;
use thiserror::Error;

use super::bodies::Bodies;
use crate::rounding::LIMIT;
use crate::volume::Shape;

/// A body outside of the contract.
#[derive(Clone, Debug, PartialEq, Error, Diagnostic)]
#[error("body {body}: {problem}")]
pub struct ContractError {
    /// The body's index.
    pub body: usize,
    /// Which quantity has which impossible value.
    pub problem: String,
    /// How to mend it.
    #[help]
    pub hint: &'static str,
}

/// Checks every body against the contract: |t|∞ ≤ 2⁶⁰, 0 < |q|² < ∞, finite velocity and spin, a shape that exists and is no larger than 2⁶⁰.
///
/// # Errors
/// The first body that breaks it; columns of unequal length.
pub fn check_bodies(bodies: &Bodies, shapes: &[Shape]) -> Result<(), ContractError> {
    let n = bodies.shape.len();
    let columns = [
        bodies.dynamic.len(),
        bodies.rotation.len(),
        bodies.translation.len(),
        bodies.velocity.len(),
        bodies.spin.len(),
    ];
    if let Some(length) = columns.into_iter().find(|&length| length != n) {
        let problem = format!("a column has {length} entries where the shapes have {n}");
        return Err(ContractError {
            body: length.min(n),
            problem,
            hint: "give every column one entry a body",
        });
    }
    for (body, &shape) in bodies.shape.iter().enumerate() {
        let Some(shape) = shapes.get(shape as usize) else {
            let problem = format!("shape {shape} of {}", shapes.len());
            return Err(ContractError {
                body,
                problem,
                hint: "shapes are counted from 0",
            });
        };
        // The ball's centre and radius are bounded by the reach, but a NaN in them is not.
        let sizes = [shape.reach, shape.ball.radius, shape.ball.centre.length()];
        if !sizes.iter().all(|size| (0.0..=LIMIT).contains(size)) {
            let problem = format!(
                "shape {} has reach {} and ball {:?}",
                shape.name, shape.reach, shape.ball
            );
            return Err(ContractError {
                body,
                problem,
                hint: "sizes are finite and at most 2^60",
            });
        }
    }
    check_poses(bodies, 0..n)?;
    for (name, column) in [("velocity", &bodies.velocity), ("spin", &bodies.spin)] {
        if let Some(body) = column.iter().position(|v| !within_limit(v)) {
            return Err(beyond(body, name, &column[body]));
        }
    }
    Ok(())
}

/// Checks the poses of the bodies `range`: what an effects step may have changed.
pub(crate) fn check_poses(
    bodies: &Bodies,
    range: std::ops::Range<usize>,
) -> Result<(), ContractError> {
    let first = range.start;
    // One flag over the whole column, no early exit: it vectorises, and a frame that fails is the last one anyway.
    let translations = &bodies.translation[range.clone()];
    if translations
        .iter()
        .fold(true, |fine, t| fine & within_limit(t))
    {
        let rotations = &bodies.rotation[range];
        return match rotations.iter().position(|q| !invertible(q)) {
            None => Ok(()),
            Some(at) => Err(ContractError {
                body: first + at,
                problem: format!("rotation {:?}", rotations[at]),
                hint: "a quaternion (x, y, z, w) has a finite norm above zero",
            }),
        };
    }
    let at = translations
        .iter()
        .position(|t| !within_limit(t))
        .unwrap_or(0);
    Err(beyond(first + at, "translation", &translations[at]))
}

fn within_limit(v: &[f32; 3]) -> bool {
    // `!(x ≤ limit)` is the refusal, so that a NaN fails.
    (v[0].abs() <= LIMIT) & (v[1].abs() <= LIMIT) & (v[2].abs() <= LIMIT)
}

fn invertible(q: &[f32; 4]) -> bool {
    // In f64, where the square of no f32 underflows or overflows.
    let [x, y, z, w] = q.map(f64::from);
    let norm2 = x * x + y * y + z * z + w * w;
    norm2 > 0.0 && norm2 < f64::INFINITY
}

fn beyond(body: usize, name: &str, value: &[f32; 3]) -> ContractError {
    ContractError {
        body,
        problem: format!("{name} {value:?}"),
        hint: "coordinates are finite and at most 2^60 in size",
    }
}
