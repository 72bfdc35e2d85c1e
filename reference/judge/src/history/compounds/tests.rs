//! Tests the judging of compounds with worlds that are wrong on purpose.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::configuration::variants;
use crate::history::history_shapes;
use crate::history::worlds::{Listing, ReportedPair};

/// What a world does wrong to its list.
type Fault = fn(&CompoundWorld, &mut Vec<ReportedPair>);

/// A world that is wrong on purpose.
struct WrongWorld(CompoundWorld, Fault);

impl Listing for WrongWorld {
    type World = CompoundWorld;

    fn world(&self) -> &CompoundWorld {
        &self.0
    }

    fn world_mut(&mut self) -> &mut CompoundWorld {
        &mut self.0
    }

    fn list(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        let mut listed = self.0.list()?;
        (self.1)(&self.0, &mut listed);
        listed.sort_unstable();
        Ok(listed)
    }
}

/// What is wrong in a history of a world with a fault, which newly built worlds have, too.
fn judged(fault: Fault) -> ListLedger {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut below = |n| rng.random_range(0..n);
    let variant = variants().next().unwrap();
    let robots = Robots::draw(history_shapes(variant, 7, false).unwrap(), &mut below).unwrap();
    let history = robots.history(&mut below);
    let states = State::all(&history).unwrap();
    let grown = GrownParts::new(&robots.shapes).unwrap();
    let mut exact = ExactParts::new(&robots, &grown);
    let near: Vec<Vec<NearParts>> = states.iter().map(|state| exact.near(state)).collect();
    let way = rows(variant).swap_remove(1);
    let mut truth = truth(&robots, &states, &near, &way, Tier::SCALAR).unwrap();
    let mode = Mode::plain(Tier::SCALAR);
    let new = || WrongWorld(world(&robots, &way, mode).unwrap(), fault);
    truth.fresh = states.iter().map(|state| state.fresh(new()).unwrap()).collect();
    let mut ledger = ListLedger::default();
    let life = Life::new(|_| Ok(new()), &history, &states).unwrap();
    life.live(WorldKind::Compounds(way.strategy), mode, &truth, &mut ledger).unwrap();
    ledger
}

/// A right world passes, and one that is wrong in the same way after each history is seen.
#[test]
fn wrong_parts_are_seen() {
    assert_eq!(judged(|_, _| {}).failure, None);
    let ListLedger { missed, differ, .. } = judged(|_, list| {
        list.retain(|pair| pair.parts.is_none_or(|parts| parts[1] == 0));
    });
    assert!(missed > 0 && differ == 0, "parts are lost");
    let ListLedger { missed, differ, .. } =
        judged(|_, list| list.retain(|pair| pair.parts.is_some()));
    assert!(missed > 0 && differ == 0, "pairs of bodies are lost");
    let ListLedger { missed, differ, .. } = judged(|world, list| {
        let body = world.world.ids().next();
        list.extend(body.map(|id| ReportedPair::of([id; 2], Some([0, 1]))));
    });
    assert!(missed == 0 && differ > 0, "pairs within a body are listed");
    let ListLedger { missed, differ, .. } = judged(|world, list| {
        let all = world.world.pairs();
        list.extend(all.map(|ids| ReportedPair::of(ids, Some([0, 0]))));
        list.sort_unstable();
        list.dedup();
    });
    assert!(missed == 0 && differ > 0, "parts that are apart are listed");
}
