//! Prints the result of a verification run: answers by stage and lists by strategy, in one table
//! per source, and the matrix of what was judged.

mod coverage;

use sdop_judge::Conclusion;
use sdop_judge::configuration::Rotation;
use sdop_judge::configuration::coverage::{Coverage, ListLedger};
use sdop_judge::configuration::world_kind::strategy_name;
use sdop_judge::truth::Predicate;
use sdop_judge::verify::{Ledger, LedgerKey};
use serde::Serialize;

use crate::commands::output::table;
use coverage::CoverageReport;

/// The result of `sdop verify`.
#[derive(Serialize)]
pub struct Report {
    /// The verdict in one word.
    conclusion: Conclusion,
    /// The number of requested units of work.
    asked: usize,
    /// The number of units that were judged before `--time` was over.
    judged: usize,
    /// Tiers that took part.
    simd: Vec<String>,
    /// Wall time.
    seconds: f64,
    /// Pairs missed, over all sources.
    missed: u64,
    /// Pairs on which a list and that of all-pairs differ, over all sources; of given boxes, a list
    /// and their definition; of long-lived worlds, a list or its events and those of a newly built
    /// world.
    differ: u64,
    sources: Vec<SourceReport>,
    coverage: CoverageReport,
    #[serde(skip)]
    judged_cells: Coverage,
}

#[derive(Serialize)]
struct SourceReport {
    name: String,
    answers: Vec<AnswersReport>,
    strategies: Vec<StrategyReport>,
}

/// One predicate's answers: how many pairs, and which stage of the reference was certain.
#[derive(Serialize)]
struct AnswersReport {
    name: &'static str,
    judged: u64,
    overlapping: u64,
    by_filter: u64,
    by_interval: u64,
    exactly: u64,
}

/// One strategy's lists, over all finders and tiers.
#[derive(Serialize)]
struct StrategyReport {
    name: String,
    judged: u64,
    required: u64,
    reported: u64,
    missed: u64,
    /// Pairs on which a list differs from that of all-pairs.
    differ: u64,
    /// Reported although the exact volumes are apart, but not those wider by the rounding margins;
    /// per million judged.
    margin_per_million: Option<f64>,
    /// Reported although those are apart too, since supports are bounded from slabs; per million
    /// judged.
    bound_per_million: Option<f64>,
    /// Reported and rightly so, but the meshes are apart, per million pairs whose meshes were
    /// judged.
    looseness_per_million: Option<f64>,
}

impl Report {
    pub fn new(tiers: &[String]) -> Self {
        Self {
            conclusion: Conclusion::Incomplete,
            asked: 0,
            judged: 0,
            simd: tiers.to_vec(),
            seconds: 0.0,
            missed: 0,
            differ: 0,
            sources: Vec::new(),
            coverage: CoverageReport::default(),
            judged_cells: Coverage::default(),
        }
    }

    pub fn add(&mut self, name: String, ledger: &Ledger) {
        self.missed += ledger.missed();
        self.differ += ledger.differing();
        self.judged_cells.add(&ledger.coverage);
        let answers = ledger.predicates.iter().zip(Predicate::ALL);
        self.sources.push(SourceReport {
            name,
            answers: answers
                .filter(|((_, tally), _)| tally.total() > 0)
                .map(|((overlapping, tally), predicate)| AnswersReport {
                    name: predicate.name(),
                    judged: tally.total(),
                    overlapping: *overlapping,
                    by_filter: tally.filter,
                    by_interval: tally.interval,
                    exactly: tally.exact,
                })
                .collect(),
            strategies: ledger.rows.iter().map(strategy).collect(),
        });
    }

    /// Draws the conclusion when all sources are there, from the numbers of requested and of judged
    /// units.
    pub fn finish(
        &mut self,
        [asked, judged]: [usize; 2],
        seconds: f64,
        (boxes, histories): (&ListLedger, &ListLedger),
        rotation: &Rotation,
    ) {
        [self.asked, self.judged] = [asked, judged];
        self.seconds = seconds;
        for lists in [boxes, histories] {
            self.missed += lists.missed;
            self.differ += lists.differ;
            self.judged_cells.add(&lists.coverage);
        }
        self.coverage = CoverageReport::of(&self.judged_cells, (boxes, histories), rotation);
        self.conclusion = self.conclude();
    }

    /// What units left out would have filled may be empty.
    fn conclude(&self) -> Conclusion {
        if self.missed > 0 || self.differ > 0 {
            Conclusion::NotPassed
        } else if self.judged < self.asked {
            Conclusion::Incomplete
        } else if self.coverage.is_full() {
            Conclusion::Pass
        } else {
            Conclusion::NotPassed
        }
    }

    /// The verdict.
    pub fn conclusion(&self) -> Conclusion {
        self.conclusion
    }

    /// Why it is not [`Conclusion::Pass`]: a pair is missed, a finder disagrees with all-pairs,
    /// units were not run, or a cell of the matrix is empty.
    pub fn why(&self) -> Option<String> {
        let &Self { missed, differ, asked, judged, .. } = self;
        match self.conclusion {
            Conclusion::Pass => None,
            Conclusion::Incomplete => Some(format!(
                "{judged} of {asked} units were judged: --time left no room for {}",
                asked - judged
            )),
            Conclusion::NotPassed if missed > 0 => Some(format!("{missed} pairs were missed")),
            Conclusion::NotPassed if differ > 0 => {
                Some(format!("lists differ from all-pairs' in {differ} pairs"))
            }
            Conclusion::NotPassed => Some("a cell of the matrix is empty".to_owned()),
        }
    }

    /// Two tables a source, and those of the matrix.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        for source in &self.sources {
            let header = ["exact answers", "pairs", "overlap", "filter", "interval", "integers"];
            let mut answers = table(&header);
            for a in &source.answers {
                let counts = [a.judged, a.overlapping, a.by_filter, a.by_interval, a.exactly];
                answers
                    .add_row([a.name.to_owned()].into_iter().chain(counts.map(|n| n.to_string())));
            }
            let header = [
                "strategy", "judged", "required", "reported", "missed", "differ", "margin/M",
                "bound/M", "loose/M",
            ];
            let mut lists = table(&header);
            for s in &source.strategies {
                let counts = [s.judged, s.required, s.reported, s.missed, s.differ];
                let counts = counts.map(|n| n.to_string());
                let rates = [s.margin_per_million, s.bound_per_million, s.looseness_per_million]
                    .map(|rate| rate.map_or("–".to_owned(), |x| format!("{x:.1}")));
                lists.add_row([s.name.clone()].into_iter().chain(counts).chain(rates));
            }
            text += &format!("{}\n{answers}\n{lists}\n\n", source.name);
        }
        text + &format!(
            "{}\n\n{}: {} of {} units judged, {} missed, {} differ from all-pairs, in {:.0} s on {}",
            self.coverage.tables(),
            self.conclusion,
            self.judged,
            self.asked,
            self.missed,
            self.differ,
            self.seconds,
            self.simd.join(", ")
        )
    }
}

fn strategy((row, count): (&LedgerKey, &sdop_judge::truth::ListCount)) -> StrategyReport {
    let rate = |part: u64, of: u64| (of > 0).then(|| 1e6 * part as f64 / of as f64);
    // What a budget leaves untested is no rounding margin.
    let budgeted = row.strategy.scheme().has_budget();
    StrategyReport {
        name: strategy_name(row.strategy, row.overlap),
        judged: count.judged,
        required: count.required,
        reported: count.reported,
        missed: count.missed,
        differ: count.differ,
        margin_per_million: rate(count.margin, count.judged).filter(|_| !budgeted),
        bound_per_million: rate(count.bound, count.judged).filter(|_| !budgeted),
        looseness_per_million: rate(count.loose, count.meshes_judged),
    }
}

#[cfg(test)]
mod tests {
    use sdop::Tier;

    use super::*;

    #[test]
    fn a_failure_outweighs_missing_units() {
        use Conclusion::{Incomplete, NotPassed};
        let short = "3 of 4 units were judged: --time left no room for 1";
        let differ = "lists differ from all-pairs' in 5 pairs";
        for (wrong, judged, conclusion, why) in [
            ([0, 0], 3, Incomplete, short),
            ([2, 5], 3, NotPassed, "2 pairs were missed"),
            ([0, 5], 3, NotPassed, differ),
            ([0, 0], 4, NotPassed, "a cell of the matrix is empty"),
        ] {
            let mut report = Report::new(&[]);
            [report.missed, report.differ] = wrong;
            let rotation = Rotation::new(&[Tier::detect()]);
            let none = ListLedger::default();
            report.finish([4, judged], 1.0, (&none, &none), &rotation);
            assert_eq!(report.conclusion(), conclusion);
            assert_eq!(report.why().as_deref(), Some(why));
        }
    }
}
