//! Prices from observed turns: each stage's seconds explained by its counts.
//!
//! An update stage follows Nu; finding follows frames, bodies, misses and hits; the second test
//! follows its tests. Prices are therefore marginal: a hit costs what one more hit costs among the
//! misses around it, with the vector of lanes that it keeps busy. A second test always sees about
//! the same share of hits, so that no choice of scenes could tell the price of a hit from that of a
//! miss: lists of known shares do ([`Split`]), and the frames themselves set the level.

use super::VolumeCosts;
use super::fit::{self, Measurement};
use super::predict::{Price, Prices};
use crate::hull_test::HullTest;
use crate::measure::counts::{Counts, Volume};
use crate::measure::culling::Stages;
use crate::measure::turns::time;
use crate::measure::variant::Variant;
use crate::random::Stream;
use sdop::bodies::Bodies;
use sdop::overlap::ordop::PosedOrDops;
use sdop::pairs::PairList;
use sdop::simd::Tier;
use sdop::volume::Shape;

/// Where the draws of lists with a known share of hits start.
const SEED: u64 = 0xca11_b8a7_e001_0000;
/// How often such a list is timed.
const REPEATS: usize = 5;
/// Fewer pairs tell nothing.
const FEWEST: usize = 32;

/// One turn of one calibration scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observed {
    pub bodies: usize,
    pub frames: usize,
    /// Over all frames of the turn.
    pub counts: Counts,
    /// Medians over the frames of one regime.
    pub stages: Stages,
    /// Seconds that making the culler took.
    pub construct: f64,
}

impl Observed {
    fn per_frame(&self, count: u64) -> f64 {
        count as f64 / self.frames as f64
    }
}

/// What a hit of a second test costs more than a miss does, in seconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split(f64);

impl Split {
    /// Times lists of which a quarter and three quarters hit; `None` where there is no second test
    /// or too few pairs.
    pub fn of(
        variant: &Variant,
        shapes: &[Shape],
        bodies: &Bodies,
        tier: Tier,
        [listed, kept]: [&[[u32; 2]]; 2],
    ) -> Option<Self> {
        let &[_, second] = variant.volumes().as_slice() else {
            return None;
        };
        let [few, many] = [1, 3].map(|quarters| mixture(listed, kept, quarters));
        let (few, many) = (few?, many?);
        let seconds: [f64; 2] = if second == Volume::Hull {
            let mut hulls = HullTest::new(shapes);
            [&few, &many].map(|list| time(REPEATS, || hulls.cull(bodies, list)))
        } else {
            let posed = PosedOrDops::new(
                shapes.iter().map(|shape| (shape, &shape.ordop)),
                bodies,
                tier,
            );
            let columns = posed.columns(variant.settings.overlap);
            let mut out = PairList::default();
            [&few, &many].map(|list| {
                time(REPEATS, || {
                    out.clear();
                    columns.test_pairs(tier, list.first(), list.second(), &mut out)
                })
            })
        };
        Some(Self((seconds[1] - seconds[0]) / (0.5 * few.len() as f64)))
    }
}

/// A list, in random order, of which so many quarters are among the `kept`, as long as both kinds
/// last.
fn mixture(listed: &[[u32; 2]], kept: &[[u32; 2]], quarters: usize) -> Option<PairList> {
    let mut kept = kept.to_vec();
    kept.sort_unstable();
    let (mut hits, mut misses): (Vec<_>, Vec<_>) = listed
        .iter()
        .partition(|pair| kept.binary_search(pair).is_ok());
    let quarter = hits.len().min(misses.len()) / 3;
    hits.truncate(quarters * quarter);
    misses.truncate((4 - quarters) * quarter);
    let mut all = [hits, misses].concat();
    if all.len() < FEWEST {
        return None;
    }
    let mut draws = Stream::new(SEED, quarters as u64);
    for last in (1..all.len()).rev() {
        all.swap(last, draws.index(last as u32 + 1) as usize);
    }
    Some(all.into_iter().collect())
}

/// The prices of spheres alone: an update, and a hit.
pub(super) fn spheres(turns: &[Observed]) -> VolumeCosts {
    alone(Volume::Sphere, turns)
}

/// Explains a variant's turns. `built` has the seconds of building each volume of all shapes;
/// `spheres` is what spheres alone cost on the same scenes.
pub(super) fn prices(
    variant: &Variant,
    turns: &[Observed],
    built: &[f64],
    splits: &[Split],
    spheres: &VolumeCosts,
) -> Prices {
    let volumes = variant.volumes();
    let mut costs: Vec<VolumeCosts> = match *volumes.as_slice() {
        [] => Vec::new(),
        [only] => vec![alone(only, turns)],
        // What hulls test is timed apart, and their poses are made with their tests.
        [before, Volume::Hull] => vec![alone(before, turns), second(Volume::Hull, turns, splits)],
        [before, last, ..] => {
            let [per_frame, own] = update(last, turns, (before, spheres.update));
            let one = first(before, turns, [per_frame, spheres.update], |s| s.finding);
            let other = second(last, turns, splits);
            let handle = (one.hit - spheres.hit).max(0.0);
            let one = VolumeCosts {
                handle,
                hit: one.hit - handle,
                ..one
            };
            vec![
                one,
                VolumeCosts {
                    update: own,
                    ..other
                },
            ]
        }
    };
    let [empty, body] = fit::prices(
        &turns
            .iter()
            .map(|turn| Measurement {
                counts: [1.0, turn.bodies as f64],
                seconds: turn.construct,
            })
            .collect::<Vec<_>>(),
    );
    for (costs, built) in costs.iter_mut().zip(built) {
        costs.construct = *built;
    }
    if let Some(costs) = costs.last_mut() {
        costs.construct += empty;
        costs.construct_body = body;
    }
    let volumes = volumes.into_iter().zip(costs);
    Prices {
        variant: variant.name.clone(),
        volumes: volumes
            .map(|(volume, costs)| Price { volume, costs })
            .collect(),
    }
}

/// The prices of a volume that is tested alone, or first before hulls.
fn alone(volume: Volume, turns: &[Observed]) -> VolumeCosts {
    let updates = update(volume, turns, (volume, 0.0));
    // Oriented volumes without a first test are tested where others refine.
    first(volume, turns, updates, |stages| {
        stages.finding + stages.refining
    })
}

/// The prices of a first test, whose updates cost so much per frame and each.
fn first(
    volume: Volume,
    turns: &[Observed],
    [per_frame, update]: [f64; 2],
    stage: fn(&Stages) -> f64,
) -> VolumeCosts {
    let row = |turn: &Observed| {
        let counters = turn.counts.of(volume);
        Measurement {
            counts: [
                1.0,
                turn.bodies as f64,
                turn.per_frame(counters.tests - counters.hits),
                turn.per_frame(counters.hits),
            ],
            seconds: stage(&turn.stages),
        }
    };
    let [frame, body, miss, hit] = fit::prices(&turns.iter().map(row).collect::<Vec<_>>());
    VolumeCosts {
        update,
        frame: frame + per_frame,
        body,
        hit,
        miss,
        ..VolumeCosts::default()
    }
}

/// Updates: seconds per frame, and per update of `volume`, beside `other`'s at a known price.
fn update(volume: Volume, turns: &[Observed], (other, price): (Volume, f64)) -> [f64; 2] {
    let row = |turn: &Observed| Measurement {
        counts: [1.0, turn.per_frame(turn.counts.of(volume).updates)],
        seconds: turn.stages.update - price * turn.per_frame(turn.counts.of(other).updates),
    };
    fit::prices(&turns.iter().map(row).collect::<Vec<_>>())
}

/// The prices of a second test: the level from the frames, hits and misses apart by the splits.
fn second(volume: Volume, turns: &[Observed], splits: &[Split]) -> VolumeCosts {
    let split = splits.iter().map(|split| split.0).sum::<f64>() / splits.len().max(1) as f64;
    let row = |turn: &Observed| {
        let counters = turn.counts.of(volume);
        let of_hulls = volume == Volume::Hull;
        Measurement {
            counts: [
                1.0,
                if of_hulls {
                    turn.per_frame(counters.updates)
                } else {
                    0.0
                },
                turn.per_frame(counters.tests),
            ],
            seconds: if of_hulls {
                turn.stages.hulls
            } else {
                turn.stages.refining
            } - split * turn.per_frame(counters.hits),
        }
    };
    let rows: Vec<_> = turns.iter().map(row).collect();
    let [frame, update, test] = fit::prices(&rows);
    VolumeCosts {
        update,
        frame,
        hit: (test + split).max(0.0),
        miss: test,
        ..VolumeCosts::default()
    }
}
