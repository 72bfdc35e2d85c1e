//! Tests the judging of histories with worlds that are wrong on purpose.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::judge::{Life, Truth, required_boxes};
use super::state::State;
use super::worlds::{JudgedWorld, ReportedPair};
use super::*;
use crate::configuration::Mode;
use crate::configuration::coverage::ListLedger;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::simd::Tier;
use sdop::world::BodyId;

fn drawn(seed: u64) -> History<BoxBody> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    draw_boxes(seed % 2 == 1, &mut |n| rng.random_range(0..n))
}

/// A world that does not see one kind of change.
struct Blind {
    world: BoxWorld,
    to: Option<ChangeKind>,
    /// Each body as the world knows it.
    known: BTreeMap<BodyId, BoxBody>,
    /// And as it was told.
    told: BTreeMap<BodyId, BoxBody>,
}

impl Blind {
    fn sees(&self, kind: ChangeKind) -> bool {
        self.to != Some(kind)
    }
}

impl JudgedWorld for Blind {
    type Body = BoxBody;
    type Saved = (BoxWorld, [BTreeMap<BodyId, BoxBody>; 2]);

    fn insert(&mut self, body: BoxBody) -> Result<BodyId, HistoryError> {
        let id = self.world.insert(body)?;
        self.known.insert(id, body);
        self.told.insert(id, body);
        Ok(id)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        self.told.remove(&id);
        match self.sees(ChangeKind::Removed) {
            true => {
                self.known.remove(&id);
                JudgedWorld::remove(&mut self.world, id)
            }
            false => Ok(()),
        }
    }

    fn change(&mut self, id: BodyId, _: BoxBody, to: BoxBody) -> Result<(), HistoryError> {
        let mut body = self.known[&id];
        if self.sees(ChangeKind::Moved) {
            body.bounds = to.bounds;
        }
        if self.sees(ChangeKind::Fixed) || to.motion != sdop::Motion::Fixed {
            body.motion = to.motion;
        }
        if self.sees(ChangeKind::Regrouped) {
            body.groups = to.groups;
        }
        self.known.insert(id, body);
        self.told.insert(id, to);
        Ok(self.world.set(id, body)?)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError> {
        match self.sees(ChangeKind::Excluded) {
            true => JudgedWorld::exclude(&mut self.world, pair, excluded),
            false => Ok(true),
        }
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        JudgedWorld::cull(&mut self.world)
    }

    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
        JudgedWorld::events(&mut self.world)
    }

    fn all(&self) -> Vec<(BodyId, BoxBody)> {
        self.told.clone().into_iter().collect()
    }

    fn save(&self) -> Self::Saved {
        (self.world.clone(), [self.known.clone(), self.told.clone()])
    }

    fn restore(&mut self, saved: &Self::Saved) -> Result<(), HistoryError> {
        let before = std::mem::take(&mut self.known);
        (self.world, [self.known, self.told]) = saved.clone();
        let is_blind = !self.sees(ChangeKind::Restored);
        for (id, body) in before.into_iter().filter(|_| is_blind) {
            // It leaves the bodies where they are.
            if let Some(known) = self.known.get_mut(&id) {
                *known = body;
                self.world.set(id, body)?;
            }
        }
        Ok(())
    }

    fn detour(&mut self, kind: ChangeKind) -> Result<bool, HistoryError> {
        self.world.detour(kind)
    }
}

/// What a world that is blind to a kind of change gets wrong over some histories.
fn wrong(to: Option<ChangeKind>) -> u64 {
    let mut ledger = ListLedger::default();
    for seed in 0..20 {
        let history = drawn(seed);
        let states = State::all(&history).unwrap();
        let required = required_boxes(&states);
        let truth = Truth::exact(required);
        let make = |_| {
            Ok(Blind { world: BoxWorld::new(), to, known: BTreeMap::new(), told: BTreeMap::new() })
        };
        let life = Life::new(make, &history, &states).unwrap();
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
        ChangeKind::Restored,
    ] {
        assert!(wrong(Some(kind)) > 0, "{}", kind.name());
    }
}

/// Most frames of a history are found from what has changed alone.
#[test]
fn histories_are_incremental() {
    let (mut updates, mut bodies) = (0, 0);
    for seed in 0..20 {
        let history = drawn(seed);
        let states = State::all(&history).unwrap();
        bodies += states.iter().map(|state| state.present().count() as u64).sum::<u64>();
        let mut life = Life::new(|_| Ok(BoxWorld::new()), &history, &states).unwrap();
        for frame in 0..states.len() {
            life.change(frame).unwrap();
            let before = life.world.counters().updates;
            life.world.cull().unwrap();
            updates += life.world.counters().updates - before;
        }
    }
    assert!(3 * updates < bodies, "{updates} of {bodies}");
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
