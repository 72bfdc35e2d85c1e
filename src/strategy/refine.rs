//! The or-DOP test of listed pairs.

use std::ops::Range;

use super::{FrameVolumes, Inputs, RowTiming, Setup, Task, Tasks};
use crate::counters::{Clock, VolumeCounters};
use crate::listing::{Output, TaskOutput, Totals, split_work};
use crate::overlap::ordop::OrDopColumns;
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch};
use crate::threads::Executor;
use crate::update::{MOST_ROWS, OrDopRows, RowsByNumber, UpdateInputs};

/// Pairs whose rows are computed together, and how many such stretches one thread checks at a time.
const PAIRS_PER_STRETCH: usize = 1024;
const STRETCHES_PER_TASK: usize = 16;

/// The or-DOP test with existing rows: takes pairs of places, returns pairs of bodies.
#[derive(Clone, Copy)]
pub(super) struct Refine<'a> {
    tier: Tier,
    columns: OrDopColumns<'a>,
    /// The body in each place.
    pub body: &'a [u32],
}

impl<'a> Refine<'a> {
    pub fn new(inputs: Inputs<'a>, rows: &'a OrDopRows) -> Self {
        let Setup { settings, scheme, .. } = inputs.setup;
        Self {
            tier: inputs.executor.tier,
            columns: OrDopColumns {
                rows: RowsByNumber::all(&rows.rows),
                tables: inputs.tables,
                overlap: scheme.overlap(settings.overlap),
            },
            body: &inputs.volumes.posed.places.body,
        }
    }

    /// Tests pairs and appends the survivors to `out`, in list order. It is called per block, so
    /// that the dispatch to a tier costs little.
    pub fn test(
        &self,
        [first, second]: [&[u32]; 2],
        counters: &mut VolumeCounters,
        seconds: &mut f64,
        out: &mut PairList,
    ) {
        let start = Clock::start();
        let listed = out.len();
        let tested = self.columns.test_pairs(self.tier, first, second, out);
        out.rename(listed, self.body);
        counters.tests += tested.tests;
        counters.hits += tested.hits;
        *seconds += start.seconds();
    }

    /// Tests a task's pairs stretch by stretch, and computes the rows of each stretch shortly
    /// before its test.
    fn test_in_windows(
        &self,
        posed: UpdateInputs<'_>,
        [first, second]: [&[u32]; 2],
        task: &mut Task,
    ) {
        let moving = posed.places.moving;
        let mut window = std::mem::take(&mut task.window);
        window.clear();
        for (first, second) in first.chunks(PAIRS_PER_STRETCH).zip(second.chunks(PAIRS_PER_STRETCH))
        {
            let start = Clock::start();
            let wanted = places_of(self.tier, moving, [first, second]);
            window.cover(self.tier, posed, &self.columns.rows, wanted);
            task.update_seconds += start.seconds();
            let columns = OrDopColumns { rows: window.rows(moving), ..self.columns };
            let here = Refine { columns, ..*self };
            let pairs = [first, second];
            here.test(pairs, &mut task.refining, &mut task.seconds, &mut task.out);
        }
        task.window = window;
    }
}

/// The ranges of places that include those of some pairs: one of moving bodies, which have the
/// first places, and one of static bodies.
fn places_of(tier: Tier, moving: usize, pairs: [&[u32]; 2]) -> [Range<usize>; 2] {
    /// Finds the smallest place and the one after the largest.
    struct FindEnds<'a>(u32, [&'a [u32]; 2]);
    impl Kernel for FindEnds<'_> {
        type Output = [[u32; 2]; 2];
        #[inline(always)]
        fn run<L: Lanes>(self, _: L) -> [[u32; 2]; 2] {
            let [mut moving, mut still] = [[u32::MAX, 0]; 2];
            for column in self.1 {
                for &place in column {
                    let moves = place < self.0;
                    let [first, second] = if moves { [place, u32::MAX] } else { [u32::MAX, place] };
                    let [end, second_end] = if moves { [place + 1, 0] } else { [0, place + 1] };
                    moving = [moving[0].min(first), moving[1].max(end)];
                    still = [still[0].min(second), still[1].max(second_end)];
                }
            }
            [moving, still]
        }
    }
    dispatch(tier, FindEnds(moving as u32, pairs))
        .map(|[least, end]| least.min(end) as usize..end as usize)
}

/// The or-DOP test that computes missing rows first, and sums up counts and times.
pub(super) struct Refiner<'a> {
    inputs: Inputs<'a>,
    rows: &'a mut OrDopRows,
    pub totals: Totals,
}

impl<'a> Refiner<'a> {
    pub fn new(inputs: Inputs<'a>, rows: &'a mut OrDopRows) -> Self {
        Self { inputs, rows, totals: Totals::default() }
    }

    /// Tests all pairs of a list and appends the survivors to `out`; on all threads if `tasks` are
    /// given.
    pub fn refine(&mut self, list: &PairList, tasks: Option<&mut Tasks>, out: &mut PairList) {
        out.lose_with(list);
        let Some(tasks) = tasks else {
            return self.refine_range(list, 0..list.len(), out);
        };
        let in_windows =
            self.inputs.volumes.row_timing == RowTiming::WhenListed && self.are_near(list);
        if !in_windows {
            self.make_rows(list, 0..list.len());
        }
        let refine = Refine::new(self.inputs, self.rows);
        // Tasks begin at the start of stretches, which were checked one by one.
        let unit = if in_windows { PAIRS_PER_STRETCH } else { MAX_WIDTH };
        let work = |units: Range<usize>, task: &mut Task, _: &TaskOutput<'_, '_>| {
            let pairs = units.start * unit..(units.end * unit).min(list.len());
            let pairs = [&list.first()[pairs.clone()], &list.second()[pairs]];
            if in_windows {
                refine.test_in_windows(self.inputs.volumes.posed, pairs, task);
            } else {
                refine.test(pairs, &mut task.refining, &mut task.seconds, &mut task.out);
            }
        };
        let (pool, units) = (self.inputs.executor.pool, list.len().div_ceil(unit));
        let done = split_work(pool, tasks, units, Output::List(out), work);
        self.totals.refining += done.refining;
        self.totals.refining_seconds += done.refining_seconds;
        self.totals.update_seconds += done.update_seconds;
    }

    /// Whether the places of each stretch of pairs are so close together that a window holds their
    /// rows.
    fn are_near(&self, list: &PairList) -> bool {
        let Executor { tier, pool } = self.inputs.executor;
        let moving = self.inputs.volumes.posed.places.moving;
        pool.all(list.len(), STRETCHES_PER_TASK * PAIRS_PER_STRETCH, |range| {
            let [first, second] =
                [list.first(), list.second()].map(|column| &column[range.clone()]);
            let mut stretches =
                first.chunks(PAIRS_PER_STRETCH).zip(second.chunks(PAIRS_PER_STRETCH));
            stretches.all(|(first, second)| {
                let places = places_of(tier, moving, [first, second]);
                places.iter().all(|places| places.len() <= MOST_ROWS)
            })
        })
    }

    /// Tests some pairs of a list on the calling thread and appends the survivors to `out`.
    pub fn refine_range(&mut self, list: &PairList, range: Range<usize>, out: &mut PairList) {
        self.make_rows(list, range.clone());
        let pairs = [&list.first()[range.clone()], &list.second()[range]];
        let Totals { refining, refining_seconds, .. } = &mut self.totals;
        Refine::new(self.inputs, self.rows).test(pairs, refining, refining_seconds, out);
    }

    /// Computes the missing rows of this frame: with lazy updates those of some listed pairs,
    /// otherwise all.
    fn make_rows(&mut self, list: &PairList, range: Range<usize>) {
        let executor = self.inputs.executor;
        let FrameVolumes { posed, stamp, row_timing, .. } = self.inputs.volumes;
        let start = Clock::start();
        match row_timing {
            RowTiming::BeforePairs => return,
            RowTiming::WhenListed => {
                let moving = 0..posed.places.moving;
                self.rows.update(executor, posed, moving, stamp);
            }
            RowTiming::OnDemand => {
                for column in [list.first(), list.second()] {
                    let wanted = &column[range.clone()];
                    let tier = executor.tier;
                    let made = self.rows.update_missing(tier, posed, wanted, stamp);
                    self.totals.refining.updates += made;
                }
            }
        }
        self.totals.update_seconds += start.seconds();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::bodies::{Bodies, Places};
    use crate::broad_phase::{AllPairs, PairFinder, Slots};
    use crate::listing::SlotNames;
    use crate::mesh::ProceduralShape;
    use crate::overlap::intervals::IntervalSlots;
    use crate::overlap::ordop::SlabTables;
    use crate::settings::{CullSettings, DirectionSet, Updates};
    use crate::strategy::Arrangement;
    use crate::threads::Threads;
    use crate::update::{ShapeFrame, UpdateInputs};
    use crate::volume::{Shape, ShapeSpec};

    /// Hands over a refiner of three boxes in one place that move, with such updates.
    fn refiner<T>(updates: Updates, run: impl FnOnce(Refiner<'_>) -> T) -> T {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let mut bodies = Bodies::default();
        for _ in 0..3 {
            bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
        }
        let (places, pool) = (Places::new(&bodies), Threads::default());
        let posed = UpdateInputs {
            frames: &[ShapeFrame::new(&shape, &shape.ordop.basis)].into_iter().collect(),
            bodies: &bodies,
            places: &places,
            balls: &[],
        };
        let (mut rows, executor) = (OrDopRows::new(3), pool.executor(Tier::SCALAR));
        if updates == Updates::Eager {
            rows.update(executor, posed, 0..3, 1);
        }
        let slots = Slots::default();
        let inputs = Inputs {
            executor,
            setup: &Setup::new(&CullSettings { updates, ..CullSettings::default() }),
            tables: &SlabTables::new(DirectionSet::K18, [(&shape, &shape.ordop)]),
            arranged: Arrangement {
                finder: &PairFinder::AllPairs(AllPairs::default()),
                slots: slots.arranged(),
                names: SlotNames::Places(&places.body),
                filter: None,
            },
            volumes: FrameVolumes {
                posed,
                intervals: &IntervalSlots::default(),
                interest: &[],
                stamp: 1,
                row_timing: match updates {
                    Updates::Eager => RowTiming::BeforePairs,
                    Updates::Lazy => RowTiming::OnDemand,
                },
            },
        };
        run(Refiner::new(inputs, &mut rows))
    }

    /// What refining two pairs of them takes.
    fn refined(updates: Updates) -> Totals {
        refiner(updates, |mut refiner| {
            let list: PairList = [[0, 1], [0, 2]].into_iter().collect();
            let mut out = PairList::default();
            refiner.refine(&list, None, &mut out);
            assert_eq!(out.sorted(), [[0, 1], [0, 2]]);
            refiner.totals
        })
    }

    /// Pairs are near whose places a window holds stretch by stretch.
    #[test]
    fn window_decides_near_stretches() {
        // The first three places are those that move.
        let is_near = |pairs: &[[u32; 2]]| {
            let list: PairList = pairs.iter().copied().collect();
            refiner(Updates::Eager, |refiner| refiner.are_near(&list))
        };
        let most = MOST_ROWS as u32;
        let mut pairs: Vec<_> =
            (0..40 * PAIRS_PER_STRETCH as u32).map(|pair| [pair % 3, 3 + 10 * pair]).collect();
        assert!(is_near(&pairs));
        pairs[20 * PAIRS_PER_STRETCH + 7][0] = pairs[20 * PAIRS_PER_STRETCH][1] + most - 1;
        assert!(is_near(&pairs));
        pairs[20 * PAIRS_PER_STRETCH + 7][0] += 1;
        assert!(!is_near(&pairs));
    }

    /// The places of pairs go from the least to the greatest.
    #[test]
    fn places_cover_all_pairs() {
        for tier in Tier::available() {
            let pairs: [&[u32]; 2] = [&[7, 9, 8], &[5, 30, 6]];
            assert_eq!(places_of(tier, 40, pairs), [5..31, 0..0]);
            assert_eq!(places_of(tier, 31, pairs), [5..31, 0..0]);
            assert_eq!(places_of(tier, 30, pairs), [5..10, 30..31]);
            assert_eq!(places_of(tier, 8, pairs), [5..8, 8..31]);
            assert_eq!(places_of(tier, 0, pairs), [0..0, 5..31]);
            assert_eq!(places_of(tier, 8, [&[7; 40], &[7; 40]]), [7..8, 0..0]);
        }
    }

    /// Rows made on demand count as updates and take an update's time.
    #[test]
    fn lazy_rows_count_as_updates() {
        let [eager, lazy] = [Updates::Eager, Updates::Lazy].map(refined);
        assert_eq!([eager, lazy].map(|t| t.refining.updates), [0, 3]);
        assert_eq!(eager.update_seconds, 0.0);
        for totals in [eager, lazy] {
            assert_eq!((totals.refining.tests, totals.refining.hits), (2, 2));
            assert!(totals.refining_seconds > 0.0);
        }
        assert!(lazy.update_seconds > 0.0);
    }
}
