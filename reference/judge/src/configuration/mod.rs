//! Every configuration in which a frame can be culled, and the modes that these use in turn.
//!
//! A *way* decides what is reported: strategy × overlap test × finder, for one or-DOP (k, axes). A
//! *mode* decides how it is computed and must change nothing: updates × tier × threads. Every way
//! in every mode on every frame would cost twenty times as much, so a [`Rotation`] gives each way
//! another mode in each turn. If the mode followed the turn's number, a mode could always meet the
//! same kind of case. Therefore the order of modes is shuffled each time all have had their turn.

pub mod coverage;
pub mod cullers;
pub mod world_kind;

use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;

use sdop::settings::{CullSettings, Finder, Overlap, Strategy, Updates};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};

/// Every or-DOP that a shape can have.
pub fn variants() -> impl Iterator<Item = (DirectionSet, Axes)> {
    let axes = |&k| Axes::ALL.iter().map(move |&axes| (k, axes));
    DirectionSet::ALL.iter().flat_map(axes)
}

/// Every strategy with each of its overlap tests, by all-pairs.
#[must_use]
pub fn rows((k, axes): (DirectionSet, Axes)) -> Vec<CullSettings> {
    let row = |strategy, overlap| CullSettings {
        strategy,
        overlap,
        pairs: Finder::AllPairs,
        k,
        axes,
        ..CullSettings::all_pairs()
    };
    let rows = Strategy::ALL.iter().flat_map(|&strategy| {
        let overlaps =
            if strategy.scheme().has_overlap_test() { Overlap::ALL } else { &[Overlap::TwoSided] };
        overlaps.iter().map(move |&overlap| row(strategy, overlap))
    });
    rows.collect()
}

/// Every way to cull with one or-DOP: the [`rows`], each by every finder.
#[must_use]
pub fn ways(k: DirectionSet, axes: Axes) -> Vec<CullSettings> {
    let finders = |row: CullSettings| {
        Finder::ALL.iter().map(move |&pairs| CullSettings { pairs, ..row.clone() })
    };
    rows((k, axes)).into_iter().flat_map(finders).collect()
}

/// Numbers of threads that take turns: the caller's alone, and more than most machines of a build
/// farm have.
pub const THREADS: [usize; 2] = [1, 3];

/// How a list is computed; none may change it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// When or-DOPs are updated.
    pub updates: Updates,
    /// The SIMD tier.
    pub tier: Tier,
    /// The number of threads.
    pub threads: usize,
}

impl Mode {
    /// The plainest mode on a tier: eager, on the caller's thread.
    #[must_use]
    pub fn plain(tier: Tier) -> Self {
        Self { updates: Updates::Eager, tier, threads: 1 }
    }
}

/// Modes that take turns.
#[derive(Clone, Debug)]
pub struct Rotation {
    modes: Vec<Mode>,
}

impl Rotation {
    /// Every mode on these tiers.
    #[must_use]
    pub fn new(tiers: &[Tier]) -> Self {
        let mut modes = Vec::new();
        for &tier in tiers {
            for &updates in Updates::ALL {
                modes.extend(THREADS.map(|threads| Mode { updates, tier, threads }));
            }
        }
        Self { modes }
    }

    /// Every mode.
    #[must_use]
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// The modes in the order of this turn: way number `w` takes the one numbered `w` modulo their
    /// number.
    ///
    /// In turns 0 … m − 1 with m modes, and in every m turns from a multiple of m on, each way has
    /// each mode once.
    #[must_use]
    pub fn turn(&self, turn: u64) -> Vec<Mode> {
        let mut order = self.modes.clone();
        let all = order.len() as u64;
        let Some(round) = turn.checked_div(all) else {
            return order;
        };
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(round));
        order.rotate_left((turn % all) as usize);
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In as many turns as there are modes, each way has each mode once.
    #[test]
    fn each_way_has_each_mode_once() {
        let rotation = Rotation::new(&Tier::available());
        let all = rotation.modes().len();
        assert_eq!(all, Tier::available().len() * Updates::ALL.len() * THREADS.len());
        for round in [0, 1, 7] {
            for way in 0..all + 3 {
                let turns = (0..all).map(|n| rotation.turn((round * all + n) as u64)[way % all]);
                let turns: Vec<Mode> = turns.collect();
                for mode in rotation.modes() {
                    assert_eq!(turns.iter().filter(|seen| *seen == mode).count(), 1);
                }
            }
        }
    }

    #[test]
    fn modes_vary_from_turn_to_turn() {
        // Rounds draw by their seed's remainder: of two and of three, for instance.
        let rotation = Rotation::new(&[Tier::SCALAR]);
        for step in [2, 3, rotation.modes().len() as u64] {
            let tier = rotation.turn(0)[0];
            let seen = (0..64).map(|n| rotation.turn(n * step)[0]);
            assert!(seen.clone().any(|mode| mode != tier), "every {step} turns");
        }
    }
}
