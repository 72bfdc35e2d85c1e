//! Scaled and mirrored meshes: files in millimetres, and the scales of URDF and SDF.

use super::{MeshError, Problem, TriangleMesh};
use crate::rounding::up;

/// Factors of x, y and z: one number for all, or `[x, y, z]`. Negative ones mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(pub [f64; 3]);

impl From<f64> for Scale {
    fn from(factor: f64) -> Self {
        Self([factor; 3])
    }
}

impl From<[f64; 3]> for Scale {
    fn from(factors: [f64; 3]) -> Self {
        Self(factors)
    }
}

impl TriangleMesh {
    /// The mesh with each coordinate of the file multiplied by its factor in f64 and then rounded
    /// as if a file had it. Faces stay counter-clockwise from outside: if the scale mirrors, each
    /// triangle's last two corners are exchanged.
    ///
    /// # Errors
    /// A factor that is zero or not finite, or a scaled coordinate beyond 2⁶⁰.
    pub fn scaled(&self, scale: impl Into<Scale>) -> Result<Self, MeshError> {
        let Scale(scale) = scale.into();
        if !scale.iter().all(|factor| factor.is_finite() && *factor != 0.0) {
            return Err(Problem::Scale { scale }.at(&self.name, None));
        }
        let point = |point: [f64; 3]| std::array::from_fn(|axis| point[axis] * scale[axis]);
        let points: Vec<[f64; 3]> = self.points().map(point).collect();
        let mirrors = scale.iter().filter(|factor| **factor < 0.0).count() % 2 == 1;
        let triangle = |&[a, b, c]: &[u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
        let triangles: Vec<[u32; 3]> = self.triangles.iter().map(triangle).collect();
        let is_rounded = self.rounding > 0.0;
        let make = if is_rounded { Self::from_f64 } else { Self::rounded };
        let mut scaled = make(&points, &triangles)
            .map_err(|error| error.problem.at(&self.name, None))?
            .named(&self.name);
        if is_rounded {
            // The rounding of the original vertices is scaled too.
            let largest = scale.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let moved = f64::from(self.rounding) * largest + f64::from(scaled.rounding);
            scaled.rounding = up(moved);
        }
        scaled.warnings.clone_from(&self.warnings);
        Ok(scaled)
    }
}
