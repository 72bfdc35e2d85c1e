//! The exact answer for one pair.

use pyo3::prelude::*;
use sdop_reference::{WidePose, wide};

use super::arguments::two;
use super::arrays::{one_row, wide_rows};
use super::errors::with_help;
use super::shape::Shape;
use super::world::{POSITION, QUATERNION};

/// Whether two posed meshes share a point, or one lies inside of a closed part of the other, in
/// exact arithmetic.
///
/// The meshes are those of `Shape.vertices`, in float32: vertices of float64 were rounded, by at
/// most `Shape.rounding`. The answer may be another for meshes that are nearer to each other, or
/// overlap by less, than both bounds.
///
/// Parameters
/// ----------
/// shape_a, shape_b : Shape
/// pose_a, pose_b : (rotation, translation)
///     Quaternion x, y, z, w of any non-zero norm, and translation, of float32 or float64: the
///     answer is about exactly these numbers.
///
/// Returns
/// -------
/// bool
#[pyfunction]
pub fn exact_meet(
    py: Python<'_>,
    shape_a: &Shape,
    pose_a: &Bound<'_, PyAny>,
    shape_b: &Shape,
    pose_b: &Bound<'_, PyAny>,
) -> PyResult<bool> {
    let poses = [pose("pose_a", pose_a)?, pose("pose_b", pose_b)?];
    py.detach(|| {
        let [a, b] = [shape_a.judged()?, shape_b.judged()?];
        Ok(wide::meet((a, &poses[0]), (b, &poses[1])).meets)
    })
}

fn pose(what: &str, given: &Bound<'_, PyAny>) -> PyResult<WidePose> {
    let [rotation, translation] = &two(given, what, "pass (rotation, translation)")?;
    let rotation = row::<4>(rotation, &format!("{what}'s rotation"), QUATERNION)?;
    let translation = row::<3>(translation, &format!("{what}'s translation"), POSITION)?;
    WidePose::new(rotation, translation).map_err(|error| {
        with_help(format!("{what}: {error}"), "a non-zero quaternion and finite numbers")
    })
}

fn row<const N: usize>(given: &Bound<'_, PyAny>, what: &str, remedy: &str) -> PyResult<[f64; N]> {
    Ok(wide_rows(&one_row::<N>(given, what, remedy)?, what)?[0])
}
