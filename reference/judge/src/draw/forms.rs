//! Forms by name and size, including extreme ones, and the shapes that are built from them.

use std::collections::BTreeMap;

use glam::Vec3;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use crate::truth::reference_shapes::Shapes;
use sdop::mesh::{ProceduralShape, TriangleMesh};
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

/// A form and how it becomes a shape.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Form {
    /// A procedural shape's name, or `point`, `segment`, `triangle`, `sliver` (zero area),
    /// `tetrahedron`.
    pub form: String,
    /// A procedural shape's sizes.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sizes: BTreeMap<String, f64>,
    /// Least and largest power of two of the bounding radius; absent: the form's own size.
    pub radius: Option<[f64; 2]>,
    /// Keeps the form's own origin and shifts the vertices by this: a ball off the body's origin.
    pub offset: Option<[f32; 3]>,
}

/// A form that can't be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("form {form}: {problem}")]
pub struct FormError {
    form: String,
    problem: String,
}

impl FormError {
    /// The problem with a form of that name.
    pub(super) fn of(form: &str, problem: impl ToString) -> Self {
        Self { form: form.to_owned(), problem: problem.to_string() }
    }
}

impl Form {
    /// A procedural shape by name, of radius 2ᵃ to 2ᵇ.
    #[must_use]
    pub fn of(form: &str, radius: [f64; 2]) -> Self {
        Self { form: form.to_owned(), sizes: BTreeMap::new(), radius: Some(radius), offset: None }
    }

    fn mesh(&self) -> Result<TriangleMesh, FormError> {
        let error = |problem: String| FormError::of(&self.form, problem);
        let flat = |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| TriangleMesh {
            name: self.form.clone(),
            vertices: vertices.to_vec(),
            triangles: triangles.to_vec(),
            ..TriangleMesh::default()
        };
        Ok(match self.form.as_str() {
            "point" => flat(&[[0.0; 3]], &[[0, 0, 0]]),
            "segment" => flat(&[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], &[[0, 1, 1]]),
            "triangle" => {
                flat(&[[-1.0, -0.5, 0.0], [1.0, -0.5, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])
            }
            "sliver" => {
                flat(&[[-1.0, -0.5, 0.25], [0.0, 0.0, 0.0], [1.0, 0.5, -0.25]], &[[0, 1, 2]])
            }
            "tetrahedron" => flat(
                &[[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
                &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
            ),
            name => {
                let sizes: Vec<(&str, f64)> =
                    self.sizes.iter().map(|(k, v)| (k.as_str(), *v)).collect();
                let shape = ProceduralShape::from_name(name, &sizes);
                shape.and_then(|shape| shape.build()).map_err(|e| error(e.to_string()))?
            }
        })
    }

    /// Draws a size and builds the shape.
    ///
    /// # Errors
    /// An unknown form, or one that has no volumes of this size.
    pub fn shape(
        &self,
        directions: DirectionSet,
        axes: Axes,
        rng: &mut impl Rng,
    ) -> Result<Shape, FormError> {
        let mut mesh = self.mesh()?;
        let radius = self.radius.map(|[least, most]| {
            let e = if most > least { rng.random_range(least..most) } else { least };
            2_f64.powf(e) as f32
        });
        if let Some(offset) = self.offset {
            mesh.vertices
                .iter_mut()
                .for_each(|v| *v = (Vec3::from(*v) + Vec3::from(offset)).to_array());
        }
        let spec = ShapeSpec {
            origin: if self.offset.is_some() { Origin::File } else { Origin::Ball },
            radius,
            directions,
            axes,
        };
        Shape::build(&mesh, &spec).map_err(|error| FormError::of(&self.form, error))
    }
}

/// Builds every form, `copies` times with sizes of their own.
///
/// # Errors
/// As [`Form::shape`], and numbers that the reference refuses.
pub fn build(
    forms: &[Form],
    copies: usize,
    directions: DirectionSet,
    axes: Axes,
    rng: &mut impl Rng,
) -> Result<Shapes, FormError> {
    let mut built = Vec::new();
    for _ in 0..copies {
        for form in forms {
            built.push(form.shape(directions, axes, rng)?);
        }
    }
    Shapes::new(built).map_err(|error| FormError::of("all", error))
}
