//! Hashes that make results comparable across machines: of the reported pairs, and of every volume of a scene.
//! Two machines' pairs are comparable only where their volumes agree.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use crate::volume::Shape;

/// SHA-256, in hexadecimal, of each shape's ball (c, r), basis (three columns), lo and hi, as little-endian f32 in order.
#[must_use]
pub fn volumes_sha256(shapes: &[Shape]) -> String {
    let mut hash = Sha256::new();
    let mut write = |values: &[f32]| values.iter().for_each(|v| hash.update(v.to_le_bytes()));
    for shape in shapes {
        write(&shape.ball.centre.to_array());
        write(&[shape.ball.radius]);
        for column in shape.ordop.basis.columns {
            write(&column.to_array());
        }
        write(&shape.ordop.lo);
        write(&shape.ordop.hi);
    }
    hex(&hash.finalize())
}

/// `pairs_sha256` of a run: for each frame u32 frame, u64 count, then u32 i, u32 j sorted, all little endian.
#[derive(Clone, Default)]
pub struct PairsHash(Sha256);

impl PairsHash {
    /// Adds one frame's sorted pairs.
    pub fn frame(&mut self, frame: u32, sorted: &[[u32; 2]]) {
        self.0.update(frame.to_le_bytes());
        self.0.update((sorted.len() as u64).to_le_bytes());
        for [i, j] in sorted {
            self.0.update(i.to_le_bytes());
            self.0.update(j.to_le_bytes());
        }
    }

    /// The hash of all frames so far, in hexadecimal.
    #[must_use]
    pub fn finish(self) -> String {
        hex(&self.0.finalize())
    }
}

/// Bytes in lower-case hexadecimal.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_is_sha256_of_the_documented_bytes() {
        let mut hash = PairsHash::default();
        hash.frame(7, &[[1, 2], [1, 300]]);
        let mut bytes = Vec::new();
        bytes.extend(7u32.to_le_bytes());
        bytes.extend(2u64.to_le_bytes());
        for number in [1u32, 2, 1, 300] {
            bytes.extend(number.to_le_bytes());
        }
        assert_eq!(hash.finish(), hex(&Sha256::digest(&bytes)));
    }
}
