//! A comparison divided into units: counts, which depend only on the scene and can be taken on any
//! machine, and times, which need a machine without other load. Joined in their order, they give
//! the results of one process: the same counts to the bit, and the times of the machine that
//! measured them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use miette::IntoDiagnostic as _;
use serde::{Deserialize, Serialize};

use super::Estimate;
use super::budget::{self, BudgetRow, ClockRow, Window};
use super::counts::{Tally, share};
use super::density::{self, Density};
use super::interest::{self, InterestRow};
use super::pays::{self, Line, Point, Standing};
use super::result::{Tradeoff, VariantResult};
use super::timing::{PASSES, Windows};
use super::truth::{ExactJudge, NarrowPhase, Sample, samples};
use super::variant::{self, Variant};
use crate::cost::calibrate::CalibrationRound;
use crate::cost::pass::{Pass, medians, pass};
use crate::measure::conditions::Conditions;
use crate::measure::machine::Machine;
use crate::measure::turns::{FEWEST_TIMED_FRAMES, Regime};
use crate::scene::{Scene, SceneFile};
use crate::sweep::{Header, Sweep, digest};
use sdop::simd::Tier;

/// The name in its files.
pub const NAME: &str = "tradeoff";

/// Pairs on which the narrow phase is timed.
const CHECKED_PAIRS: usize = 2000;
/// How often a pass builds each variant.
const BUILDS: usize = 5;
/// Sample frames of a changed scene.
const CHANGED_SAMPLES: u32 = 6;

/// The amount of work.
#[derive(Clone, Debug)]
pub struct TradeoffPlan {
    /// Number of seeds from the scene's on, with one run each.
    pub seeds: u64,
    /// Judged frames per run.
    pub samples: u32,
    /// Consecutive frames for time-critical culling.
    pub window: u32,
    /// One in this number of them is judged.
    pub stride: usize,
    /// The SIMD tier.
    pub tier: Tier,
    /// The directory in which truths are stored.
    pub cache: Option<PathBuf>,
}

/// What is compared, how thoroughly, and on what kind of machine: times of different machines can't
/// be joined.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    scene: String,
    bodies: usize,
    frames: u32,
    seeds: Vec<u64>,
    samples: u32,
    window: u32,
    stride: usize,
    machine: Machine,
}

/// A comparison, ready to run.
pub struct Comparison {
    file: SceneFile,
    plan: TradeoffPlan,
    /// The scene of the first seed.
    scene: Scene,
    /// Mean sphere hits per frame.
    hits: f64,
    /// What is compared, then the interest sets.
    variants: Vec<Variant>,
    units: Vec<TradeoffUnit>,
}

/// One unit.
#[derive(Clone, Copy, Debug)]
enum TradeoffUnit {
    /// The variants.
    Compared,
    /// The truth of the run of a seed, and every variant's counts.
    Seed(u64),
    /// Time-critical culling by tests.
    Budgets,
    /// Every variant timed once, on the run of a seed.
    Pass(u64),
    /// The price of the exact narrow phase.
    NarrowPhase,
    /// Time-critical culling by the clock.
    Clock,
    /// The scene at a multiple of its density.
    Density(f32),
}

/// The results of units so far; those of one unit have one part.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Findings {
    compared: Option<ComparedVariants>,
    /// Counts of each variant, seed by seed.
    seeds: Vec<Vec<Tally>>,
    budgets: Vec<BudgetRow>,
    passes: Vec<Pass>,
    narrow_phase: Option<NarrowPhase>,
    clock: Vec<ClockRow>,
    densities: Vec<Density>,
}

/// The compared variants.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ComparedVariants {
    /// Mean sphere hits per frame.
    hits: f64,
    /// Their names, then those of the interest sets.
    names: Vec<String>,
    /// Volume / hull volume of each variant, without the interest sets.
    volumes: Vec<Option<f64>>,
    /// The interest sets' sizes.
    sets: Vec<usize>,
}

impl Comparison {
    /// Builds the scene and the comparison.
    ///
    /// # Errors
    /// The scene can't be built, run or culled.
    pub fn new(file: &SceneFile, plan: &TradeoffPlan) -> miette::Result<Self> {
        let mut file = file.clone();
        file.spec.frames = file.spec.frames.max(FEWEST_TIMED_FRAMES);
        let scene = Scene { construct_seconds: 0.0, ..file.build()? };
        let spheres = Variant::spheres(&scene.cull);
        let samples = samples(&scene, plan.samples)?;
        let hits = Tally::unjudged(&scene, &spheres, plan.tier, &samples)?.reported_a_frame();
        let mut variants = variant::all(&scene.cull, hits.round() as u64);
        variants.extend(interest::variants(&scene));
        Ok(Self {
            plan: plan.clone(),
            variants,
            units: units(&seeds(&file, plan)),
            file,
            scene,
            hits,
        })
    }

    /// The settings, of this machine.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let TradeoffPlan { samples, window, stride, tier, .. } = self.plan;
        Settings {
            scene: self.scene.name.clone(),
            bodies: self.scene.bodies.len(),
            frames: self.scene.frames,
            seeds: seeds(&self.file, &self.plan),
            samples,
            window,
            stride,
            machine: Machine::here(tier),
        }
    }

    /// What a unit finds: findings with one part.
    fn find(&self, unit: TradeoffUnit) -> miette::Result<Findings> {
        let (file, scene) = (&self.file, &self.scene);
        let TradeoffPlan { samples: count, window, stride, tier, ref cache, .. } = self.plan;
        let mut found = Findings::default();
        match unit {
            TradeoffUnit::Compared => {
                let (sets, own) = self.split();
                let volume = |variant| variant::tightness(variant, scene);
                found.compared = Some(ComparedVariants {
                    hits: self.hits,
                    names: self.variants.iter().map(|variant| variant.name.clone()).collect(),
                    volumes: own.iter().map(volume).collect(),
                    sets,
                });
            }
            TradeoffUnit::Seed(seed) => {
                let scene = with_seed(file, seed)?;
                let samples = samples(&scene, count)?;
                let truth = ExactJudge::new(&scene.shapes)?.truth(&samples, cache.as_deref())?;
                let tally = |variant| Tally::of(&scene, variant, tier, &samples, &truth);
                found.seeds.push(self.variants.iter().map(tally).collect::<Result<_, _>>()?);
            }
            TradeoffUnit::Budgets => {
                let judge = ExactJudge::new(&scene.shapes)?;
                let frames = first_frames(scene, window)?;
                let window = Window { frames: &frames, stride };
                found.budgets =
                    budget::by_tests(scene, tier, window, &judge, cache.as_deref(), self.hits)?;
            }
            TradeoffUnit::Pass(seed) => {
                let scene = with_seed(file, seed)?;
                let frames = &mut Windows::new(&scene, count)?;
                let built =
                    Some(CalibrationRound { builds: BUILDS, ..CalibrationRound::default() });
                found.passes.push(pass(&scene, &self.variants, tier, frames, built, &mut ())?);
            }
            TradeoffUnit::NarrowPhase => {
                let judge = ExactJudge::new(&scene.shapes)?;
                found.narrow_phase = Some(judge.price(scene, tier, CHECKED_PAIRS)?);
            }
            TradeoffUnit::Clock => {
                found.clock = budget::by_clock(scene, tier, window.min(scene.frames))?;
            }
            TradeoffUnit::Density(factor) => {
                let samples = count.min(CHANGED_SAMPLES);
                found.densities.extend(density::at(file, factor, tier, samples)?);
            }
        }
        Ok(found)
    }

    /// The interest sets' sizes, and all other variants.
    fn split(&self) -> (Vec<usize>, &[Variant]) {
        let sets = interest::sizes(&self.scene);
        let own = self.variants.len() - 2 * sets.len();
        (sets, &self.variants[..own])
    }
}

/// All units: first counts, then times.
fn units(seeds: &[u64]) -> Vec<TradeoffUnit> {
    // One pass per seed, and not too few.
    let passes = seeds.iter().cycle().take(seeds.len().max(PASSES));
    let mut units = vec![TradeoffUnit::Compared];
    units.extend(seeds.iter().copied().map(TradeoffUnit::Seed));
    units.push(TradeoffUnit::Budgets);
    units.extend(passes.copied().map(TradeoffUnit::Pass));
    units.extend([TradeoffUnit::NarrowPhase, TradeoffUnit::Clock]);
    units.extend(density::FACTORS.map(TradeoffUnit::Density));
    units
}

/// The runs' seeds, from the scene's on.
fn seeds(file: &SceneFile, plan: &TradeoffPlan) -> Vec<u64> {
    let seed = |number| file.spec.seed.wrapping_add(number);
    (0..plan.seeds.max(1)).map(seed).collect()
}

fn with_seed(file: &SceneFile, seed: u64) -> miette::Result<Scene> {
    let mut file = file.clone();
    file.spec.seed = seed;
    Ok(file.build()?)
}

/// Consecutive frames from the first on.
fn first_frames(scene: &Scene, count: u32) -> miette::Result<Vec<Sample>> {
    let scene = Scene { frames: count.min(scene.frames), ..scene.clone() };
    Ok(samples(&scene, count)?)
}

impl Sweep for Comparison {
    fn header(&self) -> miette::Result<Header> {
        let scene = ("scene".to_owned(), digest(&(&self.file.spec, &self.scene)));
        let inputs = BTreeMap::from([scene]);
        Header::new(NAME, &self.settings(), inputs, self.units.len()).into_diagnostic()
    }

    fn name(&self, unit: usize) -> String {
        match self.units[unit] {
            TradeoffUnit::Compared => "what is compared".to_owned(),
            TradeoffUnit::Seed(seed) => format!("truth and counts of seed {seed}"),
            TradeoffUnit::Budgets => "budgets of tests".to_owned(),
            TradeoffUnit::Pass(seed) => format!("times on seed {seed}"),
            TradeoffUnit::NarrowPhase => "times of the narrow phase".to_owned(),
            TradeoffUnit::Clock => "budgets of time".to_owned(),
            TradeoffUnit::Density(factor) => format!("{factor} times the density"),
        }
    }

    fn run(&self, unit: usize) -> miette::Result<String> {
        serde_json::to_string(&self.find(self.units[unit])?).into_diagnostic()
    }

    fn timed(&self, unit: usize) -> bool {
        use TradeoffUnit::{Budgets, Compared, Seed};
        !matches!(self.units[unit], Compared | Seed(_) | Budgets)
    }
}

impl Findings {
    /// Reads a unit's result; units come in their order.
    ///
    /// # Errors
    /// The text is not the result of a unit.
    pub fn take(&mut self, result: &str) -> miette::Result<()> {
        let found: Self = serde_json::from_str(result).into_diagnostic()?;
        self.compared = self.compared.take().or(found.compared);
        self.narrow_phase = self.narrow_phase.or(found.narrow_phase);
        self.seeds.extend(found.seeds);
        self.budgets.extend(found.budgets);
        self.passes.extend(found.passes);
        self.clock.extend(found.clock);
        self.densities.extend(found.densities);
        Ok(())
    }

    /// The comparison, with the command line that repeats it. `None` if units are missing or belong
    /// to another comparison. `before` are the machine's conditions at the start.
    #[must_use]
    pub fn finish(
        mut self,
        command: String,
        settings: Settings,
        before: Conditions,
    ) -> Option<Tradeoff> {
        let compared = self.compared.take()?;
        let variants = compared.names.len();
        let samples = self.seeds.first()?.first()?.frames as usize;
        let fits = self.seeds.iter().all(|tallies| tallies.len() == variants)
            && self.passes.iter().all(|pass| pass.culled.len() == variants)
            && variants == compared.volumes.len() + 2 * compared.sets.len();
        if !fits {
            return None;
        }
        let rows = self.rows(&compared);
        let cheapest = pays::envelope(&rows.iter().map(line).collect::<Vec<Line>>());
        let Settings { scene, bodies, frames, seeds, machine, .. } = settings;
        let spheres = self.seeds.iter().map(|tallies| &tallies[0]);
        let truth = spheres.map(|tally| tally.truth as f64 / f64::from(tally.frames));
        Some(Tradeoff {
            command,
            machine,
            conditions: before.after(rows.iter().map(VariantResult::seconds)),
            partners: 2.0 * compared.hits / bodies as f64,
            truth: Estimate::of(&truth.collect::<Vec<_>>()),
            interest: self.interest(&compared),
            scene,
            bodies,
            frames,
            samples,
            seeds,
            narrow_phase: self.narrow_phase.unwrap_or_default(),
            rows,
            cheapest,
            densities: self.densities,
            budgets: self.budgets,
            clock: self.clock,
        })
    }

    /// Every variant but the interest sets.
    fn rows(&self, compared: &ComparedVariants) -> Vec<VariantResult> {
        let named = compared.names.iter().zip(&compared.volumes).enumerate();
        let mut rows: Vec<VariantResult> =
            named.map(|(at, (name, volume))| self.row(at, name, *volume)).collect();
        let point = |row: &VariantResult| Point {
            times: row.times.clone(),
            precisions: row.precisions.clone(),
        };
        let points: Vec<Point> = rows.iter().map(point).collect();
        for (row, standing) in rows.iter_mut().zip(pays::standings(&points)) {
            row.standing = standing;
        }
        rows
    }

    fn row(&self, at: usize, name: &str, volume_over_hull: Option<f64>) -> VariantResult {
        let tallies = || self.seeds.iter().map(|tallies| &tallies[at]);
        let passes = || self.passes.iter().map(|pass| &pass.culled[at]);
        let over_seeds =
            |value: fn(&Tally) -> f64| Estimate::of(&tallies().map(value).collect::<Vec<_>>());
        let total = |count: fn(&Tally) -> u64| tallies().map(count).sum::<u64>();
        let built: Vec<f64> = passes().map(|culled| culled.construct).collect();
        VariantResult {
            name: name.to_owned(),
            reported: over_seeds(Tally::reported_a_frame),
            precision: over_seeds(|t| t.quality().precision),
            precisions: tallies().map(|t| t.quality().precision).collect(),
            per_true: over_seeds(|t| t.quality().per_true),
            recall: share(total(|t| t.found), total(|t| t.truth)),
            volume_over_hull,
            times: passes().map(|run| run.times.quartiles(Regime::Warm).median).collect(),
            construct: Some(Estimate::in_order(&built)),
            standing: Standing::Front,
            pairs_sha256: tallies().map(|t| t.pairs_sha256.clone()).collect(),
        }
    }

    /// The interest sets: counts of the first seed.
    fn interest(&self, compared: &ComparedVariants) -> Vec<InterestRow> {
        let (first, sets) = (compared.volumes.len(), &compared.sets);
        let row = |(number, &bodies): (usize, &usize)| {
            let [eager, lazy] = [first + number, first + sets.len() + number];
            let tally = &self.seeds[0][eager];
            InterestRow {
                bodies,
                tests: tally.counters.ordop.tests as f64 / f64::from(tally.frames),
                reported: tally.reported_a_frame(),
                quality: tally.quality(),
                seconds: medians(&self.passes, eager, Regime::Warm),
                lazy_seconds: medians(&self.passes, lazy, Regime::Warm),
            }
        };
        sets.iter().enumerate().map(row).collect()
    }
}

fn line(row: &VariantResult) -> Line {
    Line { name: row.name.clone(), times: row.times.clone(), pairs: row.reported.mean }
}
