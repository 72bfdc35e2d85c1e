//! The grid finder: cells of uniform size, slots sorted by counting, contiguous runs of candidates.
//!
//! If radii differ a lot, bodies are split into levels of similar size ([`plan`]), each with its
//! own cells. Static bodies have levels of their own, which are sorted once and never paired with
//! each other. Every frame sorts the moving levels again: at ten cycles per body, that is cheaper
//! than maintaining a tree. Every few frames the places take the order of the slots, so that the
//! sort reads and writes memory nearly in sequence.

mod across;
mod cells;
mod late_bodies;
mod level;
mod near;
mod plan;

use std::ops::Range;

pub use self::cells::{Cells, TableLayout};

use self::across::LevelSearch;
use self::level::GridLevel;
use super::{BLOCK_BODIES, BlockPage, FirstTest, Reorder, Slots, bytes};
use crate::rounding::skin::Reach;
use crate::simd::Lanes;
use crate::threads::Executor;

/// Frames between reorderings of the places. Bodies that move a tenth of their radius per frame are
/// then still in their cell or next to it. Reordering in every frame would cost as much as the sort
/// gains.
const FRAMES_PER_REORDER: u32 = 4;

/// Frames between two checks whether the levels still fit. [`PLAN_GROWTH`] is the growth of the
/// number of candidates that triggers a new plan.
const FRAMES_PER_PLAN_CHECK: u32 = 8;
const PLAN_GROWTH: u64 = 2;

/// Slots per part of the work.
const SLOTS_PER_PART: usize = 1024;

/// Parts are ordered by their relative position in their level, in 2 to this power steps.
const POSITION_BITS: u32 = 24;

/// Seekers of another level per part of the work, when they search cells and when they are tested
/// against all.
const SEEKERS_BY_CELLS: usize = 256;
const SEEKERS_OF_ALL: usize = 16;

/// Levels of cells, and the bodies in their slots.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Moving levels first.
    levels: Vec<GridLevel>,
    moving_levels: usize,
    /// Whether the static levels are sorted.
    fixed_sorted: bool,
    slots: Slots,
    slot_cells: Vec<u32>,
    place_cells: Vec<u32>,
    parts: Vec<GridPart>,
    /// Frames since the last plan.
    age: u32,
    /// Candidates in the last frame, and in the first frame after the last plan.
    candidates: u64,
    planned: Option<u64>,
}

/// A part of the work: the pairs of some slots with slots of one level.
#[derive(Clone, Debug)]
struct GridPart {
    slots: Range<usize>,
    /// The level of these slots.
    seeker: usize,
    level: usize,
    kind: PartKind,
}

#[derive(Clone, Copy, Debug)]
enum PartKind {
    Near,
    Across(LevelSearch),
}

impl Grid {
    /// Finds a better order of places and writes it as the names for the places. `balls` and
    /// `names` are those of the last frame.
    pub(super) fn reorder(
        &mut self,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        self.age += 1;
        order.clear();
        if self.needs_plan(balls.len()) {
            order.extend(0..balls.len() as u32);
            self.plan(moving, balls, order);
            for place in order {
                *place = names[*place as usize];
            }
            return Reorder::All;
        }
        if self.age == 1 {
            // In the first sort after a plan, static bodies take the order of their slots
            // permanently.
            order.extend_from_slice(&self.slots.names[..balls.len()]);
            self.fixed_sorted = false;
            return Reorder::All;
        }
        if self.age.is_multiple_of(FRAMES_PER_REORDER) {
            order.extend_from_slice(&self.slots.names[..moving]);
            order.extend_from_slice(&names[moving..]);
            return Reorder::Moving;
        }
        Reorder::None
    }

    /// Whether the levels no longer fit, or there are none.
    pub(super) fn needs_plan(&self, bodies: usize) -> bool {
        let most = |planned| PLAN_GROWTH * planned + bodies as u64;
        let grown = self.planned.is_some_and(|planned| self.candidates > most(planned));
        (self.levels.is_empty() && bodies > 0) || (grown && self.age >= FRAMES_PER_PLAN_CHECK)
    }

    /// Writes the order of the slots as the order of places, after a frame in which bodies were
    /// arranged and before frames in which they aren't.
    pub(super) fn follow_slots(
        &mut self,
        moving: usize,
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        self.age += 1;
        order.clear();
        order.extend_from_slice(&self.slots.names[..names.len()]);
        if order[moving..] == names[moving..] {
            return Reorder::Moving;
        }
        self.fixed_sorted = false;
        Reorder::All
    }

    /// Counts a frame in which bodies weren't arranged.
    pub(super) fn rest(&mut self) {
        self.age += 1;
    }

    /// Sets how moving bodies are grown for the search, from the next frame on.
    pub(super) fn set_reach(&mut self, reach: Reach) {
        for level in &mut self.levels[..self.moving_levels] {
            level.reach = reach;
        }
    }

    fn plan(&mut self, moving: usize, balls: &[[f32; 4]], order: &mut [u32]) {
        let (moving_order, fixed_order) = order.split_at_mut(moving);
        self.levels = plan::levels(balls, 0..moving, moving_order);
        self.moving_levels = self.levels.len();
        let fixed = plan::levels(balls, moving..balls.len(), fixed_order);
        self.levels.extend(fixed);
        (self.fixed_sorted, self.age, self.planned) = (false, 0, None);
    }

    /// Sorts the moving levels into their slots, and the static ones after a plan.
    pub(super) fn arrange(&mut self, executor: Executor<'_>, balls: &[[f32; 4]], names: &[u32]) {
        self.slots.resize(balls.len());
        self.slot_cells.resize(balls.len(), 0);
        self.place_cells.resize(balls.len(), 0);
        let changed = if self.fixed_sorted { self.moving_levels } else { self.levels.len() };
        for level in &mut self.levels[..changed] {
            level.sort(
                executor,
                balls,
                names,
                &mut self.place_cells,
                &mut self.slots,
                &mut self.slot_cells,
            );
        }
        self.fixed_sorted = true;
        self.cut();
    }

    /// Splits the work into parts, in spatial order.
    fn cut(&mut self) {
        self.parts.clear();
        for (index, level) in self.levels[..self.moving_levels].iter().enumerate() {
            let near = GridPart {
                slots: level.range.clone(),
                seeker: index,
                level: index,
                kind: PartKind::Near,
            };
            push_parts(&mut self.parts, near, SLOTS_PER_PART);
            for (other_index, other) in self.levels.iter().enumerate().skip(index + 1) {
                let (seeks, search) = across::plan(level, other);
                let (seeker, target) =
                    if seeks { (index, other_index) } else { (other_index, index) };
                let size = match search {
                    LevelSearch::Cells => SEEKERS_BY_CELLS,
                    LevelSearch::All => SEEKERS_OF_ALL,
                };
                let across = GridPart {
                    slots: self.levels[seeker].range.clone(),
                    seeker,
                    level: target,
                    kind: PartKind::Across(search),
                };
                push_parts(&mut self.parts, across, size);
            }
        }
        // All levels have their slots in the same spatial order, so neighbouring parts read the
        // same memory.
        let levels = &self.levels;
        self.parts.sort_by_key(|part| {
            let all = &levels[part.seeker].range;
            (((part.slots.start - all.start) as u64) << POSITION_BITS) / all.len() as u64
        });
    }

    pub(super) fn bytes(&self) -> usize {
        let starts = self.levels.iter().map(|level| bytes(&level.starts));
        let cells = bytes(&self.slot_cells) + bytes(&self.place_cells);
        self.slots.bytes() + cells + starts.sum::<usize>() + bytes(&self.parts)
    }

    pub(super) fn slots(&self) -> &Slots {
        &self.slots
    }

    /// The number of arranged bodies.
    pub(super) fn bodies(&self) -> usize {
        self.slot_cells.len()
    }

    pub(super) fn slots_mut(&mut self) -> &mut Slots {
        &mut self.slots
    }

    /// Whether a part's seekers move, and whether its targets move.
    pub(super) fn moves(&self, part: usize) -> [bool; 2] {
        let part = &self.parts[part];
        [part.seeker, part.level].map(|level| level < self.moving_levels)
    }

    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// Records the number of candidates of a frame.
    pub(super) fn observe(&mut self, candidates: u64) {
        self.candidates = candidates;
        self.planned.get_or_insert(candidates);
    }

    /// Passes the candidates of parts to `test`, page by page. Pages are filled without knowing the
    /// test: it is compiled into few places, which otherwise takes half of the library's compiling.
    #[inline(always)]
    pub(super) fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        let mut page = BlockPage::new();
        for part in &self.parts[parts] {
            let mut search = PartSearch { seekers: part.slots.clone(), ..PartSearch::default() };
            while !search.seekers.is_empty() {
                match part.kind {
                    PartKind::Near => self.near(part, &mut search, &mut page),
                    PartKind::Across(how) => self.across(part, how, &mut search, &mut page),
                }
                if !page.block().codes().is_empty() {
                    test.block(l, &page.block());
                }
                for (i, run) in page.long_runs() {
                    test.run(l, i, run);
                }
            }
        }
    }
}

/// The seekers of a part whose candidates are not on a page yet, and where the first block of them
/// goes on if a page had no room for all of its rows: in which lane, and with which z and y.
#[derive(Clone, Debug, Default)]
struct PartSearch {
    seekers: Range<usize>,
    lane: usize,
    row: Option<[u32; 2]>,
}

impl PartSearch {
    /// The seekers whose candidates share a page.
    #[inline(always)]
    fn block(&self) -> Range<usize> {
        self.seekers.start..self.seekers.end.min(self.seekers.start + BLOCK_BODIES)
    }

    /// Goes on to the seekers after the block.
    #[inline(always)]
    fn next_block(&mut self) {
        (self.seekers.start, self.lane) = (self.block().end, 0);
    }
}

/// Splits a part into parts of `size` slots.
fn push_parts(parts: &mut Vec<GridPart>, whole: GridPart, size: usize) {
    let slots = whole.slots.clone();
    for start in slots.clone().step_by(size) {
        parts.push(GridPart { slots: start..slots.end.min(start + size), ..whole.clone() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Grid {
        /// Frames since the last plan, and candidates of the last frame.
        pub(in crate::broad_phase) fn age_and_candidates(&self) -> (u32, u64) {
            (self.age, self.candidates)
        }
    }

    /// A grid with one level of `each` moving bodies and one of `each` static ones, planned some
    /// frames ago.
    fn planned(each: usize) -> Grid {
        let level = |range| GridLevel::new(range, TableLayout::Box);
        Grid {
            levels: vec![level(0..each), level(each..2 * each)],
            moving_levels: 1,
            age: FRAMES_PER_PLAN_CHECK,
            ..Grid::default()
        }
    }

    /// Levels are planned anew when candidates have more than doubled after a pause.
    #[test]
    fn doubled_candidates_trigger_a_plan() {
        assert!(Grid::default().needs_plan(1) && !Grid::default().needs_plan(0));
        let mut grid = planned(5);
        assert!(!grid.needs_plan(10), "the first frame after a plan");
        grid.observe(100);
        assert!(!grid.needs_plan(10));
        for (candidates, grown) in [(0, false), (209, false), (210, false), (211, true)] {
            grid.observe(candidates);
            grid.age = FRAMES_PER_PLAN_CHECK;
            assert_eq!(grid.needs_plan(10), grown, "{candidates}");
            grid.age = FRAMES_PER_PLAN_CHECK - 1;
            assert!(!grid.needs_plan(10), "{candidates}: too soon");
        }
        grid.age = FRAMES_PER_PLAN_CHECK + 1;
        assert!(grid.needs_plan(10));
    }
}
