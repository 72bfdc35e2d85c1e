//! Torus and trefoil knot: a circle swept along a closed curve.
//!
//! Vertex (i, j) = p(uᵢ) + r·(cos vⱼ·n + sin vⱼ·m) with unit normals n, m of the curve and n × m =
//! −p′/|p′|, which makes (i, j) → (i+1, j) → (i+1, j+1) counter-clockwise from outside.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::quad;

/// A point of the curve with the normals n and m.
struct CurveFrame {
    point: DVec3,
    n: DVec3,
    m: DVec3,
}

pub(super) fn torus(
    radius: f32,
    tube: f32,
    segments: u32,
    sides: u32,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    sweep(tube, segments, sides, |u| {
        let outward = DVec3::new(libm::cos(u), libm::sin(u), 0.0);
        CurveFrame { point: outward * f64::from(radius), n: outward, m: DVec3::Z }
    })
}

/// p(u) = (sin u + 2 sin 2u, cos u − 2 cos 2u, −sin 3u)·radius/3. Its curvature never vanishes, so
/// principal normal and binormal are continuous and meet again after one turn: no twist is left to
/// undo.
pub(super) fn trefoil(
    radius: f32,
    tube: f32,
    segments: u32,
    sides: u32,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let scale = f64::from(radius) / 3.0;
    sweep(tube, segments, sides, |u| {
        let [(s1, c1), (s2, c2), (s3, c3)] =
            [u, 2.0 * u, 3.0 * u].map(|a| (libm::sin(a), libm::cos(a)));
        let point = DVec3::new(s1 + 2.0 * s2, c1 - 2.0 * c2, -s3) * scale;
        let velocity = DVec3::new(c1 + 4.0 * c2, 4.0 * s2 - s1, -3.0 * c3);
        let acceleration = DVec3::new(-s1 - 8.0 * s2, 8.0 * c2 - c1, 9.0 * s3);
        let tangent = velocity.normalize();
        let binormal = velocity.cross(acceleration).normalize();
        CurveFrame { point, n: binormal.cross(tangent), m: -binormal }
    })
}

fn sweep(
    tube: f32,
    segments: u32,
    sides: u32,
    frame: impl Fn(f64) -> CurveFrame,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    let index = |i: u32, j: u32| (i % segments) * sides + j % sides;
    for i in 0..segments {
        let CurveFrame { point, n, m } = frame(TAU * f64::from(i) / f64::from(segments));
        for j in 0..sides {
            let v = TAU * f64::from(j) / f64::from(sides);
            let offset = n * libm::cos(v) + m * libm::sin(v);
            vertices.push((point + offset * f64::from(tube)).as_vec3());
            triangles.extend(quad([
                index(i, j),
                index(i + 1, j),
                index(i + 1, j + 1),
                index(i, j + 1),
            ]));
        }
    }
    (vertices, triangles)
}
