//! Time-critical culling: precision against the budget, for each order of refinement.
//!
//! A budget of tests gives reproducible counts; a budget of microseconds shows how far it is
//! exceeded. A pair that passes the sphere test but isn't refined within the budget has an age: the
//! frames since it was last refined, or since its spheres first met.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::counts::{share, shared};
use super::interest::spread;
use super::truth::{ExactJudge, Sample};
use super::variant::Variant;
use crate::cost::pass::{SceneFrames, VariantRun, pass};
use crate::measure::turns::{Regime, median};
use crate::percentiles::Percentiles;
use crate::remedy::OrReport as _;
use crate::scene::Scene;
use sdop::culler::Culler;
use sdop::settings::{Budget, CullSettings, Interest, Order, Strategy, Updates};
use sdop::simd::Tier;

/// Budgets as shares of the cost of refining all pairs.
const SHARES: [f64; 7] = [0.0, 0.125, 0.25, 0.5, 0.75, 1.0, 1.25];

/// One order with one budget of tests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BudgetRow {
    /// Order of refinement.
    pub order: Order,
    /// Tests per frame.
    pub tests: u64,
    /// Refined pairs / pairs whose spheres overlap.
    pub refined: f64,
    /// True pairs / reported pairs, in the frames with a truth.
    pub precision: f64,
    /// True pairs found / true pairs.
    pub recall: f64,
    /// Mean age, in frames, of the pairs that are not refined in a frame.
    pub mean_age: f64,
    /// The largest age.
    pub oldest: u32,
}

/// How far a budget of time is exceeded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClockRow {
    /// The budget in microseconds per frame, from the start of the strategy.
    pub microseconds: u64,
    /// Refined pairs / pairs whose spheres overlap.
    pub refined: f64,
    /// Median of the time past the budget in microseconds; negative if the budget isn't used up.
    pub p50: f64,
    /// 99th percentile of that time.
    pub p99: f64,
}

/// Poses of consecutive frames, some with the truth.
#[derive(Clone, Copy, Debug)]
pub struct Window<'a> {
    /// Consecutive frames.
    pub frames: &'a [Sample],
    /// One in this number of frames is judged.
    pub stride: usize,
}

/// Measures every order with every budget. `tests` is the mean number of sphere hits per frame.
///
/// # Errors
/// Culling or judging fails.
pub fn by_tests(
    scene: &Scene,
    tier: Tier,
    window: Window<'_>,
    judge: &ExactJudge,
    cache: Option<&std::path::Path>,
    tests: f64,
) -> miette::Result<Vec<BudgetRow>> {
    let judged: Vec<Sample> = window.frames.iter().step_by(window.stride).cloned().collect();
    let truth = judge.truth(&judged, cache)?;
    let mut rows = Vec::new();
    for &order in Order::ALL {
        for share in SHARES {
            let budget = (share * tests).round() as u64;
            let settings = settings(scene, Budget::Tests(budget), order);
            rows.push(row(scene, &settings, tier, window, &truth)?);
        }
    }
    Ok(rows)
}

fn settings(scene: &Scene, budget: Budget, order: Order) -> CullSettings {
    let own = &scene.cull;
    // A tenth of the bodies: with only one, a few pairs in a thousand would come first, and no row
    // would show it.
    let bodies = scene.bodies.len();
    CullSettings {
        strategy: Strategy::SDopTimeCritical,
        updates: Updates::Eager,
        budget: Some(budget),
        interest: Some(Interest::Bodies(spread(bodies, bodies.div_ceil(10)))),
        order,
        ..own.clone()
    }
}

fn row(
    scene: &Scene,
    settings: &CullSettings,
    tier: Tier,
    window: Window<'_>,
    truth: &[Vec<[u32; 2]>],
) -> miette::Result<BudgetRow> {
    let mut culler = Culler::builder()
        .settings(settings)
        .tier(tier)
        .build(&scene.shapes, &scene.bodies)
        .or_report()?;
    let mut starved = Starvation::default();
    let (mut reported, mut found, mut true_pairs) = (0, 0, 0);
    let mut truth = truth.iter();
    for (number, sample) in window.frames.iter().enumerate() {
        let before = culler.counters().untested;
        let pairs = culler.cull(&sample.bodies).or_report()?;
        if number % window.stride == 0
            && let Some(truth) = truth.next()
        {
            let pairs = pairs.sorted();
            reported += pairs.len() as u64;
            found += shared(&pairs, truth);
            true_pairs += truth.len() as u64;
        }
        let untested = (culler.counters().untested - before) as usize;
        starved.frame(sample.frame, culler.potentially_colliding(), untested);
    }
    let counters = culler.counters();
    Ok(BudgetRow {
        order: settings.order,
        tests: match settings.budget {
            Some(Budget::Tests(tests)) => tests,
            _ => 0,
        },
        refined: share(counters.ordop.tests, counters.sphere.hits),
        precision: share(found, reported),
        recall: share(found, true_pairs),
        mean_age: starved.sum as f64 / starved.count.max(1) as f64,
        oldest: starved.oldest,
    })
}

/// Ages of unrefined pairs.
#[derive(Default)]
struct Starvation {
    /// For each pair of the last frame: when it was last refined, or first listed.
    since: HashMap<[u32; 2], u32>,
    sum: u64,
    count: u64,
    oldest: u32,
}

impl Starvation {
    /// Adds one frame's pairs in the order of refinement; the last `untested` were not refined.
    fn frame(
        &mut self,
        frame: u32,
        pairs: impl ExactSizeIterator<Item = [u32; 2]>,
        untested: usize,
    ) {
        let refined = pairs.len() - untested;
        let before = std::mem::take(&mut self.since);
        for (place, pair) in pairs.enumerate() {
            let since =
                if place < refined { frame } else { before.get(&pair).copied().unwrap_or(frame) };
            if place >= refined {
                // A pair that is listed for the first time has the age 1.
                let age = frame - since + 1;
                self.sum += u64::from(age);
                self.count += 1;
                self.oldest = self.oldest.max(age);
            }
            self.since.insert(pair, since);
        }
    }
}

/// Measures budgets of time: shares of the median seconds of culling without a budget after its
/// updates. All budgets take turns on the scene's first `frames` frames. The result is empty if a
/// run is too short for a warm frame.
///
/// # Errors
/// The settings can't be carried out.
pub fn by_clock(scene: &Scene, tier: Tier, frames: u32) -> miette::Result<Vec<ClockRow>> {
    let variant = |budget| Variant::of(String::new(), settings(scene, budget, Order::AsFound));
    let culled = |budgets: &[Budget]| -> miette::Result<Vec<VariantRun>> {
        let variants: Vec<Variant> = budgets.iter().copied().map(variant).collect();
        let mut frames = SceneFrames::new(scene, frames)?;
        let pass = pass(scene, &variants, tier, &mut frames, None, &mut ())?;
        Ok(pass.culled)
    };
    let spent = |culled: &VariantRun| -> Vec<f64> {
        let warm = culled.times.of(Regime::Warm).iter();
        warm.map(|s| 1e6 * (s.finding + s.refining)).collect()
    };
    let whole = median(culled(&[Budget::Tests(u64::MAX)])?.iter().flat_map(spent).collect());
    let microseconds = SHARES.map(|share| (share * whole).round() as u64);
    let row = |(microseconds, culled): (u64, VariantRun)| {
        let times = spent(&culled);
        if times.is_empty() {
            return None;
        }
        let Percentiles { p50, p99, .. } = Percentiles::of(times);
        let counters = culled.counts.culler;
        Some(ClockRow {
            microseconds,
            refined: counters.ordop.tests as f64 / counters.sphere.hits.max(1) as f64,
            p50: p50 - microseconds as f64,
            p99: p99 - microseconds as f64,
        })
    };
    let culled = culled(&microseconds.map(Budget::Microseconds))?;
    Ok(microseconds.into_iter().zip(culled).filter_map(row).collect())
}
