//! box3d-rust: a new world for each frame, hulls about its boxes, in which one short step finds
//! contacts. A port of Box3D to scalar Rust, on one thread.

use adapters::{Frame, serve};
use box3d_rust::body::{body_get_contact_data, create_body};
use box3d_rust::hull::make_box_hull;
use box3d_rust::shape::{create_hull_shape, shape_get_user_data};
use box3d_rust::world::World;
use box3d_rust::{BodyType, Pos, VEC3_ZERO, default_body_def, default_shape_def, default_world_def};

/// `B3_HUGE` and `B3_LINEAR_SLOP`.
const LIMITS: [f32; 2] = [1.0e5, 0.005];

fn main() {
    serve("box3d-rust", || |frame: &Frame| {
        let mut def = default_world_def();
        (def.gravity, def.enable_sleep) = (VEC3_ZERO, false);
        let (mut world, mut bodies) = (World::new(&def), Vec::new());
        for (ends, &id) in frame.boxes.iter().zip(&frame.ids) {
            let [x, y, z] = [0, 1, 2].map(|axis| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
            let half = [(0, x), (1, y), (2, z)];
            let half = half.map(|(axis, centre)| half_side(centre, ends[axis], ends[axis + 3]));
            let is_small = half.iter().any(|&length| length < LIMITS[1]);
            if is_small || ends.iter().any(|x| x.abs() > LIMITS[0]) {
                return Err("a box is smaller than B3_LINEAR_SLOP or farther out than B3_HUGE");
            }
            let mut body = default_body_def();
            (body.type_, body.position) = (BodyType::Dynamic, Pos { x, y, z });
            let body = create_body(&mut world, &body);
            let mut shape = default_shape_def();
            shape.user_data = id as u64;
            let hull = make_box_hull(half[0], half[1], half[2]);
            create_hull_shape(&mut world, body, &shape, &hull.base);
            bodies.push(body);
        }
        world.step(1.0e-6, 1);
        let contacts = bodies.iter().flat_map(|&body| body_get_contact_data(&world, body, usize::MAX));
        let shapes = contacts.map(|contact| [contact.shape_id_a, contact.shape_id_b]);
        let ids = shapes.map(|pair| pair.map(|shape| shape_get_user_data(&world, shape) as usize));
        Ok(ids.collect())
    });
}

/// The half side of the smallest box about a centre that contains both ends. More pairs are no
/// failure.
fn half_side(centre: f32, lower: f32, upper: f32) -> f32 {
    let mut half = (upper - centre).max(centre - lower);
    while centre - half > lower || centre + half < upper {
        half = half.next_up();
    }
    half
}
