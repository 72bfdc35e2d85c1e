//! What a verification run has judged: sums over frames, and the first failures.

use std::collections::BTreeMap;

use sdop_reference::exact::Tally;

use crate::case::Case;
use crate::configuration::Mode;
use crate::configuration::coverage::{Coverage, ListLedger};
use crate::truth::answers::{Answers, Predicate};
use crate::truth::compare::ListCount;
use sdop::settings::{CullSettings, Overlap, Strategy};

/// Failures that a ledger keeps.
pub(super) const MOST_FAILURES: usize = 8;

/// What lists are counted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LedgerKey {
    /// The strategy.
    pub strategy: Strategy,
    /// The overlap test, for strategies that have one.
    pub overlap: Option<Overlap>,
}

/// Everything that was judged: sums over frames.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// Answers by predicate: pairs that overlap, and which stage decided.
    pub predicates: [(u64, Tally); Predicate::ALL.len()],
    /// Lists against answers; a pair counts once for each finder that listed it.
    pub rows: BTreeMap<LedgerKey, ListCount>,
    /// Pairs missed or found by one finder alone, with all that is needed to see it again.
    pub failures: Vec<Failure>,
    /// In which cells lists were judged.
    pub coverage: Coverage,
    /// Lists of given boxes.
    pub boxes: ListLedger,
    /// Lists of long-lived worlds.
    pub histories: ListLedger,
}

/// A missed pair, or one on which a finder disagrees with all-pairs.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The culler's settings.
    pub settings: CullSettings,
    /// How it was computed.
    pub mode: Mode,
    /// The frames up to the one with the pair.
    pub case: Case,
    /// The pair.
    pub pair: [u32; 2],
    /// Whether the exact answers require it; otherwise only one of all-pairs and this list has it.
    pub missed: bool,
}

impl Ledger {
    /// Counts a frame's answers.
    pub fn note(&mut self, answers: &Answers) {
        for ((overlaps, tally), predicate) in self.predicates.iter_mut().zip(Predicate::ALL) {
            *overlaps += answers.of(predicate).iter().filter(|x| **x).count() as u64;
            tally.add(&answers.tally(predicate));
        }
    }

    /// Counts one list.
    pub fn count(&mut self, settings: &CullSettings, count: &ListCount) {
        let row = LedgerKey {
            strategy: settings.strategy,
            overlap: settings.strategy.scheme().has_overlap_test().then_some(settings.overlap),
        };
        self.rows.entry(row).or_default().add(count);
    }

    /// Adds another ledger. A few failures are enough.
    pub fn add(&mut self, other: Self) {
        for (mine, (overlaps, tally)) in self.predicates.iter_mut().zip(other.predicates) {
            mine.0 += overlaps;
            mine.1.add(&tally);
        }
        for (row, count) in other.rows {
            self.rows.entry(row).or_default().add(&count);
        }
        self.coverage.add(&other.coverage);
        self.boxes.add(other.boxes);
        self.histories.add(other.histories);
        self.failures.extend(other.failures);
        self.failures.truncate(MOST_FAILURES);
    }

    /// The number of all missed pairs.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.rows.values().map(|count| count.missed).sum()
    }

    /// The number of all pairs on which a list differs from that of all-pairs.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.rows.values().map(|count| count.differ).sum()
    }
}
