//! The mesh room: readers, writers, validation, topology, shapes and decimation.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod decimate;
mod far;
mod files;
mod prop;
mod scale;
mod shapes;
mod stl_ply;
mod tolerant;
mod topology;
mod tri;

use crate::forms;
use sdop::mesh::TriangleMesh;
use sha2::{Digest, Sha256};

/// Six times the signed volume is the sum of det(a, b, c): positive when counter-clockwise faces
/// look outward.
fn signed_volume(mesh: &TriangleMesh) -> f64 {
    let corner = |i: u32| glam::Vec3::from(mesh.vertices[i as usize]).as_dvec3();
    let six_volumes =
        mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))));
    six_volumes.sum::<f64>() / 6.0
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
