//! Counts the contacts of one step of a new Box3D world in which all boxes overlap.
//!
//! Cargo.toml: boxddd-sys = "=0.4.0". All boxes have a side of 1 and are moved by less than half of
//! it, so that every two overlap. The broad phase has room for 16 new pairs per moving shape and
//! ignores others (`b3PairQueryCallback` in broad_phase.c).

use boxddd_sys::ffi::*;

fn main() {
    for count in [8_i32, 16, 32, 33, 34, 40, 64, 128] {
        // SAFETY: the calls follow the header, and no id outlives its world.
        let contacts = unsafe {
            let mut def = b3DefaultWorldDef();
            def.gravity = b3Vec3 {
                x: 0.0,
                y: 0.0,
                z: 0.0,
            };
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
            b3World_Step(world, 1.0e-6, 1);
            let counters = b3World_GetCounters(world);
            b3DestroyWorld(world);
            counters.contactCount
        };
        println!(
            "{count} boxes, {} pairs overlap: {contacts} contacts",
            count * (count - 1) / 2
        );
    }
}
