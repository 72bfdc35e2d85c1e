//! Collision culling for many rigid bodies that never misses a touching pair: a broad phase for
//! meshes and for boxes.
//!
//! [`Culler`] takes the poses of all bodies and returns the pairs that might touch. It tests
//! bounding spheres first, and oriented k-DOPs (or-DOPs) only where spheres overlap; the two
//! together are called S-DOP. It uses SSE2, AVX2, AVX-512 or NEON, whichever the CPU has, and
//! reports the same pairs with each. Engines and simulators put it before their narrow phase.
//!
//! | you have | use |
//! |---|---|
//! | a fixed set of posed meshes | [`Culler`] |
//! | posed meshes that come and go | [`World`]: ids, groups, margins, f64 translations, events |
//! | bodies of several shapes, such as robots | [`compound`] in a [`World`]: pairs of parts |
//! | boxes, all of them new in each frame | [`BoxCuller`]: exactly the boxes that meet |
//! | boxes that come and go | [`BoxWorld`]: the same, with ids, groups and events |
//! | any of these in space that repeats along some axes | [`periodic`] |
//! | a volume, a line or another set to compare with a world | [`QueryIndex`] |
//! | single pairs from your own broad phase | [`world::PairTest`] |
//!
//! # The promise
//!
//! If two posed meshes intersect in exact real arithmetic, touching included, and at least one of
//! them may move, then every [`Strategy`] except the control [`Strategy::None`] reports the pair:
//! with every [`Finder`], on every CPU, and for all finite poses up to 2⁶⁰ in size. Pairs that
//! don't intersect may be reported too. Strategies differ in how many of those they report, and in
//! time.
//!
//! The answer is for one moment: there is no continuous detection. A narrow phase has to test the
//! reported pairs.
//!
//! # A first use
//!
//! ```
//! use sdop::{Bodies, Culler, ProceduralShape, Shape, ShapeSpec};
//!
//! // Once: a mesh (or `TriangleMesh::from_f32`, or a file) and its volumes.
//! let mesh = ProceduralShape::Box { x: 1.0, y: 1.0, z: 2.0 }.build()?;
//! let shapes = [Shape::build(&mesh, &ShapeSpec::default())?];
//!
//! let mut bodies = Bodies::default();
//! for x in [0.0, 1.5, 9.0] {
//!     let (shape, is_dynamic) = (0, true);
//!     let (quaternion, position) = ([0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
//!     bodies.push(shape, is_dynamic, quaternion, position);
//! }
//! let mut culler = Culler::new(&shapes, &bodies)?; // rejects numbers that aren't finite
//!
//! for _frame in 0..10 {
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
//! [`Culler::builder`] chooses strategy, finder, threads and more.
//!
//! # Conventions
//!
//! - **Axes**: right-handed. Any axis may point up.
//! - **Rotations**: quaternions in the order (x, y, z, w), of any non-zero norm. They turn the body
//!   frame into the world frame: a vertex p of a body is at R(q)·p + t.
//! - **Translations**: the position of the body's origin in the world frame. That origin is the
//!   mesh's own, as the file has it, unless [`Origin::Ball`] moves it to the centre of the smallest
//!   enclosing ball; [`Shape::offset`] says by how much.
//! - **Far meshes**: where rounding a mesh to f32 would move a vertex by more than 2⁻²⁰ of the
//!   mesh's size, its vertices are kept about a point near it. A [`World`] adds that offset to the
//!   pose in f64; a [`Culler`], whose poses are f32, rejects it.
//! - **Numbers in f64**: no pair of them is missed. [`Aabb::outward`] rounds a box;
//!   [`Body::turned`], [`World::set_pose_f64`], [`QueryVolume::shape`] and
//!   [`Part::turned`](compound::Part::turned) round a rotation, and [`TriangleMesh::from_f64`]
//!   vertices, and what they make is grown by what that may move. A [`Culler`] has no margins per
//!   body: bodies with poses in f64 belong into a [`World`].
//! - **Units**: any one unit of length, the same everywhere. Sizes and coordinates are finite and
//!   at most 2⁶⁰.
//! - **A pair** is two body indices i < j, of which at least one may move. A list holds a pair
//!   once. Its order depends on the finder and on earlier frames, never on the CPU or the number of
//!   threads; [`PairList::sorted`] sorts it.
//! - **Poses** may be of any type that converts to `[f32; 4]` and `[f32; 3]`, such as glam's `Quat`
//!   and `Vec3`.
//!
//! # Stages
//!
//! ```text
//!  mesh ──▶ volume ──▶ bodies ──▶ update ──▶ broad_phase ──▶ overlap ──▶ pairs
//!  check    ball,      poses as   volumes    candidates      survivors   i < j
//!           hull,      columns    in the     (might          (not
//!           or-DOP                world      meet)           separated)
//!  ╰─────── once ──────╯          ╰───────── each frame: Culler::cull ───────╯
//! ```
//!
//! [`Strategy`] says which tests run in which order; [`counters`] count how often each ran.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | none | boxes only: [`BoxCuller`], [`BoxWorld`], and queries about them |
//! | `shapes` (default) | meshes, hulls, or-DOPs, and everything that culls them |
//! | `readers` | reads and writes mesh files: OBJ, STL, PLY, OFF, `.tri` |
//! | `serde` | serialises settings, counters, and snapshots of worlds |
//! | `c` | the interface for C and C++, `src/c/sdop.h` |
//! | `wasm` | the interface for JavaScript, for `wasm32-unknown-unknown` |
//!
//! Every error prints what is wrong and how to mend the input; `problem` and `help` are its halves.
//!
//! # Related crates
//!
//! - `sdop-judge` checks any culler, in any language, against exact arithmetic.
//! - `sdop-bench` has scenes, measurements, studies and the program `sdop`.
//!
//! The repository has a guide, `paper/guide.md`, and short recipes, `paper/how-to.md`: excluded
//! pairs, compound bodies, periodic axes, rollback, coming from rapier or Bullet.

#![cfg_attr(
    not(feature = "shapes"),
    allow(rustdoc::broken_intra_doc_links, reason = "pages name what boxes alone lack"),
    allow(dead_code, unused_imports, reason = "rooms below have what only shapes use")
)]

pub mod bodies;
pub mod boxes;
#[cfg(feature = "c")]
pub mod c;
#[cfg(feature = "shapes")]
pub mod compound;
pub mod counters;
#[cfg(feature = "shapes")]
pub mod culler;
pub mod living;
#[cfg(feature = "shapes")]
pub mod mesh;
pub mod pairs;
pub mod periodic;
pub mod query;
pub mod settings;
#[cfg(feature = "shapes")]
pub mod volume;
#[cfg(feature = "wasm")]
pub mod wasm;
#[cfg(feature = "shapes")]
pub mod world;

mod cull_error;
mod listing;
#[cfg_attr(not(feature = "shapes"), path = "posed/none.rs")]
mod posed;
mod problem;
#[cfg(feature = "shapes")]
mod strategy;

// Inner rooms, which the judge, tests and benches enter from outside: no promise is made about
// them.
#[doc(hidden)]
pub mod broad_phase;
#[doc(hidden)]
pub mod choice;
#[cfg(feature = "readers")]
#[doc(hidden)]
pub mod files;
#[cfg(feature = "shapes")]
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

// Shown on the front page with their descriptions.
#[doc(inline)]
pub use {
    bodies::contract::ContractError,
    bodies::{Aabb, Bodies, Body, Groups, Motion},
    boxes::{BoxCuller, BoxWorld},
    cull_error::CullError,
    living::{BodyId, Event, Events, LivingSet, WorldError},
    pairs::PairList,
    query::{Line, QueryIndex, QueryVolume},
    settings::{
        Axes, Budget, CullSettings, DirectionSet, Finder, Interest, Order, Overlap, SettingsError,
        Strategy, Updates, ViewCone,
    },
    simd::{Tier, TierError},
    threads::ThreadsError,
};
#[cfg(feature = "shapes")]
#[doc(inline)]
pub use {
    culler::{Culler, CullerBuilder},
    mesh::{MeshError, ProceduralShape, TriangleMesh},
    volume::{Origin, Shape, ShapeSpec, VolumeError},
    world::World,
};

/// The README's example compiles; `.ci/run` runs it in a project of its own.
#[cfg(all(doctest, feature = "readers"))]
#[doc = include_str!("../README.md")]
struct Readme;

/// The recipes compile and run.
#[cfg(doctest)]
#[doc = include_str!("../paper/how-to.md")]
struct HowTo;
