//! Procedural shapes: closed, outward-oriented 2-manifolds with named sizes, equal to the bit on every platform.
//!
//! Each shape stresses a volume in its own way: the box is tight for every or-DOP, the icosphere for the
//! sphere alone, needle and plate for neither sphere nor small k, torus and gear have holes, the L-shape and
//! the knot leave most of their hull empty. Coordinates are computed in f64 with `libm`'s trigonometry
//! (the platform's own differs in the last bit), then rounded once to f32. All shapes are centred on the
//! origin; counter-clockwise triangles face outward.

mod polyhedra;
mod prisms;
mod tubes;

use super::TriangleMesh;

/// A shape made from a few sizes; lengths in scene units, counts in pieces.
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
        /// How often each triangle is split in four, 0 to 7.
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

/// One size of a shape, to be set by name.
enum Size<'a> {
    Length(&'a mut f32),
    Count(&'a mut u32),
}

/// Why a shape cannot be made from the given name and sizes.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum ShapeError {
    /// No shape has this name.
    #[error("there is no shape {name:?}")]
    #[diagnostic(help("the shapes are {}", ProceduralShape::NAMES.join(", ")))]
    UnknownShape {
        /// The name as given.
        name: String,
    },
    /// The shape has no such size.
    #[error("the shape {shape:?} has no size {size:?}")]
    #[diagnostic(help("its sizes are {}", known.join(", ")))]
    UnknownSize {
        /// The shape's name.
        shape: &'static str,
        /// The size as given.
        size: String,
        /// The sizes that the shape has.
        known: Vec<&'static str>,
    },
    /// The value is outside what the size allows.
    #[error("the size {size:?} of the shape {shape:?} cannot be {value}")]
    #[diagnostic(help("{size} must be {allowed}"))]
    BadSize {
        /// The shape's name.
        shape: &'static str,
        /// The size's name.
        size: &'static str,
        /// The value as given.
        value: f64,
        /// What would do.
        allowed: String,
    },
}

impl ProceduralShape {
    /// Every shape's name, as scene files and the command line spell it.
    pub const NAMES: [&str; 8] = [
        "box",
        "icosphere",
        "needle",
        "plate",
        "torus",
        "gear",
        "l-shape",
        "knot",
    ];

    /// The shape of that name with its default sizes.
    pub fn default_of(name: &str) -> Option<Self> {
        Some(match name {
            "box" => Self::Box {
                x: 1.0,
                y: 1.0,
                z: 1.0,
            },
            "icosphere" => Self::Icosphere {
                radius: 1.0,
                subdivisions: 3,
            },
            "needle" => Self::Needle {
                length: 2.0,
                radius: 0.05,
                sides: 6,
            },
            "plate" => Self::Plate {
                x: 2.0,
                y: 2.0,
                thickness: 0.02,
            },
            "torus" => Self::Torus {
                radius: 1.0,
                tube: 0.25,
                segments: 48,
                sides: 16,
            },
            "gear" => Self::Gear {
                tip: 1.0,
                root: 0.8,
                bore: 0.3,
                thickness: 0.3,
                teeth: 16,
            },
            "l-shape" => Self::LShape {
                x: 1.0,
                y: 1.0,
                arm: 0.3,
                thickness: 0.3,
            },
            "knot" => Self::Knot {
                radius: 1.0,
                tube: 0.15,
                segments: 96,
                sides: 12,
            },
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
    /// An unknown shape or size, or a value that the size does not allow; each names what would do.
    pub fn from_name(name: &str, sizes: &[(&str, f64)]) -> Result<Self, ShapeError> {
        let mut shape = Self::default_of(name).ok_or_else(|| ShapeError::UnknownShape {
            name: name.to_owned(),
        })?;
        for &(size, value) in sizes {
            shape.set(size, value)?;
        }
        shape.check()?;
        Ok(shape)
    }

    /// The mesh.
    ///
    /// # Errors
    /// Sizes that [`Self::from_name`] would refuse.
    pub fn build(&self) -> Result<TriangleMesh, ShapeError> {
        self.check()?;
        let (vertices, triangles) = match *self {
            Self::Box { x, y, z } | Self::Plate { x, y, thickness: z } => {
                polyhedra::cuboid([x, y, z])
            }
            Self::Icosphere {
                radius,
                subdivisions,
            } => polyhedra::icosphere(radius, subdivisions),
            Self::Needle {
                length,
                radius,
                sides,
            } => polyhedra::bipyramid(length, radius, sides),
            Self::Torus {
                radius,
                tube,
                segments,
                sides,
            } => tubes::torus(radius, tube, segments, sides),
            Self::Gear {
                tip,
                root,
                bore,
                thickness,
                teeth,
            } => prisms::gear([tip, root, bore], thickness, teeth),
            Self::LShape {
                x,
                y,
                arm,
                thickness,
            } => prisms::l_shape([x, y], arm, thickness),
            Self::Knot {
                radius,
                tube,
                segments,
                sides,
            } => tubes::trefoil(radius, tube, segments, sides),
        };
        Ok(TriangleMesh {
            name: self.name().to_owned(),
            vertices,
            triangles,
        })
    }

    fn sizes(&mut self) -> Vec<(&'static str, Size<'_>)> {
        use Size::{Count, Length};
        match self {
            Self::Box { x, y, z } => vec![("x", Length(x)), ("y", Length(y)), ("z", Length(z))],
            Self::Icosphere {
                radius,
                subdivisions,
            } => {
                vec![
                    ("radius", Length(radius)),
                    ("subdivisions", Count(subdivisions)),
                ]
            }
            Self::Needle {
                length,
                radius,
                sides,
            } => {
                vec![
                    ("length", Length(length)),
                    ("radius", Length(radius)),
                    ("sides", Count(sides)),
                ]
            }
            Self::Plate { x, y, thickness } => {
                vec![
                    ("x", Length(x)),
                    ("y", Length(y)),
                    ("thickness", Length(thickness)),
                ]
            }
            Self::Torus {
                radius,
                tube,
                segments,
                sides,
            }
            | Self::Knot {
                radius,
                tube,
                segments,
                sides,
            } => vec![
                ("radius", Length(radius)),
                ("tube", Length(tube)),
                ("segments", Count(segments)),
                ("sides", Count(sides)),
            ],
            Self::Gear {
                tip,
                root,
                bore,
                thickness,
                teeth,
            } => vec![
                ("tip", Length(tip)),
                ("root", Length(root)),
                ("bore", Length(bore)),
                ("thickness", Length(thickness)),
                ("teeth", Count(teeth)),
            ],
            Self::LShape {
                x,
                y,
                arm,
                thickness,
            } => vec![
                ("x", Length(x)),
                ("y", Length(y)),
                ("arm", Length(arm)),
                ("thickness", Length(thickness)),
            ],
        }
    }

    fn set(&mut self, name: &str, value: f64) -> Result<(), ShapeError> {
        let shape = self.name();
        let mut known = Vec::new();
        for (size, slot) in self.sizes() {
            if size != name {
                known.push(size);
                continue;
            }
            match slot {
                Size::Length(length) => *length = value as f32,
                Size::Count(count) if value.fract() == 0.0 && value.abs() < 1e9 => {
                    // A negative count saturates to 0, which `check` judges like any other.
                    *count = value as u32;
                }
                Size::Count(_) => {
                    let allowed = "a whole number".to_owned();
                    return Err(ShapeError::BadSize {
                        shape,
                        size,
                        value,
                        allowed,
                    });
                }
            }
            return Ok(());
        }
        Err(ShapeError::UnknownSize {
            shape,
            size: name.to_owned(),
            known,
        })
    }

    fn check(mut self) -> Result<(), ShapeError> {
        let shape = self.name();
        let bad = |size, value, allowed: String| {
            Err(ShapeError::BadSize {
                shape,
                size,
                value,
                allowed,
            })
        };
        for (size, slot) in self.sizes() {
            match slot {
                Size::Length(&mut length) => {
                    if !(MIN_LENGTH..=MAX_LENGTH).contains(&length) {
                        return bad(size, f64::from(length), "from 2^-60 to 2^58".to_owned());
                    }
                }
                Size::Count(&mut count) => {
                    let (least, most) = match (shape, size) {
                        ("icosphere", _) => (0, 7),
                        ("knot", "segments") => (32, 1024),
                        _ => (3, 1024),
                    };
                    if !(least..=most).contains(&count) {
                        return bad(size, f64::from(count), format!("from {least} to {most}"));
                    }
                }
            }
        }
        for (size, value, limit, meaning) in self.relations() {
            if value >= limit {
                return bad(
                    size,
                    f64::from(value),
                    format!("less than {limit}, {meaning}"),
                );
            }
        }
        Ok(())
    }

    /// Sizes that must stay below a limit set by other sizes, or the surface would cut itself.
    fn relations(&self) -> Vec<(&'static str, f32, f32, &'static str)> {
        match *self {
            Self::Torus { radius, tube, .. } => vec![("tube", tube, radius, "the ring's radius")],
            Self::Gear {
                tip, root, bore, ..
            } => vec![
                ("root", root, tip, "the tips' radius"),
                ("bore", bore, 0.9 * root, "nine tenths of the root's radius"),
            ],
            Self::LShape { x, y, arm, .. } => vec![("arm", arm, x.min(y), "the shorter side")],
            Self::Knot { radius, tube, .. } => {
                vec![("tube", tube, 0.2 * radius, "a fifth of the knot's radius")]
            }
            _ => Vec::new(),
        }
    }
}

/// Shortest length of a procedural shape, 2⁻⁶⁰: halves and squares of it stay far from underflow.
const MIN_LENGTH: f32 = 1.0 / (1_u64 << 60) as f32;

/// Longest length, 2⁵⁸: sums of two lengths stay within a mesh's largest coordinate.
const MAX_LENGTH: f32 = (1_u64 << 58) as f32;

/// Two triangles a → b → c → d, counter-clockwise.
fn quad([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
