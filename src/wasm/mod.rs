//! The interface for JavaScript: typed arrays in, pairs out. `wasm-bindgen` makes its loader and
//! its TypeScript types.
//!
//! An error is a JavaScript `Error` with the message of the library. A panic, which would be a bug,
//! ends the module.

mod boxes;
mod meshes;

use wasm_bindgen::JsError;

pub use boxes::{BoxWorld, Events, box_pairs};
pub use meshes::{Counts, Culler, Mesh, exact_meet};

/// The rows of a flat array, each of `N` numbers.
fn rows<'a, T, const N: usize>(given: &'a [T], name: &str) -> Result<&'a [[T; N]], JsError> {
    let (rows, rest) = given.as_chunks();
    if rest.is_empty() {
        return Ok(rows);
    }
    let length = given.len();
    Err(JsError::new(&format!("{name}: {length} numbers; give {N} for each entry")))
}

/// The only row of a flat array.
fn one<T: Copy, const N: usize>(given: &[T], name: &str) -> Result<[T; N], JsError> {
    let length = given.len();
    given.try_into().map_err(|_| JsError::new(&format!("{name}: {length} numbers; give {N}")))
}

/// Refuses a column with another number of entries than there are bodies.
fn check_length(name: &str, entries: usize, bodies: usize) -> Result<(), JsError> {
    if entries == bodies {
        return Ok(());
    }
    Err(JsError::new(&format!("{name}: {entries} entries for {bodies} bodies; give one for each")))
}
