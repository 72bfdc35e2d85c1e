//! Errors of the library as Python's exceptions, with the same text and remedy.

use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::exceptions::{PyException, PyValueError};
use pyo3::{PyErr, Python, create_exception};
use sdop_bench::remedy::Remedy;

create_exception!(
    sdop,
    SdopError,
    PyValueError,
    "Input that sdop refuses; the text says where it is wrong and how to mend it."
);

create_exception!(
    sdop,
    CaseSkipped,
    PyException,
    "Raised by a culler under judgement that can't do a case; the text says why."
);

/// An error of the library.
pub fn refused(error: impl Remedy) -> PyErr {
    match error.remedy() {
        Some(help) => with_help(error.problem(), help),
        None => SdopError::new_err(error.problem()),
    }
}

/// An error with its remedy.
pub fn with_help(what: impl Display, help: impl Display) -> PyErr {
    SdopError::new_err(format!("{what}\nhelp: {help}"))
}

/// Locks what a class guards, while other threads of Python run.
pub fn locked<T: Send, R: Send>(
    py: Python<'_>,
    guarded: &Mutex<T>,
    run: impl Send + FnOnce(&mut T) -> R,
) -> R {
    py.detach(|| run(&mut lock(guarded)))
}

/// A panic in one call doesn't affect others: the next call checks the state that it left.
pub fn lock<T>(guarded: &Mutex<T>) -> MutexGuard<'_, T> {
    guarded.lock().unwrap_or_else(PoisonError::into_inner)
}
