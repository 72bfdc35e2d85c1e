//! Counts the contacts of a new Box3D world in which all boxes overlap.
//!
//! Cargo.toml: boxddd-sys = "=0.4.0". All boxes have a side of 1 and are moved by less than half of
//! it, so that every two overlap. The broad phase has room for 16 new pairs per moving shape and
//! ignores others (`b3PairQueryCallback` in broad_phase.c). A step is a microsecond, so that the
//! boxes stay where they are.

use boxddd_sys::ffi::*;

const ZERO: b3Vec3 = b3Vec3 {
    x: 0.0,
    y: 0.0,
    z: 0.0,
};

fn main() {
    for count in [8_i32, 16, 32, 33, 34, 40, 64, 128] {
        // SAFETY: the calls follow the header, and no id outlives its world.
        let [at_first, later] = unsafe {
            let world = crowded(count);
            let contacts = [1, 60].map(|steps| {
                (0..steps).for_each(|_| b3World_Step(world, 1.0e-6, 1));
                b3World_GetCounters(world).contactCount
            });
            b3DestroyWorld(world);
            contacts
        };
        let pairs = count * (count - 1) / 2;
        println!(
            "{count} boxes, {pairs} pairs overlap: {at_first} contacts, {later} after 60 more steps"
        );
    }
}

/// A world of boxes of which every two overlap.
unsafe fn crowded(count: i32) -> b3WorldId {
    unsafe {
        let mut def = b3DefaultWorldDef();
        def.gravity = ZERO;
        let world = b3CreateWorld(&def);
        for number in 0..count {
            let mut body = b3DefaultBodyDef();
            body.type_ = b3BodyType_b3_dynamicBody;
            let at = |step: i32| 0.1 * (number / step % 5) as f32;
            body.position = b3Vec3 {
                x: at(1),
                y: at(5),
                z: at(25),
            };
            let hull = b3MakeBoxHull(0.5, 0.5, 0.5);
            b3CreateHullShape(b3CreateBody(world, &body), &b3DefaultShapeDef(), &hull.base);
        }
        world
    }
}
