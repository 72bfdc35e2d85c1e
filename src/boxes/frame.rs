//! Culls one frame of given boxes: cubes around them, candidates from a finder, the test, the list.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

use super::cube_test::CubeTest;
use super::cubes::{MakeCubes, PREFETCH_DISTANCE};
use crate::bodies::contract::ContractError;
use crate::bodies::{Aabb, PairFilter, Places, read_ahead};
use crate::broad_phase::{Balls, EndSlots, GivenBoxes, PairFinder, Population, Reorder, Volume};
use crate::counters::VolumeCounters;
use crate::cull_error::CullError;
use crate::listing::{self, FirstVolume, HitNames, ListParts, Listing, Output, Tasks, list_up_to};
use crate::pairs::PairList;
use crate::rounding::cube::less_than_sure;
use crate::settings::Finder;
use crate::simd::{Lanes, Tier, dispatch, in_default_mode};

use crate::threads::{FrameThreads, FrameWork};

/// Boxes whose cubes one thread computes at a time.
const BOXES_PER_TASK: usize = 4096;

/// Columns of boxes up to this size fit into the first caches and are read ahead in order. For
/// larger ones, prefetching each box by its name is faster: by 3 % at 96 KB and 20 % at 240 KB, but
/// 3 % slower at 48 KB (an AMD Zen 5 with cold caches).
const MOST_READ_AHEAD_BYTES: usize = 64 << 10;

/// Boxes of a frame that are sampled to choose its test.
const SAMPLE_SIZE: usize = 64;

/// Cubes decide if H is at least this multiple of the frame's greatest H − h; at most one in
/// [`SAMPLES_PER_EXCEPTION`] sampled boxes may be smaller.
const LEAST_CUBIC_RATIO: f32 = 32.0;
const SAMPLES_PER_EXCEPTION: usize = 16;

/// The boxes of a set, in the form that a finder needs.
#[derive(Clone, Debug)]
pub(super) struct BoxFrames {
    tier: Tier,
    threads: FrameThreads,
    choice: Finder,
    finder: PairFinder,
    /// Boxes by place; they have no shapes.
    places: Places,
    order: Vec<u32>,
    /// Cubes about the boxes by place: centre and half side, an eighth in size.
    cubes: Balls,
    /// The greatest H − h of the boxes that don't move.
    fixed_gap: f32,
    news: SetChange,
    ends: EndSlots,
    tasks: Tasks<()>,
    /// Candidates of the frame before.
    candidates: u64,
    /// Summed over all frames.
    pub counters: VolumeCounters,
}

/// How given boxes are tested.
#[derive(Clone, Copy)]
enum BoxTest<'a> {
    /// By the cubes around and inside them.
    Cubes(CubeTest<'a>),
    /// By their ends.
    Ends(&'a EndSlots),
}

impl FirstVolume for BoxTest<'_> {
    #[inline(always)]
    fn list<L: Lanes>(self, l: L, parts: ListParts<'_, Self>) -> VolumeCounters {
        match self {
            Self::Cubes(cubes) => parts.with(l, &cubes),
            Self::Ends(ends) => parts.with(l, ends),
        }
    }
}

/// The change of the set since the frame before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SetChange {
    None,
    /// Some boxes are new; the finder knows the others.
    Some,
    All,
}

impl BoxFrames {
    /// No boxes yet.
    pub fn new(choice: Finder, tier: Tier, threads: FrameThreads) -> Self {
        Self {
            tier,
            threads,
            choice,
            finder: finder(choice, 0),
            places: Places::default(),
            order: Vec::new(),
            cubes: Balls::new(0),
            fixed_gap: 0.0,
            news: SetChange::All,
            ends: EndSlots::default(),
            tasks: Tasks::default(),
            candidates: 0,
            counters: VolumeCounters::default(),
        }
    }

    /// The tier of its kernels.
    pub fn tier(&self) -> Tier {
        self.tier
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Replaces the set: boxes that are `present` exist from now on, and those that are `dynamic`
    /// may move. Lists of neighbours of boxes that stay are kept.
    pub fn replace(&mut self, dynamic: &[bool], present: &[bool]) {
        let stays = self.places.replace(dynamic, present);
        let (population, moving) = (population(self.len()), self.places.moving);
        let finder = &mut self.finder;
        if finder.replace(self.choice, &population, &stays, moving) && self.news != SetChange::All {
            self.news = SetChange::Some;
            self.cubes.resize(self.len());
        } else {
            self.start_anew();
        }
    }

    /// Removes all boxes and frees their memory. The next [`Self::replace`] starts without lists.
    pub fn forget(&mut self) {
        (self.places, self.order) = Default::default();
        (self.ends, self.tasks) = Default::default();
        self.cubes = Balls::new(0);
        self.start_anew();
    }

    fn start_anew(&mut self) {
        self.finder = finder(self.choice, self.len());
        self.cubes.resize(self.len());
        self.cubes.fill([0.0; 4]);
        (self.news, self.candidates) = (SetChange::All, 0);
    }

    /// Lists the boxes that meet, not both fixed, that pass the filter, if there are no more than
    /// the limit. `boxes` and what the filter has are by name.
    pub fn list(
        &mut self,
        boxes: &[Aabb],
        filter: Option<PairFilter<'_>>,
        limit: Option<usize>,
        list: &mut PairList,
    ) -> Result<(), CullError> {
        list.clear();
        if let Some(limit) = limit {
            return list_up_to(limit, list, |take| self.pass_on(boxes, filter, take));
        }
        self.cull(boxes, filter, Output::List(list))?;
        CullError::check_memory(list)
    }

    /// As [`Self::list`], but passes the pairs on in portions, and returns their number.
    pub fn pass_on(
        &mut self,
        boxes: &[Aabb],
        filter: Option<PairFilter<'_>>,
        take: &mut (dyn FnMut(&PairList) + Send),
    ) -> Result<u64, CullError> {
        let mut reported = 0;
        let mut sink = |portion: &mut PairList| {
            reported += portion.len() as u64;
            take(portion);
        };
        self.cull(boxes, filter, Output::Portions(&mut sink))?;
        Ok(reported)
    }

    fn cull(
        &mut self,
        boxes: &[Aabb],
        filter: Option<PairFilter<'_>>,
        output: Output<'_>,
    ) -> Result<(), ContractError> {
        let counted = in_default_mode(|| self.cull_frame(boxes, filter, output))?;
        self.counters += counted;
        Ok(())
    }

    fn cull_frame(
        &mut self,
        boxes: &[Aabb],
        filter: Option<PairFilter<'_>>,
        output: Output<'_>,
    ) -> Result<VolumeCounters, ContractError> {
        self.threads.expect(FrameWork {
            updates: self.len() as u64,
            candidates: self.candidates,
            refined: 0,
        });
        let Some(gap) = self.update(boxes) else {
            self.start_anew(); // nothing of this frame is left for the next to sort by
            let mut names = self.places.body.iter().map(|&name| name as usize);
            names.try_for_each(|name| boxes[name].check(name))?;
            return Ok(VolumeCounters::default());
        };
        let pool = self.threads.get();
        let executor = pool.executor(self.tier);
        let names = &self.places.body;
        let are_long = !self.cubes_decide(gap);
        let given = Some(GivenBoxes { all: boxes, are_long });
        self.finder.arrange(executor, &self.places, &self.cubes, names, given);
        let slots = self.finder.slots(&self.cubes);
        let test = if are_long {
            let order = &slots.names[..names.len()];
            self.ends.fill(executor, order, boxes, self.finder.hands_out_runs());
            BoxTest::Ends(&self.ends)
        } else {
            let less = less_than_sure(gap);
            BoxTest::Cubes(CubeTest { slots, boxes, less })
        };
        let listing = Listing {
            tier: self.tier,
            finder: &self.finder,
            first: test,
            names: HitNames::bodies(&self.finder),
            filter,
        };
        let mut counted = listing::list(listing, pool, &mut self.tasks, output).first;
        counted.updates = self.places.moving as u64;
        self.candidates = counted.tests;
        self.finder.observe(counted.tests);
        Ok(counted)
    }

    /// Moves boxes to better places and computes the cubes of those that may have moved. Returns
    /// the greatest H − h of all, or `None` if a box is invalid.
    fn update(&mut self, boxes: &[Aabb]) -> Option<f32> {
        let (moving, all) = (self.places.moving, self.places.len());
        let news = std::mem::replace(&mut self.news, SetChange::None);
        if news != SetChange::None {
            self.fixed_gap = self.make_cubes(boxes, moving..all)?;
        }
        if news == SetChange::All {
            self.make_cubes(boxes, 0..moving)?; // a new finder orders places by them
        }
        let names = &self.places.body;
        let (places, order) = (&self.places, &mut self.order);
        let changed = self.finder.reorder(places, &self.cubes, names, order);
        if changed != Reorder::None {
            std::mem::swap(&mut self.places.body, order);
        }
        if changed == Reorder::All && moving < all {
            self.make_cubes(boxes, moving..all)?;
        }
        let gap = self.make_cubes(boxes, 0..moving)?;
        Some(gap.max(self.fixed_gap))
    }

    /// Computes the cubes of a range of places. Returns the greatest H − h, or `None` if a box is
    /// invalid.
    fn make_cubes(&mut self, boxes: &[Aabb], range: Range<usize>) -> Option<f32> {
        let pool = self.threads.get();
        let are_near =
            read_ahead(pool, boxes, range.len(), MOST_READ_AHEAD_BYTES, |aabb| aabb.min[0]);
        let names = &self.places.body[range.clone()];
        // The bits of non-negative numbers sort as the values do.
        let (greatest, are_sound) = (AtomicU32::new(0), AtomicBool::new(true));
        pool.pieces(&mut self.cubes[range], BOXES_PER_TASK, |start, cubes| {
            let ahead = names.get(start + PREFETCH_DISTANCE..).filter(|_| !are_near);
            let make = MakeCubes {
                boxes,
                names: &names[start..start + cubes.len()],
                ahead: ahead.unwrap_or_default(),
                cubes,
            };
            let (gap, is_sound) = dispatch(self.tier, make);
            greatest.fetch_max(gap.to_bits(), Relaxed);
            are_sound.fetch_and(is_sound, Relaxed);
        });
        let gap = f32::from_bits(greatest.into_inner());
        are_sound.into_inner().then_some(gap)
    }

    /// Whether cubes decide most pairs, because most boxes are much larger than the greatest H − h.
    /// Some boxes are sampled, the same ones on every machine.
    fn cubes_decide(&self, gap: f32) -> bool {
        let step = self.cubes.len().div_ceil(SAMPLE_SIZE).max(1);
        let asked = self.cubes.iter().step_by(step);
        let (all, small) =
            (asked.len(), asked.filter(|cube| cube[3] < LEAST_CUBIC_RATIO * gap).count());
        SAMPLES_PER_EXCEPTION * small <= all
    }

    /// Candidates that the last frame tested to build a list of neighbours.
    pub fn list_tests(&self) -> u64 {
        self.finder.list_tests()
    }

    /// Frees the memory of lists of pairs.
    pub fn shrink_to_fit(&mut self) {
        self.tasks.shrink_to_fit();
    }

    /// Bytes of the lists of pairs.
    pub fn pair_bytes(&self) -> usize {
        self.tasks.pair_bytes()
    }
}

/// The finder with that name, or for `auto` the one for this number of boxes.
fn finder(choice: Finder, boxes: usize) -> PairFinder {
    PairFinder::new(choice, &population(boxes))
}

fn population(boxes: usize) -> Population {
    Population { bodies: boxes, radii: [1.0; 2], cheap_test: true, volume: Volume::Cube }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::threads::Threads;

    /// Cubes decide if at most one box in sixteen is small compared with the gap.
    #[test]
    fn cubes_decide_with_few_exceptions() {
        let threads = FrameThreads::new(Threads::default(), 0);
        let mut frames = BoxFrames::new(Finder::Auto, Tier::SCALAR, threads);
        assert!(frames.cubes_decide(1.0), "without boxes");
        for (small, decide) in [(0, true), (4, true), (5, false), (64, false)] {
            // One in ten is sampled.
            frames.cubes = Balls::new(10 * SAMPLE_SIZE);
            for (asked, cube) in frames.cubes.iter_mut().step_by(10).enumerate() {
                cube[3] = LEAST_CUBIC_RATIO * if asked < small { 2.9 } else { 3.0 };
            }
            assert_eq!(frames.cubes_decide(3.0), decide, "{small}");
        }
    }

    fn all_in_a_row(boxes: u32) -> Vec<Aabb> {
        (0..boxes)
            .map(|i| [i as f32, i as f32 + 0.75])
            .map(|[from, to]| Aabb::new([from, 0.0, 0.0], [to, 1.0, 1.0]))
            .collect()
    }

    /// The frames of `boxes` boxes, all of which may move, before the first cull.
    fn frames(choice: Finder, boxes: usize) -> BoxFrames {
        let mut frames =
            BoxFrames::new(choice, Tier::SCALAR, FrameThreads::new(Threads::default(), 0));
        frames.replace(&vec![true; boxes], &vec![true; boxes]);
        frames
    }

    /// Some boxes are passed on as changed if the finder knows the others.
    #[test]
    fn changed_boxes_are_passed_on() {
        let mut frames = frames(Finder::Grid, 1000);
        let set = |frames: &mut BoxFrames, boxes: usize| {
            frames.replace(&vec![true; boxes], &vec![true; boxes]);
            frames.news
        };
        assert_eq!(set(&mut frames, 1001), SetChange::All, "nothing was culled yet");
        let mut pairs = PairList::default();
        let boxes = all_in_a_row(2000);
        frames.list(&boxes, None, None, &mut pairs).unwrap();
        assert_eq!((frames.news, frames.candidates > 0), (SetChange::None, true));
        assert_eq!(set(&mut frames, 1010), SetChange::Some);
        assert_eq!(set(&mut frames, 2000), SetChange::All);
        assert_eq!(frames.candidates, 0);
        frames.choice = Finder::Sweep;
        frames.news = SetChange::None;
        assert_eq!(set(&mut frames, 2001), SetChange::All, "another finder knows nothing");
    }

    /// If cells were planned from boxes without extent, giants and small boxes would share them:
    /// two million candidates.
    #[test]
    fn first_frame_plans_itself() {
        let mut boxes = all_in_a_row(2000);
        boxes[1000] = Aabb::new([0.0, 5.0, 0.0], [2000.0, 6.0, 1.0]);
        let mut pairs = PairList::default();
        let mut frames = frames(Finder::Grid, 2000);
        frames.list(&boxes, None, None, &mut pairs).unwrap();
        let tests = frames.counters.tests;
        assert!((2000..20_000).contains(&tests), "{tests}");
    }

    /// All lists except the first task's, which is the caller's, stay for the next frame.
    #[test]
    fn list_bytes_are_counted() {
        let threads = FrameThreads::new(Threads::new(3).unwrap(), 0);
        let mut frames = BoxFrames::new(Finder::AllPairs, Tier::SCALAR, threads);
        let boxes = vec![Aabb::new([0.0; 3], [1.0; 3]); 200];
        frames.replace(&[true; 200], &[true; 200]);
        let mut pairs = PairList::default();
        frames.list(&boxes, None, None, &mut pairs).unwrap();
        assert_eq!(pairs.len(), 200 * 199 / 2);
        // Two numbers per pair, of at least half of the pairs.
        assert!(frames.pair_bytes() > 4 * pairs.len());
        frames.shrink_to_fit();
        assert!(frames.pair_bytes() < pairs.len());
    }
}
