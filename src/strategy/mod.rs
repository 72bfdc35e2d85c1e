//! The paper's strategies (section 4) and the homogeneous volumes they are judged against: which tests each makes is a row
//! of [`Strategy::scheme`](crate::settings::Strategy::scheme), and how pairs flow through them a file here.
//!
//! A strategy takes updated volumes and a pair finder and leaves the reported pairs. Strategies differ in false positives
//! and time, never in misses: each reports every pair whose meshes meet, `none` excepted.

use crate::bodies::{Groups, Places};
use crate::broad_phase::{Arranged, PairFinder};
use crate::counters::VolumeCounters;
use crate::overlap::intervals::IntervalSlots;
use crate::overlap::ordop::SlabTables;
use crate::pairs::PairList;
use crate::settings::{CullSettings, Flow, Updates};
use crate::threads::Executor;
use crate::update::{OrDopRows, Posed};

mod batch;
mod interest;
mod listing;
mod output;
mod refine;
mod sequential;
mod tasks;
mod time_critical;

pub(crate) use interest::mark;
pub(crate) use listing::{BoxInputs, BoxTest, list_boxes};
pub(crate) use output::Output;
#[cfg(feature = "serde")]
pub(crate) use time_critical::Answers;

/// Pairs that flow through the or-DOP test at once where no list is kept: few enough for the first-level cache, enough to
/// make the clock's cost vanish.
const BLOCK: usize = 256;

/// Rows that the second-level cache holds.
const FEW_ROWS: usize = 1 << 14;

/// What the finder's slots are named by.
///
/// Volumes other than spheres are looked up by place. With spheres alone, names are bodies, so that no hit needs a look at
/// its places: naming slots by place under every strategy took 2.5 % more instructions of a frame of spheres (10,000 bodies,
/// grid, AVX2).
#[derive(Clone, Copy)]
pub(crate) enum SlotNames<'a> {
    /// Bodies, in the order of the user's columns.
    Bodies,
    /// Places, in which these bodies are.
    Places(&'a [u32]),
    /// Themselves: places have the order of slots, and these bodies are in them.
    Slots(&'a [u32]),
}

/// What culling a frame reads, once volumes are updated and bodies arranged in slots.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub executor: Executor<'a>,
    pub settings: &'a CullSettings,
    /// Whether budgets are spent on pairs in the order of their bodies.
    pub is_canonical: bool,
    pub finder: &'a PairFinder,
    /// What the finder has arranged.
    pub slots: Arranged<'a>,
    pub names: SlotNames<'a>,
    /// The poses, and spheres by place where there are any.
    pub posed: Posed<'a>,
    /// Each body's groups where not all collide with all.
    pub groups: Option<&'a [Groups]>,
    pub intervals: &'a IntervalSlots,
    pub tables: &'a SlabTables,
    /// Whether each body is of interest.
    pub interest: &'a [bool],
    /// Counts frames from 1.
    pub stamp: u32,
    /// Whether the rows of this frame are still to be made ([`makes_rows`]).
    pub without_rows: bool,
}

impl Inputs<'_> {
    /// Whether rows are made when a pair needs them.
    fn is_lazy(&self) -> bool {
        self.settings.updates == Updates::Lazy
    }

    /// The body in each place.
    fn bodies_by_place(&self) -> &[u32] {
        &self.posed.places.body
    }
}

/// What stays from frame to frame: buffers, and when time-critical culling refined which pair.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    tasks: Vec<tasks::Task>,
    /// The potentially colliding set by places, where a list of it is kept.
    pub candidates: PairList,
    /// Those of them that have a body of interest, and which of those survived.
    selected: PairList,
    survivors: PairList,
    /// What is reported of a portion of them.
    portion: PairList,
    history: time_critical::History,
}

impl Scratch {
    /// Gives back the memory of lists of pairs, but for the last potentially colliding set.
    pub fn shrink_to_fit(&mut self) {
        self.candidates.shrink_to_fit();
        self.history.shrink_to_fit();
        (self.tasks, self.selected, self.survivors, self.portion) = Default::default();
    }

    /// Gives back the memory of all lists of pairs, the last potentially colliding set included.
    pub fn forget_lists(&mut self) {
        self.candidates.clear();
        self.shrink_to_fit();
    }

    /// When the pairs of the last frame were refined.
    #[cfg(feature = "serde")]
    pub fn answers(&self) -> Answers {
        self.history.answers()
    }

    /// Takes over when pairs were refined.
    #[cfg(feature = "serde")]
    pub fn set_answers(&mut self, answers: &Answers) {
        self.history.set_answers(answers);
    }

    /// Bytes that lists of pairs hold.
    pub fn pair_bytes(&self) -> usize {
        let lists = [
            &self.candidates,
            &self.selected,
            &self.survivors,
            &self.portion,
        ];
        let of_tasks = self.tasks.iter().flat_map(tasks::Task::lists);
        lists.into_iter().chain(of_tasks).map(PairList::bytes).sum()
    }
}

/// What culling a frame took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    /// Of the first test.
    pub first: VolumeCounters,
    /// Of the refining test, with the rows made on demand as updates.
    pub refining: VolumeCounters,
    /// Pairs reported untested because the budget had ended.
    pub untested: u64,
    /// Wall time of the refining test: its seconds over the threads.
    pub refining_seconds: f64,
    /// Wall time of making rows on demand.
    pub update_seconds: f64,
}

/// Whether a strategy makes the rows of bodies that move itself, when their pairs are listed, so that they are tested while the
/// caches have them. Where a list isn't kept, or caches hold all rows anyway, they are made before.
pub(crate) fn makes_rows(settings: &CullSettings, places: &Places, output: &Output<'_>) -> bool {
    settings.strategy.scheme().flow == Flow::Batch
        && settings.updates == Updates::Eager
        && !output.is_in_portions()
        && places.moving > FEW_ROWS
}

/// Culls one frame by the strategy of the settings.
pub(crate) fn cull(
    inputs: Inputs<'_>,
    rows: &mut OrDopRows,
    scratch: &mut Scratch,
    output: Output<'_>,
) -> Totals {
    scratch.candidates.clear();
    let (interest, lazy) = (Some(inputs.interest), inputs.is_lazy());
    match inputs.settings.strategy.scheme().flow {
        Flow::Nothing => Totals::default(),
        Flow::FirstTest => listing::flow(inputs, scratch, output),
        // Rows on demand need the whole set before its first test.
        Flow::Sequential if lazy => batch::flow(inputs, rows, scratch, None, output),
        Flow::OfInterest if lazy => batch::flow(inputs, rows, scratch, interest, output),
        Flow::Sequential => sequential::flow(inputs, rows, scratch, None, output),
        Flow::OfInterest => sequential::flow(inputs, rows, scratch, interest, output),
        // The same pairs in the same order, and no list that grows with them.
        Flow::Batch if output.is_in_portions() && !lazy => {
            sequential::flow(inputs, rows, scratch, None, output)
        }
        Flow::Batch => batch::flow(inputs, rows, scratch, None, output),
        Flow::TimeCritical => time_critical::flow(inputs, rows, scratch, output),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A list without room to spare.
    fn list(pairs: u32) -> PairList {
        let mut list: PairList = (0..pairs).map(|pair| [pair, pair + 1]).collect();
        list.shrink_to_fit();
        list
    }

    #[test]
    fn bytes_are_those_of_all_lists_and_the_colliding_set_alone_is_kept() {
        let task = |pairs| tasks::Task {
            out: list(pairs),
            block: list(10 * pairs),
            selected: list(100 * pairs),
            survivors: list(1000 * pairs),
            ..tasks::Task::default()
        };
        let mut scratch = Scratch {
            tasks: vec![task(1), task(2)],
            candidates: list(50_000),
            selected: list(600_000),
            survivors: list(7),
            portion: list(80),
            ..Scratch::default()
        };
        // Two numbers a pair, and a vector more behind each column.
        let pairs = 3 * 1111 + 650_087 + 12 * crate::simd::MAX_WIDTH;
        assert_eq!(scratch.pair_bytes(), 8 * pairs);
        scratch.candidates.clear();
        for pair in 0..10 {
            scratch.candidates.push(pair, pair + 1);
        }
        scratch.shrink_to_fit();
        assert_eq!(scratch.pair_bytes(), list(10).bytes());
    }
}
