//! Counters and timers of culling: the Nu and Nv of the paper's formula, and seconds per stage.
//!
//! A test counts when a candidate pair is passed to it, so counts are the same on every CPU, in
//! every tier and on any number of threads.

use std::ops::{AddAssign, Sub};

use crate::settings::{HAS_CLOCK, TestedVolume};

/// Updates and tests of one volume, summed over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VolumeCounters {
    /// Nu: volumes updated.
    pub updates: u64,
    /// Nv: pairs tested.
    pub tests: u64,
    /// Pairs that the test did not reject.
    pub hits: u64,
}

/// Bodies in the frames of a world that searches only for the partners of bodies that have changed,
/// and keeps the pairs of all others; summed over frames. All are 0 in frames that find all pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RestCounters {
    /// Bodies that were inserted, removed or set to another value since the frame before: their
    /// partners were searched for.
    pub queried: u64,
    /// Those among them that weren't queried in the frame before.
    pub thawed: u64,
    /// All other bodies: pairs of two of them were kept.
    pub kept: u64,
}

/// All counters of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Counters {
    /// Bounding spheres.
    pub sphere: VolumeCounters,
    /// or-DOPs.
    pub ordop: VolumeCounters,
    /// World-aligned boxes.
    pub aabb: VolumeCounters,
    /// World-aligned k-DOPs.
    pub kdop: VolumeCounters,
    /// Oriented boxes.
    pub obb: VolumeCounters,
    /// Pairs reported without a test because the budget was spent.
    pub untested: u64,
    /// Pairs reported.
    pub reported: u64,
    /// Bodies that were queried or kept, in a world.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rest: RestCounters,
}

impl Counters {
    /// The counters of one volume.
    #[must_use]
    pub fn of(&self, volume: TestedVolume) -> &VolumeCounters {
        match volume {
            TestedVolume::Sphere => &self.sphere,
            TestedVolume::OrDop => &self.ordop,
            TestedVolume::Aabb => &self.aabb,
            TestedVolume::KDop => &self.kdop,
            TestedVolume::Obb => &self.obb,
        }
    }

    /// The counters of one volume, to be changed.
    pub fn of_mut(&mut self, volume: TestedVolume) -> &mut VolumeCounters {
        match volume {
            TestedVolume::Sphere => &mut self.sphere,
            TestedVolume::OrDop => &mut self.ordop,
            TestedVolume::Aabb => &mut self.aabb,
            TestedVolume::KDop => &mut self.kdop,
            TestedVolume::Obb => &mut self.obb,
        }
    }
}

/// Wall time per stage, in seconds, summed over frames; `construct` happens once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seconds {
    /// Co: building every volume, once.
    pub construct: f64,
    /// The simulation's effects, which are not part of culling.
    pub effects: f64,
    /// Updating the world-space volumes.
    pub update: f64,
    /// Finding candidates and the first volume test.
    pub pair_finding: f64,
    /// or-DOP tests (with `s-dop-sequential`, timed block by block).
    pub ordop: f64,
    /// Culling: update, pair finding and or-DOP tests, without construction and effects.
    pub total: f64,
}

macro_rules! sums {
    ($($sums:ident: $($sum:ident)+;)+) => {$(
        impl AddAssign for $sums {
            fn add_assign(&mut self, more: Self) {
                $(self.$sum += more.$sum;)+
            }
        }

        impl Sub for $sums {
            type Output = Self;
            fn sub(self, before: Self) -> Self {
                Self { $($sum: self.$sum - before.$sum),+ }
            }
        }

        impl $sums {
            /// What was added since `before`.
            #[must_use]
            pub fn since(&self, before: &Self) -> Self {
                *self - *before
            }
        }
    )+};
}

sums! {
    VolumeCounters: updates tests hits;
    RestCounters: queried thawed kept;
    Counters: sphere ordop aabb kdop obb untested reported rest;
    Seconds: construct effects update pair_finding ordop total;
}

/// Measures seconds, which are 0 on targets without a clock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock(Option<std::time::Instant>);

impl Clock {
    /// Starts a clock.
    pub fn start() -> Self {
        Self(HAS_CLOCK.then(std::time::Instant::now))
    }

    /// Seconds since the start, or since the last lap.
    pub fn seconds(mut self) -> f64 {
        self.lap()
    }

    /// The same, and starts the next lap.
    pub fn lap(&mut self) -> f64 {
        let now = Self::start();
        let times = now.0.zip(std::mem::replace(self, now).0);
        times.map_or(0.0, |(now, start)| (now - start).as_secs_f64())
    }
}

/// The number of unordered pairs of `bodies` bodies that are not both static: Nv per frame of the
/// finder `all-pairs`.
#[must_use]
pub const fn pair_count(bodies: u64, statics: u64) -> u64 {
    (bodies * bodies.saturating_sub(1) - statics * statics.saturating_sub(1)) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of two statics do not count.
    #[test]
    fn static_pairs_do_not_count() {
        assert_eq!(pair_count(0, 0), 0);
        assert_eq!(pair_count(5, 0), 10);
        assert_eq!(pair_count(5, 2), 9);
        assert_eq!(pair_count(5, 5), 0);
        assert_eq!(pair_count(1_000_000, 1), 499_999_500_000);
    }
}
