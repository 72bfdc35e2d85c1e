//! The extension module of the Python package `sdop`: arrays in, arrays out, and no
//! decisions.
//!
//! Every class guards its culler with a lock that is taken without the interpreter's, so that
//! threads of Python take turns instead of failing, and others run while a frame is culled.

mod arguments;
mod arrays;
mod boxes;
mod compound;
mod culler;
mod errors;
mod exact;
mod ids;
mod judge;
mod periodic;
mod pickles;
mod program;
mod query;
mod shape;
mod world;
mod worlds;

#[pyo3::pymodule]
mod _sdop {
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "its name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use super::boxes::{BoxCuller, BoxWorld, box_pairs, rounded_outward};
    #[pymodule_export]
    use super::compound::{Compound, PartCuller};
    #[pymodule_export]
    use super::culler::Culler;
    #[pymodule_export]
    use super::errors::{CaseSkipped, SdopError};
    #[pymodule_export]
    use super::exact::exact_meet;
    #[pymodule_export]
    use super::judge::{Scene, judge};
    #[pymodule_export]
    use super::periodic::{PeriodicBoxes, PeriodicEvents, PeriodicWorld};
    #[pymodule_export]
    use super::program::main;
    #[pymodule_export]
    use super::query::QueryIndex;
    #[pymodule_export]
    use super::shape::Shape;
    #[pymodule_export]
    use super::world::{Events, World};
}
