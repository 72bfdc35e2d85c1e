//! Pair finders: which pairs are candidates for the strategy's first volume test.
//!
//! A finder arranges bodies in slots and produces candidates in two forms: a slot with a contiguous
//! run of slots, and a [`Block`] of scattered pairs if runs are too short to fill a vector. Each
//! pair that the first test would report is a candidate exactly once; two static bodies are never a
//! candidate. Slots, candidates and their order depend only on the bodies, never on the tier or on
//! threads.

use std::ops::Range;

use crate::bodies::Places;
use crate::pairs::bytes;
use crate::settings::Finder;
use crate::simd::Lanes;
use crate::threads::Executor;

mod all_pairs;
mod auto;
mod block;
mod bounds;
mod box_index;
mod ends;
mod grid;
#[cfg(debug_assertions)]
mod invariants;
mod neighbours;
mod slot_test;
mod slots;
mod sweep;

pub use all_pairs::AllPairs;
pub use auto::Population;
use block::{BLOCK_BODIES, BlockPage, RunWriter};
pub use block::{Block, MOST_CANDIDATES};
pub use bounds::BallBounds;
pub(crate) use box_index::{BODIES_IN_CACHE, Candidates, IndexedBox, tags};
pub use ends::{EndSlots, GivenBoxes};
pub use grid::{Cells, Grid, TableLayout};
use neighbours::NeighbourList;
pub use neighbours::{Neighbours, Volume};
pub use slot_test::{BallTest, SlotTest, list_slots};
pub use slots::{Balls, SlotBodies, Slots};
pub use sweep::Sweep;

/// The strategy's first volume test.
pub trait FirstTest {
    /// Slot `i` against each slot of `run`.
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>);
    /// Scattered pairs of slots, but not the block's long runs.
    fn block<L: Lanes>(&mut self, l: L, block: &Block<'_>);
}

/// A pair finder with its bodies arranged.
#[derive(Clone, Debug)]
pub enum PairFinder {
    /// Every pair.
    AllPairs(AllPairs),
    /// Cells.
    Grid(Grid),
    /// Sorted ends along an axis.
    Sweep(Sweep),
    /// Lists of neighbours, kept over frames.
    Neighbours(Box<Neighbours>),
}

/// The source of a frame's candidates.
enum CandidateSource<'a> {
    AllPairs(&'a AllPairs),
    Grid(&'a Grid),
    Sweep(&'a Sweep),
    List(&'a NeighbourList),
}

/// Which places get other bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reorder {
    /// None.
    None,
    /// Those of moving bodies.
    Moving,
    /// All.
    All,
}

impl PairFinder {
    /// Makes the finder of that name, or for `auto` the one that suits the population.
    #[must_use]
    pub fn new(finder: Finder, population: &Population) -> Self {
        match finder {
            Finder::AllPairs => Self::AllPairs(AllPairs::default()),
            Finder::Grid => Self::Grid(Grid::default()),
            Finder::Sweep => Self::Sweep(Sweep::default()),
            Finder::Neighbours => Self::Neighbours(Box::new(Neighbours::new(population.volume))),
            Finder::Auto => Self::new(population.finder(), population),
        }
    }

    /// Changes the set of bodies, in the order after [`Places::replace`]; `stays` says which former
    /// places keep their body. Returns false if the finder keeps no knowledge of bodies and starts
    /// again.
    pub fn replace(
        &mut self,
        finder: Finder,
        population: &Population,
        stays: &[bool],
        moving: usize,
    ) -> bool {
        let wanted = match finder {
            Finder::Auto => population.finder(),
            finder => finder,
        };
        let bodies = population.bodies;
        let is_kept = wanted == self.name()
            && match self {
                Self::AllPairs(_) | Self::Sweep(_) => false,
                Self::Grid(finder) => finder.replace(stays, moving, bodies),
                Self::Neighbours(finder) => finder.replace(stays, moving, bodies),
            };
        if !is_kept {
            *self = Self::new(wanted, population);
        }
        is_kept
    }

    /// Its name; never [`Finder::Auto`].
    #[must_use]
    pub fn name(&self) -> Finder {
        match self {
            Self::AllPairs(_) => Finder::AllPairs,
            Self::Grid(_) => Finder::Grid,
            Self::Sweep(_) => Finder::Sweep,
            Self::Neighbours(_) => Finder::Neighbours,
        }
    }

    /// Bytes that it holds, including its slots.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::AllPairs(finder) => finder.slots().bytes(),
            Self::Grid(finder) => finder.bytes(),
            Self::Sweep(finder) => finder.bytes(),
            Self::Neighbours(finder) => finder.bytes(),
        }
    }

    /// Candidates that the last frame tested to build a list of neighbours. An abandoned search
    /// counts as its limit.
    #[must_use]
    pub fn list_tests(&self) -> u64 {
        match self {
            Self::AllPairs(_) | Self::Grid(_) | Self::Sweep(_) => 0,
            Self::Neighbours(finder) => finder.list_tests(),
        }
    }

    /// Finds a better order of places and writes it to `order`, as the names for the places. Moving
    /// bodies stay first. `balls` and `names` are those of the last frame.
    pub fn reorder(
        &mut self,
        places: &Places,
        balls: &[[f32; 4]],
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        match self {
            Self::AllPairs(_) => Reorder::None,
            Self::Grid(finder) => finder.reorder(places.moving, balls, names, order),
            Self::Sweep(finder) => finder.reorder(places.moving, names, order),
            Self::Neighbours(finder) => finder.reorder(places.moving, balls, names, order),
        }
    }

    /// Records how many candidates the last frame had. The grid decides by it whether to plan its
    /// levels again.
    pub fn observe(&mut self, candidates: u64) {
        match self {
            Self::AllPairs(_) | Self::Sweep(_) => {}
            Self::Grid(finder) => finder.observe(candidates),
            Self::Neighbours(finder) => finder.observe(candidates),
        }
    }

    /// Arranges the bodies for a frame. `balls` and `names` are in the order of places. For every
    /// pair that the first test reports, the cubes around the two balls meet. `boxes` are the boxes
    /// inside these cubes, if boxes are reported.
    pub fn arrange(
        &mut self,
        executor: Executor<'_>,
        places: &Places,
        balls: &[[f32; 4]],
        names: &[u32],
        boxes: Option<GivenBoxes<'_>>,
    ) {
        match self {
            Self::AllPairs(finder) => finder.arrange(places, balls, names),
            Self::Grid(finder) => finder.arrange(executor, balls, names),
            Self::Sweep(finder) => finder.arrange(places, balls, names),
            Self::Neighbours(finder) => {
                finder.arrange(executor, places.moving, balls, names, boxes);
            }
        }
        #[cfg(debug_assertions)]
        self.check(executor.tier, places, balls, boxes);
    }

    /// The arranged bodies. `balls` are those that were arranged; if places have the order of
    /// slots, they are read directly.
    #[must_use]
    pub fn slots<'a>(&'a self, balls: &'a Balls) -> SlotBodies<'a> {
        let slots = self.own_slots();
        if self.slots_are_places() { slots.followed(balls) } else { slots.arranged() }
    }

    /// Whether places have the order of slots, so that columns by place can be read by slot.
    #[must_use]
    pub fn slots_are_places(&self) -> bool {
        matches!(self, Self::Neighbours(finder) if finder.slots_are_places())
    }

    /// The name of each slot's body, followed by a vector of arbitrary names.
    #[must_use]
    pub fn names(&self) -> &[u32] {
        &self.own_slots().names
    }

    fn own_slots(&self) -> &Slots {
        match self {
            Self::AllPairs(finder) => finder.slots(),
            Self::Grid(finder) => finder.slots(),
            Self::Sweep(finder) => finder.slots(),
            Self::Neighbours(finder) => finder.slots(),
        }
    }

    /// The source of this frame's candidates. Neighbour lists leave frames in which they don't pay
    /// to the grid; one compiled copy of its search serves both finders.
    #[inline(always)]
    fn search(&self) -> CandidateSource<'_> {
        match self {
            Self::AllPairs(finder) => CandidateSource::AllPairs(finder),
            Self::Grid(finder) => CandidateSource::Grid(finder),
            Self::Sweep(finder) => CandidateSource::Sweep(finder),
            Self::Neighbours(finder) => match finder.list() {
                Some(list) => CandidateSource::List(list),
                None => CandidateSource::Grid(finder.grid()),
            },
        }
    }

    /// Whether this frame's candidates include runs, or only scattered pairs.
    #[must_use]
    pub fn hands_out_runs(&self) -> bool {
        !matches!(self.search(), CandidateSource::List(_))
    }

    /// The number of parts of the work.
    #[must_use]
    pub fn parts(&self) -> usize {
        match self.search() {
            CandidateSource::AllPairs(finder) => finder.parts(),
            CandidateSource::Grid(finder) => finder.parts(),
            CandidateSource::Sweep(finder) => finder.parts(),
            CandidateSource::List(list) => list.parts(),
        }
    }

    /// Passes the candidates of the given parts to `test`, in order.
    #[inline(always)]
    pub fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        match self.search() {
            CandidateSource::AllPairs(finder) => finder.find(l, parts, test),
            CandidateSource::Grid(finder) => finder.find(l, parts, test),
            CandidateSource::Sweep(finder) => finder.find(l, parts, test),
            CandidateSource::List(list) => list.find(l, parts, test),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Tier;
    use crate::threads::Threads;

    fn population(bodies: usize) -> Population {
        Population { bodies, radii: [1.0; 2], cheap_test: true, volume: Volume::Ball }
    }

    /// Bodies in a row, of which this finder has arranged two frames.
    fn arranged(finder: Finder, bodies: usize) -> PairFinder {
        let balls: Vec<_> = (0..bodies).map(|i| [i as f32, 1.0, 1.0, 0.5]).collect();
        let mut places =
            Places { body: (0..bodies as u32).collect(), shape: vec![0; bodies], moving: bodies };
        let (mut finder, pool) = (PairFinder::new(finder, &population(bodies)), Threads::default());
        let mut order = Vec::new();
        for _ in 0..2 {
            let names = &places.body;
            if finder.reorder(&places, &balls, names, &mut order) != Reorder::None {
                std::mem::swap(&mut places.body, &mut order);
            }
            let executor = pool.executor(Tier::SCALAR);
            finder.arrange(executor, &places, &balls, &places.body, None);
        }
        finder
    }

    /// Cells are kept for bodies that stay as long as the same finder suits.
    #[test]
    fn staying_bodies_keep_their_cells() {
        for (finder, next, name, kept) in [
            (Finder::Grid, Finder::Grid, Finder::Grid, true),
            (Finder::Neighbours, Finder::Neighbours, Finder::Neighbours, true),
            (Finder::Auto, Finder::Auto, Finder::Neighbours, true),
            (Finder::Grid, Finder::Neighbours, Finder::Neighbours, false),
            (Finder::Neighbours, Finder::Grid, Finder::Grid, false),
            (Finder::Sweep, Finder::Sweep, Finder::Sweep, false),
            (Finder::AllPairs, Finder::Auto, Finder::Neighbours, false),
        ] {
            let mut finder = arranged(finder, 100);
            let is_kept = finder.replace(next, &population(100), &[true; 100], 100);
            assert_eq!((finder.name(), is_kept), (name, kept));
        }
        let mut few = arranged(Finder::Auto, 100);
        assert!(!few.replace(Finder::Auto, &population(10), &[true; 100], 10));
        assert_eq!(few.name(), Finder::AllPairs);
    }
}
