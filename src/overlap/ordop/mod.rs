//! or-DOP against or-DOP: separating axes among slab normals (and edge × edge), a vector of pairs
//! at a time.
//!
//! A body's or-DOP is stored in its row: Q, the orthonormal world directions of its basis (rounded
//! once to f32), the input translation t, and o, the offset of the slabs' centre. For a pair, M =
//! Q_Bᵀ·Q_A turns A's directions into B's coordinates, τ = a·Δ is the distance of the centres along
//! a direction a, and
//!
//! > separated ⇐ τ > h_A(a) + h_B(−a), with a turned so that τ ≥ 0.
//!
//! One side suffices because every slab contains its centre. h is the support: exact for a body's
//! own normals, and bounded by weak duality for the other's ([`support`]). There is no margin at
//! run time, because the slabs include it ([`table`]). Each lane has one pair, whose two rows are
//! loaded as columns, so no lane is idle for any k. A block of pairs is tested with A's normals
//! first. The survivors are packed together with their frames and tested with B's normals and then
//! the edges, so that half the pairs cost half the time.
//!
//! Optimisations, and the time per pair after each (k = 18, two-sided, AVX-512, the paper's set
//! with mixed shapes; 48.3 ns before):
//!
//! | step | ns |
//! |---|---|
//! | ends of each lane's slabs loaded once ([`slabs`]) instead of gathered, survivors of A's normals packed | 20.7 |
//! | up to 16 shapes: ends by permutation instead of rows (many shapes: 14.6 in the end) | 20.9 |
//! | directions written out, no loop that keeps vectors in memory for its index | 12.6 |
//! | pairs, bounds and the choice of loader once per block; no frames kept that no later axis needs | 8.7 |
//!
//! Rows are prefetched where there are more than the caches hold ([`kernel`]); with fewer, that
//! took 13 to 18 % longer. Rejected from counts: trying only axes on which the slab and an
//! inscribed ball leave a gap (4.7 of 18 per pair, but 8.8 for the worst of 16 lanes, and a
//! separate axis per lane costs half as much again); trying the axis nearest to Δ first (saves at
//! most one in eight evaluations); packing between A's normals (a packing costs as much as five
//! axes).

mod axes;
pub mod edges;
pub mod kernel;
pub mod reach;
pub mod slabs;
pub mod support;
pub mod table;

pub use kernel::{OrDopColumns, TestOutcome};
pub use table::SlabTables;
