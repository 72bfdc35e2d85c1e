//! Exact orthogonal bases: rotations rounded to integer quaternions.
//!
//! For an integer q = (x, y, z, w) with n = |q|², n·R(q) has integer entries of magnitude ≤ n and
//! orthogonal columns of norm n. With n ≤ 2²² and a scale by a power of two, the entries and their
//! sums under coefficients from {−1, 0, 1} are integers below 2²⁴ times that power: exact in f32.
//! If each vector of a basis were rounded to f32 separately, (1,1,0) = (1,0,0) + (0,1,0) would no
//! longer hold, and neither would the weak-duality bound on supports.

use glam::DQuat;

use crate::mesh::in_f64;

/// The largest |q|² of an integer quaternion.
const MAX_NORM: i64 = 1 << 22;

/// An orthogonal basis whose three columns have one common norm and f32-exact entries: an integer
/// quaternion's rotation matrix times |q|² ≤ 2²², scaled by a power of two so that the norm is in
/// (½, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The basis vectors in the body frame.
    pub columns: [[f32; 3]; 3],
}

impl Basis {
    /// The model's own axes: the identity.
    pub const MODEL: Self = Self { columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// The basis of the integer quaternion (x, y, z, w). `None` unless 0 < |q|² ≤ 2²².
    #[must_use]
    pub fn from_integer_quaternion(q: [i32; 4]) -> Option<Self> {
        let [x, y, z, w] = q.map(i64::from);
        if q.iter().any(|c| i64::from(c.unsigned_abs()) > MAX_NORM) {
            return None; // and so the squares below don't overflow
        }
        let n = x * x + y * y + z * z + w * w;
        if !(1..=MAX_NORM).contains(&n) {
            return None;
        }
        let ceil_log2 = i64::BITS - (n - 1).leading_zeros();
        let scale = f32::from_bits((127 - ceil_log2) << 23);
        let column = |a: i64, b: i64, c: i64| [a, b, c].map(|entry| entry as f32 * scale);
        Some(Self {
            columns: [
                column(w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)),
                column(2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)),
                column(2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z),
            ],
        })
    }

    /// The basis nearest to a rotation (x, y, z, w): its unit quaternion times 2048, rounded to
    /// integers. It is off by less than 10⁻³ rad. Rotations that differ only by rounding errors
    /// give the same basis, except for the few that are between two.
    #[must_use]
    pub fn snapped(rotation: impl Into<[f64; 4]>) -> Self {
        let unit = DQuat::from_array(rotation.into()).normalize().to_array();
        // Rounding may increase |q| above 2048 by up to 1.
        (2046..=2048)
            .rev()
            .find_map(|size| {
                Self::from_integer_quaternion(unit.map(|c| (c * f64::from(size)).round() as i32))
            })
            .unwrap_or(Self::MODEL)
    }

    /// The common norm of the columns, exact: n·2⁻ᵐ.
    #[must_use]
    pub fn norm(&self) -> f64 {
        // Entries are integers ≤ 2²² over one power of two, so the sum of squares n² ≤ 2⁴⁴ and its
        // root are exact.
        in_f64(&self.columns[0]).length_squared().sqrt()
    }

    /// The direction Σ cᵢ·columnsᵢ, exact for coefficients in {−1, 0, 1}.
    #[must_use]
    pub fn direction(&self, coefficients: [i8; 3]) -> [f32; 3] {
        let [a, b, c] = coefficients.map(f32::from);
        let [x, y, z] = &self.columns;
        std::array::from_fn(|i| x[i] * a + y[i] * b + z[i] * c)
    }

    /// The columns of this basis, normalised to a rotation.
    #[must_use]
    pub fn rotation(&self) -> [[f64; 3]; 3] {
        let norm = self.norm();
        self.columns.map(|column| column.map(|x| f64::from(x) / norm))
    }
}
