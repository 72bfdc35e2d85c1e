//! Prices of worlds that keep the pairs of sleeping bodies, from observed turns.
//!
//! The update stage follows Nu. Finding follows the frames, the bodies that are queried, thawed and
//! kept, and the pairs that the first volume tests. The refining stage, which updates a second
//! volume for the bodies of its pairs, follows its updates and tests.

use super::VolumeCosts;
use super::expected;
use super::explain::{Round, TurnObservation, VariantTurns, constructed, update};
use super::fit::{self, Measurement};
use super::predict::Prices;
use crate::measure::counts::Volume;

/// The prices of every variant, each a world.
pub(super) fn prices(all: &[VariantTurns<'_>], round: Round) -> Vec<Prices> {
    let of = |one: &VariantTurns<'_>| {
        let volumes = one.variant.volumes();
        let mut costs = Vec::new();
        costs.extend(volumes.first().map(|&volume| first(volume, one.turns)));
        costs.extend(volumes.get(1).map(|&volume| second(volume, one.turns, round.lanes)));
        Prices {
            variant: one.variant.name.clone(),
            level: round.level,
            lanes: round.lanes,
            volumes: constructed(one, costs),
        }
    };
    all.iter().map(of).collect()
}

/// The prices of the first volume, and of bodies.
fn first(volume: Volume, turns: &[TurnObservation]) -> VolumeCosts {
    let [per_frame, update] = update(volume, turns, (volume, 0.0));
    let row = |turn: &TurnObservation| {
        let (rest, tested) = (turn.counts.culler.rest, turn.counts.of(volume));
        let counts =
            [rest.queried, rest.thawed, rest.kept, tested.tests - tested.hits, tested.hits];
        let [queried, thawed, kept, misses, hits] = counts.map(|count| turn.per_frame(count));
        let counts = [1.0, queried, thawed, kept, misses, hits];
        Measurement::of(counts, turn.stages.finding)
    };
    let found = fit::prices(&turns.iter().map(row).collect::<Vec<_>>());
    let [frame, query, thaw, keep, miss, hit] = found;
    VolumeCosts {
        update,
        frame: frame + per_frame,
        query,
        thaw,
        keep,
        miss,
        hit,
        ..VolumeCosts::default()
    }
}

/// The prices of the second volume. Hits and misses cost the same, as no count tells them apart.
fn second(volume: Volume, turns: &[TurnObservation], lanes: usize) -> VolumeCosts {
    let row = |turn: &TurnObservation| {
        let counters = turn.counts.of(volume);
        let tests = turn.per_frame(counters.tests);
        let counts = [1.0, turn.per_frame(counters.updates), tests + expected::idle(tests, lanes)];
        Measurement::of(counts, turn.stages.refining)
    };
    let found = fit::prices(&turns.iter().map(row).collect::<Vec<_>>());
    let [frame, update, test] = found;
    VolumeCosts { update, frame, hit: test, miss: test, ..VolumeCosts::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::level::CacheLevel;
    use crate::cost::terms::Terms;
    use crate::measure::counts::Counts;
    use crate::measure::culling::StageSeconds;
    use crate::measure::variant::Variant;
    use sdop::counters::{Counters, RestCounters, VolumeCounters};
    use sdop::settings::{CullSettings, Strategy};

    const LANES: usize = 16;

    /// Turns with counts of a world, and the times of known prices, summed here term by term.
    fn turns() -> Vec<TurnObservation> {
        let turn = |number: u64| {
            let bodies = [500, 2000, 8000, 20_000][number as usize % 4];
            let queried = bodies * (1 + number * 7 % 11) / 200;
            let thawed = queried * (number * 5 % 7) / 7;
            let tests = queried * (1 + number * 3 % 13);
            let hits = tests * (1 + number % 3) / 4;
            let volume = |updates, tests, hits| VolumeCounters { updates, tests, hits };
            let counts = Counts {
                culler: Counters {
                    sphere: volume(queried + tests, tests, hits),
                    ordop: volume(queried + hits, hits, hits / 2),
                    rest: RestCounters { queried, thawed, kept: bodies - queried },
                    ..Counters::default()
                },
                hulls: VolumeCounters::default(),
            };
            let [queried, thawed, tests, hits, kept] =
                [queried, thawed, tests, hits, bodies - queried].map(|count| count as f64);
            let stages = StageSeconds {
                update: 1e-9 * (200.0 + 9.0 * (queried + tests)),
                finding: 1e-9
                    * (400.0
                        + 150.0 * queried
                        + 80.0 * thawed
                        + 0.1 * kept
                        + 5.0 * (tests - hits)
                        + 7.0 * hits),
                refining: 1e-9
                    * (100.0
                        + 40.0 * (queried + hits)
                        + 20.0 * (hits + expected::idle(hits, LANES))),
                ..StageSeconds::default()
            };
            TurnObservation {
                bodies: bodies as usize,
                frames: 1,
                counts,
                stages,
                construct: 1e-6 + 2e-9 * bodies as f64,
            }
        };
        (0..40).map(turn).collect()
    }

    /// Known prices are found again, and predict the times of the same turns.
    #[test]
    fn prices_of_worlds_are_found_again() {
        let variant = Variant::strategy(&CullSettings::default(), Strategy::SDopSequential);
        let turns = turns();
        let observed = VariantTurns {
            variant: &variant.in_world(),
            turns: &turns,
            built: vec![1e-3; 2],
            splits: &[],
        };
        let round = Round { lanes: LANES, level: CacheLevel::L2 };
        let found = prices(&[observed], round).remove(0);
        let [first, second] = [0, 1].map(|at| found.volumes[at].costs);
        for (what, found, nanoseconds) in [
            ("frame", first.frame, 600.0),
            ("update", first.update, 9.0),
            ("query", first.query, 150.0),
            ("thaw", first.thaw, 80.0),
            ("keep", first.keep, 0.1),
            ("miss", first.miss, 5.0),
            ("hit", first.hit, 7.0),
            ("second frame", second.frame, 100.0),
            ("second update", second.update, 40.0),
            ("second test", second.hit, 20.0),
        ] {
            let off = found / (1e-9 * nanoseconds) - 1.0;
            assert!(off.abs() < 1e-3, "{what}: {found:e}");
        }
        for turn in &turns {
            let terms = found.predict(&turn.counts, 1, turn.bodies);
            let predicted: f64 = terms.iter().map(Terms::recurring).sum();
            assert!((predicted / turn.stages.total() - 1.0).abs() < 1e-3);
        }
    }
}
