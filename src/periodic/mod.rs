//! Worlds in which space repeats along some axes: molecular dynamics, grains in a periodic cell,
//! tilings.
//!
//! `PeriodicWorld` has posed meshes, [`PeriodicBoxes`] boxes with ends in f64. Each of the axes
//! x, y and z may have a period. A body may be anywhere, also many periods away, and has images
//! everywhere: copies moved by whole periods. A pair is reported if an image of one body may touch
//! the other body. It is reported once, with the number of periods by which the second body has to
//! be moved to touch the first ([`PeriodicPair::image`]).
//!
//! Along a periodic axis, a body has to be smaller than half of the period, so that two bodies can
//! touch in at most one image. Larger bodies are rejected with an error that gives their size: the
//! length of a box, or the diameter of the ball around a mesh, including its margin. For particles
//! with a cutoff radius this is the minimum image convention: the cutoff is less than half of the
//! period.
//!
//! The promise is that of `World` and [`BoxWorld`], for the exact periods. If two meshes, each
//! grown by its margin, meet in exact arithmetic when one of them is moved by whole periods, the
//! pair is reported. Boxes are reported exactly if they meet. Wrapping a position does not round
//! it. If f64 rounds an image's translation, the image is grown by a bound of the error.
//!
//! Internally, an ordinary world holds each body within one period. A body near a lower border also
//! has images beyond the upper one: one image near a single border, three at an edge, seven at a
//! corner. "Near" means within one to two widths of the widest body so far, so a single giant makes
//! many bodies cost more. Setting a body costs several times as much as in a world without
//! periods, and each reported pair is compared once more. [`PeriodicIndex`] answers queries.
//!
//! ```
//! use sdop::periodic::{PeriodicBox, PeriodicBoxes};
//!
//! let mut cell = PeriodicBoxes::new([Some(10.0), Some(10.0), None])?; // z has no period
//! let left = cell.insert(PeriodicBox::new([0.0, 4.0, 0.0], [1.0, 5.0, 1.0]))?;
//! let right = cell.insert(PeriodicBox::new([9.0, 4.5, 0.5], [10.0, 5.5, 1.5]))?;
//! let pairs = cell.cull()?;
//! assert_eq!((pairs.len(), pairs[0].bodies), (1, [left, right])); // touching is meeting
//! assert_eq!(pairs[0].image, [-1, 0, 0]); // the right box, one period to the left
//! # Ok::<(), sdop::periodic::PeriodicError>(())
//! ```

mod borders;
mod boxes;
mod error;
mod images;
mod pairs;
pub(crate) mod periods;
mod query;
mod world;

pub use boxes::PeriodicBox;
pub use error::PeriodicError;
pub use images::ImageSource;
pub(crate) use images::{PlacedBody, Placement};
pub use pairs::{PeriodicEvents, PeriodicPair};
pub use query::{PeriodicHit, PeriodicIndex};
pub use world::Periodic;

use crate::boxes::{BoxCullerBuilder, BoxWorld, Boxes};

/// A long-lived set of boxes in space that repeats along some axes.
pub type PeriodicBoxes = Periodic<Boxes>;

impl PeriodicBoxes {
    /// No boxes yet, culled with all defaults. `None` is an axis without a period.
    ///
    /// # Errors
    /// A period is not a length between 2⁻⁵⁶ and 2⁵⁶.
    pub fn new(periods: [Option<f64>; 3]) -> Result<Self, PeriodicError> {
        Self::of(BoxWorld::new(), periods)
    }

    /// No boxes yet, culled with the choices of a builder.
    ///
    /// # Errors
    /// As [`Self::new`], or the system cannot start the threads.
    pub fn with(
        culler: &BoxCullerBuilder,
        periods: [Option<f64>; 3],
    ) -> Result<Self, PeriodicError> {
        Self::of(BoxWorld::with(culler)?, periods)
    }
}
