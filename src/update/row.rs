//! What stands where in an or-DOP's row: one cache line per body, which the pair test reads as columns.

/// Where Q begins: the world direction of basis axis j in numbers 3j to 3j + 2.
pub const Q: usize = 0;

/// Where the translation t begins.
pub const T: usize = 9;

/// Where the centre offset o begins.
pub const O: usize = 12;

/// Where the number of the shape stands, as the float whose bits are [`SHAPE`] + it.
pub const S: usize = 15;

/// The bits of 2²³, to which small integers add up as floats.
pub const SHAPE: u32 = 0x4b00_0000;
