//! Judges one adapter: a cell for each family of its claim's cases.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use sdop_judge::catalogue::select;
use sdop_judge::process::{Program, Service};
use sdop_judge::report::counter_example;
use sdop_judge::score::judge_answers;
use sdop_judge::shrink::{SmallestCase, shrink};
use sdop_judge::truth::Truth;
use sdop_judge::verdict::{CaseVerdict, GroupVerdict};
use sdop_judge::wire::Wire;
use sdop_judge::witness::Witness;
use sdop_judge::{Case, Claim, JudgeError, Miss, Options, Outcome, Subject, examine};
use serde::Serialize;

use crate::roster::RosterRow;
use crate::view::{Page, ShownRun};

/// Time limit of a case; libraries that compile at their first call need it.
const TIMEOUT: Duration = Duration::from_secs(120);
/// Time for reducing a failing case.
const SHRINK: Duration = Duration::from_secs(4);
/// The reason why misses of pairs that only touch are no failure.
const ONLY_TOUCHING: &str = "pairs that only touch, which it does not claim to report";
/// How many times a failing case is repeated to see its misses, since answers may vary from run to
/// run.
const TRIES: usize = 20;

/// The verdict on a library in one family of cases, or in all families.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CellVerdict {
    /// Every case was judged, and no pair was missed.
    Pass,
    /// No pair was missed in the cases that the library can represent; the others were skipped.
    Partial,
    /// All misses, if any, are outside of the library's claim.
    DoesNotClaim,
    /// A pair was missed that the library claims to report.
    Fail,
    /// It crashed, or its answer was invalid.
    Error,
}

impl CellVerdict {
    /// Its text on the board.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Partial => "partial",
            Self::DoesNotClaim => "does not claim",
            Self::Fail => "fail",
            Self::Error => "error",
        }
    }
}

/// An adapter's row.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The judged adapter.
    #[serde(flatten)]
    pub adapter: RosterRow,
    /// The version that answered, as the adapter names it; empty if it could not be run.
    pub found: String,
    /// The verdict over all cells.
    pub outcome: CellVerdict,
    /// The reason why it could not be run, if it could not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub how: Option<String>,
    /// Cases and pairs over all cells.
    pub total: GroupVerdict,
    /// One for each family.
    pub cells: Vec<Cell>,
}

/// A family of cases.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// The first word of its cases' names.
    pub family: String,
    /// The verdict.
    pub outcome: CellVerdict,
    /// Cases and pairs.
    pub total: GroupVerdict,
    /// The same by group.
    pub groups: Vec<GroupVerdict>,
    /// Reasons why cases were skipped, are outside of its claim or ended in an error, with their
    /// numbers of cases.
    pub reasons: BTreeMap<String, usize>,
    /// The cases in which pairs were missed.
    pub missed_in: Vec<String>,
    /// The smallest case that shows a miss.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest: Option<Counter>,
}

/// A counter-example.
#[derive(Clone, Debug, Serialize)]
pub struct Counter {
    /// The case from which it was reduced.
    pub from: String,
    /// The missed pairs with place and depth, one per line.
    pub says: Vec<String>,
    /// The case with the reported pairs, in the format of `sdop judge --replay`.
    pub case: String,
    /// The data of the viewer's page.
    #[serde(skip)]
    pub page: String,
}

/// Judges one adapter by the published cases whose names match a pattern.
///
/// # Errors
/// A case can't be made.
pub fn judge(
    adapter: &RosterRow,
    command: &str,
    cases: &str,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Row, JudgeError> {
    let service =
        Service::new(Program { command: command.to_owned(), wire: Wire::Ndjson, timeout: TIMEOUT });
    let mut row = Row {
        adapter: adapter.clone(),
        found: String::new(),
        outcome: CellVerdict::Error,
        how: None,
        total: GroupVerdict::default(),
        cells: Vec::new(),
    };
    match version(command) {
        Ok(found) => row.found = found,
        Err(how) => {
            row.how = Some(how);
            return Ok(row);
        }
    }
    let options = Options {
        claim: adapter.claim,
        pattern: cases.to_owned(),
        // Each cell has its own smallest case.
        shrink_time: Duration::ZERO,
        ..Options::default()
    };
    let verdict = examine(&service, &options, progress)?;
    let mut families: Vec<(String, Vec<&CaseVerdict>)> = Vec::new();
    for case in &verdict.cases {
        let family = family(&case.name);
        match families.iter_mut().find(|(name, _)| name == family) {
            Some((_, cases)) => cases.push(case),
            None => families.push((family.to_owned(), vec![case])),
        }
    }
    let groups = verdict.groups();
    for (family_name, cases) in families {
        let groups = groups.iter().filter(|it| family(&it.name) == family_name);
        let cell = Cell::of(family_name.clone(), &cases, groups.cloned().collect());
        row.cells.push(cell.explained(adapter, &service, &cases)?);
    }
    row.cells.sort_by(|a, b| a.family.cmp(&b.family));
    row.total = total(row.cells.iter().map(|cell| &cell.total));
    row.outcome = over_all(row.cells.iter().map(|cell| (cell.outcome, !cell.missed_in.is_empty())));
    Ok(row)
}

/// The output of the adapter for `--version`.
fn version(command: &str) -> Result<String, String> {
    let run = Command::new("sh").arg("-c").arg(format!("{command} --version")).output();
    let output = run.map_err(|error| error.to_string())?;
    let last = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        text.trim().lines().last().unwrap_or_default().trim().to_owned()
    };
    match (output.status.success(), last(&output.stdout)) {
        (true, found) if !found.is_empty() => Ok(found),
        _ => Err(format!("{}: {}", output.status, last(&output.stderr))),
    }
}

fn family(case: &str) -> &str {
    case.split_once('/').map_or(case, |(family, _)| family)
}

fn total<'a>(groups: impl Iterator<Item = &'a GroupVerdict>) -> GroupVerdict {
    groups.fold(GroupVerdict::default(), |mut sum, group| {
        sum.passed += group.passed;
        sum.failed += group.failed;
        sum.skipped += group.skipped;
        sum.errors += group.errors;
        sum.pairs.add(&group.pairs);
        sum
    })
}

/// The verdict over cells, each with whether it has misses. Misses that a library does not claim to
/// report make all of it "does not claim"; cells that it does not claim at all make it partial.
fn over_all(cells: impl Iterator<Item = (CellVerdict, bool)> + Clone) -> CellVerdict {
    let has = |wanted: CellVerdict| cells.clone().any(|(outcome, _)| outcome == wanted);
    let misses = cells.clone().any(|(_, misses)| misses);
    match () {
        () if has(CellVerdict::Error) => CellVerdict::Error,
        () if has(CellVerdict::Fail) => CellVerdict::Fail,
        () if misses || !(has(CellVerdict::Pass) || has(CellVerdict::Partial)) => {
            CellVerdict::DoesNotClaim
        }
        () if has(CellVerdict::Partial) || has(CellVerdict::DoesNotClaim) => CellVerdict::Partial,
        () => CellVerdict::Pass,
    }
}

impl Cell {
    /// The counts, and an outcome for which every miss is a failure.
    fn of(family: String, cases: &[&CaseVerdict], groups: Vec<GroupVerdict>) -> Self {
        let total = total(groups.iter());
        let mut reasons = BTreeMap::new();
        for case in cases {
            let why = match &case.outcome {
                Outcome::Skipped { why } => why.clone(),
                Outcome::Error { trouble } => format!("{}: {trouble}", case.name),
                Outcome::Fail { .. } | Outcome::Pass => continue,
            };
            *reasons.entry(why).or_default() += 1;
        }
        let failed = cases.iter().filter(|case| matches!(case.outcome, Outcome::Fail { .. }));
        Self {
            outcome: match () {
                () if total.errors > 0 => CellVerdict::Error,
                () if total.failed > 0 => CellVerdict::Fail,
                () if total.passed == 0 => CellVerdict::DoesNotClaim,
                () if total.skipped > 0 => CellVerdict::Partial,
                () => CellVerdict::Pass,
            },
            family,
            total,
            groups,
            reasons,
            missed_in: failed.map(|case| case.name.clone()).collect(),
            smallest: None,
        }
    }

    /// Finds the misses outside of the library's claim, and the smallest case of another one, or of
    /// any.
    fn explained(
        mut self,
        adapter: &RosterRow,
        subject: &dyn Subject,
        cases: &[&CaseVerdict],
    ) -> Result<Self, JudgeError> {
        let claim = adapter.claim;
        let (mut claimed, mut others) = (Vec::new(), Vec::new());
        for name in &self.missed_in {
            let case = named(claim, name)?;
            let touches = || !adapter.touching && only_touch(subject, &case);
            let why = adapter.disclaims(name).or_else(|| touches().then_some(ONLY_TOUCHING));
            match why {
                None => claimed.push(case),
                Some(why) => {
                    *self.reasons.entry(why.to_owned()).or_default() += 1;
                    others.push(case);
                }
            }
        }
        if self.outcome == CellVerdict::Fail && claimed.is_empty() {
            self.outcome = CellVerdict::DoesNotClaim;
        }
        let shown = if claimed.is_empty() { others } else { claimed };
        // The case with the fewest pairs is the fastest to reduce.
        let shown = shown.into_iter().min_by_key(Case::pairs);
        self.smallest = shown.and_then(|case| {
            let mut tries = (0..TRIES).map(|_| shrink(subject, &case, SHRINK));
            tries.find_map(|smallest| smallest).map(|it| Counter::of(&it, adapter))
        });
        // An answer that differs from run to run has no smallest case.
        let unstable =
            |case: &&&CaseVerdict| case.miss.is_none() && self.missed_in.contains(&case.name);
        for case in cases.iter().filter(unstable) {
            if let Outcome::Fail { why } = &case.outcome {
                *self.reasons.entry(why.clone()).or_default() += 1;
            }
        }
        Ok(self)
    }
}

/// The published case with a name.
fn named(claim: Claim, name: &str) -> Result<Case, JudgeError> {
    let mut found = select(claim, name, None)?;
    Ok(found.swap_remove(0).case()?) // its name came from there
}

/// Whether every missed pair of a case is separated by a shift of one f32 step.
fn only_touch(subject: &dyn Subject, case: &Case) -> bool {
    let Ok(truth) = Truth::new(case.claim, &case.shapes) else {
        return false;
    };
    let missed = |lists: &[Vec<[u32; 2]>]| {
        let mut missed = Vec::new();
        for (number, (frame, list)) in case.frames.iter().zip(lists).enumerate() {
            let required = truth.pairs(frame).unwrap_or_default().into_iter();
            let lost = required.filter(|pair| list.binary_search(pair).is_err());
            missed.extend(lost.map(|pair| Miss { frame: number, pair }));
        }
        missed
    };
    for _ in 0..TRIES {
        let answers = subject.answer(case).ok();
        let judged = answers.and_then(|answers| judge_answers(case, &answers).ok());
        let missed = judged.map_or_else(Vec::new, |judged| missed(&judged.lists));
        if !missed.is_empty() {
            let depth = |miss| Witness::of(case, miss).and_then(|witness| witness.depth_ulps);
            return missed.into_iter().all(|miss| depth(miss) == Some(1));
        }
    }
    false
}

impl Counter {
    fn of(smallest: &SmallestCase, adapter: &RosterRow) -> Self {
        let files = counter_example(smallest).unwrap_or_default();
        let case = files
            .first()
            .map_or_else(String::new, |(_, bytes)| String::from_utf8_lossy(bytes).into_owned());
        let says = smallest.to_string().lines().map(|line| line.trim().to_owned()).collect();
        Self { from: smallest.from.clone(), says, case, page: picture(smallest, adapter) }
    }
}

/// The viewer's data of a counter-example; empty if it can't be shown.
fn picture(smallest: &SmallestCase, adapter: &RosterRow) -> String {
    let pairs = Some(smallest.pairs.clone());
    let source = Path::new("missed-pair.ndjson");
    let Ok(mut show) = ShownRun::case(&smallest.case, pairs, source) else {
        return String::new();
    };
    show.header.program = Some(adapter.name.clone());
    let mut data = Vec::new();
    match Page::new(&show, &[show.recorded()], None) {
        Ok(page) if page.write_data(&mut data).is_ok() => {
            String::from_utf8_lossy(&data).into_owned()
        }
        _ => String::new(),
    }
}
