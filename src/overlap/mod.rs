//! The pair tests, one file per volume: columns or rows in, surviving pairs out.
//!
//! Every test rejects by a strict `>` on conservatively inflated volumes, so touching pairs are
//! reported and a NaN never rejects. First volume tests are
//! [`SlotTest`](crate::broad_phase::SlotTest)s; those of the finder's own balls are
//! [`BallTest`](crate::broad_phase::BallTest)s, which share the loops over runs and blocks. The
//! test of the ends of long boxes is in `broad_phase`, because lists of neighbours use it too. A
//! test counts when a candidate pair is passed to it; padding lanes never count.

pub mod intervals;
pub mod ordop;
pub mod sphere;
