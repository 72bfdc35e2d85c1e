//! Box3D by boxddd-sys: the contacts of one step of a new world, with an axis-aligned box per body.

use adapters::{Frame, serve};
use boxddd_sys::ffi::*;

/// `B3_HUGE` of a build in single precision, and `B3_LINEAR_SLOP`.
const LIMITS: [f32; 2] = [1.0e5, 0.005];

fn main() {
    serve("boxddd-sys", || contacts);
}

/// The half side of the smallest box about a centre that contains both ends. More pairs are no
/// failure.
fn half(centre: f32, lower: f32, upper: f32) -> f32 {
    let mut half = (upper - centre).max(centre - lower);
    while centre - half > lower || centre + half < upper {
        half = half.next_up();
    }
    half
}

fn contacts(frame: &Frame) -> Result<Vec<[usize; 2]>, &'static str> {
    let mut placed = Vec::new();
    for ends in &frame.boxes {
        let centre = [0, 1, 2].map(|axis| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
        let half = [0, 1, 2].map(|axis| half(centre[axis], ends[axis], ends[axis + 3]));
        if half.iter().any(|&length| length < LIMITS[1]) || ends.iter().any(|x| x.abs() > LIMITS[0])
        {
            return Err("a box is smaller than B3_LINEAR_SLOP or farther out than B3_HUGE");
        }
        placed.push((centre, half));
    }
    // SAFETY: the calls follow the header; ids are used only while their world exists, which is
    // local to this function.
    unsafe {
        let mut def = b3DefaultWorldDef();
        def.gravity = b3Vec3 {
            x: 0.0,
            y: 0.0,
            z: 0.0,
        };
        let world = b3CreateWorld(&def);
        let mut bodies = Vec::new();
        for (number, ([x, y, z], [a, b, c])) in placed.iter().copied().enumerate() {
            let mut def = b3DefaultBodyDef();
            def.type_ = b3BodyType_b3_dynamicBody;
            def.position = b3Vec3 { x, y, z };
            let body = b3CreateBody(world, &def);
            let mut shape = b3DefaultShapeDef();
            shape.userData = frame.ids[number] as *mut _;
            let hull = b3MakeBoxHull(a, b, c);
            b3CreateHullShape(body, &shape, &hull.base);
            bodies.push(body);
        }
        b3World_Step(world, 1.0e-6, 1);
        let mut found = Vec::new();
        for body in bodies {
            let mut room = Vec::with_capacity(b3Body_GetContactCapacity(body).max(1) as usize);
            let count = b3Body_GetContactData(body, room.as_mut_ptr(), room.capacity() as i32);
            room.set_len(count as usize);
            for contact in room {
                found.push(
                    [contact.shapeIdA, contact.shapeIdB]
                        .map(|shape| b3Shape_GetUserData(shape) as usize),
                );
            }
        }
        b3DestroyWorld(world);
        Ok(found)
    }
}
