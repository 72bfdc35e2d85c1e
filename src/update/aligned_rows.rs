//! [`AlignedRows`]: rows that each occupy one cache line. Rows are read whole and in random order.
//! In a `Vec` of floats, which is only aligned to four bytes, most rows would span two lines.

use std::ops::{Deref, DerefMut};

use crate::simd::ROW;

/// Bytes of a cache line, and of a row.
const CACHE_LINE_BYTES: usize = ROW * size_of::<f32>();

/// Rows, each on one cache line. Rows of a clone may cross two lines, which costs time but changes
/// no result.
#[derive(Clone, Debug, Default)]
pub struct AlignedRows {
    floats: Vec<f32>,
    /// The offset of the first row.
    first: usize,
    len: usize,
}

impl AlignedRows {
    /// Resizes to `len` rows. New rows are zero.
    pub fn resize(&mut self, len: usize) {
        let needed = (len + 1) * ROW;
        if needed > self.floats.len() {
            let mut floats = vec![0.0; needed];
            // At most a row minus one float. If the function can't align, rows are not aligned.
            let first = floats.as_ptr().align_offset(CACHE_LINE_BYTES).min(ROW - 1);
            floats[first..first + self.len * ROW].copy_from_slice(self.as_flattened());
            (self.floats, self.first) = (floats, first);
        } else if len > self.len {
            let [start, end] = [self.len, len].map(|rows| self.first + rows * ROW);
            self.floats[start..end].fill(0.0);
        }
        self.len = len;
    }
}

impl Deref for AlignedRows {
    type Target = [[f32; ROW]];
    fn deref(&self) -> &Self::Target {
        self.floats[self.first..self.first + self.len * ROW].as_chunks().0
    }
}

impl DerefMut for AlignedRows {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.floats[self.first..self.first + self.len * ROW].as_chunks_mut().0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows lie on lines and stay when their number changes.
    #[test]
    fn rows_stay_aligned_on_resize() {
        let mut lines = AlignedRows::default();
        assert!(lines.is_empty());
        for len in [3, 100, 7, 40, 1000] {
            let kept: Vec<_> = lines.iter().take(len).copied().collect();
            lines.resize(len);
            assert_eq!(lines.len(), len);
            assert_eq!(lines.as_ptr().addr() % 64, 0);
            assert_eq!(lines[..kept.len()], kept);
            assert!(lines[kept.len()..].iter().all(|row| *row == [0.0; ROW]));
            lines.iter_mut().for_each(|row| row[5] = len as f32);
        }
    }
}
