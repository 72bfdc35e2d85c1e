//! Poses: x ↦ R(q)x/|q|² + t with any non-zero quaternion.

use crate::InvalidInput;
use crate::linear::{Matrix, Vector, apply, norm_squared, rotation, sub};

/// The pose of a body: a quaternion and a translation as given, never renormalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    q: [f64; 4],
    t: Vector<f64>,
}

impl Pose {
    /// The body frame itself.
    pub const IDENTITY: Self = Self { q: [0.0, 0.0, 0.0, 1.0], t: [0.0; 3] };

    /// A pose of the quaternion q = (x, y, z, w) and the translation t.
    ///
    /// # Errors
    /// When a number is not finite or the quaternion is zero.
    pub fn new(q: [f32; 4], t: [f32; 3]) -> Result<Self, InvalidInput> {
        Self::from_f64(q, t.map(f64::from))
    }

    /// A pose with an f64 translation, whose numbers are in f32's range, so that the error analysis
    /// for f32 input remains valid.
    ///
    /// # Errors
    /// As [`Self::new`], and when a number of the translation is beyond f32's largest or, other
    /// than 0, below its smallest.
    pub fn from_f64(q: [f32; 4], t: Vector<f64>) -> Result<Self, InvalidInput> {
        if !q.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the quaternion"));
        }
        if !t.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the translation"));
        }
        let smallest = f64::from(f32::from_bits(1));
        let range = smallest..=f64::from(f32::MAX);
        if !t.iter().all(|x| *x == 0.0 || range.contains(&x.abs())) {
            return Err(InvalidInput::Translation);
        }
        if q == [0.0; 4] {
            return Err(InvalidInput::ZeroQuaternion);
        }
        Ok(Self::of_f64(q.map(f64::from), t))
    }

    /// A pose of arbitrary f64 numbers, only for [`WidePose`](crate::WidePose).
    pub(crate) fn of_f64(q: [f64; 4], t: Vector<f64>) -> Self {
        Self { q, t }
    }

    /// The quaternion (x, y, z, w) as given.
    pub fn quaternion(&self) -> [f64; 4] {
        self.q
    }

    /// The translation as given.
    pub fn translation(&self) -> Vector<f64> {
        self.t
    }

    /// R(q)/|q|².
    pub fn rotation(&self) -> Matrix<f64> {
        let q = self.quaternion();
        let norm = norm_squared(&q);
        rotation(&q).map(|row| row.map(|entry| entry / norm))
    }

    /// R(q)x/|q|²: the body-frame x turned into world axes, still seen from the body's origin.
    pub fn turn(&self, x: &Vector<f64>) -> Vector<f64> {
        apply(&self.rotation(), x)
    }
}

/// Δ = tB − tA. Every test compares B with A as seen from A's origin: world coordinates far out
/// would cancel.
pub fn separation(a: &Pose, b: &Pose) -> Vector<f64> {
    sub(&b.translation(), &a.translation())
}
