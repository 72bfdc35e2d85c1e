//! What has changed between two lists of pairs, found by merging them: no list of changes is kept.

use std::iter::Peekable;
use std::sync::Arc;

use super::BodyId;
use super::pair_log::{PairIds, Reported};

/// A change of one pair, or none: the lower slot first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Reported now and not before.
    Begun([BodyId; 2]),
    /// Reported now and before.
    Persisting([BodyId; 2]),
    /// Reported before and not now; pairs of a body removed since then are among them.
    Ended([BodyId; 2]),
}

/// What two lists of pairs have in common and what not, each kind sorted by slots.
///
/// Holds both lists, and borrows nothing of the world: bodies may be removed while events are read. Each iterator is one
/// pass over both lists and takes no memory; with millions of pairs, use [`Self::iter`] once instead of all three.
#[derive(Clone, Debug, Default)]
pub struct Events {
    pub(super) before: Arc<Reported>,
    pub(super) now: Arc<Reported>,
}

impl Events {
    /// All events, sorted by the slots of their pairs.
    pub fn iter(&self) -> impl Iterator<Item = Event> + '_ {
        Merge {
            before: self.before.pairs().iter().peekable(),
            now: self.now.pairs().iter().peekable(),
        }
    }

    /// Pairs reported now and not before.
    pub fn begun(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        self.iter().filter_map(|event| match event {
            Event::Begun(pair) => Some(pair),
            _ => None,
        })
    }

    /// Pairs reported now and before.
    pub fn persisting(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        self.iter().filter_map(|event| match event {
            Event::Persisting(pair) => Some(pair),
            _ => None,
        })
    }

    /// Pairs reported before and not now; those of a body removed since then are among them.
    pub fn ended(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        self.iter().filter_map(|event| match event {
            Event::Ended(pair) => Some(pair),
            _ => None,
        })
    }
}

/// Two sorted lists, merged.
struct Merge<'a> {
    before: Peekable<PairIds<'a>>,
    now: Peekable<PairIds<'a>>,
}

impl Iterator for Merge<'_> {
    type Item = Event;
    fn next(&mut self) -> Option<Event> {
        let Some(&pair) = self.now.peek() else {
            return self.before.next().map(Event::Ended);
        };
        if let Some(gone) = self.before.next_if(|&old| old < pair) {
            return Some(Event::Ended(gone));
        }
        self.now.next();
        match self.before.next_if_eq(&pair) {
            Some(_) => Some(Event::Persisting(pair)),
            None => Some(Event::Begun(pair)),
        }
    }
}
