//! parry3d: one Bvh for all frames, leaves updated and the tree refitted, and a query for each box.

use adapters::{Frame, serve};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhWorkspace};

fn main() {
    serve("parry3d", || {
        let (mut tree, mut workspace) = (Bvh::new(), BvhWorkspace::default());
        move |frame: &Frame| {
            frame.gone.iter().for_each(|&id| tree.remove(id as u32));
            let corners = |&[a, b, c, d, e, f]: &[f32; 6]| {
                Aabb::new(Vector::new(a, b, c), Vector::new(d, e, f))
            };
            let boxes: Vec<Aabb> = frame.boxes.iter().map(corners).collect();
            for (it, &id) in boxes.iter().zip(&frame.ids) {
                tree.insert_or_update_partially(*it, id as u32, 0.0);
            }
            tree.refit(&mut workspace);
            let near = |(it, &id)| {
                tree.intersect_aabb(it)
                    .map(move |other| [id, other as usize])
            };
            Ok(boxes.iter().zip(&frame.ids).flat_map(near).collect())
        }
    });
}
