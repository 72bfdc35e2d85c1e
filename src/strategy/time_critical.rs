//! S-DOP under a budget (the paper's third phase; Hubbard 1996): the potentially colliding set is
//! refined in a chosen order until the budget is spent, and pairs that are not refined are reported
//! as colliding (Dingliana & O'Sullivan 2000).
//!
//! A budget of tests gives the same pairs on every machine. A budget of time is compared with the
//! clock after every [`TESTS_PER_CLOCK_READING`] tests.

use std::collections::HashMap;
use std::ops::Range;

use super::first_test::list;
use super::refine::Refiner;
use super::{Inputs, Scratch};
use crate::counters::Clock;
use crate::listing::{Output, PAIRS_PER_PORTION, PairNames, Totals};
use crate::pairs::PairList;
use crate::settings::{Budget, Order};
use crate::update::OrDopRows;

/// Tests between two readings of the clock: a few microseconds.
const TESTS_PER_CLOCK_READING: usize = 128;

/// The refinement history, and buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    /// For each pair that spheres reported in the last frame, the frame in which it was last
    /// refined (0: never).
    refined: HashMap<[u32; 2], u32>,
    before: HashMap<[u32; 2], u32>,
    ranked: Vec<RankedPair>,
}

/// The refinement history without frame numbers: sorted pairs of bodies with ranks. The rank is 0
/// for pairs that were never refined; pairs that were last refined in the same frame have the same
/// rank, and later frames have higher ranks, without gaps. Equal histories therefore compare equal,
/// whatever the frames' numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct RefinementRanks(pub Vec<([u32; 2], u32)>);

impl RefinementRanks {
    /// The largest rank.
    pub fn latest(&self) -> u32 {
        self.0.iter().map(|&(_, rank)| rank).max().unwrap_or(0)
    }
}

/// A pair with its rank. Pairs are ordered by rank, then by body, which is the same for every pair
/// finder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RankedPair {
    rank: u32,
    bodies: [u32; 2],
    places: [u32; 2],
}

/// Spheres first; then or-DOPs until the budget ends.
pub(super) fn flow(
    inputs: Inputs<'_>,
    rows: &mut OrDopRows,
    scratch: &mut Scratch,
    output: Output<'_>,
) -> Totals {
    let mut spender = Spender::new(inputs, rows);
    let Scratch { tasks, candidates, history, portion, .. } = scratch;
    let order = inputs.setup.settings.order;
    let is_sorted = inputs.setup.is_canonical || order != Order::AsFound;
    let listed = match output {
        Output::Portions(sink) if !is_sorted => {
            let mut take = |candidates: &mut PairList| {
                portion.clear();
                spender.report(candidates, 0..candidates.len(), portion);
                sink(portion);
            };
            list(inputs, PairNames::Places, tasks, Output::Portions(&mut take))
        }
        output => {
            let listed = list(inputs, PairNames::Places, tasks, Output::List(candidates));
            if is_sorted && !candidates.is_lost() {
                arrange(inputs, history, candidates);
            }
            let all = 0..candidates.len();
            match output {
                Output::List(out) => {
                    out.lose_with(candidates);
                    spender.report(candidates, all, out);
                }
                Output::Portions(sink) => {
                    if candidates.is_lost() {
                        sink(candidates);
                    }
                    for start in all.step_by(PAIRS_PER_PORTION) {
                        portion.clear();
                        let end = candidates.len().min(start + PAIRS_PER_PORTION);
                        spender.report(candidates, start..end, portion);
                        sink(portion);
                    }
                }
            }
            listed
        }
    };
    if order == Order::OldestAnswer {
        let tests = spender.refiner.totals.refining.tests as usize;
        let bodies = inputs.bodies_by_place();
        let pairs = candidates.iter().map(|pair| pair.map(|place| bodies[place as usize]));
        history.remember(pairs, tests, inputs.volumes.stamp);
    }
    Totals { first: listed.first, ..spender.refiner.totals }
}

/// Refines pairs until the budget is spent.
struct Spender<'a> {
    refiner: Refiner<'a>,
    /// The body in each place.
    body: &'a [u32],
    tests_left: usize,
    /// A budget of time: when it began, and its seconds.
    time: Option<(Clock, f64)>,
}

impl<'a> Spender<'a> {
    fn new(inputs: Inputs<'a>, rows: &'a mut OrDopRows) -> Self {
        let (tests_left, time) = match inputs.setup.settings.budget {
            Some(Budget::Tests(tests)) => (usize::try_from(tests).unwrap_or(usize::MAX), None),
            Some(Budget::Microseconds(us)) => {
                (usize::MAX, Some((Clock::start(), us as f64 * 1e-6)))
            }
            None => (usize::MAX, None),
        };
        Self {
            refiner: Refiner::new(inputs, rows),
            body: &inputs.volumes.posed.places.body,
            tests_left,
            time,
        }
    }

    /// Appends the reported pairs among some candidates to `out`: those that survive the or-DOP
    /// test, and those that the budget leaves untested.
    fn report(&mut self, candidates: &PairList, range: Range<usize>, out: &mut PairList) {
        let limit = range.end.min(range.start.saturating_add(self.tests_left));
        let slice = if self.time.is_some() { TESTS_PER_CLOCK_READING } else { limit.max(1) };
        let mut next = range.start;
        while next < limit && self.time.is_none_or(|(clock, most)| clock.seconds() < most) {
            let end = limit.min(next + slice);
            self.refiner.refine_range(candidates, next..end, out);
            next = end;
        }
        self.tests_left -= next - range.start;
        self.refiner.totals.untested += (range.end - next) as u64;
        for at in next..range.end {
            let places = [candidates.first()[at], candidates.second()[at]];
            let [a, b] = places.map(|place| self.body[place as usize]);
            out.push(a, b);
        }
    }
}

/// Sorts the potentially colliding set into the order of refinement.
fn arrange(inputs: Inputs<'_>, history: &mut History, candidates: &mut PairList) {
    let order = inputs.setup.settings.order;
    let History { refined, ranked, .. } = history;
    let body = inputs.bodies_by_place();
    let of_no_interest = |&body: &u32| !inputs.volumes.interest[body as usize];
    let rank = |bodies: [u32; 2], places: [u32; 2]| match order {
        Order::AsFound => 0,
        Order::InterestFirst => u32::from(bodies.iter().all(of_no_interest)),
        // The bits of non-negative numbers sort as the values do.
        Order::LargestOverlap => relative_distance(inputs.volumes.posed.balls, places).to_bits(),
        Order::OldestAnswer => refined.get(&bodies).copied().unwrap_or(0),
    };
    ranked.clear();
    if ranked.try_reserve(candidates.len()).is_err() {
        return candidates.lose();
    }
    ranked.extend(candidates.iter().map(|places| {
        let bodies = places.map(|place| body[place as usize]);
        RankedPair { rank: rank(bodies, places), bodies, places }
    }));
    ranked.sort_unstable();
    candidates.clear();
    for pair in &*ranked {
        let [i, j] = pair.places;
        candidates.push(i, j);
    }
}

/// d²/s² of a pair's inflated spheres: 0 when concentric, 1 when touching.
fn relative_distance(spheres: &[[f32; 4]], pair: [u32; 2]) -> f32 {
    let [a, b] = pair.map(|place| spheres[place as usize]);
    let (dx, dy, dz, s) = (a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] + b[3]);
    (dx * dx + dy * dy + dz * dz) / (s * s)
}

impl History {
    /// Frees the memory of buffers.
    pub fn shrink_to_fit(&mut self) {
        self.refined.shrink_to_fit();
        (self.before, self.ranked) = Default::default();
    }

    /// The refinement history without frame numbers.
    pub fn answers(&self) -> RefinementRanks {
        let mut answers: Vec<_> = self.refined.iter().map(|(&pair, &at)| (pair, at)).collect();
        let mut frames: Vec<u32> = answers.iter().map(|&(_, at)| at).collect();
        frames.push(0);
        frames.sort_unstable();
        frames.dedup();
        for (_, at) in &mut answers {
            *at = frames.partition_point(|frame| frame < at) as u32;
        }
        answers.sort_unstable();
        RefinementRanks(answers)
    }

    /// Replaces the refinement history. Coming frames must have larger numbers than the latest
    /// rank.
    pub fn set_answers(&mut self, answers: &RefinementRanks) {
        self.refined = answers.0.iter().copied().collect();
    }

    /// Records the frame in which each sphere hit was last refined: this one for the first
    /// `refined` of `pairs`.
    fn remember(&mut self, pairs: impl Iterator<Item = [u32; 2]>, refined: usize, stamp: u32) {
        std::mem::swap(&mut self.refined, &mut self.before);
        self.refined.clear();
        self.refined.extend(pairs.enumerate().map(|(at, pair)| {
            let before = self.before.get(&pair).copied().unwrap_or(0);
            (pair, if at < refined { stamp } else { before })
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distances are relative to the sum of radii.
    #[test]
    fn distances_are_relative_to_radii() {
        let spheres = [[9.0; 4], [1.0, 2.0, 3.0, 1.0], [-3.0, 6.0, -4.0, 2.0]];
        // Apart by (4, −4, 7), whose length is 9, of radii that are 3 together.
        assert_eq!(relative_distance(&spheres, [1, 2]), 9.0);
    }

    /// Answers have ranks in the order of frames.
    #[test]
    fn answer_ranks_follow_frames() {
        let mut history = History::default();
        history.remember([[0, 5], [0, 2], [3, 4]].into_iter(), 2, 7);
        history.remember([[3, 4], [0, 5], [1, 2]].into_iter(), 1, 900);
        let answers = history.answers();
        assert_eq!(answers.0, [([0, 5], 1), ([1, 2], 0), ([3, 4], 2)]);
        assert_eq!(answers.latest(), 2);
        let mut other = History::default();
        other.set_answers(&answers);
        assert_eq!(other.answers(), answers);
        other.remember([[3, 4], [0, 5]].into_iter(), 0, 3);
        assert_eq!(other.answers().0, [([0, 5], 1), ([3, 4], 2)]);
    }

    /// Answers are kept and buffers are given back.
    #[test]
    fn shrinking_keeps_the_answers() {
        let mut history = History::default();
        history.remember([[0, 1], [0, 2], [3, 4]].into_iter(), 2, 7);
        history.remember([[3, 4], [0, 1]].into_iter(), 1, 9);
        history.ranked.reserve(100);
        history.before.reserve(100);
        history.refined.reserve(100);
        history.shrink_to_fit();
        assert_eq!(history.refined, HashMap::from([([3, 4], 9), ([0, 1], 7)]));
        assert!(history.refined.capacity() < 100);
        assert_eq!((history.before.capacity(), history.ranked.capacity()), (0, 0));
    }
}
