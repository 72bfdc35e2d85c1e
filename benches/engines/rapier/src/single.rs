//! For `rapier3d`, whose numbers are f32.

pub use rapier3d as rapier;

#[path = "../../../../examples/rapier/src/dispatcher.rs"]
mod dispatcher;
#[path = "../../../../examples/rapier/src/filter.rs"]
mod filter;
#[path = "../../../../examples/rapier/src/volumes.rs"]
mod volumes;

pub use dispatcher::CullingDispatcher;
pub use filter::{Cost, Filter, HOOKS};
pub use volumes::{Step, volume};

#[path = "proof/mod.rs"]
pub mod proof;
