//! Bounding volumes as plain numbers in the body frame (design, section 2): built elsewhere, judged here.

use std::sync::OnceLock;

use crate::InvalidInput;
use crate::exact::mesh::Mesh;
use crate::exact::polytope::Polytope;
use crate::linear::Vector;

/// The ball ‖x − c‖ ≤ r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre c.
    pub centre: [f32; 3],
    /// Radius r ≥ 0.
    pub radius: f32,
}

/// The k/2 slab directions of a k-DOP as integer combinations of a basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DirectionSet {
    /// The axes.
    K6,
    /// Axes and cube diagonals.
    K14,
    /// Axes and face diagonals, the Tribox set.
    K18,
    /// All of them.
    K26,
}

const AXES: [[i32; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const FACE_DIAGONALS: [[i32; 3]; 6] = [
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
];
const CUBE_DIAGONALS: [[i32; 3]; 4] = [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [-1, -1, 1]];

impl DirectionSet {
    /// Every set, coarse to fine.
    pub const ALL: [Self; 4] = [Self::K6, Self::K14, Self::K18, Self::K26];

    /// The coefficients of each direction over the basis.
    pub fn coefficients(self) -> Vec<[i32; 3]> {
        let (faces, cubes) = match self {
            Self::K6 => (&FACE_DIAGONALS[..0], &CUBE_DIAGONALS[..0]),
            Self::K14 => (&FACE_DIAGONALS[..0], &CUBE_DIAGONALS[..]),
            Self::K18 => (&FACE_DIAGONALS[..], &CUBE_DIAGONALS[..0]),
            Self::K26 => (&FACE_DIAGONALS[..], &CUBE_DIAGONALS[..]),
        };
        [&AXES[..], faces, cubes].concat()
    }
}

/// An oriented k-DOP: lo_i ≤ d_i·x ≤ hi_i with d_i = Σ_j coefficient_ij·basis_j.
#[derive(Clone, Debug, PartialEq)]
pub struct Slabs {
    /// Which directions.
    pub directions: DirectionSet,
    /// The three basis vectors, exactly orthogonal and of one norm.
    pub basis: [[f32; 3]; 3],
    /// Lower slab ends.
    pub lo: Vec<f32>,
    /// Upper slab ends.
    pub hi: Vec<f32>,
}

impl Slabs {
    /// The box that the first three slabs make.
    pub fn axes_only(&self) -> Self {
        let first = |ends: &[f32]| ends.iter().take(3).copied().collect();
        Self {
            directions: DirectionSet::K6,
            basis: self.basis,
            lo: first(&self.lo),
            hi: first(&self.hi),
        }
    }
}

/// A mesh with its volumes.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Bounding ball.
    pub ball: Ball,
    /// Oriented k-DOP.
    pub slabs: Slabs,
    /// Its corners, exact and rounded.
    pub polytope: Polytope,
    /// The oriented box's polytope: of the slabs' first three axes unless [`Shape::with_obb`] gave another.
    pub obb: Polytope,
    /// Vertices as culled.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex triples.
    pub triangles: Vec<[u32; 3]>,
    mesh: OnceLock<Mesh>,
}

impl Shape {
    /// A shape of a ball, slabs and a mesh. Whether the volumes contain the mesh is not asked here.
    ///
    /// # Errors
    /// When a number is not finite, the slabs are not k/2, the basis is not exact or an index is out of range.
    pub fn new(
        ball: Ball,
        slabs: Slabs,
        vertices: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, InvalidInput> {
        if !ball.centre.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the ball's centre"));
        }
        if !(ball.radius >= 0.0 && ball.radius.is_finite()) {
            return Err(InvalidInput::Radius);
        }
        check_mesh(&vertices, &triangles)?;
        let polytope = Polytope::new(&slabs)?;
        let obb = Polytope::new(&slabs.axes_only())?;
        Ok(Self {
            ball,
            slabs,
            polytope,
            obb,
            vertices,
            triangles,
            mesh: OnceLock::new(),
        })
    }

    /// The same shape with an oriented box of its own (`directions` K6) for the `obb` strategy.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn with_obb(self, slabs: &Slabs) -> Result<Self, InvalidInput> {
        Ok(Self {
            obb: Polytope::new(slabs)?,
            ..self
        })
    }

    /// The mesh prepared for exact judgement, at first use.
    pub fn mesh(&self) -> &Mesh {
        self.mesh
            .get_or_init(|| Mesh::checked(&self.vertices, &self.triangles))
    }

    /// The vertices in f64.
    pub fn points(&self) -> impl Iterator<Item = Vector<f64>> {
        self.vertices.iter().map(|v| v.map(f64::from))
    }
}

/// Finite vertices and indices in range.
pub(crate) fn check_mesh(
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
) -> Result<(), InvalidInput> {
    if !vertices.iter().flatten().all(|x| x.is_finite()) {
        return Err(InvalidInput::NotFinite("a vertex"));
    }
    for (triangle, indices) in triangles.iter().enumerate() {
        if let Some(&vertex) = indices.iter().find(|i| **i as usize >= vertices.len()) {
            return Err(InvalidInput::Index {
                triangle,
                vertex,
                vertices: vertices.len(),
            });
        }
    }
    Ok(())
}
