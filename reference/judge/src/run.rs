//! Runs a culler on the cases of its claim.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use sdop::choice::nearest;
use sdop::periodic::PeriodicError;
use sdop::volume::Shape;

use super::answer::{Answer, StopReason};
use super::case::{Case, Frame};
use super::catalogue::{CaseId, CatalogueError, select};
use super::claim::Claim;
use super::score::{CaseScore, Outcome, judge_case};
use super::shrink::shrink_some;
use super::subject::{ContestantFactory, CullFunction, PairwiseTest, Scene, Subject};
use super::verdict::{CaseVerdict, Verdict};
use crate::contestant::Contestant;
use crate::truth::reference_shapes::InvalidInput;

/// The error if nothing could be judged.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// A case that can't be drawn.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// A case that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// Bodies with parts, which other claims are not about.
    #[error("the bodies of {case} have parts: the claim {claim} is not about them, `parts` is")]
    Parts {
        /// The case's name.
        case: String,
        /// The claim.
        claim: Claim,
    },
    /// Periods outside of the contract, or boxes that are too large or too far away for them.
    #[error("{case}, frame {frame}: {problem}")]
    Periods {
        /// The case's name.
        case: String,
        /// The frame.
        frame: usize,
        /// What is wrong with it.
        problem: PeriodicError,
    },
    /// No case's name matches.
    #[error("no case of the claim {claim} matches `{pattern}`")]
    NoCase {
        /// The claim.
        claim: Claim,
        /// The pattern.
        pattern: String,
    },
    /// A known failure that isn't the name of a case.
    #[error("the known failure `{name}` is no case of the claim {claim}{hint}")]
    Known {
        /// The claim.
        claim: Claim,
        /// The name.
        name: String,
        /// A case of a similar name, if there is one.
        hint: String,
    },
}

/// A program that answers none of this number of cases is given up.
const STARTS: usize = 3;

/// What is run.
#[derive(Clone, Debug)]
pub struct Options {
    /// The claim.
    pub claim: Claim,
    /// Which cases, by name.
    pub pattern: String,
    /// Fresh cases of this seed, in addition to the published ones.
    pub seed: Option<u64>,
    /// No case starts after this time.
    pub time: Option<Duration>,
    /// No case starts after a failure.
    pub fail_fast: bool,
    /// The most extra pairs for each required one.
    pub extra_limit: Option<f64>,
    /// Cases that are known to fail.
    pub known: BTreeSet<String>,
    /// The time for reducing a failing case.
    pub shrink_time: Duration,
    /// The longest that a culler may take for a large set, as estimated from a smaller one.
    pub large_time: Duration,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            claim: Claim::Mesh,
            pattern: "*".to_owned(),
            seed: None,
            time: None,
            fail_fast: false,
            extra_limit: None,
            known: BTreeSet::new(),
            shrink_time: Duration::from_secs(4),
            large_time: Duration::from_secs(60),
        }
    }
}

/// A culler's trial in preparation; [`judge`] begins one.
pub struct Judge<S> {
    subject: S,
    options: Options,
}

/// Judges a Rust culler, made anew for each case by `make`.
pub fn judge<F, C>(make: F) -> Judge<ContestantFactory<F>>
where
    F: Fn(&Scene<'_>) -> C + Sync,
    C: Contestant,
{
    Judge { subject: ContestantFactory(make), options: Options::default() }
}

/// Judges a culler that keeps nothing between frames: a function of the shapes and of a frame. The
/// frame has the bodies' poses and boxes. Pairs are i < j, each once.
pub fn judge_function<F>(cull: F) -> Judge<CullFunction<F>>
where
    F: Fn(&[Shape], &Frame) -> Vec<[u32; 2]> + Sync,
{
    Judge { subject: CullFunction(cull), options: Options::default() }
}

/// Judges a test of single pairs: whether two bodies of a frame overlap, as far as it can tell.
pub fn judge_pair_test<T>(overlap: T) -> Judge<PairwiseTest<T>>
where
    T: Fn(&[Shape], &Frame, [usize; 2]) -> bool + Sync,
{
    Judge { subject: PairwiseTest(overlap), options: Options::default() }
}

impl<S: Subject> Judge<S> {
    /// The culler's claim. The default is meshes.
    #[must_use]
    pub fn claims(mut self, claim: Claim) -> Self {
        self.options.claim = claim;
        self
    }

    /// Only cases with these names: `*` matches any text, `?` one character.
    #[must_use]
    pub fn cases(mut self, pattern: &str) -> Self {
        pattern.clone_into(&mut self.options.pattern);
        self
    }

    /// Adds cases that this seed draws.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.options.seed = Some(seed);
        self
    }

    /// The most extra pairs for each required one; without it they are counted only.
    #[must_use]
    pub fn extra_limit(mut self, limit: f64) -> Self {
        self.options.extra_limit = Some(limit);
        self
    }

    /// Runs the cases.
    ///
    /// # Errors
    /// No such case, or one that can't be made.
    pub fn run(&self) -> Result<Verdict, JudgeError> {
        examine(&self.subject, &self.options, |_, _| {})
    }

    /// As [`Judge::assert`], but it doesn't panic if the claim has no such case, or if the culler
    /// skips all of them because its set of bodies can't change; the verdict is then printed as
    /// incomplete.
    ///
    /// # Panics
    /// Panics if the verdict is no pass.
    pub fn assert_if_any(&self) {
        match self.run() {
            Err(JudgeError::NoCase { .. }) => {}
            Err(error) => panic!("{error}"),
            Ok(verdict) if verdict.cases.iter().all(is_skipped) => eprint!("{verdict}"),
            Ok(verdict) => verdict.assert_passed(),
        }
    }

    /// Runs the cases and panics unless the verdict is a pass, for use in a test.
    ///
    /// # Panics
    /// Panics if the verdict is no pass, or if there is no such case.
    pub fn assert(&self) {
        match self.run() {
            Ok(verdict) => verdict.assert_passed(),
            Err(error) => panic!("{error}"),
        }
    }
}

/// Runs the cases of a claim. `progress` receives how many cases are done, and their number.
///
/// # Errors
/// As [`Judge::run`].
pub fn examine(
    subject: &dyn Subject,
    options: &Options,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Verdict, JudgeError> {
    let (claim, pattern) = (options.claim, &options.pattern);
    let mut jobs = select(claim, pattern, None)?;
    if options.seed.is_some() {
        jobs.extend(select(claim, pattern, options.seed)?);
    }
    if jobs.is_empty() {
        let pattern = pattern.clone();
        return Err(JudgeError::NoCase { claim, pattern });
    }
    check_known(claim, &options.known)?;
    let deadline = options.time.and_then(|time| Instant::now().checked_add(time));
    let stop = AtomicBool::new(false);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let subject = Timed { subject, took: AtomicU64::new(0) };
    let run = |id: &CaseId| -> Result<Option<(Case, CaseVerdict)>, JudgeError> {
        if stop.load(Ordering::Relaxed) || deadline.is_some_and(|end| Instant::now() >= end) {
            return Ok(None);
        }
        let case = id.case()?;
        if id.is_large() {
            subject.took.store(0, Ordering::Relaxed);
        }
        // Every group's first case runs twice: equal input must have equal answers.
        let judged = judge_case(&subject, &case, id.number == 0)?;
        let verdict = line(&case, &judged, &options.known);
        stop.fetch_or(options.fail_fast && verdict.counts_against(), Ordering::Relaxed);
        progress(jobs.len().min(done.fetch_add(1, Ordering::Relaxed) + 1), jobs.len());
        Ok(Some((case, verdict)))
    };
    let (usual, large) = jobs.split_at(jobs.partition_point(|id| !id.is_large()));
    let (first, rest) = usual.split_at(usual.len().min(STARTS));
    let mut ran: Vec<Option<(Case, CaseVerdict)>> =
        first.par_iter().map(run).collect::<Result<_, _>>()?;
    // A program that says nothing about these cases says nothing about others.
    let answers = |one: &Option<(Case, CaseVerdict)>| {
        let is_error = |verdict: &CaseVerdict| matches!(verdict.outcome, Outcome::Error { .. });
        one.as_ref().is_none_or(|(_, verdict)| !is_error(verdict) || verdict.known)
    };
    again_alone(first, &mut ran, run)?;
    stop.fetch_or(!first.is_empty() && !ran.iter().any(answers), Ordering::Relaxed);
    let mut others = rest.par_iter().map(run).collect::<Result<Vec<_>, _>>()?;
    again_alone(rest, &mut others, run)?;
    ran.extend(others);
    let mut pace = BTreeMap::new();
    let mut large_not_judged = 0;
    for id in large {
        let judged = match is_too_slow(id, &pace, options)? {
            true => None,
            false => run(id)?,
        };
        match judged.filter(|(_, verdict)| !verdict.is_late()) {
            Some((case, verdict)) => {
                let took = subject.took.load(Ordering::Relaxed) as f64;
                pace.insert(id.group.name, took / case.pairs().max(1) as f64);
                ran.push(Some((case, verdict)));
            }
            None => large_not_judged += 1,
        }
    }
    Ok(Verdict { large_not_judged, ..conclude(&subject, options, ran) })
}

/// Runs those cases again for which time was over, one by one: others have run beside them. It ends
/// with the first for which the time is over again.
fn again_alone(
    jobs: &[CaseId],
    ran: &mut [Option<(Case, CaseVerdict)>],
    run: impl Fn(&CaseId) -> Result<Option<(Case, CaseVerdict)>, JudgeError>,
) -> Result<(), JudgeError> {
    for (id, ran) in jobs.iter().zip(ran) {
        if ran.as_ref().is_none_or(|(_, verdict)| !verdict.is_late()) {
            continue;
        }
        match run(id)? {
            Some((_, verdict)) if verdict.is_late() => break,
            Some(again) => *ran = Some(again),
            None => break,
        }
    }
    Ok(())
}

/// Whether a culler that takes time for each pair, as it did in a smaller set of the same group,
/// would take too long.
fn is_too_slow(
    id: &CaseId,
    pace: &BTreeMap<&str, f64>,
    options: &Options,
) -> Result<bool, CatalogueError> {
    let Some(pace) = pace.get(id.group.name) else {
        return Ok(false);
    };
    Ok(pace * id.case()?.pairs() as f64 > options.large_time.as_nanos() as f64)
}

/// A subject with the longest time that it took for a case, in nanoseconds.
struct Timed<'a> {
    subject: &'a dyn Subject,
    took: AtomicU64,
}

impl Subject for Timed<'_> {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let start = Instant::now();
        let answers = self.subject.answer(case);
        self.took.fetch_max(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        answers
    }
}

/// Runs a case that is given, such as a counter-example from a file; its name and its claim don't
/// matter.
///
/// # Errors
/// A case that the reference refuses, bodies with parts unless the claim is `parts`, and boxes
/// that don't fit their periods.
pub fn examine_given(
    subject: &dyn Subject,
    options: &Options,
    case: Case,
) -> Result<Verdict, JudgeError> {
    let claim = options.claim;
    if claim != Claim::Parts && case.frames.iter().any(|frame| frame.parts.is_some()) {
        let case = case.name;
        return Err(JudgeError::Parts { case, claim });
    }
    for (frame, checked) in case.frames.iter().map(Frame::check_periods).enumerate() {
        checked.map_err(|problem| JudgeError::Periods {
            case: case.name.clone(),
            frame,
            problem,
        })?;
    }
    let case = Case { claim, ..case };
    let judged = judge_case(subject, &case, true)?;
    let verdict = line(&case, &judged, &options.known);
    Ok(conclude(subject, options, vec![Some((case, verdict))]))
}

/// Makes the verdict, and the smallest scene of a miss.
fn conclude(
    subject: &dyn Subject,
    options: &Options,
    ran: Vec<Option<(Case, CaseVerdict)>>,
) -> Verdict {
    let not_run = ran.iter().filter(|one| one.is_none()).count();
    let ran: Vec<(Case, CaseVerdict)> = ran.into_iter().flatten().collect();
    let missed = ran.iter().filter(|(_, verdict)| verdict.miss.is_some() && !verdict.known);
    let missed: Vec<&Case> = missed.map(|(case, _)| case).collect();
    let smallest = shrink_some(subject, &missed, options.shrink_time);
    let cases: Vec<CaseVerdict> = ran.into_iter().map(|(_, verdict)| verdict).collect();
    Verdict {
        claim: options.claim,
        seed: options.seed,
        stale: stale(options, &cases),
        cases,
        not_run,
        large_not_judged: 0,
        extra_limit: options.extra_limit,
        smallest,
    }
}

fn line(case: &Case, judged: &CaseScore, known: &BTreeSet<String>) -> CaseVerdict {
    CaseVerdict {
        name: case.name.clone(),
        flag: case.flag.clone(),
        outcome: judged.outcome.clone(),
        pairs: judged.count,
        miss: judged.miss,
        known: known.contains(&case.name),
    }
}

fn is_skipped(case: &CaseVerdict) -> bool {
    matches!(case.outcome, Outcome::Skipped { .. })
}

/// Checks that each known failure is a case of the claim, with a seed or without.
fn check_known(claim: Claim, known: &BTreeSet<String>) -> Result<(), JudgeError> {
    if known.is_empty() {
        return Ok(());
    }
    let cases = select(claim, "*", None)?;
    let names: BTreeSet<String> = cases.iter().map(CaseId::name).collect();
    let published = |name: &str| match name.rsplit_once('@') {
        Some((case, seed)) if seed.parse::<u64>().is_ok() => case.to_owned(),
        _ => name.to_owned(),
    };
    let Some(name) = known.iter().find(|name| !names.contains(&published(name))) else {
        return Ok(());
    };
    let near = nearest(name, names.iter().map(String::as_str));
    Err(JudgeError::Known {
        claim,
        name: name.clone(),
        hint: near.map_or_else(String::new, |near| format!(": did you mean `{near}`?")),
    })
}

/// Known failures that pass.
fn stale(options: &Options, cases: &[CaseVerdict]) -> Vec<String> {
    let passes = |name: &&String| {
        let mut cases = cases.iter().filter(|case| case.name == **name);
        cases.any(|case| case.outcome == Outcome::Pass)
    };
    options.known.iter().filter(passes).cloned().collect()
}
