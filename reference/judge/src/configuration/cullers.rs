//! Cullers of a configuration.

use super::{Mode, Rotation};
use sdop::boxes::{BoxCuller, BoxCullerBuilder};
use sdop::culler::{Culler, CullerBuilder};
use sdop::settings::{Budget, CullSettings, Finder, Interest, Strategy, Updates};

/// What a strategy with a budget may spend.
const BUDGET: Budget = Budget::Tests(3);

/// The culling settings that a strategy needs to run on any frame: interest in every seventh body,
/// a budget of three tests.
#[must_use]
pub fn settings(strategy: Strategy, base: &CullSettings, bodies: usize) -> CullSettings {
    CullSettings {
        strategy,
        interest: Some(Interest::Bodies((0..bodies as u32).step_by(7).collect())),
        budget: Some(BUDGET),
        ..base.clone()
    }
}

/// A culler of these settings in this mode, with the same budget.
pub fn culler(settings: &CullSettings, mode: Mode) -> CullerBuilder {
    let culler = Culler::builder().settings(settings).budget(BUDGET).updates(mode.updates);
    culler.tier(mode.tier).threads(mode.threads).worth_waking(0)
}

/// What the finder led to in the culler's last frame, sorted: the list, which every finder must
/// give. What a budget leaves untested depends on the order in which pairs were found, so
/// time-critical culling shows the potentially colliding set.
#[must_use]
pub fn found(culler: &Culler, settings: &CullSettings) -> Vec<[u32; 2]> {
    if !settings.strategy.scheme().has_budget() {
        return culler.pairs().sorted();
    }
    let mut pairs: Vec<[u32; 2]> = culler.potentially_colliding().collect();
    pairs.sort_unstable();
    pairs
}

/// The choices of a culler or world of boxes by a finder in a mode.
pub fn box_culler(finder: Finder, mode: Mode) -> BoxCullerBuilder {
    let of = BoxCuller::builder().finder(finder).tier(mode.tier).threads(mode.threads);
    of.worth_waking(0)
}

/// Every finder in every mode; given boxes have no update mode.
pub fn finders(rotation: &Rotation) -> impl Iterator<Item = (Finder, Mode)> {
    let modes = rotation.modes().iter().filter(|mode| mode.updates == Updates::Eager);
    modes.flat_map(|&mode| Finder::ALL.iter().map(move |&finder| (finder, mode)))
}

/// A finder in its turn.
#[must_use]
pub fn finder(turn: usize) -> Finder {
    Finder::ALL[turn % Finder::ALL.len()]
}
