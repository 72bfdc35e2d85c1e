//! Merges vertices at equal positions, for formats in which every triangle has its own three
//! points.

use std::collections::HashMap;

/// Keeps each distinct position once, in the order of first use, and returns the indices of the
/// triangles, which are three consecutive corners each. 0 and −0 are equal.
pub(crate) fn weld(corners: &mut Vec<[f32; 3]>) -> Vec<[u32; 3]> {
    let mut vertices = Vec::new();
    let mut index_of: HashMap<[u32; 3], u32> = HashMap::new();
    let mut index = |&position: &[f32; 3]| {
        // x + 0.0 turns −0 into 0 and changes nothing else.
        let key = position.map(|x| (x + 0.0).to_bits());
        *index_of.entry(key).or_insert_with(|| {
            vertices.push(position);
            (vertices.len() - 1) as u32 // fewer than the corners, which a u32 counts
        })
    };
    let triangles = corners.as_chunks::<3>().0.iter();
    let triangles = triangles.map(|[a, b, c]| [index(a), index(b), index(c)]).collect();
    *corners = vertices;
    triangles
}
