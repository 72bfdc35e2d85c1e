//! obvhs: one Bvh2 for all frames, built by ploc, with primitives moved, inserted and removed.

use std::collections::HashSet;

use adapters::{Frame, serve};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::insertion_removal::build_bvh2_by_insertion;

fn main() {
    serve("obvhs", || {
        let (mut tree, mut known): (Option<Bvh2>, HashSet<usize>) = (None, HashSet::new());
        move |frame: &Frame| {
            let corners =
                |&[a, b, c, d, e, f]: &[f32; 6]| Aabb::new([a, b, c].into(), [d, e, f].into());
            let boxes: Vec<Aabb> = frame.boxes.iter().map(corners).collect();
            let tree = tree.get_or_insert_with(|| {
                known.extend(frame.ids.iter().copied());
                build_bvh2_by_insertion(&boxes)
            });
            for id in &frame.gone {
                known.remove(id);
                tree.remove_primitive(*id as u32);
            }
            for (it, &id) in boxes.iter().zip(&frame.ids) {
                if known.insert(id) {
                    tree.insert_primitive(*it, id as u32);
                } else {
                    tree.move_primitive(*it, id as u32);
                }
            }
            let mut found = Vec::new();
            for (it, &id) in boxes.iter().zip(&frame.ids) {
                tree.aabb_traverse(*it, |tree, node| {
                    let node = &tree.nodes[node as usize];
                    let primitives =
                        node.first_index as usize..(node.first_index + node.prim_count) as usize;
                    found.extend(
                        tree.primitive_indices[primitives]
                            .iter()
                            .map(|&other| [id, other as usize]),
                    );
                    true
                });
            }
            Ok(found)
        }
    });
}
