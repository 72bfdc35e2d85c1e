//! Joins vertices at equal positions, for formats that write every triangle with its own three points.

use std::collections::HashMap;

use glam::Vec3;

/// Gives each distinct position one index, in the order of first use. Positions are equal when their coordinates
/// are (0 and −0 too); nothing is rounded, so no two points that differ are ever joined.
#[derive(Default)]
pub(super) struct Welder {
    vertices: Vec<Vec3>,
    index_of: HashMap<[u32; 3], u32>,
}

impl Welder {
    /// The index of the position.
    pub(super) fn index(&mut self, position: Vec3) -> u32 {
        // x + 0.0 turns −0 into 0 and changes nothing else.
        let key = position.to_array().map(|x| (x + 0.0).to_bits());
        *self.index_of.entry(key).or_insert_with(|| {
            self.vertices.push(position);
            // Past 2³² the index wraps, but `TriangleMesh::new` then refuses the vertex count.
            (self.vertices.len() - 1) as u32
        })
    }

    pub(super) fn into_vertices(self) -> Vec<Vec3> {
        self.vertices
    }
}
