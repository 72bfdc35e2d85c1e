//! Times a program and our culler on the same frames: first both are judged, then they take turns
//! and each frame is timed.
//!
//! Our culler is timed from outside, around its call. A program's time is what it reports as `ns`
//! (*self-reported*), because a time measured from outside would include its pipes and its parser.
//! If it also reports `nu` and `nv`, its counts get terms of the formula by
//! [our prices](OwnPrices).

use std::time::Instant;

use serde::Serialize;

use crate::cost::calibrate::{Calibration, Effort};
use crate::cost::pass::{SceneFrames, pass};
use crate::cost::table;
use crate::effects::EffectError;
use crate::measure::turns::Regime;
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::bodies::Aabb;
use sdop::bodies::contract::ContractError;
use sdop::boxes::BoxCuller;
use sdop::culler::{CullError, Culler};
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Tier;
use sdop_judge::answer::{Answer, StopReason};
use sdop_judge::case::{Case, Frame};
use sdop_judge::claim::Claim;
use sdop_judge::contestant::WorldBox;
use sdop_judge::score::{Outcome, judge_answers};
use sdop_judge::subject::Subject;
use sdop_judge::truth::reference_shapes::InvalidInput;

/// Why nothing was timed.
#[derive(Debug, thiserror::Error)]
pub enum TimingError {
    /// An effect that the scene can't have.
    #[error(transparent)]
    Effect(#[from] EffectError),
    /// A body left the contract.
    #[error(transparent)]
    Contract(#[from] ContractError),
    /// A frame that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// Bodies that our culler refuses.
    #[error(transparent)]
    Cull(#[from] CullError),
}

/// One contestant's line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContestantTiming {
    /// The program's name.
    pub name: String,
    /// How its answers were judged, on every frame.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Pairs reported, over all frames.
    pub reported: u64,
    /// Which side measured the time.
    pub clock: &'static str,
    /// Median over all frames and rounds but the first frame of each, in nanoseconds; none for
    /// answers without a time, and unless all of them passed.
    pub median_ns: Option<u64>,
    /// Nu and Nv, means per frame; none if an answer has no counts.
    pub counts: Option<[f64; 2]>,
}

/// What frames of a scene cost us by the formula, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OwnPrices {
    /// Cu, summed over our volumes.
    pub update: f64,
    /// Cv of a hit, of the volume that decides.
    pub hit: f64,
    /// Cv of a miss.
    pub miss: f64,
    /// Our own terms in the mean frame: Nu·Cu, F and Nv·Cv.
    pub terms: [f64; 3],
}

impl OwnPrices {
    /// The prices of a strategy, calibrated for a scene, and its terms in the scene's first frames.
    /// `None` if they can't be timed.
    ///
    /// # Errors
    /// Settings that the scene can't have; a body that leaves the contract.
    pub fn of(
        scene: &Scene,
        strategy: Strategy,
        frames: u32,
    ) -> Result<Option<Self>, SimulationError> {
        let effort = Effort { turns: 1, builds: 1 };
        let settings = CullSettings { pairs: Finder::Auto, ..scene.cull.clone() };
        let (tier, variants) = (Tier::detect(), [Variant::strategy(&settings, strategy)]);
        let round = Calibration::new(scene, &variants, tier, effort)?.round()?;
        let volumes = round.prices[Regime::Warm as usize].first().map(|it| it.volumes.clone());
        let mut run = SceneFrames::new(scene, frames)?;
        let pass = pass(scene, &variants, tier, &mut run, Some(round), &mut ())?;
        let passes = (&[&pass][..], &[&pass][..]);
        let of = (scene.name.as_str(), scene.bodies.len());
        let cost = table::cost(of, (0, &variants[0]), passes, Regime::Warm);
        Ok(volumes.zip(cost).and_then(|(volumes, cost)| {
            let deciding = volumes.last()?.costs;
            Some(Self {
                update: volumes.iter().map(|volume| volume.costs.update).sum(),
                hit: deciding.hit,
                miss: deciding.miss,
                terms: [cost.sum(|t| t.update), cost.sum(|t| t.finding), cost.sum(|t| t.test)],
            })
        }))
    }

    /// Nu·Cu and Nv·Cv of another culler's counts and reported pairs per frame.
    #[must_use]
    pub fn of_counts(&self, [nu, nv]: [f64; 2], reported: f64) -> [f64; 2] {
        [nu * self.update, reported * self.hit + (nv - reported).max(0.0) * self.miss]
    }
}

/// The frames of a scene as a case of a claim.
///
/// # Errors
/// Effects that the scene can't have, a body that leaves the contract.
pub fn frames(scene: &Scene, count: u32, claim: Claim) -> Result<Case, TimingError> {
    let mut effects = scene.start_effects()?;
    let mut bodies = scene.bodies.clone();
    let mut frames = Vec::new();
    for number in 0..count {
        if number > 0 {
            effects.step(&mut bodies)?;
        }
        frames.push(Frame::fitted(bodies.clone(), &scene.shapes));
    }
    Ok(Case {
        name: scene.name.clone(),
        flag: String::new(),
        source: "a scene".to_owned(),
        claim,
        claims: Claim::PLAIN.to_vec(),
        shapes: scene.shapes.clone(),
        frames,
    })
}

/// Our strategy for a claim; none for given boxes, which a `BoxCuller` gets.
#[must_use]
pub fn strategy(claim: Claim) -> Option<Strategy> {
    match claim {
        Claim::Sphere => Some(Strategy::Sphere),
        Claim::OrDop => Some(Strategy::OrDop),
        Claim::Hull | Claim::Mesh => Some(Strategy::SDopSequential),
        _ => None,
    }
}

/// Our culler of given boxes over the frames, each with its time.
fn boxes(case: &Case) -> Result<Vec<Answer>, CullError> {
    let mut culler = BoxCuller::new();
    let mut answers = Vec::new();
    for frame in &case.frames {
        let corners = |&[a, b, c, d, e, f]: &WorldBox| Aabb::new([a, b, c], [d, e, f]);
        let given: Vec<Aabb> = frame.boxes.iter().map(corners).collect();
        let start = Instant::now();
        culler.cull(&given)?;
        let ns = start.elapsed().as_nanos() as u64;
        let is_pair =
            |pair: &[u32; 2]| pair.iter().any(|&body| frame.bodies.dynamic[body as usize]);
        let pairs = culler.pairs().sorted().into_iter().filter(is_pair).collect();
        answers.push(Answer { pairs, ns: Some(ns), ..Answer::default() });
    }
    Ok(answers)
}

/// What tables call ours.
pub(crate) fn own_name(claim: Claim) -> String {
    format!("sdop {}", strategy(claim).map_or("BoxCuller", Strategy::name))
}

/// Our culler over the frames, each with its time.
pub(crate) fn ours(case: &Case) -> Result<Vec<Answer>, CullError> {
    let Some(strategy) = strategy(case.claim) else {
        return boxes(case);
    };
    let Some(first) = case.frames.first() else {
        return Ok(Vec::new());
    };
    let mut culler = Culler::builder().strategy(strategy).build(&case.shapes, &first.bodies)?;
    let counts = |culler: &Culler| {
        let volumes = || strategy.scheme().volumes().map(|volume| *culler.counters().of(volume));
        [volumes().map(|v| v.updates).sum::<u64>(), volumes().map(|v| v.tests).sum::<u64>()]
    };
    let (mut answers, mut before) = (Vec::new(), [0, 0]);
    for frame in &case.frames {
        let start = Instant::now();
        culler.cull(&frame.bodies)?;
        let ns = start.elapsed().as_nanos() as u64;
        let now = counts(&culler);
        let [nu, nv] = [0, 1].map(|at| Some(now[at] - before[at]));
        answers.push(Answer { pairs: culler.pairs().sorted(), ns: Some(ns), nu, nv });
        before = now;
    }
    Ok(answers)
}

/// Judges both on every frame, then has them take turns for so many rounds.
///
/// # Errors
/// A frame that the reference or our culler refuses.
pub fn compare(
    name: &str,
    subject: &dyn Subject,
    case: &Case,
    rounds: u32,
) -> Result<Vec<ContestantTiming>, TimingError> {
    let mut theirs = TimedContestant::new(name.to_owned(), "self-reported");
    let mut own = TimedContestant::new(own_name(case.claim), "wall, around the call");
    for round in 0..rounds {
        own.add(case, Ok(ours(case)?), round == 0)?;
        if theirs.outcome == Outcome::Pass {
            theirs.add(case, subject.answer(case), true)?;
        }
    }
    Ok([own, theirs].map(TimedContestant::timing).into())
}

/// A contestant between its turns.
struct TimedContestant {
    name: String,
    clock: &'static str,
    outcome: Outcome,
    reported: u64,
    counts: Option<[f64; 2]>,
    times: Vec<u64>,
}

impl TimedContestant {
    fn new(name: String, clock: &'static str) -> Self {
        Self { name, clock, outcome: Outcome::Pass, reported: 0, counts: None, times: Vec::new() }
    }

    fn add(
        &mut self,
        case: &Case,
        answers: Result<Vec<Answer>, StopReason>,
        judged: bool,
    ) -> Result<(), InvalidInput> {
        let answers = match answers {
            Ok(answers) => answers,
            Err(StopReason::Skipped { why, .. }) => {
                self.outcome = Outcome::Skipped { why };
                return Ok(());
            }
            Err(StopReason::Trouble(trouble)) => {
                self.outcome = Outcome::Error { trouble };
                return Ok(());
            }
        };
        if judged {
            self.outcome = judge_answers(case, &answers)?.outcome;
        }
        self.reported = answers.iter().map(|answer| answer.pairs.len() as u64).sum();
        let sum =
            |count: fn(&Answer) -> Option<u64>| answers.iter().map(count).sum::<Option<u64>>();
        let per_frame = |sum: u64| sum as f64 / answers.len().max(1) as f64;
        self.counts = sum(|a| a.nu).zip(sum(|a| a.nv)).map(|(nu, nv)| [nu, nv].map(per_frame));
        // The first frame builds what later ones keep.
        self.times.extend(answers.iter().skip(1).filter_map(|answer| answer.ns));
        Ok(())
    }

    fn timing(mut self) -> ContestantTiming {
        self.times.sort_unstable();
        let passed = self.outcome == Outcome::Pass;
        ContestantTiming {
            median_ns: self.times.get(self.times.len() / 2).copied().filter(|_| passed),
            name: self.name,
            outcome: self.outcome,
            reported: self.reported,
            counts: self.counts,
            clock: self.clock,
        }
    }
}
