//! The pair tests, one file per volume: columns or rows in, surviving pairs out.
//!
//! Every test rejects by a strict `>` on conservatively inflated volumes, so touching is reported
//! and NaN never culls. First volume tests are [`SlotTest`](crate::broad_phase::SlotTest)s, and
//! those of the finder's own balls [`BallTest`](crate::broad_phase::BallTest)s, which share the way
//! through runs and blocks. The test of the ends of long boxes stands in `broad_phase`, whose lists
//! of neighbours take it too. A test counts when a candidate pair is handed to it; padding lanes
//! never count.

pub mod boxes;
#[cfg(feature = "shapes")]
pub mod intervals;
#[cfg(feature = "shapes")]
pub mod ordop;
#[cfg(feature = "shapes")]
pub mod sphere;
