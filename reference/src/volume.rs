//! Bounding volumes as plain numbers in the body frame. This crate judges them; it does not build
//! them.

use crate::InvalidInput;

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
const FACE_DIAGONALS: [[i32; 3]; 6] =
    [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
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
            return Err(InvalidInput::Index { triangle, vertex, vertices: vertices.len() });
        }
    }
    Ok(())
}
