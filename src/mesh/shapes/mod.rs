//! Procedural shapes: closed, outward-oriented 2-manifolds with named sizes, the same bits on every
//! platform.
//!
//! The shapes suit different volumes. The box fits every or-DOP tightly and the icosphere fits the
//! sphere; needle and plate fit neither spheres nor or-DOPs of small k; torus and gear have holes;
//! the L-shape and the knot leave most of their hull empty. Coordinates are computed in f64 with
//! `libm`'s trigonometry (the platform's own differs in the last bit), then rounded once to f32.
//! All shapes are centred on the origin; counter-clockwise triangles face outward.

mod polyhedra;
mod prisms;
mod sizes;
mod tubes;

pub use sizes::ShapeError;

use glam::Vec3;

use super::TriangleMesh;

/// A shape made from a few sizes. Lengths are in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProceduralShape {
    /// A box with edges `x`, `y`, `z`.
    Box {
        /// Edge along x.
        x: f32,
        /// Edge along y.
        y: f32,
        /// Edge along z.
        z: f32,
    },
    /// An icosahedron, subdivided and pushed out to a sphere: 20·4^subdivisions triangles.
    Icosphere {
        /// Radius of the sphere through the vertices.
        radius: f32,
        /// How often each triangle is split into four: 0 to 7.
        subdivisions: u32,
    },
    /// A slim bipyramid along z.
    Needle {
        /// Distance between the two tips.
        length: f32,
        /// Radius of the ring in the middle.
        radius: f32,
        /// Vertices of the ring.
        sides: u32,
    },
    /// A flat box in the xy plane.
    Plate {
        /// Edge along x.
        x: f32,
        /// Edge along y.
        y: f32,
        /// Edge along z.
        thickness: f32,
    },
    /// A ring about z.
    Torus {
        /// Radius of the tube's centre line.
        radius: f32,
        /// Radius of the tube, less than `radius`.
        tube: f32,
        /// Steps along the centre line.
        segments: u32,
        /// Steps around the tube.
        sides: u32,
    },
    /// A spur gear about z with trapezoid teeth and a bore.
    Gear {
        /// Radius of the teeth's tips.
        tip: f32,
        /// Radius between the teeth, less than `tip`.
        root: f32,
        /// Radius of the bore, less than nine tenths of `root`.
        bore: f32,
        /// Height along z.
        thickness: f32,
        /// Number of teeth.
        teeth: u32,
    },
    /// Two arms at a right angle in the xy plane.
    LShape {
        /// Outer length along x.
        x: f32,
        /// Outer length along y.
        y: f32,
        /// Width of the arms, less than `x` and `y`.
        arm: f32,
        /// Height along z.
        thickness: f32,
    },
    /// A tube along a trefoil knot.
    Knot {
        /// Largest distance of the centre line from z.
        radius: f32,
        /// Radius of the tube, at most a fifth of `radius` (beyond that it would cut itself).
        tube: f32,
        /// Steps along the knot.
        segments: u32,
        /// Steps around the tube.
        sides: u32,
    },
}

impl ProceduralShape {
    /// The name of every shape in scene files and on the command line.
    pub const NAMES: [&str; 8] =
        ["box", "icosphere", "needle", "plate", "torus", "gear", "l-shape", "knot"];

    /// The shape of that name with its default sizes.
    pub fn default_of(name: &str) -> Option<Self> {
        Some(match name {
            "box" => Self::Box { x: 1.0, y: 1.0, z: 1.0 },
            "icosphere" => Self::Icosphere { radius: 1.0, subdivisions: 3 },
            "needle" => Self::Needle { length: 2.0, radius: 0.05, sides: 6 },
            "plate" => Self::Plate { x: 2.0, y: 2.0, thickness: 0.02 },
            "torus" => Self::Torus { radius: 1.0, tube: 0.25, segments: 48, sides: 16 },
            "gear" => Self::Gear { tip: 1.0, root: 0.8, bore: 0.3, thickness: 0.3, teeth: 16 },
            "l-shape" => Self::LShape { x: 1.0, y: 1.0, arm: 0.3, thickness: 0.3 },
            "knot" => Self::Knot { radius: 1.0, tube: 0.15, segments: 96, sides: 12 },
            _ => return None,
        })
    }

    /// The shape's name, one of [`Self::NAMES`].
    pub fn name(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Icosphere { .. } => "icosphere",
            Self::Needle { .. } => "needle",
            Self::Plate { .. } => "plate",
            Self::Torus { .. } => "torus",
            Self::Gear { .. } => "gear",
            Self::LShape { .. } => "l-shape",
            Self::Knot { .. } => "knot",
        }
    }

    /// The shape of that name with some sizes replaced; a size not named keeps its default.
    ///
    /// # Errors
    /// An unknown shape or size, or a value that is not allowed. The error lists what is allowed.
    pub fn from_name(name: &str, sizes: &[(&str, f64)]) -> Result<Self, ShapeError> {
        let mut shape = Self::default_of(name)
            .ok_or_else(|| ShapeError::UnknownShape { name: name.to_owned() })?;
        for &(size, value) in sizes {
            shape.set(size, value)?;
        }
        shape.check()?;
        Ok(shape)
    }

    /// The mesh.
    ///
    /// # Errors
    /// Invalid sizes, as in [`Self::from_name`].
    pub fn build(&self) -> Result<TriangleMesh, ShapeError> {
        self.check()?;
        let (vertices, triangles) = match *self {
            Self::Box { x, y, z } | Self::Plate { x, y, thickness: z } => {
                polyhedra::cuboid([x, y, z])
            }
            Self::Icosphere { radius, subdivisions } => polyhedra::icosphere(radius, subdivisions),
            Self::Needle { length, radius, sides } => polyhedra::bipyramid(length, radius, sides),
            Self::Torus { radius, tube, segments, sides } => {
                tubes::torus(radius, tube, segments, sides)
            }
            Self::Gear { tip, root, bore, thickness, teeth } => {
                prisms::gear([tip, root, bore], thickness, teeth)
            }
            Self::LShape { x, y, arm, thickness } => prisms::l_shape([x, y], arm, thickness),
            Self::Knot { radius, tube, segments, sides } => {
                tubes::trefoil(radius, tube, segments, sides)
            }
        };
        Ok(TriangleMesh {
            name: self.name().to_owned(),
            vertices: vertices.iter().map(Vec3::to_array).collect(),
            triangles,
            ..TriangleMesh::default()
        })
    }
}

/// Two triangles a → b → c → d, counter-clockwise.
fn quad([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
