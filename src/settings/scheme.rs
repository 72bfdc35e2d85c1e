//! The table of strategies: what each one tests, and how pairs flow from test to test. Counters,
//! updates, the choice of a finder and prices follow from a strategy's row.

use super::{DirectionSet, Overlap, Strategy};
use crate::choice::choices;

choices! {
    /// A volume that pairs are tested with. Updates, tests and hits are counted per volume.
    TestedVolume, "volume", {
        /// Bounding spheres.
        Sphere = "sphere",
        /// or-DOPs.
        OrDop = "ordop",
        /// World-aligned boxes.
        Aabb = "aabb",
        /// World-aligned k-DOPs.
        KDop = "kdop",
        /// Oriented boxes.
        Obb = "obb",
    }
}

/// How pairs flow from the first test to the refining one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// No pair is tested.
    Nothing,
    /// Pairs that pass the first test are reported.
    FirstTest,
    /// Blocks of candidates that passed the first test are refined at once; no list is kept (paper,
    /// section 4a).
    Sequential,
    /// All candidates that passed the first test are listed, then refined (paper, section 4b).
    Batch,
    /// As `Sequential`, but only pairs with a body of interest are refined (paper, section 4c).
    OfInterest,
    /// As `Batch`, until a budget is spent.
    TimeCritical,
}

/// A row of the table of strategies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The first test, of every candidate: spheres or world-aligned volumes.
    pub first: Option<TestedVolume>,
    /// The refining test, of oriented volumes: for pairs that passed the first test, or for every
    /// candidate if there is no first test.
    pub refining: Option<TestedVolume>,
    /// How pairs get from the first test to the refining one.
    pub flow: Flow,
}

impl Strategy {
    /// The strategy's row in the table of strategies.
    #[must_use]
    pub const fn scheme(self) -> Scheme {
        use TestedVolume::{Aabb, KDop, Obb, OrDop, Sphere};
        let (first, refining, flow) = match self {
            Self::None => (None, None, Flow::Nothing),
            Self::Sphere => (Some(Sphere), None, Flow::FirstTest),
            Self::OrDop => (None, Some(OrDop), Flow::Sequential),
            Self::SDopSequential => (Some(Sphere), Some(OrDop), Flow::Sequential),
            Self::SDopBatch => (Some(Sphere), Some(OrDop), Flow::Batch),
            Self::SDopObjectOfInterest => (Some(Sphere), Some(OrDop), Flow::OfInterest),
            Self::SDopTimeCritical => (Some(Sphere), Some(OrDop), Flow::TimeCritical),
            Self::Aabb => (Some(Aabb), None, Flow::FirstTest),
            Self::KDop => (Some(KDop), None, Flow::FirstTest),
            Self::Obb => (None, Some(Obb), Flow::Sequential),
        };
        Scheme { first, refining, flow }
    }
}

impl Scheme {
    /// The volumes in the order of their tests.
    pub fn volumes(self) -> impl Iterator<Item = TestedVolume> {
        self.first.into_iter().chain(self.refining)
    }

    /// Whether any pairs are tested: true for all strategies but the control.
    #[must_use]
    pub fn culls(self) -> bool {
        self.flow != Flow::Nothing
    }

    /// Whether a budget may leave pairs untested, so that the list depends on the order in which
    /// they were found.
    #[must_use]
    pub fn has_budget(self) -> bool {
        self.flow == Flow::TimeCritical
    }

    /// Whether the overlap test can be chosen. Oriented boxes have only one.
    #[must_use]
    pub fn has_overlap_test(self) -> bool {
        self.refining == Some(TestedVolume::OrDop)
    }

    /// Whether the strategy has no first test. Oriented volumes are then binned by balls of their
    /// own, and testing a pair costs hardly less than finding a candidate.
    #[must_use]
    pub fn is_oriented_alone(self) -> bool {
        self.first.is_none() && self.refining.is_some()
    }

    /// Whether each shape's oriented box replaces its or-DOP.
    #[must_use]
    pub fn has_boxes(self) -> bool {
        self.refining == Some(TestedVolume::Obb)
    }

    /// The directions of the world-aligned slabs, if the strategy has any; `k` are those of a
    /// k-DOP.
    #[must_use]
    pub fn slabs(self, k: DirectionSet) -> Option<DirectionSet> {
        match self.first {
            Some(TestedVolume::Aabb) => Some(DirectionSet::K6),
            Some(TestedVolume::KDop) => Some(k),
            _ => None,
        }
    }

    /// The separating axes of the refining test: `given`, but for oriented boxes all 15.
    #[must_use]
    pub fn overlap(self, given: Overlap) -> Overlap {
        if self.has_boxes() { Overlap::Full } else { given }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every row has tests that its stages and flow can carry out.
    #[test]
    fn scheme_rows_are_consistent() {
        for strategy in Strategy::ALL {
            let Scheme { first, refining, flow } = strategy.scheme();
            let oriented = [TestedVolume::OrDop, TestedVolume::Obb];
            assert!(first.is_none_or(|volume| !oriented.contains(&volume)));
            assert!(refining.is_none_or(|volume| oriented.contains(&volume)));
            let lists_spheres = first == Some(TestedVolume::Sphere) && refining.is_some();
            match flow {
                Flow::Nothing => assert!(first.is_none() && refining.is_none()),
                Flow::FirstTest => assert!(first.is_some() && refining.is_none()),
                Flow::Sequential => assert!(refining.is_some()),
                Flow::Batch | Flow::OfInterest | Flow::TimeCritical => assert!(lists_spheres),
            }
        }
    }
}
