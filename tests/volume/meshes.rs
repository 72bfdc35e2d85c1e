//! Vertex sets that the suites share.

use glam::{DQuat, Vec3};
use proptest::prelude::*;
use sdop::mesh::TriangleMesh;

/// A cloud of vertices as a mesh; the volumes never look at triangles.
pub fn mesh(vertices: Vec<Vec3>) -> TriangleMesh {
    TriangleMesh {
        name: "test".into(),
        vertices: vertices.iter().map(Vec3::to_array).collect(),
        triangles: Vec::new(),
        ..TriangleMesh::default()
    }
}

/// The eight corners of a box about the origin.
pub fn box_corners(size: Vec3) -> Vec<Vec3> {
    (0..8)
        .map(|i| {
            size * Vec3::from_array([1, 2, 4].map(|bit| if i & bit == 0 { -0.5 } else { 0.5 }))
        })
        .collect()
}

/// The lattice points of a box's surface, `n` steps an edge.
pub fn box_grid(size: Vec3, n: usize) -> Vec<Vec3> {
    let side = 0..=n;
    let mut points = Vec::new();
    for i in side.clone() {
        for j in side.clone() {
            for k in side.clone() {
                if [i, j, k].iter().any(|&x| x == 0 || x == n) {
                    let steps = [i, j, k].map(|x| x as f32 / n as f32 - 0.5);
                    points.push(size * Vec3::from_array(steps));
                }
            }
        }
    }
    points
}

/// Rotated in f64, rounded to f32: what was coplanar is so no longer, by one part in 2²⁴.
pub fn rotated(vertices: &[Vec3], rotation: DQuat) -> Vec<Vec3> {
    let turn = |v: &Vec3| (rotation * v.as_dvec3()).as_vec3();
    vertices.iter().map(turn).collect()
}

pub fn rotation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0_f64)
        .prop_map(DQuat::from_array)
        .prop_filter("near zero", |q| q.length() > 0.1)
        .prop_map(DQuat::normalize)
}

/// 1 to 40 vertices of one magnitude, from subnormal to 2⁵⁹, with a share of equal, small-integer
/// and zero coordinates; a point, a segment or coplanar in three of four cases.
pub fn vertices() -> impl Strategy<Value = Vec<Vec3>> {
    let exponent = prop_oneof![Just(0), -149..=58_i32];
    let coordinate = prop_oneof![
        3 => -1.0..=1.0_f32,
        1 => (-2..=2_i8).prop_map(f32::from),
        1 => Just(0.0_f32),
    ];
    let vertex = prop::array::uniform3(coordinate);
    (exponent, prop::collection::vec(vertex, 1..40), 0..4_usize).prop_map(
        |(exponent, mut list, rank)| {
            for vertex in &mut list {
                vertex[rank..].fill(0.5);
            }
            let scale = 2.0_f64.powi(exponent);
            let scaled = |x: f32| (f64::from(x) * scale) as f32;
            let scaled = |v: [f32; 3]| Vec3::from_array(v.map(scaled));
            list.into_iter().map(scaled).collect()
        },
    )
}

/// [`vertices`] with at least two different ones.
pub fn extended() -> impl Strategy<Value = Vec<Vec3>> {
    vertices().prop_filter("one point", |list| list.iter().any(|v| *v != list[0]))
}
