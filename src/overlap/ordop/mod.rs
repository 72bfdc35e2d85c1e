//! or-DOP against or-DOP: separating axes among slab normals (and edge × edge), a vector of pairs
//! at a time.
//!
//! A body's or-DOP lives in its row: Q, the orthonormal world directions of its basis (once-rounded
//! f32), the input translation t, and o, the offset of the slabs' centre. For a pair, M = Q_Bᵀ·Q_A
//! turns A's directions into B's coordinates, τ = a·Δ is the gap of the centres along a direction
//! a, and
//!
//! > separated ⇐ τ > h_A(a) + h_B(−a), with a turned so that τ ≥ 0.
//!
//! One side suffices because every slab contains its centre. h is the support: exact for a body's
//! own normals, bounded by weak duality for the other's ([`support`]). No margin at run time: the
//! slabs carry it ([`table`]). Lanes are pairs: each pair's two rows are loaded as columns, so no
//! lane is idle whatever k is. A block of pairs goes through A's normals first; what they leave is
//! packed together with its frames and goes through B's, then the edges, so that half of the pairs
//! cost half.
//!
//! What was tried, k = 18, two-sided, AVX-512, ns per pair of the paper's set with mixed shapes
//! (from 48.3):
//!
//! | step | ns |
//! |---|---|
//! | ends of each lane's slabs loaded once ([`slabs`]) instead of gathered, survivors of A's normals packed | 20.7 |
//! | up to 16 shapes: ends by permutation instead of rows (many shapes: 14.6 in the end) | 20.9 |
//! | directions written out, no loop that keeps vectors in memory for its index | 12.6 |
//! | pairs, bounds and the choice of loader once per block; no frames kept that no later axis needs | 8.7 |
//!
//! Measured and dropped: prefetching a block's rows (nothing at a million bodies, 13 to 18 % lost
//! in the caches). Reasoned away, from counts: trying only axes on which the slab and an inscribed
//! ball leave a gap (4.7 of 18 per pair, but 8.8 for the worst of 16 lanes, and each lane's own
//! axis costs half as much again); the axis nearest to Δ first (saves one in eight evaluations at
//! best); packing within A's normals (a packing costs as much as five axes).

mod axes;
pub mod edges;
pub mod kernel;
mod posed;
pub mod reach;
pub mod slabs;
pub mod support;
pub mod table;

pub use kernel::{OrDopColumns, Tested};
pub use posed::PosedOrDops;
pub use table::SlabTables;
