//! The pair tests, one file a volume: columns or rows in, surviving pairs out.
//!
//! Every test rejects by a strict `>` on conservatively inflated volumes, so touching is reported and NaN never culls.
//! A test counts when a candidate pair is handed to it; padding lanes never count.

pub mod intervals;
pub mod ordop;
pub mod sphere;
