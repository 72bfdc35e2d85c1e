//! Many short lists in one allocation.
//!
//! Each list is a run of entries, with room for a power of two of them. A list that outgrows its
//! room moves to a larger one, and the next list of that size reuses the old room. Lists are
//! therefore created and changed without calls to the allocator, and changing a list costs time in
//! proportion to its length. When many rooms are free, the owner of the lists moves them next to
//! each other ([`Runs::compact`]), so that memory follows the present lists.

use super::bytes;
use crate::simd::{CACHE_LINE, prefetch};

/// A list shrinks to half of its room when it fills at most one in this many entries of it.
const SHRINK_DIVISOR: u32 = 4;

/// Lists are moved next to each other when the free rooms exceed this share of the others and of
/// the number of lists.
const FREE_DIVISOR: usize = 4;

/// The allocation grows by at least this share.
const GROWTH_DIVISOR: usize = 4;

/// Where a list's entries are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Run {
    /// In units of the smallest room.
    start: u32,
    len: u32,
    /// Zero, or a power of two no less than the smallest room.
    room: u32,
}

impl Run {
    /// An empty list.
    pub const EMPTY: Self = Self { start: 0, len: 0, room: 0 };

    /// Whether the list is empty.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.len == 0
    }

    /// Number of entries.
    #[inline(always)]
    pub fn len(self) -> usize {
        self.len as usize
    }
}

/// The entries of many lists, of which each that isn't empty has room for `LEAST` at least, a power
/// of two.
#[derive(Clone, Debug)]
pub(crate) struct Runs<T, const LEAST: usize> {
    items: Vec<T>,
    /// Unused entries before the first room, so that rooms begin with a cache line, or fill one
    /// together.
    skipped: usize,
    /// Starts of the free rooms, indexed by the logarithm of their size.
    free: Vec<Vec<u32>>,
    /// Entries in the rooms of lists.
    taken: usize,
}

impl<T, const LEAST: usize> Default for Runs<T, LEAST> {
    fn default() -> Self {
        Self { items: Vec::new(), skipped: 0, free: Vec::new(), taken: 0 }
    }
}

impl<T: Copy + Default, const LEAST: usize> Runs<T, LEAST> {
    const LEAST_ROOM: u32 = LEAST as u32;

    /// The number of a list's first entry.
    #[inline(always)]
    pub fn first(&self, run: Run) -> usize {
        self.skipped + run.start as usize * LEAST
    }

    /// The entries of a list.
    #[inline(always)]
    pub fn get(&self, run: Run) -> &[T] {
        let first = self.first(run);
        &self.items[first..first + run.len()]
    }

    /// An entry by its number.
    #[inline(always)]
    pub fn entry(&self, number: usize) -> &T {
        &self.items[number]
    }

    /// Prefetches the first entries of a list, unless it is empty.
    #[inline(always)]
    pub fn prefetch(&self, run: Run) {
        let list = self.get(run);
        list.first().map(prefetch);
        list.last().map(prefetch);
    }

    /// The entries of a list, to be changed.
    #[inline(always)]
    pub fn get_mut(&mut self, run: Run) -> &mut [T] {
        let first = self.first(run);
        &mut self.items[first..first + run.len()]
    }

    /// Allocates what lists of these lengths will take, none of them empty.
    pub fn reserve_all(&mut self, lengths: impl Iterator<Item = u32>) {
        let rooms = lengths.map(|len| Self::room_for(len) as usize);
        self.allocate(rooms.sum());
    }

    /// As [`Self::reserve_all`], with a share more for lists that grow.
    pub fn reserve_growing(&mut self, lengths: impl Iterator<Item = u32>) {
        let rooms: usize = lengths.map(|len| Self::room_for(len) as usize).sum();
        self.allocate(rooms + rooms / GROWTH_DIVISOR);
    }

    /// Allocates this number of entries, and aligns the rooms to cache lines.
    fn allocate(&mut self, more: usize) {
        let per_line = CACHE_LINE / size_of::<T>().max(1);
        self.items.reserve_exact(more + per_line);
        let (start, end) = (self.skipped, self.items.len());
        let offset = self.items.as_ptr().align_offset(CACHE_LINE);
        self.skipped = if offset < per_line { offset } else { 0 };
        if self.skipped != start {
            let end_now = end + self.skipped - start;
            self.items.resize(end.max(end_now), T::default());
            self.items.copy_within(start..end, self.skipped);
            self.items.truncate(end_now);
        }
    }

    /// Makes room for at least `len` entries of an empty list.
    pub fn reserve(&mut self, run: &mut Run, len: usize) {
        let needed = Self::room_for(len as u32);
        if needed > run.room {
            self.release(run);
            run.start = self.take_room(needed);
            run.room = needed;
        }
    }

    /// Appends an entry.
    #[inline]
    pub fn push(&mut self, run: &mut Run, item: T) {
        self.insert(run, run.len(), item);
    }

    /// Inserts an entry at the index `at`.
    #[inline]
    pub fn insert(&mut self, run: &mut Run, at: usize, item: T) {
        if run.len == run.room {
            self.resize(run, (2 * run.room).max(Self::LEAST_ROOM));
        }
        let (first, len) = (self.first(*run), run.len());
        self.items.copy_within(first + at..first + len, first + at + 1);
        self.items[first + at] = item;
        run.len += 1;
    }

    /// Removes the entry at `at`. The others keep their order.
    pub fn remove(&mut self, run: &mut Run, at: usize) {
        let (first, len) = (self.first(*run), run.len());
        self.items.copy_within(first + at + 1..first + len, first + at);
        self.shorten(run);
    }

    /// Adds an entry to a sorted list, or removes it, unless that is so already. Returns whether it
    /// wasn't.
    pub fn set(&mut self, run: &mut Run, item: T, is_in: bool) -> bool
    where
        T: Ord,
    {
        match (self.get(*run).binary_search(&item), is_in) {
            (Err(at), true) => self.insert(run, at, item),
            (Ok(at), false) => self.remove(run, at),
            _ => return false,
        }
        true
    }

    /// Replaces the list by another.
    pub fn replace(&mut self, run: &mut Run, items: &[T]) {
        let len = items.len() as u32;
        if len == 0 {
            self.release(run);
            return;
        }
        if len > run.room || (len * SHRINK_DIVISOR <= run.room && run.room > Self::LEAST_ROOM) {
            self.release(run);
            self.reserve(run, items.len());
        }
        run.len = len;
        self.get_mut(*run).copy_from_slice(items);
    }

    fn shorten(&mut self, run: &mut Run) {
        run.len -= 1;
        if run.len == 0 {
            self.release(run);
        } else if run.len * SHRINK_DIVISOR <= run.room && run.room > Self::LEAST_ROOM {
            self.resize(run, run.room / 2);
        }
    }

    /// Moves the list to another room.
    fn resize(&mut self, run: &mut Run, room: u32) {
        let mut moved = Run { start: self.take_room(room), len: run.len, room };
        let (from, to) = (self.first(*run), self.first(moved));
        self.items.copy_within(from..from + run.len(), to);
        std::mem::swap(run, &mut moved);
        self.release(&mut moved);
    }

    /// Empties the list and frees its room.
    fn release(&mut self, run: &mut Run) {
        if run.room > 0 {
            let size = run.room.ilog2() as usize;
            if self.free.len() <= size {
                self.free.resize_with(size + 1, Vec::new);
            }
            self.free[size].push(run.start);
            self.taken -= run.room as usize;
        }
        *run = Run::default();
    }

    fn room_for(len: u32) -> u32 {
        len.next_power_of_two().max(Self::LEAST_ROOM)
    }

    fn take_room(&mut self, room: u32) -> u32 {
        self.taken += room as usize;
        let freed = self.free.get_mut(room.ilog2() as usize);
        if let Some(start) = freed.and_then(Vec::pop) {
            return start;
        }
        let len = self.items.len();
        if len + room as usize > self.items.capacity() {
            self.allocate((room as usize).max(len / GROWTH_DIVISOR));
        }
        let start = self.items.len();
        self.items.resize(start + room as usize, T::default());
        ((start - self.skipped) / LEAST) as u32
    }

    /// Entries in the rooms of lists.
    pub fn taken(&self) -> usize {
        self.taken
    }

    /// Whether so much room is free that [`Self::compact`] pays, for this number of lists.
    pub fn is_sparse(&self, lists: usize) -> bool {
        self.items.len() - self.skipped - self.taken > (self.taken + lists) / FREE_DIVISOR
    }

    /// Moves the lists next to each other, each with no more room than it needs. `lists` must have
    /// all that aren't empty.
    pub fn compact<'a>(&mut self, lists: impl Iterator<Item = &'a mut Run>) {
        let lists: Vec<&mut Run> = lists.filter(|list| list.room > 0).collect();
        let mut compacted = Self::default();
        compacted.reserve_all(lists.iter().map(|list| list.len));
        for list in lists {
            let mut moved = Run::default();
            compacted.replace(&mut moved, self.get(*list));
            *list = moved;
        }
        *self = compacted;
    }

    /// Bytes that the lists hold, including free rooms.
    pub fn bytes(&self) -> usize {
        bytes(&self.items) + self.free.iter().map(bytes).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn lists_in_runs_are_lists() {
        change_lists::<1>();
        change_lists::<4>();
    }

    fn change_lists<const LEAST: usize>() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut runs = Runs::<u32, LEAST>::default();
        let mut lists: Vec<(Run, Vec<u32>)> = vec![Default::default(); 12];
        let mut compacted = 0;
        for step in 0..20_000 {
            let mut below = |n: usize| random.next_u32() as usize % n;
            // Some lists are filled, then others, so that all grow long and short again.
            let (run, list) = &mut lists[below(12)];
            let fills = step / 1000 % 2 == 0;
            match (below(6), list.len()) {
                (0, len) => {
                    let items: Vec<u32> = (0..below(2 * len + 2) as u32).collect();
                    runs.replace(run, &items);
                    *list = items;
                }
                (_, len) if fills || len == 0 => {
                    let at = below(len + 1);
                    runs.insert(run, at, step);
                    list.insert(at, step);
                }
                (_, len) => {
                    let at = below(len);
                    runs.remove(run, at);
                    list.remove(at);
                }
            }
            assert_eq!((run.len(), run.is_empty()), (list.len(), list.is_empty()));
            let entries: usize = lists.iter().map(|(_, list)| list.len()).sum();
            if runs.is_sparse(12) {
                runs.compact(lists.iter_mut().map(|(run, _)| run));
                assert!(runs.items.capacity() <= 2 * entries + 12 * 3 + 16, "{step}");
                compacted += 1;
            }
            assert!(runs.items.len() <= 5 * entries + 12 * 5 + 16, "{step}");
            assert!(lists.iter().all(|(run, list)| runs.get(*run) == list), "{step}");
        }
        assert!((20..2000).contains(&compacted), "{compacted}");
    }

    #[test]
    fn rooms_are_used_again() {
        let mut runs = Runs::<u32, 4>::default();
        let mut taken = 0;
        for round in 0..10 {
            let mut lists = [Run::default(); 20];
            for run in &mut lists {
                (0..50_u32).for_each(|item| runs.push(run, item));
            }
            lists.iter_mut().for_each(|run| runs.replace(run, &[]));
            if round == 0 {
                taken = runs.items.len();
            }
        }
        assert_eq!(runs.items.len(), taken);
        assert!(runs.bytes() >= 4 * taken);
    }
}
