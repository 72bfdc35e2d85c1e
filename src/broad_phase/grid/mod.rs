//! The grid: cells of uniform size, counting-sorted slots, contiguous runs of candidates.
//!
//! Where radii differ much, bodies are split into levels of like size ([`plan`]), each with its own cells; static bodies
//! have levels of their own, sorted once, so no two of them ever meet. Every frame sorts the moving levels anew: at ten
//! cycles a body that is cheaper than keeping a tree in shape. Now and then the places themselves take the order of the
//! slots, so that the sort reads and writes memory nearly in sequence.

mod across;
mod cells;
mod level;
mod near;
mod plan;

use std::ops::Range;

pub use self::cells::{Cells, Layout};

use self::across::Search;
use self::level::Level;
use super::{Block, FirstTest, Reorder, Slots, bytes};
use crate::simd::Lanes;
use crate::threads::Executor;

/// Frames after which places take the order of slots. Bodies that move a tenth of their radius a frame are then in their cell
/// still, or beside it; each frame would spare the sort no more than following the order costs.
const REORDER: u32 = 4;

/// Frames between two looks at whether the levels still fit, and the growth of the candidates that calls for new ones.
const PLAN_PAUSE: u32 = 8;
const PLAN_GROWTH: u64 = 2;

/// Slots in one part of the work.
const PART: usize = 1024;

/// Bodies that seek those of another level in one part of the work, by cells or all against all.
const SEEKERS_BY_CELLS: usize = 256;
const SEEKERS_OF_ALL: usize = 16;

/// Levels of cells, and the bodies in their slots.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Moving levels first.
    levels: Vec<Level>,
    moving_levels: usize,
    /// Whether the static levels are sorted.
    fixed_sorted: bool,
    slots: Slots,
    slot_cells: Vec<u32>,
    place_cells: Vec<u32>,
    parts: Vec<Part>,
    /// Frames since the last plan.
    age: u32,
    /// Candidates of the last frame, and of the first after the last plan.
    candidates: u64,
    planned: Option<u64>,
}

/// A piece of the work: the pairs of some slots with slots of one level.
#[derive(Clone, Debug)]
struct Part {
    slots: Range<usize>,
    level: usize,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Near,
    Across(Search),
}

impl Grid {
    /// Looks for a better order of places and writes it as the names that take the places. `balls` and `names` are those of
    /// the last frame.
    pub(super) fn reorder(
        &mut self,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        self.age += 1;
        let grown = self
            .planned
            .is_some_and(|planned| self.candidates > PLAN_GROWTH * planned + balls.len() as u64);
        let unplanned = self.levels.is_empty() && !balls.is_empty();
        order.clear();
        if unplanned || (grown && self.age >= PLAN_PAUSE) {
            order.extend(0..balls.len() as u32);
            self.plan(moving, balls, order);
            for place in order {
                *place = names[*place as usize];
            }
            return Reorder::All;
        }
        if self.age == 1 {
            // The first sort after a plan: static bodies take the order of their slots once and for all.
            order.extend_from_slice(&self.slots.names[..balls.len()]);
            self.fixed_sorted = false;
            return Reorder::All;
        }
        if self.age.is_multiple_of(REORDER) {
            order.extend_from_slice(&self.slots.names[..moving]);
            order.extend_from_slice(&names[moving..]);
            return Reorder::Moving;
        }
        Reorder::None
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
        let changed = if self.fixed_sorted {
            self.moving_levels
        } else {
            self.levels.len()
        };
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

    /// Cuts the work into parts.
    fn cut(&mut self) {
        self.parts.clear();
        for (index, level) in self.levels[..self.moving_levels].iter().enumerate() {
            push_parts(&mut self.parts, level, PART, index, Kind::Near);
            for (other_index, other) in self.levels.iter().enumerate().skip(index + 1) {
                let (seeks, search) = across::plan(level, other);
                let (seeker, target) = if seeks {
                    (level, other_index)
                } else {
                    (other, index)
                };
                let size = match search {
                    Search::Cells => SEEKERS_BY_CELLS,
                    Search::All => SEEKERS_OF_ALL,
                };
                push_parts(&mut self.parts, seeker, size, target, Kind::Across(search));
            }
        }
    }

    pub(super) fn bytes(&self) -> usize {
        let starts = self.levels.iter().map(|level| bytes(&level.starts));
        let cells = bytes(&self.slot_cells) + bytes(&self.place_cells);
        self.slots.bytes() + cells + starts.sum::<usize>() + bytes(&self.parts)
    }

    pub(super) fn slots(&self) -> &Slots {
        &self.slots
    }

    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// Hears how many candidates a frame had.
    pub(super) fn observe(&mut self, candidates: u64) {
        self.candidates = candidates;
        self.planned.get_or_insert(candidates);
    }

    #[inline(always)]
    pub(super) fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        let mut block = Block::new();
        for part in &self.parts[parts] {
            let (slots, level) = (part.slots.clone(), &self.levels[part.level]);
            match part.kind {
                Kind::Near => self.near(l, level, slots, &mut block, test),
                Kind::Across(Search::Cells) => self.across(l, slots, level, &mut block, test),
                Kind::Across(Search::All) => {
                    for i in slots {
                        test.run(l, i, level.range.clone());
                    }
                }
            }
        }
    }
}

/// Cuts a level's slots into parts of `size`.
fn push_parts(parts: &mut Vec<Part>, of: &Level, size: usize, level: usize, kind: Kind) {
    for start in of.range.clone().step_by(size) {
        parts.push(Part {
            slots: start..of.range.end.min(start + size),
            level,
            kind,
        });
    }
}
