//! Single arguments: ids, numbers, groups and shapes, refused in our own words.

use std::sync::Arc;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use sdop::{BodyId, Groups};

use super::errors::with_help;
use super::shape::Shape;

/// The id of a body.
pub struct Id(pub BodyId);

/// The number of a shape.
pub struct ShapeNumber(pub u32);

/// The bits of the groups that a body is in, and of those that it collides with.
pub struct GroupBits(pub Groups);

/// A list of shapes.
pub struct ShapeList(pub Vec<Arc<sdop::Shape>>);

/// Extracts an argument, or refuses it in our own words.
macro_rules! extracted {
    ($name:ident, $given:ident, $extract:expr) => {
        impl<'py> FromPyObject<'_, 'py> for $name {
            type Error = PyErr;
            fn extract($given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
                $extract
            }
        }
    };
}

extracted!(Id, given, {
    let bits = whole(&given, "the id", "an id is a whole number, as `insert` returned it");
    Ok(Self(BodyId::from_bits(bits?)))
});

extracted!(ShapeNumber, given, {
    let help = "shapes have whole numbers, counted from 0 in the order of the list";
    Ok(Self(whole(&given, "the number of the shape", help)?))
});

extracted!(GroupBits, given, {
    let help = "pass two whole numbers below 2**32: bits of the groups that the body is in, and of those that it collides with";
    let [member, mask] = two(&given, "groups", help)?;
    let bits = |bits: &Bound<'_, PyAny>| whole(bits, "one of groups", help);
    Ok(Self(Groups { member: bits(&member)?, mask: bits(&mask)? }))
});

extracted!(ShapeList, given, {
    let help = "pass a list of `sdop.Shape`";
    let items = given.try_iter().map_err(|_| mistyped("shapes", &given, help))?;
    let shape = |(number, item): (usize, PyResult<Bound<'_, PyAny>>)| {
        let item = item?;
        let shape = item.cast::<Shape>().map(|shape| shape.get().built.clone());
        shape.map_err(|_| mistyped(&format!("shapes[{number}]"), &item, help))
    };
    Ok(Self(items.enumerate().map(shape).collect::<PyResult<_>>()?))
});

impl ShapeList {
    /// The shapes, as the library takes them.
    pub fn built(&self) -> Vec<sdop::Shape> {
        self.0.iter().map(|shape| sdop::Shape::clone(shape)).collect()
    }
}

/// A sequence of two.
pub fn two<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    help: &str,
) -> PyResult<[Bound<'py, PyAny>; 2]> {
    given.extract().map_err(|_| mistyped(what, given, help))
}

fn whole<T: TryFrom<u64>>(given: &Bound<'_, PyAny>, what: &str, help: &str) -> PyResult<T> {
    match given.extract::<u64>() {
        Ok(number) => {
            T::try_from(number).map_err(|_| with_help(format!("{what} is {number}"), help))
        }
        Err(error) if error.is_instance_of::<PyTypeError>(given.py()) => {
            Err(mistyped(what, given, help))
        }
        Err(_) => Err(with_help(format!("{what} is {}", shown(given)), help)),
    }
}

/// The error of an argument of another type.
pub fn mistyped(what: &str, given: &Bound<'_, PyAny>, help: &str) -> PyErr {
    let name = given.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
    PyTypeError::new_err(format!("{what} is {} of type {name}\nhelp: {help}", shown(given)))
}

/// The beginning of a value's `repr`.
fn shown(given: &Bound<'_, PyAny>) -> String {
    given.repr().map_or_else(|_| "…".into(), |text| text.to_string().chars().take(60).collect())
}
