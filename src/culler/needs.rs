//! What a strategy asks of the other rooms: which volumes it looks at, and by which finder.

use super::models::Models;
use crate::bodies::Places;
use crate::broad_phase::Population;
use crate::settings::{CullSettings, Finder, Strategy};
use crate::volume::DirectionSet;

/// Which volumes a strategy looks at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Needs {
    /// Balls by place.
    pub balls: bool,
    /// or-DOPs.
    pub rows: bool,
    /// World-aligned slabs.
    pub intervals: Option<DirectionSet>,
}

impl Needs {
    pub fn of(settings: &CullSettings, finder: Finder) -> Self {
        let (balls, rows, intervals) = match settings.strategy {
            Strategy::None => (false, false, None),
            Strategy::Sphere => (true, false, None),
            // Binned by balls, which a finder that doesn't bin can do without.
            Strategy::OrDop | Strategy::Obb => (finder != Finder::AllPairs, true, None),
            Strategy::Aabb => (false, false, Some(DirectionSet::K6)),
            Strategy::KDop => (false, false, Some(settings.k)),
            Strategy::SDopSequential
            | Strategy::SDopBatch
            | Strategy::SDopObjectOfInterest
            | Strategy::SDopTimeCritical => (true, true, None),
        };
        Self {
            balls,
            rows,
            intervals,
        }
    }
}

/// What `auto` looks at.
pub(super) fn population(strategy: Strategy, models: &Models, places: &Places) -> Population {
    let radii = places
        .shape
        .iter()
        .map(|&s| models.frames[s as usize].radius());
    Population {
        bodies: places.len(),
        radii: radii.fold([f32::INFINITY, 0.0], |[lo, hi], r| [r.min(lo), r.max(hi)]),
        cheap_test: !matches!(strategy, Strategy::OrDop | Strategy::Obb),
    }
}
