//! or-DOP against or-DOP: separating axes among slab normals (and edge × edge), a vector of pairs at a time.
//!
//! A body's or-DOP lives in its row: Q, the orthonormal world directions of its basis (once-rounded f32), the input
//! translation t, and o, the offset of the slabs' centre. For a pair, M = Q_Bᵀ·Q_A turns A's directions into B's
//! coordinates, τ = a·Δ is the gap of the centres along a direction a, and
//!
//! > separated ⇐ τ > h_A(a) + h_B(−a), with a turned so that τ ≥ 0.
//!
//! One side suffices because every slab contains its centre. h is the support: exact for a body's own normals, bounded
//! by weak duality for the other's ([`support`]). No margin at run time: the slabs carry it ([`table`]).
//! Lanes are pairs: each pair's two rows are loaded as columns, so no lane is idle whatever k is.

mod axes;
pub mod edges;
pub mod kernel;
pub mod reach;
pub mod support;
pub mod table;

pub use axes::{O, Q, T};
pub use kernel::{OrDopColumns, Tested};
pub use table::SlabTables;
