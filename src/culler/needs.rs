//! What a strategy needs: which volumes are updated, and which pair finder suits it.

use super::models::Models;
use crate::bodies::Places;
use crate::broad_phase::{Population, Volume};
use crate::listing::Totals;
use crate::settings::{Finder, Scheme, TestedVolume};
use crate::threads::FrameWork;
use crate::volume::DirectionSet;

/// Which volumes a strategy needs updated.
#[derive(Clone, Copy, Debug)]
pub(super) struct VolumeNeeds {
    /// Balls, by place.
    pub balls: bool,
    /// Rows: or-DOPs, or boxes.
    pub rows: bool,
    /// World-aligned slabs.
    pub intervals: Option<DirectionSet>,
    /// Slots named by place: rows and slabs are looked up by place, spheres alone need the body
    /// only.
    pub by_place: bool,
}

impl VolumeNeeds {
    /// The needs of a row of the table of strategies; `k` are the directions of a k-DOP.
    pub fn of(scheme: Scheme, k: DirectionSet, finder: Finder) -> Self {
        // Oriented volumes are binned by balls; a finder that doesn't bin needs none.
        let binned = scheme.is_oriented_alone() && finder != Finder::AllPairs;
        let (rows, intervals) = (scheme.refining.is_some(), scheme.slabs(k));
        Self {
            balls: binned || scheme.first == Some(TestedVolume::Sphere),
            rows,
            intervals,
            by_place: rows || intervals.is_some(),
        }
    }

    /// The names of slots: numbers of places, or the bodies in them.
    pub fn names<'a>(&self, numbers: &'a [u32], places: &'a Places) -> &'a [u32] {
        if self.by_place { numbers } else { &places.body }
    }

    /// The balls by place, or none if they are not updated.
    pub fn known<'a>(&self, balls: &'a [[f32; 4]]) -> &'a [[f32; 4]] {
        if self.balls { balls } else { &[] }
    }

    /// The work of a frame with `moving` moving bodies and the tests of the frame `like`.
    pub fn work(&self, moving: u64, like: &Totals) -> FrameWork {
        let volumes = u64::from(self.balls) + u64::from(self.rows);
        let slabs = if self.intervals.is_some() { INTERVALS_COST } else { 0 };
        FrameWork {
            updates: (volumes + slabs) * moving,
            candidates: like.first.tests,
            refined: like.refining.tests,
        }
    }
}

/// The cost of updating a body's world-aligned slabs, in updates of a ball.
const INTERVALS_COST: u64 = 16;

/// The facts by which `auto` picks a finder.
pub(super) fn population(scheme: Scheme, models: &Models, places: &Places) -> Population {
    let radii = places.shape.iter().map(|&s| models.frames[s as usize].radius());
    Population {
        bodies: places.len(),
        radii: radii.fold([f32::INFINITY, 0.0], |[lo, hi], r| [r.min(lo), r.max(hi)]),
        cheap_test: !scheme.is_oriented_alone(),
        volume: match scheme.first {
            Some(TestedVolume::Aabb | TestedVolume::KDop) => Volume::Cube,
            _ => Volume::Ball,
        },
    }
}
