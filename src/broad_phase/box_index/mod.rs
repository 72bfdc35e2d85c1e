//! An index of boxes by location that is changed box by box: a table of cells of several sizes
//! ([`levels`]), and the [`candidates`] that it finds.
//!
//! A box that moves, comes or goes changes its old cell and its new one; a query reads the cells
//! near a box and their boxes, four at a time. Nothing is sorted, and nothing is rebuilt. The cells
//! of a row along x are next to each other in the table, each row begins anywhere, and cells at the
//! same place share their boxes.

mod candidates;
mod levels;

pub(crate) use self::candidates::{BODIES_IN_CACHE, Candidates, IndexedBox, tags};
use self::levels::{Levels, cell_count};
use crate::bodies::Aabb;
use crate::pairs::{Run, Runs, sort_few};
use crate::simd::{BoxQuad, SeekerQuad, TaggedBox, prefetch};

/// Number of boxes by which prefetching is ahead while an index is made.
const PREFETCH_DISTANCE: usize = 16;

/// Searching this number of cells takes as long as testing one box.
const CELLS_PER_BOX: u64 = 2;

/// Boxes in a quad.
const LANES: usize = 4;

/// Tag of a fixed box.
const FIXED_TAG: u32 = 1;

/// A cell of the table, within a cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
struct Cell {
    /// Number of its boxes. They fill all lanes of its quads except some of the last one, and those
    /// that aren't fixed come first: a fixed box reads no others.
    boxes: u32,
    quads: Run,
}

/// What is known of a slot, in a cache line: the box of its body and its cell, and what its
/// [`Candidates`] need.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Body {
    /// The box as it is; that in the cells may be larger.
    tagged: TaggedBox,
    /// The position of its cell in the table.
    cell: u32,
    /// The number of the box in the cell.
    place: u32,
    level: u16,
    /// Whether the slot has a box in the index.
    is_present: bool,
    /// Whether it has an enlarged box and a list.
    is_listed: bool,
    list: Run,
    /// The last search before which it moved or came.
    search: u32,
}

impl Body {
    /// No box.
    const NONE: Self = Self {
        tagged: TaggedBox::NONE,
        cell: 0,
        place: 0,
        level: 0,
        is_present: false,
        is_listed: false,
        list: Run::EMPTY,
        search: 0,
    };
}

/// All boxes of a world by location.
#[derive(Clone, Debug)]
struct BoxIndex {
    levels: Levels,
    /// A power of two.
    cells: Vec<Cell>,
    quads: Runs<BoxQuad, 1>,
    /// By slot.
    bodies: Vec<Body>,
    len: usize,
}

impl BoxIndex {
    /// An index of `count` boxes, no two in one slot. It is made in a few passes over all boxes:
    /// their cells, the room of each cell, the boxes.
    fn of(boxes: impl Iterator<Item = TaggedBox> + Clone, count: usize) -> Self {
        let mut index = Self {
            levels: Levels::suited_to(boxes.clone().map(|tagged| tagged.aabb()), count),
            cells: vec![Cell::default(); count.next_power_of_two()],
            quads: Runs::default(),
            bodies: Vec::new(),
            len: 0,
        };
        let mut counts = vec![0_u32; index.cells.len()];
        for tagged in boxes.clone() {
            let (cell, level) = index.cell_of(&tagged.aabb(), &Body::NONE);
            index.extend_to(tagged.slot as usize + 1);
            index.bodies[tagged.slot as usize] = Body { tagged, cell, level, ..Body::NONE };
            counts[cell as usize] += 1;
        }
        let quads = |boxes: u32| boxes.div_ceil(LANES as u32);
        let filled = counts.iter().filter(|&&boxes| boxes > 0);
        index.quads.reserve_growing(filled.map(|&boxes| quads(boxes)));
        for (cell, &boxes) in index.cells.iter_mut().zip(&counts).filter(|(_, boxes)| **boxes > 0) {
            index.quads.reserve(&mut cell.quads, quads(boxes) as usize);
        }
        let mut ahead = boxes.clone().skip(PREFETCH_DISTANCE);
        for tagged in boxes {
            if let Some(ahead) = ahead.next() {
                prefetch(&index.cells[index.bodies[ahead.slot as usize].cell as usize]);
            }
            let Body { cell, level, .. } = index.bodies[tagged.slot as usize];
            index.insert(&tagged, cell, level);
        }
        index
    }

    /// Makes room for slots below this one.
    fn extend_to(&mut self, slots: usize) {
        if self.bodies.len() < slots {
            self.bodies.resize(slots, Body::NONE);
        }
    }

    /// The cell and the level of a box that comes in place of this body's.
    #[inline(always)]
    fn cell_of(&mut self, aabb: &Aabb, former: &Body) -> (u32, u16) {
        let level = self.levels.all.get(usize::from(former.level));
        let level = match level.filter(|level| former.is_present && level.suits(aabb)) {
            Some(_) => former.level,
            None => self.levels.level_of(aabb),
        };
        (self.levels.all[usize::from(level)].home(aabb) & self.mask(), level)
    }

    fn mask(&self) -> u32 {
        (self.cells.len() - 1) as u32
    }

    /// Puts a box into the cells, in place of the one that its slot may have there. It takes about
    /// the same time however many boxes share a cell.
    #[inline]
    fn put(&mut self, tagged: &TaggedBox) {
        let body = self.bodies[tagged.slot as usize];
        let (cell, level) = self.cell_of(&tagged.aabb(), &body);
        if body.is_present && (body.cell, body.level) == (cell, level) {
            let quads = self.quads.get_mut(self.cells[cell as usize].quads);
            let (quad, lane) = (body.place as usize / LANES, body.place as usize % LANES);
            if (quads[quad].tags[lane] ^ tagged.tags) & FIXED_TAG == 0 {
                return quads[quad].put(lane, tagged);
            }
        }
        self.remove(tagged.slot);
        self.insert(tagged, cell, level);
    }

    /// Puts a box that is in no cell into this one.
    fn insert(&mut self, tagged: &TaggedBox, cell: u32, level: u16) {
        let body = &mut self.bodies[tagged.slot as usize];
        (body.cell, body.level, body.is_present) = (cell, level, true);
        let Cell { boxes, quads } = &mut self.cells[cell as usize];
        let last = *boxes;
        *boxes += 1;
        if (last as usize).is_multiple_of(LANES) {
            self.quads.push(quads, BoxQuad::default());
        }
        let mut place = last;
        if tagged.tags & FIXED_TAG == 0 {
            place = self.movable(cell, last);
            if place < last {
                self.move_box(cell, place, last);
            }
        }
        self.set(cell, place, tagged);
        self.levels.all[usize::from(level)].boxes += 1;
        self.len += 1;
    }

    /// Removes a box from the cells, if it is there. The last one of its cell and kind takes its
    /// place.
    fn remove(&mut self, slot: u32) {
        let body = &mut self.bodies[slot as usize];
        if !std::mem::take(&mut body.is_present) {
            return;
        }
        let Body { cell, mut place, level, .. } = *body;
        let count = self.cells[cell as usize].boxes;
        let (movable, last) = (self.movable(cell, count), count - 1);
        if place < movable {
            self.move_box(cell, movable - 1, place);
            place = movable - 1;
        }
        if place < last {
            self.move_box(cell, last, place);
        }
        let Cell { boxes, quads } = &mut self.cells[cell as usize];
        *boxes = last;
        let last = last as usize;
        self.quads.get_mut(*quads)[last / LANES].clear(last % LANES);
        if last.is_multiple_of(LANES) {
            self.quads.remove(quads, last / LANES);
        }
        self.levels.all[usize::from(level)].boxes -= 1;
        self.len -= 1;
    }

    /// The number of boxes in a cell that aren't fixed, of `count` in all.
    fn movable(&self, cell: u32, count: u32) -> u32 {
        let quads = self.quads.get(self.cells[cell as usize].quads);
        let is_fixed = |place: u32| {
            quads[place as usize / LANES].tags[place as usize % LANES] & FIXED_TAG != 0
        };
        let (mut from, mut to) = (0, count);
        if count > 0 && !is_fixed(count - 1) {
            from = count;
        }
        while from < to {
            let middle = from + (to - from) / 2;
            (from, to) = if is_fixed(middle) { (from, middle) } else { (middle + 1, to) };
        }
        from
    }

    /// Copies the box in a place of a cell to another place.
    fn move_box(&mut self, cell: u32, from: u32, to: u32) {
        let quads = self.quads.get(self.cells[cell as usize].quads);
        let tagged = quads[from as usize / LANES].get(from as usize % LANES);
        self.set(cell, to, &tagged);
    }

    #[inline(always)]
    fn set(&mut self, cell: u32, place: u32, tagged: &TaggedBox) {
        let quads = self.quads.get_mut(self.cells[cell as usize].quads);
        quads[place as usize / LANES].put(place as usize % LANES, tagged);
        self.bodies[tagged.slot as usize].place = place;
    }

    /// Frees the room that boxes have left in cells, if it is much.
    fn compact(&mut self) {
        if self.quads.is_sparse(self.cells.len()) {
            self.quads.compact(self.cells.iter_mut().map(|cell| &mut cell.quads));
        }
    }

    /// Prefetches what [`Self::put`] will read of later boxes: for the last of them the body, for
    /// the next one its cell, for the one that comes soon its quad.
    #[inline(always)]
    fn prefetch(&self, [last, next, soon]: [Option<&IndexedBox>; 3]) {
        let body = |ahead: &IndexedBox| self.bodies.get(ahead.slot as usize);
        if let Some(body) = last.and_then(body) {
            prefetch(body);
        }
        if let Some(body) = next.and_then(body) {
            prefetch(&self.cells[body.cell as usize]);
        }
        if let Some(body) = soon.and_then(body).filter(|body| body.is_present) {
            let first = self.quads.first(self.cells[body.cell as usize].quads);
            self.quads.entry(first + body.place as usize / LANES).prefetch();
        }
    }

    /// Lists and prefetches the quads of the cells near each of these boxes. Returns the number of
    /// their cells and boxes, or `None` if there are more than `most`.
    #[inline(never)]
    fn search(&self, seekers: &[TaggedBox], search: &mut Search, most: usize) -> Option<usize> {
        let Search { rows, quads, ends, .. } = search;
        rows.clear();
        quads.clear();
        ends.clear();
        // Two passes here and one by the caller, so that many cache misses overlap.
        for seeker in seekers {
            self.list_rows(&seeker.aabb(), rows);
            ends.push(rows.len());
        }
        let (mut work, mut first) = (0, 0);
        for (end, seeker) in ends.iter_mut().zip(seekers) {
            let is_fixed = seeker.tags & FIXED_TAG != 0;
            for &row in &rows[std::mem::replace(&mut first, *end)..*end] {
                work += self.list_quads(row, is_fixed, quads);
                if work > most {
                    return None;
                }
            }
            *end = quads.len();
        }
        Some(work)
    }

    /// Lists the rows of cells to be searched for a box: the whole table, if they have too many.
    #[inline(always)]
    fn list_rows(&self, aabb: &Aabb, rows: &mut Vec<CellRow>) {
        let start = rows.len();
        let mut left = CELLS_PER_BOX * self.len as u64;
        for level in self.levels.all.iter().filter(|level| level.boxes > 0) {
            let range = level.cells_near(aabb);
            let Some(rest) = left.checked_sub(cell_count(&range)) else {
                rows.truncate(start);
                rows.push(CellRow { first: 0, len: self.cells.len() });
                return;
            };
            left = rest;
            level.each_row(&range, |first, len| {
                let row = CellRow { first: first & self.mask(), len };
                prefetch(&self.cells[row.first as usize]);
                rows.push(row);
            });
        }
    }

    /// Lists and prefetches the quads in a row of cells, which goes on at the start of the table
    /// where it ends: for a fixed seeker, those of boxes that aren't fixed. Returns the number of
    /// cells and boxes.
    #[inline(always)]
    fn list_quads(
        &self,
        CellRow { first, len }: CellRow,
        is_fixed: bool,
        quads: &mut Vec<u32>,
    ) -> usize {
        let mut work = len;
        for step in 0..len {
            let at = (first as usize + step) & (self.cells.len() - 1);
            let Cell { mut boxes, quads: run } = self.cells[at];
            if is_fixed {
                boxes = self.movable(at as u32, boxes);
            }
            work += boxes as usize;
            let number = self.quads.first(run) as u32;
            for number in number..number + boxes.div_ceil(LANES as u32) {
                self.quads.entry(number as usize).prefetch();
                quads.push(number);
            }
        }
        work
    }
}

/// Calls `take` with the slot and the tags of each box in the quads of these numbers that meets the
/// seeker's. It may be called twice for a box, and is called for the seeker's own.
#[inline(always)]
fn each_meeting(
    quads: &Runs<BoxQuad, 1>,
    seeker: &TaggedBox,
    numbers: &[u32],
    hits: &mut Vec<(u32, u32)>,
    mut take: impl FnMut(u32, u32),
) {
    if hits.len() < numbers.len() {
        hits.resize(2 * numbers.len(), (0, 0));
    }
    // Without branches: which boxes meet can't be foreseen.
    let (seeker, mut count) = (SeekerQuad::of(seeker), 0);
    for &number in numbers {
        let lanes = quads.entry(number as usize).meeting(&seeker);
        hits[count] = (number, lanes);
        count += usize::from(lanes != 0);
    }
    for &(number, mut lanes) in &hits[..count] {
        let quad = quads.entry(number as usize);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            take(quad.slots[lane], quad.tags[lane]);
        }
    }
}

/// Cells next to each other.
#[derive(Clone, Copy, Debug)]
struct CellRow {
    first: u32,
    len: usize,
}

/// Buffers of searches, kept from frame to frame.
#[derive(Clone, Debug, Default)]
struct Search {
    rows: Vec<CellRow>,
    quads: Vec<u32>,
    /// The end of each seeker's rows, then of its quads.
    ends: Vec<usize>,
    /// The quads that a seeker meets, in their first part.
    hits: Vec<(u32, u32)>,
}

/// Sorts the numbers from `start` on, and removes duplicates.
#[inline(always)]
fn sort_each_once(numbers: &mut Vec<u32>, start: usize) {
    sort_few(&mut numbers[start..]);
    let mut end = start;
    for at in start..numbers.len() {
        if end == start || numbers[end - 1] != numbers[at] {
            numbers[end] = numbers[at];
            end += 1;
        }
    }
    numbers.truncate(end);
}
