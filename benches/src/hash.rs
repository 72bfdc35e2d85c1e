//! Hashes of the reported pairs and of all volumes of a scene, to compare results between machines.
//! Pairs are comparable only if the volumes agree.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use sdop::volume::Shape;

/// SHA-256, in hexadecimal, of each shape's ball (c, r), basis (three columns), lo and hi, as
/// little-endian f32 in order.
#[must_use]
pub fn volumes_sha256(shapes: &[Shape]) -> String {
    let mut hash = Sha256::new();
    let mut write = |values: &[f32]| values.iter().for_each(|v| hash.update(v.to_le_bytes()));
    for shape in shapes {
        write(&shape.ball.centre);
        write(&[shape.ball.radius]);
        for column in shape.ordop.basis.columns {
            write(&column);
        }
        write(&shape.ordop.lo);
        write(&shape.ordop.hi);
    }
    hex(&hash.finalize())
}

/// `pairs_sha256` of a run: for each frame u32 frame, u64 count, then u32 i, u32 j sorted, all
/// little endian.
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

/// `pairs_digest` of a run: 128 bits that don't depend on the order of pairs, so that parts add up.
///
/// Each pair of each frame becomes two numbers of 64 bits, scrambled from frame, i and j; each is
/// summed modulo 2⁶⁴ over all. Two runs whose digests differ report different pairs. Equal digests
/// of different pairs are a chance in 2¹²⁸, but no secret: anyone who wants to can find some.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairsDigest(pub [u64; 2]);

impl PairsDigest {
    /// Adds some pairs i < j of a frame.
    pub fn add(&mut self, frame: u32, pairs: impl Iterator<Item = [u32; 2]>) {
        let frame = scrambled(u64::from(frame) + 1);
        for [i, j] in pairs {
            let pair = u64::from(i) << 32 | u64::from(j);
            let first = scrambled(scrambled(pair ^ frame).wrapping_add(frame));
            let second = scrambled(scrambled(pair.wrapping_add(frame)) ^ first.rotate_left(32));
            self.0[0] = self.0[0].wrapping_add(first);
            self.0[1] = self.0[1].wrapping_add(second);
        }
    }

    /// The digest in hexadecimal.
    #[must_use]
    pub fn finish(self) -> String {
        format!("{:016x}{:016x}", self.0[0], self.0[1])
    }
}

/// A one-to-one map of 64 bits in which each bit depends on all (the output function of SplitMix64,
/// Steele et al. 2014).
fn scrambled(x: u64) -> u64 {
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
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

    fn digest(frames: &[(u32, &[[u32; 2]])]) -> String {
        let mut digest = PairsDigest::default();
        for (frame, pairs) in frames {
            digest.add(*frame, pairs.iter().copied());
        }
        digest.finish()
    }

    /// Digest sees every change but that of order.
    #[test]
    fn digest_ignores_order_alone() {
        let whole = digest(&[(0, &[[1, 2], [1, 3]]), (1, &[[1, 2]])]);
        assert_eq!(whole, digest(&[(1, &[[1, 2]]), (0, &[[1, 3]]), (0, &[[1, 2]])]));
        for other in [
            digest(&[(0, &[[1, 2], [1, 3]]), (1, &[[1, 3]])]),
            digest(&[(0, &[[1, 2], [1, 3]]), (2, &[[1, 2]])]),
            digest(&[(0, &[[1, 2]]), (1, &[[1, 2], [1, 3]])]),
            digest(&[(0, &[[1, 2], [1, 3]]), (1, &[[1, 2], [1, 2]])]),
            digest(&[(0, &[[1, 2], [1, 3]])]),
        ] {
            assert_ne!(whole, other);
        }
    }

    /// Hash is sha256 of the documented bytes.
    #[test]
    fn hash_matches_documented_bytes() {
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
