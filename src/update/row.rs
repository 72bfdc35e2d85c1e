//! The layout of an or-DOP's row: one cache line per body, of which the pair test transposes a
//! vector at a time.

/// Index of Q: the world direction of basis axis j in numbers 3j to 3j + 2.
pub const Q: usize = 0;

/// Index of the translation t.
pub const T: usize = 9;

/// Index of the centre offset o.
pub const O: usize = 12;

/// Index of the number of the shape, as the float whose bits are [`SHAPE`] + it.
pub const S: usize = 15;

/// The bits of 2²³, to which small integers add up as floats.
pub const SHAPE: u32 = 0x4b00_0000;
