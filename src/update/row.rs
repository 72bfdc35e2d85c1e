//! The layout of an or-DOP's row: one cache line per body. The pair test transposes a vector of
//! rows at a time.

/// Index of Q: the world direction of basis axis j is at 3j to 3j + 2.
pub const Q: usize = 0;

/// Index of the translation t.
pub const T: usize = 9;

/// Index of the centre offset o.
pub const O: usize = 12;

/// Index of the shape number, as the float whose bits are [`SHAPE`] plus it.
pub const S: usize = 15;

/// The bits of 2²³. Adding a small integer to the bits adds it to the float.
pub const SHAPE: u32 = 0x4b00_0000;
