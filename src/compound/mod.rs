//! Bodies of several shapes: robots, vehicles, furniture, a concave mesh cut into convex pieces.
//!
//! A [`Compound`] is a list of parts, each a shape with a pose in the frame of the body. Its
//! [`shape`](Compound::shape) contains all of them: give that to a [`World`](crate::World) like any
//! other shape, and insert one body per robot. The world then finds pairs of bodies, and a
//! [`PartCuller`] finds the pairs of parts within them: S-DOP on two levels. Parts of one body are
//! never paired. Groups, excluded pairs, margins, rest and events belong to bodies and work as
//! before.
//!
//! The promise is that of culling. If the meshes of two parts, each grown by the margin of its body
//! and posed by its local pose and then by the pose of its body, meet in exact arithmetic, and the
//! world may report the two bodies, the pair of parts is reported. This includes the rounding of
//! composed poses: parts are grown by its bound.
//!
//! ```
//! use sdop::compound::{Compound, Part, PartCuller};
//! use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};
//!
//! let link = ProceduralShape::Box { x: 1.0, y: 0.25, z: 0.25 }.build()?;
//! let shapes = [Shape::build(&link, &ShapeSpec::default())?];
//! let along = |x: f64| Part { translation: [x, 0.0, 0.0], ..Part::default() };
//! let arm = Compound::build("arm", &shapes, &[along(0.0), along(1.0), along(2.0)])?;
//!
//! let mut world = World::new(vec![arm.shape().clone(), shapes[0].clone()])?;
//! let robot = world.insert(Body::default())?;
//! let plank = world.insert(Body::at(1, [0.0, 0.0, 0.0, 1.0], [2.2, 0.2, 0.0]))?;
//!
//! let mut parts = PartCuller::new();
//! parts.set_parts(0, arm); // shape 0 of the world has these parts
//! world.cull()?;
//! let pairs = parts.cull(&world)?;
//! assert_eq!((pairs.len(), pairs[0].bodies, pairs[0].parts), (1, [robot, plank], [2, 0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod build;
mod culler;
mod error;
mod part_set;

pub use build::{Compound, Part};
pub use culler::{PartCuller, PartPair};
pub use error::CompoundError;
