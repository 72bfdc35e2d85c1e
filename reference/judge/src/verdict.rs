//! What a run of cases says: by group and by case, with the smallest scene of a miss.

use std::fmt;

use serde::Serialize;

use super::answer::AnswerError;
use super::case::group_of;
use super::claim::Claim;
use super::score::{Miss, Outcome, PairCounts};
use super::shrink::SmallestCase;

/// A case's line.
#[derive(Clone, Debug, Serialize)]
pub struct CaseVerdict {
    /// Its name.
    pub name: String,
    /// The bug that it looks for.
    pub flag: String,
    /// How it ended.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Pairs counted.
    pub pairs: PairCounts,
    /// The first missed pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub miss: Option<Miss>,
    /// Listed as a known failure.
    pub known: bool,
}

impl CaseVerdict {
    /// The group: the name without its number.
    #[must_use]
    pub fn group(&self) -> &str {
        group_of(&self.name)
    }

    /// Whether it failed or erred, and isn't known to. A slow program on a busy machine is not
    /// wrong: no answer in time is no failure, and no pass either.
    #[must_use]
    pub fn counts_against(&self) -> bool {
        let fails = matches!(self.outcome, Outcome::Fail { .. } | Outcome::Error { .. });
        fails && !self.known && !self.is_late()
    }

    /// Whether the time was over before an answer.
    #[must_use]
    pub fn is_late(&self) -> bool {
        let Outcome::Error { trouble } = &self.outcome else {
            return false;
        };
        matches!(trouble, AnswerError::Timeout { .. } | AnswerError::Idle { .. })
    }
}

/// The name and what is wrong, if anything is.
impl fmt::Display for CaseVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.name;
        match &self.outcome {
            Outcome::Pass => write!(f, "{name} passed"),
            Outcome::Fail { why } => write!(f, "{name} {why}"),
            Outcome::Error { trouble } => write!(f, "{name} {trouble}"),
            Outcome::Skipped { why } => write!(f, "{name} ({why})"),
        }
    }
}

/// A group's line.
#[derive(Clone, Debug, Default, Serialize)]
pub struct GroupVerdict {
    /// The group.
    pub name: String,
    /// Cases that passed.
    pub passed: u32,
    /// Cases with a miss, or with answers that differ from run to run.
    pub failed: u32,
    /// Cases that were skipped.
    pub skipped: u32,
    /// Cases without an answer that could be judged.
    pub errors: u32,
    /// Pairs.
    pub pairs: PairCounts,
}

/// What a run shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Conclusion {
    /// All requested cases were judged, and nothing speaks against the claim.
    Pass,
    /// Nothing speaks against the claim, but some cases were skipped or not run.
    Incomplete,
    /// Something speaks against the claim, or no case passes.
    NotPassed,
}

impl fmt::Display for Conclusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pass => "PASS",
            Self::Incomplete => "INCOMPLETE",
            Self::NotPassed => "NOT PASSED",
        })
    }
}

/// The result of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// What was claimed.
    pub claim: Claim,
    /// The seed of the fresh cases, if there were any.
    pub seed: Option<u64>,
    /// Every case that was run.
    pub cases: Vec<CaseVerdict>,
    /// The number of cases that were not run, because time was up or an earlier case failed.
    pub not_run: usize,
    /// Large sets that were not judged, because the culler is too slow for them.
    pub large_not_judged: usize,
    /// Known failures that pass: the list is stale.
    pub stale: Vec<String>,
    /// The most extra pairs for each required one that the culler allows itself.
    pub extra_limit: Option<f64>,
    /// The smallest scene of the first miss.
    #[serde(skip)]
    pub smallest: Option<SmallestCase>,
}

impl Verdict {
    /// What the run shows.
    #[must_use]
    pub fn conclusion(&self) -> Conclusion {
        let is_refuted = !self.stale.is_empty()
            || self.is_beyond_limit()
            || self.cases.iter().any(CaseVerdict::counts_against);
        if is_refuted {
            Conclusion::NotPassed
        } else if self.judged() < self.asked() || self.cases.is_empty() {
            Conclusion::Incomplete
        } else if self.cases.iter().any(|case| case.outcome == Outcome::Pass) {
            Conclusion::Pass
        } else {
            Conclusion::NotPassed // known failures alone show nothing to be right
        }
    }

    /// Whether all requested cases were judged and nothing speaks against the claim: some cases
    /// passed, and all others are known to fail.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.conclusion() == Conclusion::Pass
    }

    /// Whether the program could not even be started.
    #[must_use]
    pub fn is_without_start(&self) -> bool {
        let is_start = |case: &CaseVerdict| match &case.outcome {
            Outcome::Error { trouble } => matches!(trouble, AnswerError::Start { .. }),
            _ => false,
        };
        !self.cases.is_empty() && self.cases.iter().all(is_start)
    }

    /// Why the conclusion is not [`Conclusion::Pass`], on one line.
    #[must_use]
    pub fn why(&self) -> Option<String> {
        let is_skipped = |case: &&CaseVerdict| matches!(case.outcome, Outcome::Skipped { .. });
        match self.conclusion() {
            Conclusion::Pass => None,
            Conclusion::Incomplete => {
                let late = self.cases.iter().filter(|case| case.is_late()).count();
                let late = match late {
                    0 => String::new(),
                    _ if late == self.cases.len() => {
                        format!(", {late} out of time: it hangs, or needs a longer --timeout")
                    }
                    _ => format!(", {late} out of time: give a longer --timeout"),
                };
                Some(format!(
                    "{} of {} cases were judged: {} skipped, {} not run{late}",
                    self.judged(),
                    self.asked(),
                    self.cases.iter().filter(is_skipped).count(),
                    self.not_run
                ))
            }
            Conclusion::NotPassed => Some(self.refutation()),
        }
    }

    /// What speaks against the claim first.
    fn refutation(&self) -> String {
        let mut against = self.cases.iter().filter(|case| case.counts_against());
        if let Some(first) = against.next() {
            let count = 1 + against.count();
            return format!("{count} of {} cases failed, first {first}", self.asked());
        }
        if let Some(name) = self.stale.first() {
            return format!("the known failure {name} passes: take it off the list");
        }
        match self.extra_limit.filter(|_| self.is_beyond_limit()) {
            Some(limit) => format!("more extra pairs than {limit} for each required one"),
            None => "no case passed: all are known failures".to_owned(),
        }
    }

    /// The number of requested cases.
    #[must_use]
    pub fn asked(&self) -> usize {
        self.cases.len() + self.not_run
    }

    /// Cases that were judged: run, neither skipped nor out of time.
    #[must_use]
    pub fn judged(&self) -> usize {
        let is_skipped =
            |case: &&CaseVerdict| matches!(case.outcome, Outcome::Skipped { .. }) || case.is_late();
        self.cases.len() - self.cases.iter().filter(is_skipped).count()
    }

    /// Whether more extra pairs were reported than the culler allows itself.
    #[must_use]
    pub fn is_beyond_limit(&self) -> bool {
        let pairs = self.pairs();
        self.extra_limit.is_some_and(|limit| pairs.extra as f64 > limit * pairs.required as f64)
    }

    /// Pairs over all cases.
    #[must_use]
    pub fn pairs(&self) -> PairCounts {
        let mut sum = PairCounts::default();
        self.cases.iter().for_each(|case| sum.add(&case.pairs));
        sum
    }

    /// Cases by group, in the order in which groups first appear.
    #[must_use]
    pub fn groups(&self) -> Vec<GroupVerdict> {
        let mut groups: Vec<GroupVerdict> = Vec::new();
        for case in &self.cases {
            let at = groups.iter().position(|group| group.name == case.group());
            let at = at.unwrap_or_else(|| {
                groups.push(GroupVerdict {
                    name: case.group().to_owned(),
                    ..GroupVerdict::default()
                });
                groups.len() - 1
            });
            let group = &mut groups[at];
            match case.outcome {
                Outcome::Pass => group.passed += 1,
                Outcome::Fail { .. } => group.failed += 1,
                Outcome::Skipped { .. } => group.skipped += 1,
                Outcome::Error { .. } => group.errors += 1,
            }
            group.pairs.add(&case.pairs);
        }
        groups
    }

    /// Panics with the summary unless the verdict is a pass: what a test calls.
    ///
    /// # Panics
    /// When the verdict is no pass.
    pub fn assert_passed(&self) {
        assert!(self.passed(), "\n{self}");
    }
}

/// The summary, in ten lines or so.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (pairs, count) = (self.pairs(), |outcome: fn(&Outcome) -> bool| {
            self.cases.iter().filter(|case| outcome(&case.outcome)).count()
        });
        writeln!(
            f,
            "claim {}: {}, {} of {} cases judged{}",
            self.claim,
            self.conclusion(),
            self.judged(),
            self.asked(),
            if self.large_not_judged > 0 { ", large sets not judged" } else { "" }
        )?;
        writeln!(
            f,
            "cases: {} passed, {} failed, {} errors, {} skipped, {} not run",
            count(|o| *o == Outcome::Pass),
            count(|o| matches!(o, Outcome::Fail { .. })),
            count(|o| matches!(o, Outcome::Error { .. })),
            count(|o| matches!(o, Outcome::Skipped { .. })),
            self.not_run
        )?;
        writeln!(
            f,
            "pairs: {} judged, {} required, {} missed; {} extra ({} by rounding, {} by a looser volume, {} both static, {} neither)",
            pairs.judged,
            pairs.required,
            pairs.missed,
            pairs.extra,
            pairs.by_rounding,
            pairs.by_looseness,
            pairs.both_static,
            pairs.unexplained()
        )?;
        if self.is_beyond_limit() {
            writeln!(
                f,
                "more extra pairs than the limit of {} for each required one",
                self.extra_limit.unwrap_or_default()
            )?;
        }
        for name in self.stale.iter().take(3) {
            writeln!(f, "known failure {name} passes: take it off the list")?;
        }
        for case in self.cases.iter().filter(|case| case.counts_against()).take(3) {
            writeln!(f, "{case}")?;
            if matches!(case.outcome, Outcome::Fail { .. }) && !case.flag.is_empty() {
                writeln!(f, "  this case is also meant to catch: {}", case.flag)?;
            }
        }
        let mut skipped =
            self.cases.iter().filter(|case| matches!(case.outcome, Outcome::Skipped { .. }));
        if let Some(case) = skipped.next() {
            writeln!(f, "skipped, for one: {case}")?;
        }
        self.smallest.as_ref().map_or(Ok(()), |smallest| smallest.fmt(f))
    }
}

#[cfg(test)]
mod tests;
