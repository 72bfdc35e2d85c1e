//! [`Chunk`]: the neighbours found by one part of the grid's work, and the room that its columns
//! keep for the next list.

use crate::simd::MAX_WIDTH;

/// Capacity of a list relative to its length.
const CAPACITY_FACTOR: f64 = 1.5;

/// The neighbours found by one part of the grid's work.
#[derive(Clone, Debug, Default)]
pub struct Chunk {
    /// The codes of all entries, followed by a vector of arbitrary codes.
    pub(super) codes: Vec<u32>,
    len: usize,
    /// For each entry, the slot of lane 0 and the end of its codes.
    pub(super) entries: Vec<(u32, u32)>,
    /// The capacity to allocate, relative to the need.
    pub(super) spare: f64,
}

impl Chunk {
    pub(super) fn clear(&mut self) {
        self.codes.clear();
        self.entries.clear();
        self.len = 0;
    }

    /// The slot of lane 0 of the open entry, if there is one.
    #[inline(always)]
    pub fn first(&self) -> Option<usize> {
        self.entries.last().map(|&(first, _)| first as usize)
    }

    /// Opens an entry, replacing the last one if that is empty.
    #[inline(always)]
    pub fn open(&mut self, first: usize) {
        if self.entries.last().is_some_and(|&(_, end)| end as usize == self.len) {
            let before = self.entries.len().checked_sub(2);
            let start = before.map_or(0, |before| self.entries[before].1 as usize);
            if start == self.len {
                self.entries.pop();
            }
        }
        reserve(&mut self.entries, 1, 1.0);
        self.entries.push((first as u32, self.len as u32));
    }

    /// Appends codes to the open entry.
    #[inline(always)]
    pub fn append(&mut self, codes: &[u32]) {
        reserve(&mut self.codes, codes.len() + MAX_WIDTH, self.spare);
        self.codes.extend_from_slice(codes);
        self.len += codes.len();
        if let Some((_, end)) = self.entries.last_mut() {
            *end = self.len as u32;
        }
    }

    /// Completes the list, and reserves room for the following ones.
    pub(super) fn close(&mut self) {
        reserve(&mut self.codes, MAX_WIDTH, self.spare);
        self.codes.resize(self.len + MAX_WIDTH, 0);
        leave_room(&mut self.codes, self.spare);
        leave_room(&mut self.entries, 1.0);
    }

    /// How many pairs it holds.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }
}

/// Reserves room: `spare` times what is needed so far, and half as much again.
#[inline(always)]
fn reserve<T>(column: &mut Vec<T>, more: usize, spare: f64) {
    let needed = column.len() + more;
    if column.capacity() < needed {
        let room = (CAPACITY_FACTOR * spare * needed as f64) as usize;
        column.reserve_exact(room.max(needed) - column.len());
    }
}

/// Reserves room in a full column, because the next list may be slightly longer and would allocate.
fn leave_room<T>(column: &mut Vec<T>, spare: f64) {
    let [least, room] =
        [1.0, CAPACITY_FACTOR].map(|times| (times * spare * column.len() as f64) as usize);
    if column.capacity() < least {
        column.reserve_exact(room - column.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_without_neighbours_are_overwritten() {
        let mut chunk = Chunk { spare: 1.0, ..Chunk::default() };
        assert_eq!(chunk.first(), None);
        for (first, codes) in [(0, &[][..]), (16, &[7, 8]), (32, &[]), (48, &[]), (64, &[9])] {
            chunk.open(first);
            assert_eq!(chunk.first(), Some(first));
            chunk.append(codes);
        }
        chunk.open(80);
        chunk.close();
        assert_eq!(chunk.entries, [(16, 2), (64, 3), (80, 3)]);
        assert_eq!((chunk.len(), &chunk.codes[..3]), (3, &[7, 8, 9][..]));
        assert_eq!(chunk.codes.len(), 3 + MAX_WIDTH);
    }
}
