//! What a verification run does with frames: exact answers once, then every strategy, overlap test and finder on every
//! tier against them.

use std::collections::BTreeMap;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use sdop_reference::exact::Tally;

use super::answers::{Answers, Predicate, explained_by_margins};
use super::compare::{Count, compare, settings};
use super::draw::{ContactSpec, crowd, probe};
use super::forms::{self, Form, FormError};
use super::hard::{Group, GroupError};
use super::judged::{InvalidInput, Shapes};
use crate::bodies::Bodies;
use crate::culler::Culler;
use crate::mesh::ProceduralShape;
use crate::settings::{CullSettings, Finder, Overlap, SettingsError, Strategy, Updates};
use crate::simd::Tier;
use crate::volume::{Axes, DirectionSet, Shape};

/// Why a round can't be run.
#[derive(Debug, thiserror::Error)]
pub enum RoundError {
    /// Settings that the bodies can't have.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Numbers that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A group of hard cases.
    #[error(transparent)]
    Group(#[from] GroupError),
}

/// One strategy's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Row {
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
    /// Lists against answers; a pair counts once a finder and tier that reported on it.
    pub rows: BTreeMap<Row, Count>,
    /// Pairs missed, with all that is needed to see it again.
    pub failures: Vec<Failure>,
}

/// A missed pair.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The culler's settings.
    pub settings: CullSettings,
    /// Its tier.
    pub tier: Tier,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// The frames up to the one in which the pair was missed.
    pub frames: Vec<Bodies>,
    /// The pair.
    pub pair: [u32; 2],
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
    pub fn count(&mut self, settings: &CullSettings, count: &Count) {
        let row = Row {
            strategy: settings.strategy,
            overlap: refines(settings.strategy).then_some(settings.overlap),
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
        self.failures.extend(other.failures);
        self.failures.truncate(MOST_FAILURES);
    }

    /// Missed pairs in all.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.rows.values().map(|count| count.missed).sum()
    }
}

const MOST_FAILURES: usize = 8;

/// Whether the overlap test matters to a strategy.
#[must_use]
pub fn refines(strategy: Strategy) -> bool {
    match strategy {
        Strategy::None | Strategy::Sphere | Strategy::Aabb | Strategy::KDop | Strategy::Obb => {
            false
        }
        Strategy::OrDop
        | Strategy::SDopSequential
        | Strategy::SDopBatch
        | Strategy::SDopObjectOfInterest
        | Strategy::SDopTimeCritical => true,
    }
}

/// Every way to cull with one or-DOP: strategy × overlap × finder. Updates alternate between eager and lazy.
#[must_use]
pub fn ways(k: DirectionSet, axes: Axes) -> Vec<CullSettings> {
    let mut ways = Vec::new();
    for &strategy in Strategy::ALL {
        let overlaps = if refines(strategy) {
            Overlap::ALL
        } else {
            &[Overlap::TwoSided]
        };
        for &overlap in overlaps {
            for &pairs in Finder::ALL {
                let lazy = ways.len() % 2 == 1;
                ways.push(CullSettings {
                    strategy,
                    pairs,
                    k,
                    axes,
                    overlap,
                    updates: if lazy { Updates::Lazy } else { Updates::Eager },
                    ..CullSettings::default()
                });
            }
        }
    }
    ways
}

/// Culls a run of frames in one way on one tier and holds every list against the answers.
///
/// # Errors
/// Settings that the bodies can't have.
pub fn check(
    shapes: &Shapes,
    frames: &[Bodies],
    answers: &[Answers],
    way: &CullSettings,
    tier: Tier,
    ledger: &mut Ledger,
) -> Result<(), RoundError> {
    let Some(first) = frames.first() else {
        return Ok(());
    };
    let settings = settings(way.strategy, way, first.len());
    let mut culler = Culler::new(&shapes.built, first, &settings, tier)?;
    for (n, (frame, answers)) in frames.iter().zip(answers).enumerate() {
        let (mut count, missed, extra) = compare(answers, &settings, &culler.cull(frame).sorted());
        if settings.strategy != Strategy::SDopTimeCritical {
            for pair in extra {
                let margin = u64::from(explained_by_margins(shapes, frame, &settings, pair)?);
                count.margin += margin;
                count.bound -= margin;
            }
        }
        ledger.count(&settings, &count);
        if let (Some(&pair), true) = (missed.first(), ledger.failures.len() < MOST_FAILURES) {
            ledger.failures.push(Failure {
                settings: settings.clone(),
                tier,
                shapes: shapes.built.clone(),
                frames: frames[..=n].to_vec(),
                pair,
            });
        }
    }
    Ok(())
}

/// Judges runs of frames and culls them in every way on each of `levels`.
///
/// # Errors
/// As [`check`], and poses outside the contract.
pub fn judge_and_check(
    shapes: &Shapes,
    runs: &[Vec<Bodies>],
    (k, axes): (DirectionSet, Axes),
    predicates: &[Predicate],
    tiers: &[Tier],
) -> Result<Ledger, RoundError> {
    let mut ledger = Ledger::default();
    for frames in runs {
        let judge = |frame| Answers::judge(shapes, frame, k, predicates);
        let answers: Vec<Answers> = frames.iter().map(judge).collect::<Result<_, _>>()?;
        answers.iter().for_each(|frame| ledger.note(frame));
        for (n, way) in ways(k, axes).iter().enumerate() {
            // Tiers are bit-identical (tested), so each way takes its turn on one of them.
            let tier = tiers[n % tiers.len().max(1)];
            check(shapes, frames, &answers, way, tier, &mut ledger)?;
        }
    }
    Ok(ledger)
}

/// What a seed draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A probe among partners that nearly touch it.
    Near,
    /// A crowd in a box, uniform.
    Random,
}

/// Partners of a near round's probe.
pub const PARTNERS: usize = 1024;

/// Bodies of a random round.
pub const CROWD: usize = 150;

/// One round: the frame of a seed for one or-DOP, judged by everything but the meshes.
///
/// # Errors
/// As [`judge_and_check`].
pub fn round(
    source: Source,
    seed: u64,
    (k, axes): (DirectionSet, Axes),
    tiers: &[Tier],
) -> Result<Ledger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(1 + source as u64);
    let shapes = forms::build(&pool(), 1, k, axes, &mut rng)?;
    let frame = match source {
        Source::Near => {
            let shape = seed as usize % shapes.built.len();
            probe(&shapes, &contacts(seed), shape, PARTNERS, &mut rng)
        }
        // About a tenth of the pairs' spheres overlap.
        Source::Random => crowd(&shapes, CROWD, 6.5, &mut rng),
    };
    let volumes = &Predicate::ALL[..7];
    judge_and_check(&shapes, &[vec![frame]], (k, axes), volumes, tiers)
}

/// Every procedural shape with a size of its own, and two about origins that are not their balls' centres.
fn pool() -> Vec<Form> {
    let mut forms: Vec<Form> = ProceduralShape::NAMES
        .iter()
        .map(|name| Form::of(name, [-1.0, 1.0]))
        .collect();
    for (name, offset) in [("l-shape", [0.7, -0.3, 0.4]), ("box", [13.1, 7.7, -5.3])] {
        forms.push(Form {
            radius: None,
            offset: Some(offset),
            ..Form::of(name, [0.0; 2])
        });
    }
    forms
}

/// Contacts of a near round: every other seed at the origin, the others up to 2²⁰ from it.
fn contacts(seed: u64) -> ContactSpec {
    ContactSpec {
        gap: [0.5, 4.0, 16.0][seed as usize % 3],
        origin: (seed % 2 == 1).then_some([0.0, 20.0]),
        ..ContactSpec::default()
    }
}

/// One group of hard cases in every way on each of `levels`, for one or-DOP.
///
/// # Errors
/// As [`judge_and_check`], and groups that can't be made.
pub fn group(
    group: &Group,
    (k, axes): (DirectionSet, Axes),
    tiers: &[Tier],
) -> Result<Ledger, RoundError> {
    let cases = group.cases(k, axes)?;
    judge_and_check(
        &cases.shapes,
        &cases.runs,
        (k, axes),
        &Predicate::ALL,
        tiers,
    )
}
