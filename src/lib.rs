//! Which pairs of rigid bodies might touch? Collision culling by bounding spheres and oriented
//! k-DOPs (S-DOP), on SIMD in every tier of the CPU, that never misses a pair.
//!
//! # The promise
//!
//! If two posed meshes intersect in exact real arithmetic, touching included, and at least one of
//! them may move, the pair is reported: by every [`Strategy`] but the control [`Strategy::None`],
//! with every [`Finder`], on every CPU, for any finite poses up to 2⁶⁰ in size. Pairs that don't
//! intersect may be reported too; strategies differ in how many, and in time. The question is who
//! touches *now*: there is no continuous detection, and a narrow phase still has to judge what is
//! reported.
//!
//! # A first use
//!
//! ```
//! use sdop::{Bodies, Culler, ProceduralShape, Shape, ShapeSpec};
//!
//! let mesh = ProceduralShape::Box { x: 1.0, y: 1.0, z: 2.0 }.build()?; // or `TriangleMesh::from_f32`, or a file
//! let shapes = [Shape::build(&mesh, &ShapeSpec::default())?]; // ball, hull and or-DOP, once
//!
//! let mut bodies = Bodies::default();
//! for x in [0.0, 1.5, 9.0] {
//!     bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]); // shape, dynamic, quaternion, translation
//! }
//! let mut culler = Culler::new(&shapes, &bodies)?; // refuses what is not finite or out of range
//! for _ in 0..10 {
//!     for translation in &mut bodies.translation {
//!         translation[0] *= 0.8; // your simulation moves the bodies …
//!     }
//!     for [i, j] in culler.cull(&bodies)?.iter() {
//!         assert!(i < j); // … and your narrow phase judges these
//!     }
//! }
//! assert_eq!(culler.pairs().sorted(), [[0, 1], [0, 2], [1, 2]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Culler::builder`] chooses strategy, finder, threads and more. A [`Culler`] has a fixed set of
//! bodies; in a [`World`] they come and go, with stable ids, groups, contact margins, f64
//! translations and events. Whoever has boxes already takes [`BoxCuller`] or [`BoxWorld`]: exactly
//! the pairs of boxes that meet. A [`QueryIndex`] answers which bodies of a world touch a volume or
//! lie along a line.
//!
//! # Conventions
//!
//! - **Axes**: right-handed. Which one points up doesn't matter: nothing here prefers an axis.
//! - **Rotations**: quaternions in the order (x, y, z, w), of any non-zero norm. They turn the body
//!   frame into the world frame: a vertex p of a body stands at R(q)·p + t.
//! - **Translations**: of the body's origin, world frame. That is the mesh's own origin, as the
//!   file has it, unless [`Origin::Ball`] moves the centre of the smallest enclosing ball there;
//!   [`Shape::offset`] keeps what was moved.
//! - **Far meshes**: where rounding a mesh to f32 would move a vertex by more than 2⁻²⁰ of the
//!   mesh's size, its vertices are kept about a point near it. A [`World`] adds that offset to the
//!   pose in f64; a [`Culler`], whose poses are f32, refuses it.
//! - **Units**: any one unit of length, the same everywhere. Sizes and coordinates are finite and
//!   at most 2⁶⁰.
//! - **A pair** is two body indices i < j, of which at least one may move. A list holds a pair
//!   once, and its order depends on the finder and the frames so far, never on the CPU or the
//!   number of threads; [`PairList::sorted`] gives an order of its own.
//! - **Poses** are taken as anything that turns into arrays: `[f32; 4]` and `[f32; 3]`, or glam's
//!   `Quat` and `Vec3`.
//!
//! # Stages
//!
//! ```text
//!  mesh ──▶ volume ──▶ bodies ──▶ update ──▶ broad_phase ──▶ overlap ──▶ pairs
//!  check    ball,      poses as   volumes    candidates      survivors   i < j
//!           hull,      columns    into the   (who might      (who does
//!           or-DOP                world      meet)           not miss)
//!  ╰─────── once ──────╯          ╰───────── each frame: Culler::cull ───────╯
//! ```
//!
//! [`strategy`](Strategy) names which tests run in which order; [`counters`] say how often each
//! did.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | none | boxes alone: [`BoxCuller`], [`BoxWorld`] |
//! | `shapes` (default) | meshes, hulls and or-DOPs, and what culls them: all of the above |
//! | `readers` | readers and writers of mesh files: OBJ, STL, PLY, OFF, `.tri` |
//! | `serde` | settings, choices and counters as serde's data; snapshots of worlds that can be stored and sent |
//!
//! Every error has a `help` method: how to mend what it reports.
//!
//! The crate `sdop-judge` judges any culler against the exact reference. `sdop-bench` has scenes,
//! measurements, studies and the program `sdop`.

#![cfg_attr(
    not(feature = "shapes"),
    allow(
        rustdoc::broken_intra_doc_links,
        reason = "this page names what boxes alone lack"
    )
)]

pub mod bodies;
pub mod boxes;
#[cfg(feature = "c")]
pub mod c;
pub mod counters;
pub mod culler;
#[cfg(feature = "shapes")]
pub mod mesh;
pub mod pairs;
pub mod query;
pub mod settings;
#[cfg(feature = "shapes")]
pub mod volume;
pub mod world;

mod strategy;

// Inner rooms, which the judge, tests and benches enter from outside: no promise is made about
// them.
#[doc(hidden)]
pub mod broad_phase;
#[doc(hidden)]
pub mod choice;
#[cfg(feature = "readers")]
pub mod files;
#[doc(hidden)]
pub mod overlap;
#[doc(hidden)]
pub mod rounding;
#[doc(hidden)]
pub mod simd;
#[doc(hidden)]
pub mod threads;
#[cfg(feature = "shapes")]
#[doc(hidden)]
pub mod update;

pub use bodies::contract::ContractError;
pub use bodies::{Aabb, Bodies, Groups, Motion};
pub use boxes::{BoxCuller, BoxWorld};
pub use culler::CullError;
#[cfg(feature = "shapes")]
pub use culler::{Culler, CullerBuilder};
#[cfg(feature = "shapes")]
pub use mesh::{MeshError, ProceduralShape, TriangleMesh};
pub use pairs::PairList;
pub use query::{Line, QueryIndex, QueryVolume};
pub use settings::Finder;
#[cfg(feature = "shapes")]
pub use settings::{
    Axes, Budget, CullSettings, DirectionSet, Interest, Order, Overlap, SettingsError, Strategy,
    Updates, ViewCone,
};
pub use simd::{Tier, TierError};
pub use threads::ThreadsError;
#[cfg(feature = "shapes")]
pub use volume::{Origin, Shape, ShapeSpec, VolumeError};
#[cfg(feature = "shapes")]
pub use world::{Body, World};
pub use world::{BodyId, Event, Events, WorldError};

/// The README's example compiles and runs.
#[cfg(all(doctest, feature = "readers"))]
#[doc = include_str!("../README.md")]
struct Readme;

/// The recipes compile and run.
#[cfg(doctest)]
#[doc = include_str!("../paper/how-to.md")]
struct HowTo;
