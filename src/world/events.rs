//! What has changed between two lists of pairs.

use super::BodyId;

/// Pairs of bodies, the lower slot first, each list sorted by slots.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Events {
    /// Reported now and not before.
    pub begun: Vec<[BodyId; 2]>,
    /// Reported now and before.
    pub persisting: Vec<[BodyId; 2]>,
    /// Reported before and not now; pairs of a body removed since then are among them.
    pub ended: Vec<[BodyId; 2]>,
}

/// The pairs at the last look, and what has changed since the one before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Watch {
    seen: Vec<[BodyId; 2]>,
    now: Vec<[BodyId; 2]>,
    events: Events,
}

impl Watch {
    /// Looks at the pairs of today.
    pub fn look(&mut self, pairs: impl Iterator<Item = [BodyId; 2]>) -> &Events {
        std::mem::swap(&mut self.seen, &mut self.now);
        self.now.clear();
        self.now.extend(pairs);
        self.now.sort_unstable();
        let Events {
            begun,
            persisting,
            ended,
        } = &mut self.events;
        for list in [&mut *begun, &mut *persisting, &mut *ended] {
            list.clear();
        }
        let mut before = self.seen.iter().copied().peekable();
        for &pair in &self.now {
            while let Some(gone) = before.next_if(|&old| old < pair) {
                ended.push(gone);
            }
            match before.next_if_eq(&pair) {
                Some(_) => persisting.push(pair),
                None => begun.push(pair),
            }
        }
        ended.extend(before);
        &self.events
    }
}
