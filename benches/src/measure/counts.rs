//! The counters of a run per volume: Nu and Nv of the formula.

use sdop::choice::choices;
use sdop::counters::{Counters, VolumeCounters};
use sdop::settings::{Strategy, TestedVolume};

choices! {
    /// The volumes that are updated, tested and have prices.
    Volume, "volume", {
        /// Bounding spheres.
        Sphere = "sphere",
        /// or-DOPs.
        OrDop = "or-dop",
        /// World-aligned boxes.
        Aabb = "aabb",
        /// World-aligned k-DOPs.
        KDop = "k-dop",
        /// Oriented boxes.
        Obb = "obb",
        /// Convex hulls of what the others let through.
        Hull = "hull",
    }
}

impl Volume {
    /// The volumes of a strategy, in the order of its tests.
    #[must_use]
    pub fn of(strategy: Strategy) -> Vec<Self> {
        strategy.scheme().volumes().map(Self::from).collect()
    }
}

impl From<TestedVolume> for Volume {
    fn from(volume: TestedVolume) -> Self {
        match volume {
            TestedVolume::Sphere => Self::Sphere,
            TestedVolume::OrDop => Self::OrDop,
            TestedVolume::Aabb => Self::Aabb,
            TestedVolume::KDop => Self::KDop,
            TestedVolume::Obb => Self::Obb,
        }
    }
}

/// What a run has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Counts {
    /// The culler's counters.
    pub culler: Counters,
    /// Those of the convex hulls after it.
    pub hulls: VolumeCounters,
}

impl Counts {
    /// What was counted since `before`.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self { culler: self.culler.since(&before.culler), hulls: self.hulls.since(&before.hulls) }
    }

    /// The counters of one volume.
    #[must_use]
    pub fn of(&self, volume: Volume) -> VolumeCounters {
        match volume {
            Volume::Sphere => self.culler.sphere,
            Volume::OrDop => self.culler.ordop,
            Volume::Aabb => self.culler.aabb,
            Volume::KDop => self.culler.kdop,
            Volume::Obb => self.culler.obb,
            Volume::Hull => self.hulls,
        }
    }
}
