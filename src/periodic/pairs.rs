//! The pairs of a periodic world, and its events: what has begun and ended since they were last
//! read.

use crate::living::BodyId;
use crate::pairs::{Merge, Merged};

/// Two bodies that may touch, the second one moved by whole periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PeriodicPair {
    /// The bodies, the lower slot first.
    pub bodies: [BodyId; 2],
    /// The number of periods along each axis by which the second body is moved, from where the user
    /// has put it, so that it may touch the first.
    pub image: [i32; 3],
}

/// The pairs that have begun, persist or have ended between two culls of a periodic world, each
/// kind sorted by slots. It doesn't borrow the world.
///
/// Two bodies are one pair wherever they touch: if one is moved by a whole period and touches the
/// other in another image, their pair persists, and has the later image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PeriodicEvents {
    begun: Vec<PeriodicPair>,
    persisting: Vec<PeriodicPair>,
    ended: Vec<PeriodicPair>,
}

impl PeriodicEvents {
    /// The events between two culls, from their sorted pairs.
    pub(super) fn between(before: &[PeriodicPair], now: &[PeriodicPair]) -> Self {
        let mut events = Self::default();
        let order = |old: &&PeriodicPair, new: &&PeriodicPair| old.bodies.cmp(&new.bodies);
        for merged in Merge::new(before, now, order) {
            match merged {
                Merged::First(&gone) => events.ended.push(gone),
                Merged::Second(&come) => events.begun.push(come),
                Merged::Both(_, &pair) => events.persisting.push(pair),
            }
        }
        events
    }

    /// Pairs reported now and not before.
    #[must_use]
    pub fn begun(&self) -> &[PeriodicPair] {
        &self.begun
    }

    /// Pairs reported now and before.
    #[must_use]
    pub fn persisting(&self) -> &[PeriodicPair] {
        &self.persisting
    }

    /// Pairs reported before and not now, with their former images; those of a body removed since
    /// then are among them.
    #[must_use]
    pub fn ended(&self) -> &[PeriodicPair] {
        &self.ended
    }
}

/// Merges a sorted list into another.
pub(super) fn merge(pairs: &mut Vec<PeriodicPair>, others: &[PeriodicPair]) {
    let (mut left, mut end) = (pairs.len(), pairs.len() + others.len());
    pairs.extend_from_slice(others);
    for &other in others.iter().rev() {
        while left > 0 && pairs[left - 1] > other {
            (left, end) = (left - 1, end - 1);
            pairs[end] = pairs[left];
        }
        end -= 1;
        pairs[end] = other;
    }
}
