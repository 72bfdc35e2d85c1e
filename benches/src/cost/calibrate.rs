//! Calibration: Cu, Cv, Co and F of every volume, measured on [calibration scenes](super::design).
//!
//! A round measures all calibration scenes, in an order in which consecutive ones differ much in
//! size, so that a drift of the machine doesn't look like a price. All variants take turns on the
//! same frames. [`explain`](mod@super::explain) then explains each stage's seconds by its counts.
//! Dividing a run's own seconds by its own counts would be no prediction.

use super::construct::volume_seconds;
use super::design::{self, DENSITIES, SCENE_STEP, SCENES};
use super::expected;
use super::explain::{self, Round, TurnObservation, VariantTurns};
use super::hit_premium::HitPremium;
use super::level::CacheLevel;
use super::predict::Prices;
use crate::measure::counts::Counts;
use crate::measure::culling::Culling;
use crate::measure::turns::{FrameTimes, Regime, Turns, median, next_turn, turn_frames};
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::contestant::Contestant;

/// The calibration scene with the most pairs, on which hits and misses are distinguished.
const MOST_PAIRS: usize = SCENES - 1;

/// The amount of calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Effort {
    /// Turns of each calibration scene in a round.
    pub turns: usize,
    /// How often volumes and cullers are built in a pass, to measure Co; calibration builds cullers
    /// in each turn.
    pub builds: usize,
}

/// A variant, its constant data, and its observations in a round.
struct PreparedVariant {
    variant: Variant,
    shapes: Vec<Shape>,
    /// Seconds that each of its volumes takes for all shapes, in some turns.
    volumes: Vec<Vec<f64>>,
    observed: [Vec<TurnObservation>; 2],
    splits: Vec<HitPremium>,
}

impl PreparedVariant {
    fn new(variant: &Variant, scene: &Scene) -> Self {
        Self {
            shapes: variant.shapes(scene),
            variant: variant.clone(),
            volumes: Vec::new(),
            observed: [Vec::new(), Vec::new()],
            splits: Vec::new(),
        }
    }

    fn calibrated(&self, regime: usize) -> VariantTurns<'_> {
        let volumes = self.variant.volumes().len();
        let built = |volume| median(self.volumes.iter().map(|turn| turn[volume]).collect());
        VariantTurns {
            variant: &self.variant,
            turns: &self.observed[regime],
            built: (0..volumes).map(built).collect(),
            splits: &self.splits,
        }
    }
}

/// What a round of calibration found.
#[derive(Clone, Debug, Default)]
pub struct CalibrationRound {
    /// The prices of each variant for warm and for cold frames; empty without a calibration.
    pub prices: [Vec<Prices>; 2],
    /// How often a pass measures Co, once at least.
    pub builds: usize,
}

/// The calibration of some variants for scenes of one kind.
pub struct Calibration {
    /// The variants, followed by those whose prices they share.
    prepared: Vec<PreparedVariant>,
    variants: usize,
    spheres: usize,
    subjects: Vec<(Scene, Trajectory)>,
    turns: Turns,
    tier: Tier,
    level: CacheLevel,
    effort: Effort,
}

impl Calibration {
    /// Prepares the calibration scenes. Spheres alone are always calibrated, and or-DOPs after
    /// spheres whenever they refine: their prices are the same for every strategy.
    ///
    /// # Errors
    /// The effects can't be simulated.
    pub fn new(
        scene: &Scene,
        variants: &[Variant],
        tier: Tier,
        effort: Effort,
    ) -> Result<Self, SimulationError> {
        let spheres = Variant::spheres(&scene.cull);
        let mut all = variants.to_vec();
        let shared =
            std::iter::once(spheres.clone()).chain(variants.iter().filter_map(explain::anchor));
        for variant in shared {
            if all.iter().all(|known| !is_same(known, &variant)) {
                all.push(variant);
            }
        }
        let subject = |scene: Scene| {
            let trajectory = Trajectory::new(&scene)?.with_frames(u32::MAX);
            Ok((scene, trajectory))
        };
        Ok(Self {
            prepared: all.iter().map(|variant| PreparedVariant::new(variant, scene)).collect(),
            variants: variants.len(),
            spheres: all.iter().position(|one| is_same(one, &spheres)).unwrap_or(0),
            subjects: design::scenes(scene).map(subject).collect::<Result<_, SimulationError>>()?,
            turns: Turns::from_stream(1),
            tier,
            level: CacheLevel::of(scene.bodies.len()),
            effort,
        })
    }

    /// Runs a round.
    ///
    /// # Errors
    /// The settings can't be carried out, or a body leaves the contract.
    pub fn round(&mut self) -> Result<CalibrationRound, SimulationError> {
        for prepared in &mut self.prepared {
            prepared.observed.iter_mut().for_each(Vec::clear);
            prepared.splits.clear();
            prepared.volumes.clear();
        }
        for number in 0..SCENES * self.effort.turns {
            self.turn(number * SCENE_STEP % SCENES)?;
        }
        let round = Round { lanes: expected::lanes(self.tier), level: self.level };
        let prices = std::array::from_fn(|regime| {
            let all: Vec<_> = self.prepared.iter().map(|one| one.calibrated(regime)).collect();
            let mut prices = explain::prices(&all, round);
            prices.truncate(self.variants);
            prices
        });
        Ok(CalibrationRound { prices, builds: self.effort.builds })
    }

    /// One turn of one calibration scene.
    fn turn(&mut self, subject: usize) -> Result<(), SimulationError> {
        let (scene, trajectory) = &mut self.subjects[subject];
        let frames = turn_frames(scene.bodies.len());
        let poses = next_turn(trajectory, frames)?;
        let mut cullers = Vec::new();
        for prepared in &mut self.prepared {
            // Shapes are the same in all scenes.
            if subject < DENSITIES {
                let seconds = volume_seconds(&prepared.variant, &prepared.shapes);
                prepared.volumes.push(seconds);
            }
            let variant = design::adapted(&prepared.variant, scene.bodies.len());
            cullers.push(variant.culling_of(&prepared.shapes, scene, self.tier)?);
        }
        // Before the first timed frame, all cullers run on other poses: so buffers have grown, and
        // the frame is cold.
        cullers.iter_mut().for_each(|culler| culler.frame(&scene.bodies));
        let before: Vec<Counts> = cullers.iter().map(Culling::counts).collect();
        let mut times = vec![FrameTimes::default(); cullers.len()];
        self.turns.round(&mut cullers, &poses, |timed| times[timed.number].push(&timed));
        let listed = cullers[self.spheres].pairs();
        for (at, prepared) in self.prepared.iter_mut().enumerate() {
            let observed = TurnObservation {
                bodies: scene.bodies.len(),
                frames: poses.len(),
                counts: cullers[at].counts().since(&before[at]),
                stages: Default::default(),
                construct: cullers[at].construct,
            };
            for (&regime, all) in Regime::ALL.iter().zip(&mut prepared.observed) {
                let stages = times[at].medians(regime);
                all.push(TurnObservation { stages, ..observed });
            }
            if subject == MOST_PAIRS {
                let kept = cullers[at].pairs();
                let split = HitPremium::of(
                    &prepared.variant,
                    &prepared.shapes,
                    &poses[poses.len() - 1],
                    self.tier,
                    [&listed, &kept],
                );
                prepared.splits.extend(split);
            }
        }
        Ok(())
    }
}

/// Whether two variants cull in the same way; names don't count.
fn is_same(one: &Variant, other: &Variant) -> bool {
    (&one.settings, one.hulls) == (&other.settings, other.hulls)
}
