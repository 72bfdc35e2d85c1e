//! The exact answer for one pair.

use pyo3::prelude::*;
use sdop_reference::exact::meeting;
use sdop_reference::{Body, Pose};

use super::arrays::rows;
use super::errors::with_help;
use super::shape::Shape;

const ROUND: &str = "pass float32: the exact answer is about the numbers as given";

/// Whether two posed meshes share a point, or one lies inside of a closed part of the other, in
/// exact arithmetic.
///
/// Parameters
/// ----------
/// shape_a, shape_b : Shape
/// pose_a, pose_b : (rotation, translation)
///     Quaternion x, y, z, w of any non-zero norm, and translation, in float32.
///
/// Returns
/// -------
/// bool
#[pyfunction]
pub fn exact_meet(
    py: Python<'_>,
    shape_a: &Shape,
    pose_a: (Bound<'_, PyAny>, Bound<'_, PyAny>),
    shape_b: &Shape,
    pose_b: (Bound<'_, PyAny>, Bound<'_, PyAny>),
) -> PyResult<bool> {
    let poses = [pose("pose_a", &pose_a)?, pose("pose_b", &pose_b)?];
    py.detach(|| {
        let [a, b] = [(shape_a, poses[0]), (shape_b, poses[1])].map(|(shape, pose)| {
            shape.judged().map(|shape| Body {
                shape,
                pose,
                dynamic: true,
            })
        });
        Ok(meeting::overlap(&a?, &b?).meets)
    })
}

fn pose(
    what: &str,
    (rotation, translation): &(Bound<'_, PyAny>, Bound<'_, PyAny>),
) -> PyResult<Pose> {
    let numpy = rotation.py().import("numpy")?;
    let rotation = numpy.call_method1("reshape", (rotation, (1, 4)))?;
    let translation = numpy.call_method1("reshape", (translation, (1, 3)))?;
    let rotation = rows::<4>(&rotation, &format!("{what}'s rotation"), ROUND)?.rows()[0];
    let translation = rows::<3>(&translation, &format!("{what}'s translation"), ROUND)?.rows()[0];
    Pose::new(rotation, translation).map_err(|error| {
        with_help(
            format!("{what}: {error}"),
            "a non-zero quaternion and finite numbers",
        )
    })
}
