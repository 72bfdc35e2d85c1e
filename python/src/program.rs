//! The command `sdop`.

use pyo3::prelude::*;

/// Runs the command `sdop` with these arguments, the program's name first, and returns its exit
/// code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| sdop_bench::commands::main(arguments))
}
