//! Prices from observed turns: each stage's seconds explained by its counts.
//!
//! An update stage follows Nu; finding follows frames, bodies, misses and hits; the second test
//! follows its tests. Prices are therefore marginal: the price of a hit is what one more hit costs
//! among the misses around it, including the lanes of the vector that it keeps busy. Each volume is
//! priced separately: spheres with the strategy of spheres, or-DOPs with the sequential S-DOP of
//! the same settings. What another strategy costs in addition is priced per frame, and per pair
//! that it lists. The share of hits in a second test is always about the same, so no choice of
//! scenes could separate the price of a hit from that of a miss. Lists with known shares separate
//! them ([`HitPremium`]), and the frames determine the level of both prices.

use super::VolumeCosts;
use super::expected;
use super::fit::{self, Measurement};
use super::hit_premium::HitPremium;
use super::level::CacheLevel;
use super::predict::{FirstTest, Price, Prices};
use super::terms::Terms;
use crate::measure::counts::{Counts, Volume};
use crate::measure::culling::StageSeconds;
use crate::measure::variant::Variant;
use sdop::settings::Strategy;

/// One turn of one calibration scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnObservation {
    pub bodies: usize,
    pub frames: usize,
    /// Over all frames of the turn.
    pub counts: Counts,
    /// Medians over the frames of one regime.
    pub stages: StageSeconds,
    /// Seconds to build the culler.
    pub construct: f64,
}

impl TurnObservation {
    fn per_frame(&self, count: u64) -> f64 {
        count as f64 / self.frames as f64
    }
}

/// A variant's turns in a round.
pub(super) struct VariantTurns<'a> {
    pub variant: &'a Variant,
    pub turns: &'a [TurnObservation],
    /// Seconds of building each of its volumes of all shapes.
    pub built: Vec<f64>,
    pub splits: &'a [HitPremium],
}

/// The facts that hold for all variants of a round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub lanes: usize,
    pub level: CacheLevel,
}

/// The prices of every variant. They include spheres alone, and for each that refines its [anchor].
pub(super) fn prices(all: &[VariantTurns<'_>], round: Round) -> Vec<Prices> {
    let spheres = all.iter().find(|one| one.variant.volumes() == [Volume::Sphere]);
    let spheres = spheres
        .map_or_else(VolumeCosts::default, |one| alone(Volume::Sphere, one.turns, round.lanes));
    let refined = |one: &VariantTurns<'_>| {
        let wanted = anchor(one.variant)?;
        let is_anchor = |other: &&VariantTurns<'_>| {
            (&other.variant.settings, other.variant.hulls) == (&wanted.settings, false)
        };
        let anchor = all.iter().find(is_anchor)?;
        Some(refining(anchor, &spheres, round.lanes))
    };
    let of = |one: &VariantTurns<'_>| {
        let costs = match *one.variant.volumes().as_slice() {
            [] => Vec::new(),
            [Volume::Sphere] => vec![spheres],
            [only] => vec![alone(only, one.turns, round.lanes)],
            [_, Volume::Hull] => vec![spheres, hulls(one)],
            [_, ..] => {
                let second = refined(one).unwrap_or_default();
                vec![spheres, beyond(one, [spheres, second], round)]
            }
        };
        Prices {
            variant: one.variant.name.clone(),
            level: round.level,
            lanes: round.lanes,
            volumes: constructed(one, costs),
        }
    };
    all.iter().map(of).collect()
}

/// The variant with which another's second volume is priced: every pair that passes the sphere test
/// is tested, and none is stored. `None` if there is no second volume, or if it is hulls.
pub(super) fn anchor(variant: &Variant) -> Option<Variant> {
    let [Volume::Sphere, second] = *variant.volumes().as_slice() else {
        return None;
    };
    (second != Volume::Hull).then(|| Variant::strategy(&variant.settings, Strategy::SDopSequential))
}

/// Adds the price of building: each volume's own, and to the last one the culler's.
fn constructed(one: &VariantTurns<'_>, mut costs: Vec<VolumeCosts>) -> Vec<Price> {
    let row = |turn: &TurnObservation| Measurement::of([1.0, turn.bodies as f64], turn.construct);
    let [empty, body] = fit::prices(&one.turns.iter().map(row).collect::<Vec<_>>());
    for (costs, built) in costs.iter_mut().zip(&one.built) {
        costs.construct = *built;
    }
    if let Some(costs) = costs.last_mut() {
        costs.construct += empty;
        costs.construct_body = body;
    }
    let volumes = one.variant.volumes().into_iter().zip(costs);
    volumes.map(|(volume, costs)| Price { volume, costs }).collect()
}

/// The prices of a volume that is tested alone.
fn alone(volume: Volume, turns: &[TurnObservation], lanes: usize) -> VolumeCosts {
    let [per_frame, update] = update(volume, turns, (volume, 0.0));
    let row = |turn: &TurnObservation| {
        let first = FirstTest::of(volume, &turn.counts, turn.frames as f64, turn.bodies as f64);
        // Oriented volumes have no first test; they are tested when others refine.
        let seconds = turn.stages.finding + turn.stages.refining;
        Measurement::of(first.counts(lanes), seconds)
    };
    let found = fit::prices(&turns.iter().map(row).collect::<Vec<_>>());
    let [frame, body, row, miss, hit, further] = found;
    VolumeCosts {
        update,
        frame: frame + per_frame,
        body,
        row,
        hit,
        miss,
        further,
        ..VolumeCosts::default()
    }
}

/// Updates: seconds per frame and per update of `volume`, given the price of `other`'s.
fn update(volume: Volume, turns: &[TurnObservation], (other, price): (Volume, f64)) -> [f64; 2] {
    let row = |turn: &TurnObservation| Measurement {
        counts: [1.0, turn.per_frame(turn.counts.of(volume).updates)],
        seconds: turn.stages.update - price * turn.per_frame(turn.counts.of(other).updates),
        whole: turn.stages.update,
    };
    fit::prices(&turns.iter().map(row).collect::<Vec<_>>())
}

/// Cu and Cv of or-DOPs after spheres, from the variant that only refines.
fn refining(anchor: &VariantTurns<'_>, spheres: &VolumeCosts, lanes: usize) -> VolumeCosts {
    let known = (Volume::Sphere, spheres.update);
    let [_, update] = update(Volume::OrDop, anchor.turns, known);
    let stage = |turn: &TurnObservation| (Volume::OrDop, turn.stages.refining);
    let [_, _, hit, miss] = second_test(anchor, lanes, stage);
    VolumeCosts { update, hit, miss, ..VolumeCosts::default() }
}

/// The prices of hulls after spheres, whose poses are computed in their tests.
fn hulls(one: &VariantTurns<'_>) -> VolumeCosts {
    let [frame, update, hit, miss] = second_test(one, 1, |turn| (Volume::Hull, turn.stages.hulls));
    VolumeCosts { update, frame, hit, miss, ..VolumeCosts::default() }
}

/// The prices of a second test: per frame, per update (of hulls), per hit, and per miss or idle
/// lane. The level comes from the frames, the difference of hit and miss from the splits.
fn second_test(
    one: &VariantTurns<'_>,
    lanes: usize,
    stage: impl Fn(&TurnObservation) -> (Volume, f64),
) -> [f64; 4] {
    let split = one.splits.iter().map(|split| split.0).sum::<f64>();
    let split = split / one.splits.len().max(1) as f64;
    let row = |turn: &TurnObservation| {
        let (volume, seconds) = stage(turn);
        let counters = turn.counts.of(volume);
        let updates = if volume == Volume::Hull { counters.updates } else { 0 };
        let tests = turn.per_frame(counters.tests);
        Measurement {
            counts: [1.0, turn.per_frame(updates), tests + expected::idle(tests, lanes)],
            seconds: seconds - split * turn.per_frame(counters.hits),
            whole: seconds,
        }
    };
    let [frame, update, test] = fit::prices(&one.turns.iter().map(row).collect::<Vec<_>>());
    [frame, update, (test + split).max(0.0), test]
}

/// A second volume's prices with the strategy's additional ones: per frame, and per pair that
/// passes the first test.
fn beyond(one: &VariantTurns<'_>, [first, second]: [VolumeCosts; 2], round: Round) -> VolumeCosts {
    let volumes = one.variant.volumes().into_iter().zip([first, second]);
    let known = Prices {
        variant: String::new(),
        level: round.level,
        lanes: round.lanes,
        volumes: volumes.map(|(volume, costs)| Price { volume, costs }).collect(),
    };
    let row = |turn: &TurnObservation| {
        let terms = known.predict(&turn.counts, turn.frames as u32, turn.bodies);
        let explained: f64 = terms.iter().map(Terms::recurring).sum();
        let whole = turn.stages.total();
        Measurement {
            counts: [1.0, turn.per_frame(turn.counts.of(Volume::Sphere).hits)],
            seconds: whole - explained,
            whole,
        }
    };
    let [frame, handle] = fit::prices(&one.turns.iter().map(row).collect::<Vec<_>>());
    VolumeCosts { frame, handle, ..second }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::design;
    use sdop::counters::VolumeCounters;
    use sdop::settings::CullSettings;

    const LANES: usize = 16;

    /// Prices in ns of realistic size, all different.
    fn known(volume: Volume) -> VolumeCosts {
        let all = match volume {
            Volume::Sphere => [2.2, 310.0, 8.0, 17.0, 0.9, 0.21, 0.0],
            Volume::Aabb => [820.0, 640.0, 21.0, 0.0, 5.0, 0.12, 0.16],
            Volume::Obb => [9.0, 900.0, 3.0, 0.0, 60.0, 10.0, 0.0],
            _ => [14.0, 150.0, 0.0, 0.0, 19.0, 13.0, 0.0],
        };
        let [update, frame, body, row, hit, miss, further] = all.map(|ns| 1e-9 * ns);
        VolumeCosts { update, frame, body, row, hit, miss, further, ..VolumeCosts::default() }
    }

    /// Turns of the design's sizes and shares, with the counts of all pairs and the times of known
    /// prices, which scatter by 1 %. The seconds are summed here term by term, not by the tested
    /// code.
    fn turns(first: Volume, refines: bool, handle: f64) -> Vec<TurnObservation> {
        let mut all = Vec::new();
        for (number, (bodies, share)) in design::grid(CacheLevel::L2).into_iter().enumerate() {
            let (n, moving) = (bodies as f64, (0.8 * bodies as f64).round());
            let still = n - moving;
            let tests = 0.5 * (n * (n - 1.0) - still * (still - 1.0));
            let hits = (share * tests).round();
            let counters = |updates, tests, hits| VolumeCounters {
                updates: updates as u64,
                tests: tests as u64,
                hits: hits as u64,
            };
            let mut counts = Counts::default();
            let own = counters(moving, tests, hits);
            match first {
                Volume::Sphere => counts.culler.sphere = own,
                Volume::Aabb => counts.culler.aabb = own,
                _ => counts.culler.obb = own,
            }
            let costs = known(first);
            let rows = expected::rows(moving, n, tests, hits);
            let further = tests * expected::further(tests, hits, LANES);
            let scatter = 0.99 + 0.002 * f64::from(number as u32 * 7 % 11);
            let mut stages = StageSeconds {
                update: moving * costs.update,
                finding: costs.frame
                    + n * costs.body
                    + if first == Volume::Sphere { rows * costs.row } else { 0.0 }
                    + hits * costs.hit
                    + (tests - hits) * costs.miss
                    + further * costs.further,
                ..StageSeconds::default()
            };
            if refines {
                let (second, kept) = (known(Volume::OrDop), (0.3 * hits).round());
                counts.culler.ordop = counters(moving, hits, kept);
                stages.update += moving * second.update;
                stages.finding += second.frame + hits * handle;
                let idle = expected::idle(hits, LANES);
                stages.refining = kept * second.hit + (hits - kept + idle) * second.miss;
            }
            stages.update *= scatter;
            stages.finding *= scatter;
            stages.refining *= scatter;
            all.push(TurnObservation {
                bodies,
                frames: 1,
                counts,
                stages,
                construct: 1e-6 + 2e-9 * n,
            });
        }
        all
    }

    fn estimated(strategies: &[(Strategy, f64)]) -> Vec<Prices> {
        let settings = CullSettings::default();
        let variants: Vec<_> = strategies
            .iter()
            .map(|(strategy, handle)| (Variant::strategy(&settings, *strategy), *handle))
            .collect();
        let second = known(Volume::OrDop);
        let splits = [HitPremium(second.hit - second.miss)];
        let observed: Vec<_> = variants
            .iter()
            .map(|(variant, handle)| match *variant.volumes().as_slice() {
                [only] => turns(only, false, *handle),
                _ => turns(Volume::Sphere, true, *handle),
            })
            .collect();
        let all: Vec<_> = variants
            .iter()
            .zip(&observed)
            .map(|((variant, _), turns)| VariantTurns {
                variant,
                turns,
                built: vec![1e-3; variant.volumes().len()],
                splits: &splits,
            })
            .collect();
        let round = Round { lanes: LANES, level: CacheLevel::L2 };
        prices(&all, round)
    }

    fn assert_near(what: &str, found: f64, truth: f64, within: f64) {
        let off = if truth == 0.0 { found / 1e-9 } else { found / truth - 1.0 };
        assert!(off.abs() < within, "{what}: {found:e} for {truth:e}");
    }

    #[test]
    fn known_prices_are_found_again() {
        for (strategy, volume) in [
            (Strategy::Sphere, Volume::Sphere),
            (Strategy::Aabb, Volume::Aabb),
            (Strategy::Obb, Volume::Obb),
        ] {
            let found = estimated(&[(strategy, 0.0)]).remove(0).volumes[0].costs;
            let truth = known(volume);
            for (what, found, truth, within) in [
                ("update", found.update, truth.update, 0.02),
                ("frame", found.frame, truth.frame, 0.1),
                ("body", found.body, truth.body, 0.3),
                ("row", found.row, truth.row, 0.3),
                ("hit", found.hit, truth.hit, 0.1),
                ("miss", found.miss, truth.miss, 0.1),
                ("further", found.further, truth.further, 0.1),
            ] {
                assert_near(&format!("{volume} {what}"), found, truth, within);
            }
        }
    }

    /// A volume has one price under every strategy.
    #[test]
    fn price_is_equal_for_strategies() {
        let found = estimated(&[
            (Strategy::Sphere, 0.0),
            (Strategy::SDopSequential, 2e-9),
            (Strategy::SDopBatch, 3e-9),
            (Strategy::SDopObjectOfInterest, 8e-9),
        ]);
        let [spheres, refined @ ..] = &found[..] else {
            panic!("no spheres");
        };
        let truth = known(Volume::OrDop);
        for (prices, handle) in refined.iter().zip([2e-9, 3e-9, 8e-9]) {
            let [first, second] = [0, 1].map(|at| prices.volumes[at].costs);
            let of_spheres = spheres.volumes[0].costs;
            assert_eq!(
                VolumeCosts { construct: 0.0, construct_body: 0.0, ..first },
                VolumeCosts { construct: 0.0, construct_body: 0.0, ..of_spheres },
                "{}",
                prices.variant
            );
            assert_near("Cu", second.update, truth.update, 0.05);
            assert_near("hit", second.hit, truth.hit, 0.05);
            assert_near("miss", second.miss, truth.miss, 0.05);
            assert_near("handle", second.handle, handle, 0.2);
            assert_near("frame", second.frame, truth.frame, 0.3);
        }
    }
}
