//! Contacts with and without the filter, step by step from the same state.

use super::super::rapier::prelude::*;
use super::sim::{Sim, bodies_that_differ, overlaps, touches};
use crate::record::Check;

/// Takes `steps` filtered steps; before each, its state is stepped without the filter and compared.
///
/// `dropped` is called with the state and the pair of the first step that drops one.
pub fn check(
    sim: &mut Sim,
    steps: usize,
    mut dropped: impl FnMut(&PhysicsWorld, [ColliderHandle; 2]),
) -> Check {
    let mut check = Check {
        steps,
        ..Check::default()
    };
    for step in 0..steps {
        let before = sim.calls().narrow();
        let free = sim.unfiltered().world;
        let between = sim.calls().narrow();
        sim.step();
        check.checked_unfiltered += between - before;
        check.checked += sim.calls().narrow() - between;
        let filtered = &sim.stage.world;
        let (expected, found) = (touches(&free), touches(filtered));
        let (overlapping, overlaps) = (overlaps(&free), overlaps(filtered));
        check.touching += expected.len() as u64;
        check.overlapping += overlapping.len() as u64;
        let lacks_points = expected.keys().filter(|pair| !found.contains_key(*pair));
        for &pair in lacks_points.chain(overlapping.difference(&overlaps)) {
            check.dropped += 1;
            if check.first_dropped.is_none() {
                check.first_dropped = Some((step, pair.map(|c| c.into_raw_parts().0)));
                dropped(&free, pair);
            }
        }
        let differs = |pair: &&[ColliderHandle; 2]| {
            found
                .get(*pair)
                .is_some_and(|touch| *touch != expected[*pair])
        };
        check.contacts_that_differ += expected.keys().filter(differs).count() as u64;
        check.bodies_that_differ += bodies_that_differ(&filtered.bodies, &free.bodies) as u64;
    }
    check
}
