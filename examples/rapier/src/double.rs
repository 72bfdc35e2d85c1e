//! For `rapier3d-f64`, whose numbers are f64.

pub use rapier3d_f64 as rapier;

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
