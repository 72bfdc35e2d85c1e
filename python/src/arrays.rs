//! Arrays of numpy as rows of numbers, and back.
//!
//! One rule for all columns of f32: an array of float32 whose rows lie one after the other is read
//! in place; any other array of numbers is copied. If float32 can't hold all of its numbers, they
//! stay float64, for functions that miss no pair of these; with `exact`, they are rejected.

use numpy::{
    PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn,
    PyUntypedArrayMethods as _,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors::with_help;

/// Rows of N numbers: in f32, borrowed from an array of numpy or copied, or in f64.
pub enum Rows<'py, const N: usize> {
    Borrowed(PyReadonlyArrayDyn<'py, f32>),
    Copied(Vec<f32>),
    /// Some number is none of f32.
    Wide(Vec<f64>),
}

impl<const N: usize> Rows<'_, N> {
    /// The rows, if f32 holds them.
    pub fn narrow(&self) -> Option<&[[f32; N]]> {
        let numbers = match self {
            // checked when it was borrowed
            Self::Borrowed(array) => array.as_slice().unwrap_or_default(),
            Self::Copied(numbers) => numbers,
            Self::Wide(_) => return None,
        };
        Some(numbers.as_chunks().0)
    }

    /// The rows in f64.
    pub fn wide(&self) -> Vec<[f64; N]> {
        match (self, self.narrow()) {
            (Self::Wide(numbers), _) => numbers.as_chunks().0.to_vec(),
            (_, rows) => rows.into_iter().flatten().map(|row| row.map(f64::from)).collect(),
        }
    }
}

/// A column of rows of N numbers. `what` is its name in errors. If it has to be `exact`, numbers
/// that f32 can't hold are rejected with the advice `remedy`.
pub fn rows<'py, const N: usize>(
    given: &Bound<'py, PyAny>,
    what: &str,
    exact: bool,
    remedy: &str,
) -> PyResult<Rows<'py, N>> {
    check_mask(given, what)?;
    if let Ok(array) = given.cast::<PyArrayDyn<f32>>() {
        check_shape::<N>(array.shape(), what)?;
        let array = array.readonly();
        return Ok(if array.is_c_contiguous() {
            Rows::Borrowed(array)
        } else {
            Rows::Copied(array.as_array().iter().copied().collect())
        });
    }
    let (array, shape) = as_f64(given, what)?;
    check_shape::<N>(&shape, what)?;
    let is_narrow = |wide: &f64| f64::from(*wide as f32) == *wide || wide.is_nan();
    match array.iter().position(|wide| !is_narrow(wide)) {
        None => Ok(Rows::Copied(array.into_iter().map(|wide| wide as f32).collect())),
        Some(_) if !exact => Ok(Rows::Wide(array)),
        Some(at) => Err(with_help(inexact(what, at, N, array[at]), remedy)),
    }
}

fn inexact(what: &str, at: usize, n: usize, number: f64) -> String {
    let (row, column) = (at / n, at % n);
    format!("{what}[{row}, {column}] is {number:?}, which float32 can't hold exactly")
}

/// A column of rows of N numbers in f64.
pub fn wide_rows<const N: usize>(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; N]>> {
    let (numbers, shape) = as_f64(given, what)?;
    check_shape::<N>(&shape, what)?;
    Ok(numbers.as_chunks().0.to_vec())
}

/// Exactly N numbers, in whatever shape, as an array of one row. `remedy` names them.
pub fn one_row<'py, const N: usize>(
    given: &Bound<'py, PyAny>,
    what: &str,
    remedy: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let array = as_any(given, what)?;
    if array.getattr("size")?.extract::<usize>()? != N {
        let shape: Vec<usize> = array.getattr("shape")?.extract()?;
        return Err(with_help(format!("{what} has shape {shape:?}"), remedy));
    }
    array.call_method1("reshape", ((1, N),))
}

/// A column of numbers in f64.
pub fn wide_column(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<f64>> {
    let (numbers, shape) = as_f64(given, what)?;
    check_column(&shape, what)?;
    Ok(numbers)
}

/// Whole numbers from 0 to 2³² − 1, in rows of N; `shape` names the accepted shapes.
pub fn whole_rows<const N: usize>(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[u32; N]>> {
    let (numbers, shape) = whole(given, what)?;
    check_shape::<N>(&shape, what)?;
    Ok(numbers.as_chunks().0.to_vec())
}

/// A column of whole numbers from 0 to 2³² − 1.
pub fn whole_column(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<u32>> {
    let (numbers, shape) = whole(given, what)?;
    check_column(&shape, what)?;
    Ok(numbers)
}

/// A column of ids.
pub fn id_column(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<u64>> {
    let array = as_array(given, "uint64", what)?;
    let array = array.cast::<PyArrayDyn<u64>>()?;
    check_column(array.shape(), what)?;
    Ok(array.readonly().as_array().iter().copied().collect())
}

/// A column of true and false.
pub fn flags(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<bool>> {
    let array = as_any(given, what)?;
    let Ok(array) = array.cast::<PyArrayDyn<bool>>() else {
        let text = format!("{what} has dtype {}", array.getattr("dtype")?);
        return Err(PyTypeError::new_err(format!("{text}, and must be of bool")));
    };
    check_column(array.shape(), what)?;
    Ok(array.readonly().as_array().iter().copied().collect())
}

fn whole(given: &Bound<'_, PyAny>, what: &str) -> PyResult<(Vec<u32>, Vec<usize>)> {
    let array = as_array(given, "int64", what)?;
    let array = array.cast::<PyArrayDyn<i64>>()?;
    let numbers = array.readonly();
    let numbers = numbers
        .as_array()
        .iter()
        .map(|&number| {
            u32::try_from(number).map_err(|_| {
                with_help(
                    format!("{what} has the number {number}"),
                    "numbers of shapes, bodies and vertices are at least 0 and below 2**32",
                )
            })
        })
        .collect::<PyResult<Vec<u32>>>()?;
    Ok((numbers, array.shape().to_vec()))
}

fn as_f64(given: &Bound<'_, PyAny>, what: &str) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let array = as_array(given, "float64", what)?;
    let array = array.cast::<PyArrayDyn<f64>>()?;
    let numbers = array.readonly().as_array().iter().copied().collect();
    Ok((numbers, array.shape().to_vec()))
}

/// Converts anything that numpy accepts as an array of numbers to another type of the same kind: no
/// fraction is cut off, and no number is rounded.
fn as_array<'py>(
    given: &Bound<'py, PyAny>,
    dtype: &str,
    what: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let array = as_any(given, what)?;
    if array.getattr("size")?.extract::<usize>()? == 0 {
        return array.call_method1("astype", (dtype,)); // an empty list has no kind
    }
    let own = array.getattr("dtype")?;
    let (kind, size): (String, usize) =
        (own.getattr("kind")?.extract()?, own.getattr("itemsize")?.extract()?);
    let accepted = match (dtype, kind.as_str()) {
        (_, "i" | "u") => "",
        ("float64", "f") if size <= 8 => "",
        ("float64", _) => "accepted are float32, float64, float16 and integers",
        ("uint64", "f") => {
            "accepted are integers: NumPy makes float64 of uint64 next to signed integers, which \
             changes ids; write np.array(ids, dtype=np.uint64)"
        }
        _ => "accepted are integers, such as int64 or uint32",
    };
    if !accepted.is_empty() {
        return Err(PyTypeError::new_err(format!("{what} has dtype {own}; {accepted}")));
    }
    if (dtype, kind.as_str()) == ("uint64", "i") {
        let least: i64 = array.call_method0("min")?.extract()?;
        if least < 0 {
            let number = format!("{what} has the number {least}");
            return Err(with_help(number, "ids are whole numbers, as `insert` returned them"));
        }
    }
    let options = PyDict::new(given.py());
    options.set_item("copy", false)?;
    let converted = array.call_method("astype", (dtype,), Some(&options))?;
    if dtype == "float64" && kind != "f" && size == 8 {
        let back = converted.call_method1("astype", (&own,))?;
        if !numpy(given.py())?.call_method1("array_equal", (&array, back))?.is_truthy()? {
            return Err(with_help(
                format!("{what} has whole numbers above 2**53, which float64 can't hold"),
                "pass float64, whose numbers are then the ones that are meant",
            ));
        }
    }
    Ok(converted)
}

/// What numpy makes an array of.
fn as_any<'py>(given: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyAny>> {
    check_mask(given, what)?;
    let array = numpy(given.py())?.call_method1("asarray", (given,));
    array.map_err(|error| match error.is_instance_of::<PyValueError>(given.py()) {
        true => with_help(format!("{what} has rows of unequal lengths"), "pad the short ones"),
        false => error,
    })
}

/// Refuses a masked array with masked numbers, which NumPy hands over as if they were valid.
fn check_mask(given: &Bound<'_, PyAny>, what: &str) -> PyResult<()> {
    let has_mask = given.getattr_opt("mask")?.is_some();
    let masked = || given.py().import("numpy.ma")?.call_method1("is_masked", (given,));
    if has_mask && masked()?.is_truthy()? {
        return Err(with_help(
            format!("{what} is a masked array, and some of its numbers are masked"),
            "leave their rows out, or fill them: `array.filled(…)`",
        ));
    }
    Ok(())
}

fn numpy(py: Python<'_>) -> PyResult<Bound<'_, PyModule>> {
    py.import("numpy")
}

/// (rows, N), or for boxes also (rows, 2, 3).
fn check_shape<const N: usize>(shape: &[usize], what: &str) -> PyResult<()> {
    match shape {
        [_, columns] if *columns == N => Ok(()),
        [_, 2, 3] if N == 6 => Ok(()),
        [0] => Ok(()),
        _ => {
            let wanted =
                if N == 6 { "(n, 6) or (n, 2, 3)".to_owned() } else { format!("(n, {N})") };
            Err(with_help(
                format!("{what} has shape {shape:?}"),
                format!("its shape must be {wanted}"),
            ))
        }
    }
}

fn check_column(shape: &[usize], what: &str) -> PyResult<()> {
    match shape {
        [_] => Ok(()),
        _ => Err(with_help(format!("{what} has shape {shape:?}"), "its shape must be (n,)")),
    }
}

/// Checks that two columns have one entry for each body.
pub fn check_length(what: &str, length: usize, bodies: usize) -> PyResult<()> {
    if length == bodies {
        return Ok(());
    }
    Err(with_help(
        format!("{what} has {length} rows for {bodies} bodies"),
        "all columns have one row per body",
    ))
}

/// Rows of two as an array of shape (rows, 2), which reuses the vector's memory.
pub fn pairs<T: numpy::Element>(
    py: Python<'_>,
    pairs: Vec<[T; 2]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = pairs.len();
    let flat = PyArray1::from_vec(py, pairs.into_flattened());
    flat.reshape([rows, 2])
}

/// Rows of N as an array of shape (rows, N).
pub fn matrix<'py, T: numpy::Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let flat: Bound<'py, PyArray<T, _>> = PyArray1::from_slice(py, rows.as_flattened());
    flat.reshape([rows.len(), N])
}
