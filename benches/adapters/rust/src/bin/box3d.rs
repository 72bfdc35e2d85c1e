//! Box3D by boxddd-sys: the contacts of a step, with an axis-aligned box per body in one world for
//! all frames.

use std::collections::{HashMap, HashSet};
use std::ffi::c_void;

use adapters::{Found, Frame, serve};
use boxddd_sys::ffi::*;

/// `B3_HUGE` of a build in single precision, and `B3_LINEAR_SLOP`.
const LIMITS: [f32; 2] = [1.0e5, 0.005];
const ZERO: b3Vec3 = b3Vec3 {
    x: 0.0,
    y: 0.0,
    z: 0.0,
};
const UPRIGHT: b3Quat = b3Quat { v: ZERO, s: 1.0 };

fn main() {
    serve("boxddd-sys", || {
        let mut world = World::new();
        move |frame: &Frame| world.contacts(frame)
    });
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

struct Placed {
    body: b3BodyId,
    shape: b3ShapeId,
    half: [f32; 3],
}

/// A world that is destroyed after its case, with the bodies by their ids.
struct World {
    id: b3WorldId,
    bodies: HashMap<usize, Placed>,
    /// Pairs of ids that don't collide, at an address that Box3D keeps.
    excluded: Box<HashSet<[usize; 2]>>,
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: the world exists, and nothing uses it from here on.
        unsafe { b3DestroyWorld(self.id) }
    }
}

/// Whether two shapes collide, by their ids in `context`.
unsafe extern "C" fn may_collide(a: b3ShapeId, b: b3ShapeId, context: *mut c_void) -> bool {
    // SAFETY: the context is the set of a world that exists, and is not changed during a step.
    let excluded = unsafe { &*context.cast::<HashSet<[usize; 2]>>() };
    // SAFETY: Box3D calls with shapes that exist.
    let mut pair = [a, b].map(|shape| unsafe { b3Shape_GetUserData(shape) } as usize);
    pair.sort_unstable();
    !excluded.contains(&pair)
}

// SAFETY of all calls below: they follow the header, and ids are used only while what they name
// exists.
impl World {
    fn new() -> Self {
        let mut excluded = Box::default();
        let id = unsafe {
            let mut def = b3DefaultWorldDef();
            def.gravity = ZERO;
            def.enableSleep = false;
            let id = b3CreateWorld(&def);
            let context: *mut HashSet<[usize; 2]> = &raw mut *excluded;
            b3World_SetCustomFilterCallback(id, Some(may_collide), context.cast());
            id
        };
        Self {
            id,
            bodies: HashMap::new(),
            excluded,
        }
    }

    fn contacts(&mut self, frame: &Frame) -> Found {
        let mut placed = Vec::new();
        for ends in &frame.boxes {
            let centre = [0, 1, 2].map(|axis| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
            let half = [0, 1, 2].map(|axis| half(centre[axis], ends[axis], ends[axis + 3]));
            let is_small = half.iter().any(|&length| length < LIMITS[1]);
            if is_small || ends.iter().any(|x| x.abs() > LIMITS[0]) {
                return Err("a box is smaller than B3_LINEAR_SLOP or farther out than B3_HUGE");
            }
            placed.push((centre, half));
        }
        for gone in frame.gone.iter().filter_map(|id| self.bodies.remove(id)) {
            unsafe { b3DestroyBody(gone.body) }
        }
        let pair = |pair: &[usize; 2]| {
            let mut ids = pair.map(|number| frame.ids[number]);
            ids.sort_unstable();
            ids
        };
        let excluded: HashSet<[usize; 2]> = frame.excluded.iter().map(pair).collect();
        let is_changed = excluded != *self.excluded;
        *self.excluded = excluded;
        for (number, (centre, half)) in placed.into_iter().enumerate() {
            let (id, groups) = (
                frame.ids[number],
                frame.groups.as_ref().map(|it| it[number]),
            );
            self.place(id, centre, half, groups, is_changed);
        }
        unsafe { b3World_Step(self.id, 1.0e-6, 1) }
        Ok(self
            .bodies
            .values()
            .flat_map(|it| unsafe { pairs(it.body) })
            .collect())
    }

    /// Moves a body. It gets a new shape if its size or the excluded pairs have changed.
    fn place(
        &mut self,
        id: usize,
        [x, y, z]: [f32; 3],
        half: [f32; 3],
        groups: Option<[u32; 2]>,
        is_new_shape: bool,
    ) {
        let world = self.id;
        let (def, filter) = unsafe {
            let mut def = b3DefaultShapeDef();
            def.userData = id as *mut c_void;
            def.enableCustomFiltering = true;
            if let Some([category, mask]) = groups {
                (def.filter.categoryBits, def.filter.maskBits) = (category.into(), mask.into());
            }
            (def, def.filter)
        };
        let hulled = |body| unsafe {
            let hull = b3MakeBoxHull(half[0], half[1], half[2]);
            b3CreateHullShape(body, &def, &hull.base)
        };
        let position = b3Vec3 { x, y, z };
        let placed = self.bodies.entry(id).or_insert_with(|| unsafe {
            let mut def = b3DefaultBodyDef();
            def.type_ = b3BodyType_b3_dynamicBody;
            def.position = position;
            let body = b3CreateBody(world, &def);
            Placed {
                body,
                shape: hulled(body),
                half,
            }
        });
        unsafe {
            if placed.half != half || is_new_shape {
                b3DestroyShape(placed.shape, true);
                (placed.shape, placed.half) = (hulled(placed.body), half);
            }
            b3Shape_SetFilter(placed.shape, filter, true);
            b3Body_SetTransform(placed.body, position, UPRIGHT);
            b3Body_SetLinearVelocity(placed.body, ZERO);
            b3Body_SetAngularVelocity(placed.body, ZERO);
        }
    }
}

/// The pairs of ids of a body's contacts.
unsafe fn pairs(body: b3BodyId) -> Vec<[usize; 2]> {
    unsafe {
        let mut room = Vec::with_capacity(b3Body_GetContactCapacity(body).max(1) as usize);
        let count = b3Body_GetContactData(body, room.as_mut_ptr(), room.capacity() as i32);
        room.set_len(count as usize);
        let id = |shape| b3Shape_GetUserData(shape) as usize;
        room.iter()
            .map(|contact: &b3ContactData| [contact.shapeIdA, contact.shapeIdB].map(id))
            .collect()
    }
}
