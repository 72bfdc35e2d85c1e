//! Compounds: parts and the shape that contains them.

use super::CompoundError;
use super::part_set::PartSet;
use crate::bodies::contract::{ContractError, check_pose};
use crate::mesh::TriangleMesh;
use crate::rounding::narrow::{narrow, turn_error};
use crate::rounding::up;
use crate::simd::in_default_mode;
use crate::update::offset::{compose, reach_about_pose};
use crate::volume::{Shape, ShapeSpec};
use crate::world::digest_of;

/// A shape in the frame of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)] // as `sdop.h` has it
pub struct Part {
    /// Index into the compound's shapes.
    pub shape: u32,
    /// Orientation in the frame of the body: a quaternion (x, y, z, w) of any non-zero norm.
    pub rotation: [f32; 4],
    /// Position of the shape's origin in the frame of the body.
    pub translation: [f64; 3],
    /// Whether the rotation was rounded from f64: `turned` sets it. The part is then grown by what
    /// that may move its points.
    pub rounded: bool,
}

impl Default for Part {
    /// Shape 0 at the origin of the body, not rotated.
    fn default() -> Self {
        Self { shape: 0, rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3], rounded: false }
    }
}

impl Part {
    /// This part with a rotation in f64, a quaternion (x, y, z, w) of any non-zero norm. If f32
    /// holds it, that is all. Otherwise `rotation` gets the nearest, and `rounded` says so.
    #[must_use]
    pub fn turned(self, rotation: impl Into<[f64; 4]>) -> Self {
        let (rotation, rounded) = in_default_mode(|| narrow(rotation.into()));
        Self { rotation, rounded, ..self }
    }
}

/// Several shapes that move as one body. See the [module](super).
#[derive(Clone, Debug)]
pub struct Compound {
    shape: Shape,
    /// By which a world's shape is recognised as this one's.
    pub(super) digest: u64,
    pub(super) parts: PartSet,
}

impl Compound {
    /// A compound of parts with these shapes. Its own shape has the slab directions of the first
    /// part's shape, along the principal axes of all parts.
    ///
    /// # Errors
    /// No parts, a part whose shape number or pose is invalid, or parts that reach farther from the
    /// body's origin than 2⁶⁰.
    pub fn build(
        name: impl Into<String>,
        shapes: &[Shape],
        parts: &[Part],
    ) -> Result<Self, CompoundError> {
        let name = name.into();
        let Some(first) = parts.first() else {
            return Err(CompoundError::NoParts { compound: name });
        };
        in_default_mode(|| {
            let checked = (0..).zip(parts);
            let checked = checked.map(|(number, part)| check(number, part, shapes));
            if let Err(source) = checked.collect::<Result<(), _>>() {
                let compound = name;
                return Err(CompoundError::Part { compound, source });
            }
            let spec = ShapeSpec {
                directions: shapes[first.shape as usize].ordop.directions,
                ..ShapeSpec::default()
            };
            let mesh = mesh_of(shapes, parts)?.named(name);
            let shape = Shape::build(&mesh, &spec)?;
            Ok(Self { digest: digest_of(&shape), shape, parts: PartSet::new(shapes, parts) })
        })
    }

    /// The shape that contains all parts, for a [`World`](crate::World).
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Number of parts.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.parts.len()
    }
}

fn check(number: usize, part: &Part, shapes: &[Shape]) -> Result<(), ContractError> {
    if part.shape as usize >= shapes.len() {
        return Err(ContractError {
            body: number,
            quantity: "shape",
            value: format!("{} of {}", part.shape, shapes.len()),
            hint: "shapes are counted from 0",
        });
    }
    check_pose(number, &part.rotation, &part.translation)
}

/// The meshes of all parts as one, in the frame of the body. Its rounding bounds the distance of
/// each vertex from the exactly posed vertex of the part.
fn mesh_of(shapes: &[Shape], parts: &[Part]) -> Result<TriangleMesh, CompoundError> {
    let (mut points, mut triangles, mut rounding) = (Vec::new(), Vec::new(), 0.0_f64);
    for part in parts {
        let shape = &shapes[part.shape as usize];
        let first = points.len() as u32;
        triangles.extend(shape.triangles.iter().map(|t| t.map(|i| i + first)));
        for vertex in &shape.vertices {
            let own = [0, 1, 2].map(|axis| f64::from(vertex[axis]) + shape.pose_offset[axis]);
            let (point, error) = compose(part.rotation, part.translation, own);
            points.push(point);
            let turned = turn_error(part.rounded, reach_about_pose(0.0, own));
            // Twice the bound, for the sum above.
            rounding = rounding.max(2.0 * error + f64::from(shape.rounding) + turned);
        }
    }
    let mut mesh = TriangleMesh::from_f64(&points, &triangles)?;
    let moved = |(point, vertex): (&[f64; 3], [f64; 3])| {
        let [x, y, z] = [0, 1, 2].map(|axis| point[axis] - vertex[axis]);
        (x * x + y * y + z * z).sqrt()
    };
    let moved = points.iter().zip(mesh.points()).map(moved);
    mesh.rounding = up(moved.fold(0.0, f64::max) + rounding);
    Ok(mesh)
}
