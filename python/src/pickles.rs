//! What `pickle` stores of an object: a version, and a state of which the class makes it again.

use pyo3::PyTypeInfo;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::errors::with_help;

/// The version of pickles that this library writes and reads.
const VERSION: u32 = 1;

/// The result of `__reduce__`: the `_unpickled` of the class `C`, and what it is called with.
pub fn reduced<'py, C: PyTypeInfo>(
    py: Python<'py>,
    state: impl IntoPyObject<'py>,
) -> PyResult<Bound<'py, PyTuple>> {
    (py.get_type::<C>().getattr("_unpickled")?, (VERSION, state)).into_pyobject(py)
}

/// The state in a pickle. Other versions are rejected.
pub fn state<'py, S: FromPyObjectOwned<'py>>(
    version: u32,
    state: &Bound<'py, PyAny>,
) -> PyResult<S> {
    if version != VERSION {
        return Err(with_help(
            format!("a pickle of version {version}, and this library reads version {VERSION}"),
            "load it with the version of sdop that wrote it",
        ));
    }
    state.extract().map_err(Into::into)
}
