//! For `rapier3d`, whose numbers are f32.

pub use rapier3d as rapier;

#[path = "dispatcher.rs"]
mod dispatcher;
#[path = "filter.rs"]
mod filter;
#[path = "volumes.rs"]
mod volumes;

pub use dispatcher::CullingDispatcher;
pub use filter::{Cost, Filter, HOOKS};
pub use volumes::{Step, volume};

#[path = "proof/mod.rs"]
pub mod proof;
