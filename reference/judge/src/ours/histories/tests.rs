//! Tests the judging of histories with worlds that are wrong on purpose.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::judge::{Life, Truth, required_boxes};
use super::state::State;
use super::worlds::{JudgedWorld, ReportedPair};
use super::*;
use crate::ours::configurations::Mode;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::simd::Tier;
use sdop::world::{BodyId, Events};

fn drawn(seed: u64) -> History<BoxBody> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    draw_boxes(&mut |n| rng.random_range(0..n))
}

/// A world that does not see one kind of change.
struct Blind {
    world: BoxWorld,
    to: Option<ChangeKind>,
    /// Each body as the world knows it.
    known: Vec<(BodyId, BoxBody)>,
}

impl Blind {
    fn sees(&self, kind: ChangeKind) -> bool {
        self.to != Some(kind)
    }
}

impl JudgedWorld for Blind {
    type Body = BoxBody;

    fn insert(&mut self, body: BoxBody) -> Result<BodyId, HistoryError> {
        let id = self.world.insert(body)?;
        self.known.push((id, body));
        Ok(id)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        match self.sees(ChangeKind::Removed) {
            true => JudgedWorld::remove(&mut self.world, id),
            false => Ok(()),
        }
    }

    fn change(&mut self, id: BodyId, _: BoxBody, to: BoxBody) -> Result<(), HistoryError> {
        let at = self.known.iter().position(|(known, _)| *known == id).unwrap();
        let mut body = self.known[at].1;
        if self.sees(ChangeKind::Moved) {
            body.bounds = to.bounds;
        }
        if self.sees(ChangeKind::Fixed) || to.motion != sdop::Motion::Fixed {
            body.motion = to.motion;
        }
        if self.sees(ChangeKind::Regrouped) {
            body.groups = to.groups;
        }
        self.known[at].1 = body;
        Ok(self.world.set(id, body)?)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<(), HistoryError> {
        match self.sees(ChangeKind::Excluded) {
            true => JudgedWorld::exclude(&mut self.world, pair, excluded),
            false => Ok(()),
        }
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        JudgedWorld::cull(&mut self.world)
    }

    fn events(&mut self) -> Option<Events> {
        JudgedWorld::events(&mut self.world)
    }
}

/// What a world that is blind to a kind of change gets wrong over some histories.
fn wrong(to: Option<ChangeKind>) -> u64 {
    let mut ledger = HistoryLedger::default();
    for seed in 0..20 {
        let history = drawn(seed);
        let states = State::all(&history).unwrap();
        let required = required_boxes(&states);
        let truth = Truth::exact(required);
        let world = Blind { world: BoxWorld::new(), to, known: Vec::new() };
        let life = Life::new(world, &history, &states).unwrap();
        life.live(WorldKind::Boxes, Mode::plain(Tier::SCALAR), &truth, &mut ledger).unwrap();
    }
    assert_eq!(ledger.failure.is_some(), ledger.missed + ledger.differ > 0);
    ledger.missed + ledger.differ
}

/// A world that misses a kind of change is found out, and one that sees all is not.
#[test]
fn blind_worlds_are_seen() {
    assert_eq!(wrong(None), 0);
    for kind in [
        ChangeKind::Removed,
        ChangeKind::Moved,
        ChangeKind::Fixed,
        ChangeKind::Regrouped,
        ChangeKind::Excluded,
    ] {
        assert!(wrong(Some(kind)) > 0, "{}", kind.name());
    }
}

/// Most frames of a history are found from what has changed alone.
#[test]
fn histories_are_incremental() {
    for seed in 0..20 {
        let history = drawn(seed);
        let states = State::all(&history).unwrap();
        let bodies = states.iter().map(|state| state.present().count() as u64);
        let bodies: u64 = bodies.sum();
        let mut life = Life::new(BoxWorld::new(), &history, &states).unwrap();
        for frame in 0..states.len() {
            life.change(frame).unwrap();
            life.world.cull().unwrap();
        }
        let updates = life.world.counters().updates;
        assert!(3 * updates < bodies, "seed {seed}: {updates} of {bodies}");
    }
}

/// Every kind of change comes, on bodies that are there.
#[test]
fn every_kind_of_change_is_drawn() {
    for seed in 0..20 {
        let history = drawn(seed);
        let mut seen: Vec<ChangeKind> = history.frames.iter().flatten().map(|one| one.0).collect();
        seen.sort_unstable();
        seen.dedup();
        let all = ChangeKind::ALL.iter().copied().filter(|change| WorldKind::Boxes.has(*change));
        assert_eq!(seen, all.collect::<Vec<_>>(), "seed {seed}");
    }
}
