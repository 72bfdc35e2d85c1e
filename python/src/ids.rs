//! Ids of bodies as Python's whole numbers, in columns of uint64.

use sdop::BodyId;

/// Ids of pairs.
pub fn bits_of(pairs: impl Iterator<Item = [BodyId; 2]>) -> Vec<[u64; 2]> {
    pairs.map(|pair| pair.map(BodyId::to_bits)).collect()
}
