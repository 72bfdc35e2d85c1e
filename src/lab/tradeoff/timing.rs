//! Time: the formula's prices for each variant, and its nanoseconds a frame measured beside all others.
//!
//! Prices come from [`calibrate`](crate::lab::cost::calibrate), that is from other runs; hull prices are measured on the same
//! resampled scenes. What is measured here is whole frames, all variants in turns on the same poses.

use serde::{Deserialize, Serialize};

use super::contender::{Contender, HullTest};
use super::counts::Tally;
use super::truth::Sample;
use super::variant::Variant;
use crate::lab::cost::VolumeCosts;
use crate::lab::cost::calibrate::{Effort, calibrate, scenes};
use crate::lab::cost::predict::{Prices, Volume};
use crate::lab::measure::turns::{median, time};
use crate::lab::random::Stream;
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::pairs::PairList;
use crate::settings::{CullSettings, SettingsError, Strategy, Updates};
use crate::simd::Tier;

/// Where the draws of the order of turns start.
const SEED: u64 = 0x5a3e_7100_0000_0000;

/// Median seconds a frame of each variant. Each repeats every sample `repeats` times, in another order each time: whoever
/// always followed the same one would always find the caches and clocks that it leaves.
///
/// # Errors
/// Settings that can't be carried out.
pub fn measure(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    samples: &[Sample],
    repeats: u32,
    mut done: impl FnMut(),
) -> Result<Vec<f64>, SettingsError> {
    let mut contenders = variants
        .iter()
        .map(|variant| Contender::new(scene, variant, tier))
        .collect::<Result<Vec<_>, _>>()?;
    let mut seconds = vec![Vec::new(); contenders.len()];
    let mut order: Vec<usize> = (0..contenders.len()).collect();
    for (turn, sample) in samples.iter().enumerate() {
        shuffle(&mut order, turn as u64);
        for &at in &order {
            // The first of a variant's repeats finds caches that the others left, as a frame finds those of the simulation.
            for _ in 0..repeats {
                contenders[at].frame(&sample.bodies);
                seconds[at].push(contenders[at].seconds());
            }
            done();
        }
    }
    Ok(seconds.into_iter().map(median).collect())
}

fn shuffle(order: &mut [usize], stream: u64) {
    let mut draws = Stream::new(SEED, stream);
    for last in (1..order.len()).rev() {
        order.swap(last, draws.index(last as u32 + 1) as usize);
    }
}

/// Counts and prices of one volume of a variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VolumeTerms {
    /// The volume.
    pub name: String,
    /// Updates a frame.
    pub nu: f64,
    /// Tests a frame.
    pub nv: f64,
    /// Hits a frame.
    pub hits: f64,
    /// Seconds an update.
    pub cu: f64,
    /// Seconds a test, with hits and misses mixed as here.
    pub cv: f64,
    /// Seconds of pair finding a frame.
    pub finding: f64,
    /// Seconds of construction, once.
    pub co: f64,
}

impl VolumeTerms {
    /// The recurring part of T, seconds a frame.
    #[must_use]
    pub fn recurring(&self) -> f64 {
        self.nu * self.cu + self.nv * self.cv + self.finding
    }
}

/// Prices of the volumes of one variant.
#[derive(Clone, Debug)]
pub struct VariantPrices {
    volumes: Prices,
    hulls: Option<VolumeCosts>,
}

impl VariantPrices {
    /// The formula's terms for counts on sample frames.
    #[must_use]
    pub fn terms(&self, variant: &Variant, tally: &Tally, bodies: usize) -> Vec<VolumeTerms> {
        let frames = f64::from(tally.frames);
        let term = |name: &str,
                    costs: &VolumeCosts,
                    counters: crate::counters::VolumeCounters,
                    finding| {
            VolumeTerms {
                name: name.to_owned(),
                nu: counters.updates as f64 / frames,
                nv: counters.tests as f64 / frames,
                hits: counters.hits as f64 / frames,
                cu: costs.update,
                cv: costs.test(&counters) / counters.tests.max(1) as f64,
                finding,
                co: costs.construct,
            }
        };
        let mut terms: Vec<VolumeTerms> = Volume::of(variant.settings.strategy)
            .iter()
            .map(|&volume| {
                let costs = self.volumes.get(volume);
                let finding = costs.frame + costs.body * bodies as f64;
                term(
                    volume.name(),
                    &costs,
                    volume.counters(&tally.counters),
                    finding,
                )
            })
            .collect();
        terms.extend(
            self.hulls
                .map(|costs| term("hull", &costs, tally.hulls, 0.0)),
        );
        terms
    }
}

/// Prices of every variant; variants that share volumes share their prices.
///
/// # Errors
/// Settings that can't be carried out, effects that can't be simulated.
pub fn prices(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    effort: Effort,
    mut done: impl FnMut(),
) -> Result<Vec<VariantPrices>, SimulationError> {
    let mut known: Vec<(CullSettings, Prices)> = Vec::new();
    let mut all = Vec::new();
    for variant in variants {
        let settings = priced_as(&variant.settings);
        let found = known.iter().find(|(other, _)| *other == settings);
        let volumes = match found {
            Some((_, prices)) => prices.clone(),
            None => {
                let variant = Variant {
                    settings: settings.clone(),
                    ..variant.clone()
                };
                let strategies = [settings.strategy];
                let prices = calibrate(&variant.apply(scene), &strategies, tier, effort, |_| ())?;
                known.push((settings, prices.clone()));
                prices
            }
        };
        all.push(VariantPrices {
            volumes,
            hulls: if variant.hulls {
                Some(hull_prices(scene, tier)?)
            } else {
                None
            },
        });
        done();
    }
    Ok(all)
}

/// The settings whose volumes cost the same: all kinds of S-DOP test the same pairs of the same or-DOPs.
fn priced_as(settings: &CullSettings) -> CullSettings {
    let strategy = match settings.strategy {
        Strategy::SDopBatch
        | Strategy::SDopObjectOfInterest
        | Strategy::SDopTimeCritical
        | Strategy::SDopSequential => Strategy::SDopSequential,
        other => other,
    };
    CullSettings {
        strategy,
        updates: Updates::Eager,
        interest: None,
        budget: None,
        ..settings.clone()
    }
}

/// Hull prices on the calibration scenes: hits and misses are timed apart, so nothing needs fitting.
fn hull_prices(scene: &Scene, tier: Tier) -> Result<VolumeCosts, SettingsError> {
    let [mut misses, mut hits] = [(0.0, 0.0); 2];
    let mut hulls = HullTest::new(scene);
    for crowd in scenes(scene) {
        let mut culler = Contender::new(&crowd, &Variant::spheres(&scene.cull), tier)?;
        let listed = culler.frame(&crowd.bodies);
        hulls.cull(&crowd.bodies, listed);
        let kept = hulls.kept.clone();
        let kept_sorted = kept.sorted();
        let missed: PairList = listed
            .iter()
            .filter(|pair| kept_sorted.binary_search(pair).is_err())
            .collect();
        for (pairs, (seconds, count)) in [(&missed, &mut misses), (&kept, &mut hits)] {
            *seconds += time(3, || hulls.cull(&crowd.bodies, pairs));
            *count += pairs.len() as f64;
        }
    }
    let each = |(seconds, count): (f64, f64)| if count > 0.0 { seconds / count } else { 0.0 };
    Ok(VolumeCosts {
        construct: time(1, || HullTest::new(scene)),
        hit: each(hits),
        miss: each(misses),
        ..VolumeCosts::default()
    })
}

/// Means over seeds of each volume's terms.
#[must_use]
pub fn mean(runs: &[Vec<VolumeTerms>]) -> Vec<VolumeTerms> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    (0..first.len())
        .map(|at| {
            let over = |term: fn(&VolumeTerms) -> f64| {
                runs.iter().map(|run| term(&run[at])).sum::<f64>() / runs.len() as f64
            };
            VolumeTerms {
                name: first[at].name.clone(),
                nu: over(|t| t.nu),
                nv: over(|t| t.nv),
                hits: over(|t| t.hits),
                cu: over(|t| t.cu),
                cv: over(|t| t.cv),
                finding: over(|t| t.finding),
                co: over(|t| t.co),
            }
        })
        .collect()
}
