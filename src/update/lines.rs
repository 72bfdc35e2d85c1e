//! Rows on cache lines of their own. A vector's memory is aligned as its elements are, that is to
//! four bytes for floats: most rows would lie across two lines, and a row is read whole, at random.

use std::ops::{Deref, DerefMut};

use crate::simd::ROW;

/// Bytes of a cache line, as many as a row has.
const LINE: usize = ROW * size_of::<f32>();

/// Rows, each on one cache line. Those of a clone may lie across two, which takes time and changes
/// nothing.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    floats: Vec<f32>,
    /// Where the first row begins.
    first: usize,
    len: usize,
}

impl Lines {
    /// Room for `len` rows: the first ones stay, new ones are zero.
    pub fn resize(&mut self, len: usize) {
        let needed = (len + 1) * ROW;
        if needed > self.floats.len() {
            let mut floats = vec![0.0; needed];
            // At most a row less a float; the hint to the contrary that the function may give costs
            // alignment alone.
            let first = floats.as_ptr().align_offset(LINE).min(ROW - 1);
            floats[first..first + self.len * ROW].copy_from_slice(self.as_flattened());
            (self.floats, self.first) = (floats, first);
        } else if len > self.len {
            let [start, end] = [self.len, len].map(|rows| self.first + rows * ROW);
            self.floats[start..end].fill(0.0);
        }
        self.len = len;
    }
}

impl Deref for Lines {
    type Target = [[f32; ROW]];
    fn deref(&self) -> &Self::Target {
        self.floats[self.first..self.first + self.len * ROW]
            .as_chunks()
            .0
    }
}

impl DerefMut for Lines {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.floats[self.first..self.first + self.len * ROW]
            .as_chunks_mut()
            .0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_lie_on_lines_and_stay_when_their_number_changes() {
        let mut lines = Lines::default();
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
