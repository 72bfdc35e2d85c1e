//! Ids of bodies as Python's whole numbers, in columns of uint64.

use numpy::PyArray2;
use pyo3::Bound;
use sdop::{BodyId, CullError};

/// An array of shape (m, 2): the ids of pairs.
pub type IdPairs<'py> = Bound<'py, PyArray2<u64>>;

/// Ids of pairs.
pub fn bits_of(pairs: impl Iterator<Item = [BodyId; 2]>) -> Result<Vec<[u64; 2]>, CullError> {
    collected(pairs.map(|pair| pair.map(BodyId::to_bits)))
}

/// All rows, if there is memory for them.
pub fn collected<T>(rows: impl Iterator<Item = T>) -> Result<Vec<T>, CullError> {
    let mut all = Vec::new();
    let no_memory = |_| CullError::OutOfMemory;
    all.try_reserve_exact(rows.size_hint().0).map_err(no_memory)?;
    for row in rows {
        if all.len() == all.capacity() {
            all.try_reserve(1).map_err(no_memory)?;
        }
        all.push(row);
    }
    Ok(all)
}
