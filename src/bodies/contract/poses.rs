//! The contract's checks of poses.

use std::ops::Range;

use super::{ContractError, check_column, check_number, refuse};
use crate::bodies::Bodies;
use crate::rounding::LIMIT;
use crate::simd::{Kernel, Lanes, Tier, dispatch};

/// How to mend a rotation.
const ROTATION_HELP: &str = "a quaternion (x, y, z, w) has a finite norm above zero";

/// How to mend a vector.
const VECTOR_HELP: &str = "coordinates are finite and at most 2^60 in size";

/// Checks that every body's shape number is below `shapes`.
pub(crate) fn check_numbers(numbers: &[u32], shapes: usize) -> Result<(), ContractError> {
    match numbers.iter().position(|&number| number as usize >= shapes) {
        None => Ok(()),
        Some(body) => refuse_number(body, numbers[body], shapes),
    }
}

pub(crate) fn refuse_number(body: usize, number: u32, shapes: usize) -> Result<(), ContractError> {
    let value = format!("{number} of {shapes}");
    refuse(body, "shape", value, "shapes are counted from 0")
}

/// Checks one pose with a translation in f64.
#[doc(hidden)]
pub fn check_pose(body: usize, q: &[f32; 4], t: &[f64; 3]) -> Result<(), ContractError> {
    if !is_invertible(q) {
        return refuse(body, "rotation", format!("{q:?}"), ROTATION_HELP);
    }
    if !t.iter().all(|x| x.abs() <= f64::from(LIMIT)) {
        return refuse(body, "translation", format!("{t:?}"), VECTOR_HELP);
    }
    Ok(())
}

/// Checks the poses of the bodies in `range`, after a step may have changed them.
#[doc(hidden)]
pub fn check_poses(bodies: &Bodies, range: Range<usize>) -> Result<(), ContractError> {
    let first = range.start;
    check_vectors("translation", &bodies.translation[range.clone()], first)?;
    let rotations = &bodies.rotation[range];
    match rotations.iter().position(|q| !is_invertible(q)) {
        None => Ok(()),
        Some(at) => {
            let value = format!("{:?}", rotations[at]);
            refuse(first + at, "rotation", value, ROTATION_HELP)
        }
    }
}

/// Whether all coordinates of a column are at most 2⁶⁰ in size.
fn are_within_limit(column: &[[f32; 3]]) -> bool {
    // Without an early exit, so that the compiler vectorises it. Only one column ever fails,
    // because culling ends there.
    column.as_flattened().iter().fold(0, |most, x| size(*x).max(most)) <= size(LIMIT)
}

/// Checks that every column has one entry per body, and that there are at most
/// [`MOST_BODIES`](super::MOST_BODIES).
pub(crate) fn check_columns(bodies: &Bodies) -> Result<(), ContractError> {
    check_number(bodies.len())?;
    for (name, length) in [
        ("dynamic", bodies.dynamic.len()),
        ("rotation", bodies.rotation.len()),
        ("translation", bodies.translation.len()),
    ] {
        check_column(name, length, bodies.len())?;
    }
    Ok(())
}

/// Checks that the coordinates of a column are at most 2⁶⁰ in size. Its first entry belongs to the
/// body `first`.
#[doc(hidden)]
pub fn check_vectors(
    name: &'static str,
    column: &[[f32; 3]],
    first: usize,
) -> Result<(), ContractError> {
    if are_within_limit(column) {
        return Ok(());
    }
    let at = column.iter().position(|v| !is_within_limit(v)).unwrap_or(0);
    refuse(first + at, name, format!("{:?}", column[at]), VECTOR_HELP)
}

// All limits are written as `x ≤ limit`, so that a NaN fails.

/// A number's size as an integer: its bits without the sign. They order as sizes do, with NaN above
/// all.
#[inline(always)]
fn size(number: f32) -> u32 {
    number.to_bits() & !(1 << 31)
}

#[inline]
pub(crate) fn is_within_limit(v: &[f32; 3]) -> bool {
    v.iter().all(|&x| size(x) <= size(LIMIT))
}

/// Whether the centres of all balls are within 2⁶⁰, and their radii finite. It is not inlined, so
/// that callgrind shows its cost (`.ci/instructions`).
#[inline(never)]
pub(crate) fn balls_are_within_limit(tier: Tier, balls: &[[f32; 4]]) -> bool {
    dispatch(tier, BallsWithinLimit(balls))
}

struct BallsWithinLimit<'a>(&'a [[f32; 4]]);

/// Numbers checked per step of the loop: several vectors in every tier, so that the loop itself
/// costs little.
const NUMBERS_PER_CHECK: usize = 64;

impl Kernel for BallsWithinLimit<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> bool {
        // The largest of each column, at two instructions per vector.
        let mut largest = [0; NUMBERS_PER_CHECK];
        let (many, rest) = self.0.as_flattened().as_chunks::<NUMBERS_PER_CHECK>();
        for numbers in many {
            enlarge(&mut largest, numbers);
        }
        enlarge(&mut largest, rest);
        let mut fine = true;
        for ball in largest.as_chunks::<4>().0 {
            let [x, y, z, radius] = *ball;
            fine &= x.max(y).max(z) <= size(LIMIT) && radius <= size(f32::MAX);
        }
        fine
    }
}

#[inline(always)]
fn enlarge(largest: &mut [u32; NUMBERS_PER_CHECK], numbers: &[f32]) {
    for (largest, number) in largest.iter_mut().zip(numbers) {
        *largest = size(*number).max(*largest);
    }
}

fn is_invertible(q: &[f32; 4]) -> bool {
    // In f64, where the square of no f32 underflows or overflows.
    let [x, y, z, w] = q.map(f64::from);
    let norm2 = x * x + y * y + z * z + w * w;
    norm2 > 0.0 && norm2 < f64::INFINITY
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Invalid coordinates: one ulp beyond the limit, and further.
    const BEYOND_LIMIT: [f32; 5] =
        [LIMIT.next_up(), -LIMIT.next_up(), f32::INFINITY, f32::NAN, -f32::NAN];

    /// Coordinates are refused for an ulp beyond the limit.
    #[test]
    fn coordinates_beyond_limit_are_rejected() {
        for count in [1, 2, 40] {
            let fine = vec![[LIMIT, -LIMIT, -0.0]; count];
            assert_eq!(check_vectors("translation", &fine, 7), Ok(()));
            for (at, axis) in (0..count).flat_map(|at| [0, 1, 2].map(|axis| (at, axis))) {
                for bad in BEYOND_LIMIT {
                    let mut column = fine.clone();
                    column[at][axis] = bad;
                    assert!(!is_within_limit(&column[at]));
                    let told = check_vectors("translation", &column, 7);
                    assert_eq!(told.map_err(|error| error.body), Err(7 + at), "{bad}");
                }
            }
        }
    }

    /// Balls are refused in every lane for an ulp beyond the limit.
    #[test]
    fn balls_beyond_limit_are_rejected() {
        for tier in Tier::available() {
            for count in [0, 1, 16, 17, 50] {
                let fine = vec![[LIMIT, -LIMIT, 0.0, f32::MAX]; count];
                assert!(balls_are_within_limit(tier, &fine), "{tier}, {count}");
                for (ball, axis) in
                    (0..count).flat_map(|ball| [0, 1, 2, 3].map(|axis| (ball, axis)))
                {
                    for bad in BEYOND_LIMIT {
                        let mut balls = fine.clone();
                        balls[ball][axis] = bad;
                        let is_fine = axis == 3 && bad.is_finite();
                        assert_eq!(
                            balls_are_within_limit(tier, &balls),
                            is_fine,
                            "{tier}, {ball}, {axis}: {bad}"
                        );
                    }
                }
            }
        }
    }
}
