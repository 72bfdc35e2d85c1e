//! Contacts with and without the filter, step by step from the same state.

use super::super::rapier::parry::query::distance;
use super::super::rapier::prelude::*;
use super::sim::{Sim, bodies_that_differ, overlaps, touches};
use crate::record::Check;

/// Takes `steps` filtered steps; before each, its state is stepped without the filter and compared.
///
/// `dropped` is called with the state before the first step that drops a pair, and with the pair.
pub fn check(
    sim: &mut Sim,
    steps: usize,
    mut dropped: impl FnMut(&PhysicsWorld, [ColliderHandle; 2]),
) -> Check {
    let mut check = Check { steps, ..Check::default() };
    for step in 0..steps {
        let before = sim.calls().narrow();
        let [start, free] = sim.unfiltered().map(|stage| stage.world);
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
            if out_of_sight(&start, pair) {
                check.leftovers += 1;
                continue;
            }
            check.dropped += 1;
            if check.first_dropped.is_none() {
                check.first_dropped = Some((step, pair.map(|c| c.into_raw_parts().0)));
                dropped(&start, pair);
            }
        }
        let differs = |pair: &&[ColliderHandle; 2]| {
            found.get(*pair).is_some_and(|touch| *touch != expected[*pair])
        };
        check.contacts_that_differ += expected.keys().filter(differs).count() as u64;
        check.bodies_that_differ += bodies_that_differ(&filtered.bodies, &free.bodies) as u64;
    }
    check
}

/// Whether the two are farther apart than rapier looks in this step, by its own distance query. It
/// keeps points of such a pair all the same where a shape was replaced by one with fewer manifolds
/// (`set_shape`): it updates the first of them and leaves the others as they were. A pair that is
/// rejected loses them.
fn out_of_sight(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> bool {
    let body = |collider: &Collider| collider.parent().and_then(|body| world.bodies.get(body));
    let pose = |collider: &Collider| match (body(collider), collider.position_wrt_parent()) {
        (Some(body), Some(local)) => *body.position() * *local,
        _ => *collider.position(),
    };
    let [Some(a), Some(b)] = pair.map(|handle| world.colliders.get(handle)) else {
        return false;
    };
    let way = |collider| body(collider).map_or(0.0, |body| body.linvel().length());
    let parameters = &world.integration_parameters;
    let way = parameters.dt * (way(a) + way(b)); // soft CCD looks as far, at most
    let looks = parameters.prediction_distance().max(way) + a.contact_skin() + b.contact_skin();
    distance(&pose(a), a.shape(), &pose(b), b.shape()).is_ok_and(|found| found.distance > looks)
}
