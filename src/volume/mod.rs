//! Bounding volumes, built once per mesh (the paper's Co) in the body frame.

use glam::Vec3;

/// A ball that contains every vertex of its mesh exactly: ‖v − c‖ ≤ r in real arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre in the body frame.
    pub centre: Vec3,
    /// Radius, rounded up.
    pub radius: f32,
}

/// The slab directions of a k-DOP, as integer combinations of its orthogonal basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum DirectionSet {
    /// The three axes.
    K6,
    /// Axes and the four cube diagonals.
    K14,
    /// Axes and the six face diagonals: the Tribox set.
    K18,
    /// Axes, face diagonals and cube diagonals.
    K26,
}

/// An orthogonal basis whose three columns have one common norm and f32-exact entries:
/// an integer quaternion's rotation matrix times |q|² ≤ 2²², scaled by a power of two so that the norm is in (½, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The basis vectors in the body frame.
    pub columns: [Vec3; 3],
}

/// An oriented k-DOP in the body frame: `lo[i] ≤ d_i·x ≤ hi[i]` for every vertex x in exact arithmetic,
/// with d_i = Σ_j coefficient[i][j]·columns[j].
#[derive(Clone, Debug, PartialEq)]
pub struct OrDop {
    /// Which slab directions.
    pub directions: DirectionSet,
    /// The exact basis that the directions combine.
    pub basis: Basis,
    /// Lower slab ends, one a direction, rounded down.
    pub lo: Vec<f32>,
    /// Upper slab ends, one a direction, rounded up.
    pub hi: Vec<f32>,
}

/// A mesh with its volumes: what the culler needs to know of a body's form.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The mesh's name.
    pub name: String,
    /// Vertices as culled (body frame; for `origin = "ball"` re-centred and scaled, rounded to f32).
    pub vertices: Vec<Vec3>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Smallest enclosing ball of `vertices`, rounded up.
    pub ball: Ball,
    /// ρ: the largest vertex norm about the body origin, rounded up.
    pub reach: f32,
    /// The oriented k-DOP of `vertices`.
    pub ordop: OrDop,
}
