//! An index of boxes by location that is changed box by box: a hash table of cells of several sizes
//! ([`levels`]).
//!
//! A box that moves, comes or goes changes its old cell and its new one; a query reads the cells
//! near a box and their boxes. Nothing is sorted, and nothing is rebuilt except a full table of
//! cells.

mod levels;

use self::levels::{Levels, cell_count};
use crate::bodies::{Aabb, Groups, PairRules};
use crate::pairs::{ROOM, Run, Runs};
use crate::simd::{TaggedBox, prefetch};

/// The table of cells is enlarged when more than this share of it is used.
const MAX_LOAD: [usize; 2] = [3, 4];

/// A new index keeps a table of at most this number of cells per cell with boxes.
const MOST_SPARE_CELLS: usize = 8;

/// Number of boxes by which prefetching is ahead while an index is made.
const PREFETCH_DISTANCE: usize = 16;

/// Searching this number of cells takes as long as testing one box.
const CELLS_PER_BOX: u64 = 2;

/// Tag of a fixed box.
const FIXED_TAG: u32 = 1;
/// Tag of a box that doesn't collide with all groups.
const GROUPED_TAG: u32 = 2;

/// A cell of the table, within a cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
struct Cell {
    /// See [`BoxLevel::name`](levels::BoxLevel::name); 0 if there is no cell.
    name: u32,
    /// Those that aren't fixed come first: a fixed box reads no others.
    boxes: Run,
}

/// The cell of a box.
#[derive(Clone, Copy, Debug, Default)]
struct HomeCell {
    /// The cell's name, or 0.
    cell: u32,
    /// The number of the box in the cell's list.
    place: u32,
    level: u16,
}

/// A body in the index, or one to be inserted or removed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IndexedBox {
    pub slot: u32,
    /// A removed body is in no index, and meets no box.
    pub is_present: bool,
    pub tags: u32,
    pub aabb: Aabb,
}

/// All boxes of a world by location.
#[derive(Clone, Debug)]
pub(crate) struct BoxIndex {
    levels: Levels,
    /// Open addressing with linear probing. Cells stay when their last box leaves, until the table
    /// is rebuilt.
    cells: Vec<Cell>,
    taken: usize,
    boxes: Runs<TaggedBox>,
    /// The cell of each slot's box.
    homes: Vec<HomeCell>,
    len: usize,
}

impl BoxIndex {
    /// An index of `count` boxes, all present, no two in one slot. It is made in a few passes over
    /// all boxes: their cells, the length of each cell's list, the lists.
    pub fn of(boxes: impl Iterator<Item = IndexedBox> + Clone, count: usize) -> Self {
        let mut index = Self::suited_to(boxes.clone().map(|indexed| indexed.aabb), count);
        let mut names = Vec::with_capacity(count);
        for IndexedBox { slot, aabb, .. } in boxes.clone() {
            let home = index.home_of(&aabb);
            index.homes.resize(index.homes.len().max(slot as usize + 1), HomeCell::default());
            index.homes[slot as usize] = home;
            index.levels.all[usize::from(home.level)].boxes += 1;
            names.push(home.cell);
        }
        let mut lengths = vec![0; index.cells.len()];
        for (number, &name) in names.iter().enumerate() {
            index.prefetch_cell(names.get(number + PREFETCH_DISTANCE));
            let at = index.find(name);
            index.taken += usize::from(lengths[at] == 0);
            index.cells[at].name = name;
            lengths[at] += 1;
        }
        let filled = lengths.iter().copied().filter(|&len| len > 0);
        index.boxes.reserve_growing(filled);
        for (cell, &len) in index.cells.iter_mut().zip(&lengths).filter(|(_, len)| **len > 0) {
            index.boxes.reserve(&mut cell.boxes, len as usize);
        }
        for tag in [0, FIXED_TAG] {
            for (number, (indexed, &name)) in boxes.clone().zip(&names).enumerate() {
                if indexed.tags & FIXED_TAG == tag {
                    index.prefetch_cell(names.get(number + PREFETCH_DISTANCE));
                    let at = index.find(name);
                    let run = &mut index.cells[at].boxes;
                    index.homes[indexed.slot as usize].place = run.len() as u32;
                    index.boxes.push(run, indexed.tagged());
                }
            }
        }
        index.len = names.len();
        if MOST_SPARE_CELLS * index.taken < index.cells.len() {
            index.make_room();
        }
        index
    }

    /// An empty index with levels chosen for these boxes.
    fn suited_to(boxes: impl Iterator<Item = Aabb>, count: usize) -> Self {
        Self {
            levels: Levels::suited_to(boxes, count),
            cells: vec![Cell::default(); (2 * count + 16).next_power_of_two()],
            taken: 0,
            boxes: Runs::default(),
            homes: Vec::new(),
            len: 0,
        }
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The cell of a box that isn't in its list yet.
    fn home_of(&mut self, aabb: &Aabb) -> HomeCell {
        let level = self.levels.level_of(aabb);
        HomeCell { cell: self.levels.all[usize::from(level)].home(aabb), place: 0, level }
    }

    /// Moves a box to its present cell, or removes it if it is gone. It takes the same time however
    /// many boxes share a cell.
    pub fn put(&mut self, indexed: &IndexedBox) {
        let &IndexedBox { slot, is_present, ref aabb, .. } = indexed;
        if !is_present {
            return self.remove(slot);
        }
        if self.homes.len() <= slot as usize {
            self.homes.resize(slot as usize + 1, HomeCell::default());
        }
        let mut home = self.home_of(aabb);
        let entry = indexed.tagged();
        let former = self.homes[slot as usize];
        if [former.cell, former.level.into()] == [home.cell, home.level.into()] {
            let at = self.find(home.cell);
            let boxes = self.boxes.get_mut(self.cells[at].boxes);
            if (boxes[former.place as usize].tags ^ entry.tags) & FIXED_TAG == 0 {
                boxes[former.place as usize] = entry;
                return;
            }
        }
        self.remove(slot);
        if (self.taken + 1) * MAX_LOAD[1] > self.cells.len() * MAX_LOAD[0] {
            self.make_room();
        }
        let at = self.find(home.cell);
        if self.cells[at].name == 0 {
            self.cells[at].name = home.cell;
            self.taken += 1;
        }
        let first_fixed = self.movable(self.cells[at].boxes);
        let run = &mut self.cells[at].boxes;
        let mut place = run.len();
        self.boxes.push(run, entry);
        if entry.tags & FIXED_TAG == 0 && first_fixed < place {
            let boxes = self.boxes.get_mut(*run);
            boxes.swap(first_fixed, place);
            self.homes[boxes[place].slot as usize].place = place as u32;
            place = first_fixed;
        }
        home.place = place as u32;
        self.levels.all[usize::from(home.level)].boxes += 1;
        self.homes[slot as usize] = home;
        self.len += 1;
    }

    /// Removes a box, if it is there. The last one of its cell and kind takes its place.
    fn remove(&mut self, slot: u32) {
        let home = match self.homes.get_mut(slot as usize) {
            Some(home) if home.cell != 0 => *home,
            _ => return,
        };
        let at = self.find(home.cell);
        let movable = self.movable(self.cells[at].boxes);
        let run = &mut self.cells[at].boxes;
        let mut place = home.place as usize;
        if place < movable {
            let boxes = self.boxes.get_mut(*run);
            boxes.swap(place, movable - 1);
            self.homes[boxes[place].slot as usize].place = place as u32;
            place = movable - 1;
        }
        self.boxes.swap_remove(run, place);
        if let Some(moved) = self.boxes.get(*run).get(place) {
            self.homes[moved.slot as usize].place = place as u32;
        }
        self.homes[slot as usize] = HomeCell::default();
        self.levels.all[usize::from(home.level)].boxes -= 1;
        self.len -= 1;
    }

    /// The number of boxes in a cell that aren't fixed.
    fn movable(&self, run: Run) -> usize {
        self.boxes.get(run).partition_point(|entry| entry.tags & FIXED_TAG == 0)
    }

    /// The position of a cell in the table, or where it would be inserted.
    #[inline(always)]
    fn find(&self, name: u32) -> usize {
        let mask = self.cells.len() - 1;
        let mut at = name as usize & mask;
        loop {
            let found = self.cells[at].name;
            if found == name || found == 0 {
                return at;
            }
            at = (at + 1) & mask;
        }
    }

    /// Rebuilds the table without empty cells, so large that half of it is free, and the lists of
    /// its cells without the rooms that nothing is in.
    fn make_room(&mut self) {
        let filled = self.cells.iter().filter(|cell| !cell.boxes.is_empty());
        let size = (2 * filled.clone().count() + 16).next_power_of_two();
        let mut filled: Vec<Cell> = filled.copied().collect();
        self.taken = filled.len();
        self.cells = vec![Cell::default(); size];
        self.boxes.compact(filled.iter_mut().map(|cell| &mut cell.boxes));
        for cell in filled {
            let at = self.find(cell.name);
            self.cells[at] = cell;
        }
    }

    /// Frees the room that boxes have left in cells, if it is much.
    pub fn compact(&mut self) {
        if self.boxes.is_sparse(self.cells.len()) {
            self.boxes.compact(self.cells.iter_mut().map(|cell| &mut cell.boxes));
        }
    }

    /// Prefetches what [`Self::put`] will read of later boxes: for the last of them the name of its
    /// cell, for the next one the cell, for the one that comes soon the boxes in the cell.
    #[inline]
    pub fn prefetch(&self, [last, next, soon]: [Option<&IndexedBox>; 3]) {
        let home = |indexed: &IndexedBox| self.homes.get(indexed.slot as usize);
        if let Some(home) = last.and_then(home) {
            prefetch(home);
        }
        self.prefetch_cell(next.and_then(home).map(|home| &home.cell));
        if let Some(home) = soon.and_then(home)
            && home.cell != 0
        {
            self.boxes.prefetch(self.cells[self.find(home.cell)].boxes);
        }
    }

    #[inline(always)]
    fn prefetch_cell(&self, name: Option<&u32>) {
        if let Some(&name) = name {
            prefetch(&self.cells[name as usize & (self.cells.len() - 1)]);
        }
    }

    /// Appends, for each of some boxes, the slots of those that meet it, are not both fixed, and
    /// are allowed by the rules: sorted, each once. The end of each box's part is appended to
    /// `ends`. Returns the number of boxes and cells read, or `None` before any box is read if
    /// there are more than `most`.
    #[inline(never)]
    pub fn find_partners(
        &self,
        seekers: &[IndexedBox],
        rules: PairRules<'_>,
        search: &mut Search,
        found: &mut Vec<u32>,
        ends: &mut Vec<usize>,
        most: usize,
    ) -> Option<usize> {
        // Three passes, so that many cache misses overlap.
        search.clear();
        for seeker in seekers {
            if seeker.is_present {
                self.list_cells(&seeker.aabb, search);
            } else {
                search.ends.push((search.names.len(), false));
            }
        }
        let everywhere = search.ends.iter().filter(|(_, is_everywhere)| *is_everywhere);
        let mut work = search.names.len() + self.len * everywhere.count();
        let mut first = 0;
        for (seeker, &(end, _)) in seekers.iter().zip(&search.ends) {
            for &name in &search.names[std::mem::replace(&mut first, end)..end] {
                let mut run = self.cells[self.find(name)].boxes;
                if !run.is_empty() {
                    self.boxes.prefetch(run);
                    if seeker.tags & FIXED_TAG != 0 {
                        run = run.first(self.movable(run));
                    }
                }
                work += run.len();
                search.runs.push(run);
            }
        }
        if work > most {
            return None;
        }
        let mut first = 0;
        for (seeker, &(end, is_everywhere)) in seekers.iter().zip(&search.ends) {
            let start = found.len();
            let (tagged, hits) = (seeker.tagged(), &mut search.hits);
            hits.count = 0;
            if is_everywhere {
                for cell in &self.cells {
                    self.look_into(cell.boxes, &tagged, hits);
                }
            }
            for &run in &search.runs[std::mem::replace(&mut first, end)..end] {
                self.look_into(run, &tagged, hits);
            }
            let met = hits.numbers[..hits.count].iter();
            let met = met.map(|&number| self.boxes.entry(number));
            let allowed = met.filter(|met| seeker.may_meet(met, rules));
            found.extend(allowed.map(|met| met.slot));
            sort_each_once(found, start);
            ends.push(found.len());
        }
        Some(work)
    }

    /// Lists the cells to be searched for a box, or notes that all are.
    fn list_cells(&self, aabb: &Aabb, search: &mut Search) {
        let start = search.names.len();
        let mut left = CELLS_PER_BOX * self.len as u64;
        for level in self.levels.all.iter().filter(|level| level.boxes > 0) {
            let range = level.cells_near(aabb);
            let Some(rest) = left.checked_sub(cell_count(&range)) else {
                search.names.truncate(start);
                search.ends.push((start, true));
                return;
            };
            left = rest;
            level.each_name(&range, |name| {
                self.prefetch_cell(Some(&name));
                search.names.push(name);
            });
        }
        search.ends.push((search.names.len(), false));
    }

    /// Appends the boxes of a cell that meet this one. Nearly all cells have few boxes, so there is
    /// no branch that depends on how many, or on which of them meet.
    #[inline(always)]
    fn look_into(&self, run: Run, &seeker: &TaggedBox, hits: &mut Hits) {
        hits.make_room(run.len() + ROOM);
        let (mut count, entries) = (hits.count, &mut hits.numbers[..]);
        let (first, rooms) = self.boxes.rooms(run);
        let (mut number, end) = (first, first + run.len());
        for room in rooms {
            for entry in room {
                entries[count] = number;
                count += usize::from(entry.meets(&seeker) & (number < end));
                number += 1;
            }
        }
        hits.count = count;
    }
}

/// The boxes that meet a seeker.
#[derive(Clone, Debug, Default)]
struct Hits {
    /// Numbers of entries, of which the first `count` are in use.
    numbers: Vec<usize>,
    count: usize,
}

impl Hits {
    #[inline(always)]
    fn make_room(&mut self, more: usize) {
        if self.numbers.len() < self.count + more {
            self.grow(more);
        }
    }

    #[cold]
    fn grow(&mut self, more: usize) {
        self.numbers.resize(2 * (self.count + more), 0);
    }
}

/// Buffers of searches, kept from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Search {
    names: Vec<u32>,
    runs: Vec<Run>,
    /// The end of each seeker's cells, and whether all cells are searched.
    ends: Vec<(usize, bool)>,
    hits: Hits,
}

impl Search {
    fn clear(&mut self) {
        self.names.clear();
        self.runs.clear();
        self.ends.clear();
    }
}

/// Sorts the numbers from `start` on, and removes duplicates.
fn sort_each_once(numbers: &mut Vec<u32>, start: usize) {
    numbers[start..].sort_unstable();
    let mut end = start;
    for at in start..numbers.len() {
        if end == start || numbers[end - 1] != numbers[at] {
            numbers[end] = numbers[at];
            end += 1;
        }
    }
    numbers.truncate(end);
}

impl IndexedBox {
    fn tagged(&self) -> TaggedBox {
        TaggedBox { min: self.aabb.min, slot: self.slot, max: self.aabb.max, tags: self.tags }
    }

    /// Whether a pair with another box, is reported if the boxes
    /// meet.
    fn may_meet(&self, other: &TaggedBox, rules: PairRules<'_>) -> bool {
        let &TaggedBox { slot, tags, .. } = other;
        let are_fixed = self.tags & tags & FIXED_TAG != 0;
        let collide = (self.tags | tags) & GROUPED_TAG == 0
            || rules.groups[self.slot as usize].collide(rules.groups[slot as usize]);
        let may_meet = slot != self.slot && !are_fixed && collide;
        may_meet && !rules.excluded.contains(self.slot, slot)
    }
}

/// The tags of a body.
pub(crate) fn tags(is_dynamic: bool, groups: Groups) -> u32 {
    (FIXED_TAG * u32::from(!is_dynamic)) | (GROUPED_TAG * u32::from(groups != Groups::ALL))
}
