//! Checks exactly whether a volume contains its mesh. This is separate from the tests of overlap,
//! and covers volumes in the body frame and posed volumes.
//!
//! All checks take a pose; a volume in the body frame is checked under [`Pose::IDENTITY`], a
//! world-aligned one with the identity basis under the body's pose. The cascade is that of
//! [`crate::exact`].

use std::cmp::Ordering;

use dashu_int::IBig;

use crate::exact::relative::{Approximate, Relative};
use crate::exact::{Interval, cascade, sphere};
use crate::linear::{Matrix, Vector, apply, dot, integers, largest, sub};
use crate::number::{Number, unit_of};
use crate::pose::Pose;
use crate::shape::Shape;
use crate::volume::{Ball, Slabs};

/// The error for a mesh that is not inside its volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Breach {
    /// A vertex outside the ball.
    #[error("vertex {vertex} is outside the ball")]
    Ball {
        /// Its number.
        vertex: usize,
    },
    /// A vertex outside a slab.
    #[error("vertex {vertex} is outside slab {slab}")]
    Slab {
        /// Its number.
        vertex: usize,
        /// The slab's.
        slab: usize,
    },
    /// A slab direction that no f32 vector is, so that the sum of basis vectors would round.
    #[error("slab direction {slab} is not exact in f32")]
    Direction {
        /// The slab's number.
        slab: usize,
    },
}

/// Checks that every vertex is in the ball and in the slabs, and that every direction is exact.
///
/// # Errors
/// The first breach.
pub fn check_shape(shape: &Shape) -> Result<(), Breach> {
    check_directions(&shape.slabs)?;
    check_ball(&shape.ball, &shape.vertices, &Pose::IDENTITY)?;
    check_slabs(&shape.slabs, &shape.vertices, &Pose::IDENTITY)
}

/// Is every direction Σ c_j b_j, computed without rounding, an f32 vector?
///
/// # Errors
/// The first slab whose direction is not.
pub fn check_directions(slabs: &Slabs) -> Result<(), Breach> {
    let unit = unit_of(slabs.basis.iter().flatten().map(|x| f64::from(*x)));
    let component = |c: &[i32; 3], i: usize| {
        let column = [0, 1, 2].map(|j| IBig::lift(f64::from(slabs.basis[j][i]), unit));
        dot(&integers(*c), &column)
    };
    let exact = |c: &[i32; 3]| (0..3).all(|i| fits_f32(&component(c, i), unit));
    match slabs.directions.coefficients().iter().position(|c| !exact(c)) {
        Some(slab) => Err(Breach::Direction { slab }),
        None => Ok(()),
    }
}

/// Is x·2^unit an f32?
fn fits_f32(x: &IBig, unit: i32) -> bool {
    let widened = f64::lift_integer(x, unit, 0);
    let narrow = widened as f32;
    narrow.is_finite() && f64::from(narrow) == widened && IBig::lift(widened, unit) == *x
}

/// Is every posed vertex in the ball?
///
/// # Errors
/// The first vertex that is not.
pub fn check_ball(ball: &Ball, vertices: &[[f32; 3]], pose: &Pose) -> Result<(), Breach> {
    let map = Approximate::between(&Pose::IDENTITY, pose);
    let inside = |v: &[f32; 3]| inner_ball(ball, &Ball { centre: *v, radius: 0.0 }, pose, &map);
    match vertices.iter().position(|v| !inside(v)) {
        Some(vertex) => Err(Breach::Ball { vertex }),
        None => Ok(()),
    }
}

/// Is the whole posed ball `inner` in the ball `outer`: ‖R c/|q|² + t − c'‖ ≤ r' − r?
pub fn ball_in_ball(outer: &Ball, inner: &Ball, pose: &Pose) -> bool {
    inner_ball(outer, inner, pose, &Approximate::between(&Pose::IDENTITY, pose))
}

/// The f64 filter's bound is that of [`crate::exact::sphere`].
fn inner_ball(outer: &Ball, inner: &Ball, pose: &Pose, map: &Approximate) -> bool {
    if inner.radius > outer.radius {
        return false;
    }
    let filter = || {
        let centre = inner.centre.map(f64::from);
        let d = sub(&map.map(&centre), &outer.centre.map(f64::from));
        let room = f64::from(outer.radius) - f64::from(inner.radius);
        sphere::compare(&d, map.error(largest(&centre)), room)
    };
    let unit = || {
        let lengths =
            outer.centre.iter().chain(&inner.centre).chain([&outer.radius, &inner.radius]);
        unit_of(lengths.map(|x| f64::from(*x)).chain(pose.translation()))
    };
    cascade(
        filter,
        || in_ball::<Interval>(outer, inner, pose, 0),
        || in_ball::<IBig>(outer, inner, pose, unit()),
    )
    .value
}

fn in_ball<N: Number>(outer: &Ball, inner: &Ball, pose: &Pose, unit: i32) -> Option<bool> {
    let map = Relative::<N>::between(&Pose::IDENTITY, pose, unit);
    let d = sub(
        &map.seen(&inner.centre.map(f64::from), unit),
        &map.own(&outer.centre.map(f64::from), unit),
    );
    let lift = |x: f32| N::lift(f64::from(x), unit);
    let room = map.scale.times(&lift(outer.radius).minus(&lift(inner.radius)));
    Some(room.times(&room).minus(&dot(&d, &d)).sign()? != Ordering::Less)
}

/// Is every posed vertex in every slab?
///
/// # Errors
/// The first vertex that is not, and the slab.
pub fn check_slabs(slabs: &Slabs, vertices: &[[f32; 3]], pose: &Pose) -> Result<(), Breach> {
    let map = Approximate::between(&Pose::IDENTITY, pose);
    let basis = slabs.basis.map(|row| row.map(f64::from));
    let size = basis.iter().map(largest).fold(0.0, f64::max);
    let coefficients = slabs.directions.coefficients();
    for (vertex, v) in vertices.iter().enumerate() {
        let v = v.map(f64::from);
        let x = map.map(&v);
        // A coordinate of basis·x is off by 3|b|δ and its own rounding, a height by three of them.
        let error = 10.0 * size * (map.error(largest(&v)) + 8.0 * f64::EPSILON * largest(&x));
        let xi = apply(&basis, &x);
        for (slab, c) in coefficients.iter().enumerate() {
            let ends = [slabs.lo[slab], slabs.hi[slab]].map(f64::from);
            let height = dot(&integers(*c), &xi);
            let room = (height - ends[0]).min(ends[1] - height);
            let bound = error + f64::EPSILON * (ends[0].abs() + ends[1].abs());
            let inside = match room {
                room if room > bound => Some(true),
                room if room < -bound => Some(false),
                _ => in_slab::<Interval>(&basis, c, ends, &v, pose, 0).or_else(|| {
                    in_slab::<IBig>(&basis, c, ends, &v, pose, slab_unit(&basis, ends, &v, pose))
                }),
            };
            if inside != Some(true) {
                return Err(Breach::Slab { vertex, slab });
            }
        }
    }
    Ok(())
}

/// A length unit whose product with the basis' unit divides the slab's ends.
fn slab_unit(basis: &Matrix<f64>, ends: [f64; 2], v: &Vector<f64>, pose: &Pose) -> i32 {
    let ends = unit_of(ends) - unit_of(basis.iter().flatten().copied());
    ends.min(unit_of(v.iter().copied().chain(pose.translation())))
}

fn in_slab<N: Number>(
    basis: &Matrix<f64>,
    c: &[i32; 3],
    ends: [f64; 2],
    v: &Vector<f64>,
    pose: &Pose,
    unit: i32,
) -> Option<bool> {
    let map = Relative::<N>::between(&Pose::IDENTITY, pose, unit);
    let basis_unit = unit_of(basis.iter().flatten().copied());
    let rows = basis.map(|row| row.map(|x| N::lift(x, basis_unit)));
    let height = dot(&integers(*c), &apply(&rows, &map.seen(v, unit)));
    let [lo, hi] = ends.map(|end| map.scale.times(&N::lift(end, unit + basis_unit)));
    let room = [height.minus(&lo).sign()?, hi.minus(&height).sign()?];
    Some(!room.contains(&Ordering::Less))
}
