//! Queries: which bodies may touch a volume, which body does a line meet first, which bodies of one
//! set may meet those of another?
//!
//! Use them for picking, sensors, explosions, lines of sight and placing a body. A [`QueryIndex`]
//! holds the bodies of a [`World`](crate::World) or a [`BoxWorld`](crate::BoxWorld) as they were at
//! its last update. An update compares each body with its copy in the index and changes only those
//! that differ: an unchanged body costs one comparison, and a query builds nothing. No cull is
//! needed.
//!
//! The promise is that of culling: no body is missed that has a point in common with the volume or
//! the line in exact arithmetic, touching included. Boxes are reported for a box exactly if they
//! meet. For balls and lines, a box may also be reported at a distance below 2⁻⁵⁰ of the lengths
//! involved, because f64 rounds. Bodies of a `World` are grown by their margins and tested by their
//! boxes, balls and or-DOPs, as in culling, so a narrow phase has to test the reported ones.
//! Queries ignore groups and whether a body moves: filter the answers. In space that repeats, use
//! [`PeriodicIndex`](crate::periodic::PeriodicIndex).
//!
//! ```
//! use sdop::{Aabb, BoxWorld, Line, QueryIndex, QueryVolume};
//!
//! let mut world = BoxWorld::new();
//! let crates = [0.0, 2.0, 4.0].map(|x| Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]));
//! let [near, middle, far] = crates.map(|aabb| world.insert(aabb).unwrap());
//!
//! let mut index = QueryIndex::new();
//! index.update(&world);
//! let ball = QueryVolume::Ball { centre: [1.5, 0.5, 0.5], radius: 0.5 };
//! assert_eq!(index.touching(&ball)?, [near, middle]); // touching is meeting
//! let line = Line::Segment { from: [9.0, 0.5, 0.5], to: [-1.0, 0.5, 0.5] };
//! let first = index.first(&line)?.unwrap();
//! assert_eq!(first.body, far);
//! assert!(first.at <= 0.4 && first.at > 0.399_999);
//! # Ok::<(), sdop::query::QueryError>(())
//! ```

mod answers;
mod index;
mod lines;
mod sets;
mod source;
mod tree;
mod volume;

pub use crate::posed::QueryShape;
pub use answers::Answers;
pub use index::QueryIndex;
pub use lines::LineHit;
pub use source::QuerySource;
pub(crate) use source::{FIXED_TREE, MOVING_TREE, sealed::Sealed};
pub use volume::{Line, QueryError, QueryVolume};
