//! Cuboid, bipyramid and icosphere.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::quad;

/// A box with the given edges, vertex i at the corner whose sign along axis a is bit a of i.
pub(super) fn cuboid(edges: [f32; 3]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let half = Vec3::from_array(edges) * 0.5;
    let sign = |corner: u32, axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let vertices = (0..8).map(|i| half * Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect();
    // -x, +x, -y, +y, -z, +z, each counter-clockwise from outside.
    let faces =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (vertices, faces.into_iter().flat_map(quad).collect())
}

/// Two pyramids base to base: a ring of `sides` vertices in the xy plane, tips at ±length/2 on z.
pub(super) fn bipyramid(length: f32, radius: f32, sides: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = vec![Vec3::new(0.0, 0.0, length * 0.5), Vec3::new(0.0, 0.0, -length * 0.5)];
    let mut triangles = Vec::new();
    for i in 0..sides {
        let angle = TAU * f64::from(i) / f64::from(sides);
        let ring = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0) * f64::from(radius);
        vertices.push(ring.as_vec3());
        let (here, next) = (2 + i, 2 + (i + 1) % sides);
        triangles.extend([[0, here, next], [1, next, here]]);
    }
    (vertices, triangles)
}

/// An icosahedron split `subdivisions` times, each vertex pushed out to the radius.
pub(super) fn icosphere(radius: f32, subdivisions: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut directions, mut triangles) = icosahedron();
    for _ in 0..subdivisions {
        triangles = split(&mut directions, &triangles);
    }
    let vertices = directions.iter().map(|d| (*d * f64::from(radius)).as_vec3()).collect();
    (vertices, triangles)
}

/// The twelve vertices (0, ±1, ±φ) and their cyclic shifts, scaled to the unit sphere. Vertices at
/// the shortest distance, 2 before scaling, are neighbours; three mutual neighbours are a face.
fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let golden = (1.0 + libm::sqrt(5.0)) / 2.0;
    let mut corners = Vec::new();
    for axis in 0..3 {
        for (one, phi) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut corner = [0.0; 3];
            corner[(axis + 1) % 3] = one;
            corner[(axis + 2) % 3] = phi;
            corners.push(DVec3::from_array(corner));
        }
    }
    let near = |a: usize, b: usize| corners[a].distance_squared(corners[b]) < 5.0;
    let mut triangles = Vec::new();
    for a in 0..12_usize {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outward = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                    let face = if outward { [a, b, c] } else { [a, c, b] };
                    triangles.push(face.map(|i| i as u32));
                }
            }
        }
    }
    (corners.into_iter().map(DVec3::normalize).collect(), triangles)
}

/// Splits every triangle in four at its edges' midpoints, which are pushed out to the unit sphere.
fn split(directions: &mut Vec<DVec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut midpoints = HashMap::new();
    let mut midpoint = |a: u32, b: u32| {
        *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
            directions.push((directions[a as usize] + directions[b as usize]).normalize());
            directions.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let [ab, bc, ca] = [midpoint(a, b), midpoint(b, c), midpoint(c, a)];
        finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    finer
}
