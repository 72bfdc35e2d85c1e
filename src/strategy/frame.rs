//! Culling one frame by a strategy: its inputs, its buffers, and the flow of pairs.

use super::time_critical::RefinementRanks;
use super::{Tasks, batch, first_test, sequential, time_critical};
use crate::bodies::{PairFilter, Places};
use crate::broad_phase::{PairFinder, SlotBodies};
use crate::listing::{Output, SlotNames, Totals};
use crate::overlap::intervals::IntervalSlots;
use crate::overlap::ordop::SlabTables;
use crate::pairs::PairList;
use crate::settings::{CullSettings, Flow, Scheme, Updates};
use crate::threads::Executor;
use crate::update::{OrDopRows, UpdateInputs};

/// Rows that fit into the second-level cache.
const ROWS_IN_CACHE: usize = 1 << 14;

/// The settings that a culler is made with.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub settings: CullSettings,
    /// The strategy's row in the table of strategies.
    pub scheme: Scheme,
    /// Whether budgets are spent on pairs in the order of their body numbers, independent of the
    /// finder and of earlier frames.
    pub is_canonical: bool,
}

impl Setup {
    pub fn new(settings: &CullSettings) -> Self {
        Self { settings: settings.clone(), scheme: settings.strategy.scheme(), is_canonical: false }
    }
}

/// When the rows of bodies that move are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RowTiming {
    /// Before pairs are found.
    BeforePairs,
    /// When pairs are listed, so that they are tested while the caches have their rows.
    WhenListed,
    /// Those that a pair needs, when it needs them: lazy updates.
    OnDemand,
}

impl RowTiming {
    /// Rows wait for the list only where a list is kept and caches don't hold all rows anyway.
    pub fn of(setup: &Setup, places: &Places, output: &Output<'_>) -> Self {
        match setup.settings.updates {
            Updates::Lazy => Self::OnDemand,
            Updates::Eager
                if setup.scheme.flow == Flow::Batch
                    && !output.is_in_portions()
                    && places.moving > ROWS_IN_CACHE =>
            {
                Self::WhenListed
            }
            Updates::Eager => Self::BeforePairs,
        }
    }
}

/// Bodies in slots, as the finder has arranged them.
#[derive(Clone, Copy)]
pub(crate) struct Arrangement<'a> {
    pub finder: &'a PairFinder,
    pub slots: SlotBodies<'a>,
    pub names: SlotNames<'a>,
    /// Which pairs pass after the first test, where not all do.
    pub filter: Option<PairFilter<'a>>,
}

/// What is new in each frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameVolumes<'a> {
    /// The poses, and spheres by place where there are any.
    pub posed: UpdateInputs<'a>,
    pub intervals: &'a IntervalSlots,
    /// Whether each body is of interest.
    pub interest: &'a [bool],
    /// The number of the frame, from 1.
    pub stamp: u32,
    pub row_timing: RowTiming,
}

/// The inputs of culling a frame, after volumes are updated and bodies are arranged in slots.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub executor: Executor<'a>,
    pub setup: &'a Setup,
    pub tables: &'a SlabTables,
    pub arranged: Arrangement<'a>,
    pub volumes: FrameVolumes<'a>,
}

impl Inputs<'_> {
    /// The body in each place.
    pub(super) fn bodies_by_place(&self) -> &[u32] {
        &self.volumes.posed.places.body
    }
}

/// State that is kept from frame to frame: buffers, and the refinement history of time-critical
/// culling.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(super) tasks: Tasks,
    /// The potentially colliding set as pairs of places, if a list of it is kept.
    pub candidates: PairList,
    /// The candidates that have a body of interest, and which of those survived.
    pub(super) selected: PairList,
    pub(super) survivors: PairList,
    /// The reported pairs of a portion of the candidates.
    pub(super) portion: PairList,
    pub(super) history: time_critical::History,
}

impl Scratch {
    /// Frees the memory of lists of pairs, except the last potentially colliding set.
    pub fn shrink_to_fit(&mut self) {
        self.candidates.shrink_to_fit();
        self.history.shrink_to_fit();
        (self.tasks, self.selected, self.survivors, self.portion) = Default::default();
    }

    /// Frees the memory of all lists of pairs, including the last potentially colliding set.
    pub fn forget_lists(&mut self) {
        self.candidates.clear();
        self.shrink_to_fit();
    }

    /// When each pair of the last frame was last refined.
    pub fn answers(&self) -> RefinementRanks {
        self.history.answers()
    }

    /// Replaces the refinement history.
    pub fn set_answers(&mut self, answers: &RefinementRanks) {
        self.history.set_answers(answers);
    }

    /// Bytes that lists of pairs hold.
    pub fn pair_bytes(&self) -> usize {
        let lists = [&self.candidates, &self.selected, &self.survivors, &self.portion];
        let lists: usize = lists.into_iter().map(PairList::bytes).sum();
        lists + self.tasks.pair_bytes()
    }
}

/// Culls one frame by the strategy of the settings.
pub(crate) fn cull(
    inputs: Inputs<'_>,
    rows: &mut OrDopRows,
    scratch: &mut Scratch,
    output: Output<'_>,
) -> Totals {
    scratch.candidates.clear();
    let interest = Some(inputs.volumes.interest);
    let lazy = inputs.volumes.row_timing == RowTiming::OnDemand;
    match inputs.setup.scheme.flow {
        Flow::Nothing => Totals::default(),
        Flow::FirstTest => first_test::flow(inputs, scratch, output),
        // Lazy rows need the whole set before its first test.
        Flow::Sequential if lazy => batch::flow(inputs, rows, scratch, None, output),
        Flow::OfInterest if lazy => batch::flow(inputs, rows, scratch, interest, output),
        Flow::Sequential => sequential::flow(inputs, rows, scratch, None, output),
        Flow::OfInterest => sequential::flow(inputs, rows, scratch, interest, output),
        // The same pairs in the same order, without a list that grows with them.
        Flow::Batch if output.is_in_portions() && !lazy => {
            sequential::flow(inputs, rows, scratch, None, output)
        }
        Flow::Batch => batch::flow(inputs, rows, scratch, None, output),
        Flow::TimeCritical => time_critical::flow(inputs, rows, scratch, output),
    }
}
