//! Scaled and mirrored meshes: files in millimetres, URDF's and SDF's scales.

use glam::Vec3;

use super::{MeshError, Problem, TriangleMesh};

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
    /// The mesh with each coordinate multiplied by its factor, rounded to f32 once. What was counter-clockwise from outside
    /// stays so: where the scale mirrors, each triangle's last two corners are exchanged.
    ///
    /// # Errors
    /// A factor that is zero or not finite, or a mesh that is beyond 2⁶⁰ with it.
    pub fn scaled(&self, scale: impl Into<Scale>) -> Result<Self, MeshError> {
        let Scale(scale) = scale.into();
        if !scale
            .iter()
            .all(|factor| factor.is_finite() && *factor != 0.0)
        {
            return Err(Problem::Scale { scale }.at(&self.name, None));
        }
        let vertex = |v: &Vec3| {
            let scaled = [0, 1, 2].map(|axis| (f64::from(v[axis]) * scale[axis]) as f32);
            Vec3::from_array(scaled)
        };
        let mirrors = scale.iter().filter(|factor| **factor < 0.0).count() % 2 == 1;
        let triangle = |&[a, b, c]: &[u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
        Self::new(
            self.name.clone(),
            self.vertices.iter().map(vertex).collect(),
            self.triangles.iter().map(triangle).collect(),
        )
    }
}
