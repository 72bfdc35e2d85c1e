//! An engine with all changes that it has reported.

use sdop_judge::contestant::Contestant;

use crate::changes::Changes;
use crate::incremental::{Found, Incremental, Moves};

/// An engine with all changes so far.
pub struct Follower {
    engine: Box<dyn Incremental>,
    log: Changes,
}

impl Follower {
    /// An engine whose first boxes have been read.
    pub fn new(engine: Box<dyn Incremental>) -> Self {
        let mut follower = Self { engine, log: Changes::default() };
        follower.settle();
        follower
    }

    /// Bytes of the changes, which are no part of the engine.
    pub fn log_bytes(&self) -> u64 {
        self.log.bytes()
    }

    /// Whether it reports events.
    pub fn has_events(&self) -> bool {
        matches!(self.engine.found(), Found::Changes(_))
    }
}

impl Contestant<Moves> for Follower {
    fn frame(&mut self, moves: &Moves) {
        self.engine.frame(moves);
    }

    fn settle(&mut self) {
        if let Found::Changes(changes) = self.engine.found() {
            for &(pair, begins) in changes {
                self.log.note(pair, begins);
            }
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        match self.engine.found() {
            Found::Changes(_) => self.log.pairs(),
            Found::Pairs(pairs) => pairs,
        }
    }
}
