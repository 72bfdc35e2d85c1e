//! Gear and L-shape: outlines in the xy plane, raised along z.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::quad;

/// A tooth's outline as fractions of the pitch, and whether each point is at the tip: flank up, tip
/// land, flank down, root land.
const TOOTH_PROFILE: [(f64, bool); 4] = [(0.0, false), (0.2, true), (0.5, true), (0.7, false)];

/// A gear with the radii [tip, root, bore]: outline and bore share their angles, so plain quads
/// join them.
pub(super) fn gear(radii: [f32; 3], thickness: f32, teeth: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let [tip, root, bore] = radii.map(f64::from);
    let half = f64::from(thickness) / 2.0;
    let n = 4 * teeth;
    let mut vertices = Vec::new();
    for tooth in 0..teeth {
        for (part, on_tip) in TOOTH_PROFILE {
            let angle = TAU * (f64::from(tooth) + part) / f64::from(teeth);
            let (cos, sin) = (libm::cos(angle), libm::sin(angle));
            let outer = if on_tip { tip } else { root };
            for (radius, z) in [(outer, -half), (outer, half), (bore, -half), (bore, half)] {
                vertices.push(DVec3::new(radius * cos, radius * sin, z).as_vec3());
            }
        }
    }
    let mut triangles = Vec::new();
    for i in 0..n {
        let ([low, high, bore_low, bore_high], [low2, high2, bore_low2, bore_high2]) =
            (corners(i), corners((i + 1) % n));
        triangles.extend(quad([low, low2, high2, high]));
        triangles.extend(quad([high, high2, bore_high2, bore_high]));
        triangles.extend(quad([bore_high, bore_high2, bore_low2, bore_low]));
        triangles.extend(quad([bore_low, bore_low2, low2, low]));
    }
    (vertices, triangles)
}

/// The four vertices at outline step i: outer low and high, bore low and high.
fn corners(i: u32) -> [u32; 4] {
    [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3]
}

/// An L of outer lengths [x, y]. The whole outline is visible from the inner corner, so a fan from
/// there fills it.
pub(super) fn l_shape([x, y]: [f32; 2], arm: f32, thickness: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let inner_corner = 3;
    let outline = [[0.0, 0.0], [x, 0.0], [x, arm], [arm, arm], [arm, y], [0.0, y]];
    let n = outline.len() as u32;
    let mut vertices = Vec::new();
    for z in [-thickness * 0.5, thickness * 0.5] {
        vertices.extend(outline.map(|[px, py]| Vec3::new(px - x * 0.5, py - y * 0.5, z)));
    }
    let mut triangles = Vec::new();
    for i in 0..n {
        let next = (i + 1) % n;
        triangles.extend(quad([i, next, n + next, n + i]));
        if i != inner_corner && next != inner_corner {
            triangles.extend([[n + inner_corner, n + i, n + next], [inner_corner, next, i]]);
        }
    }
    (vertices, triangles)
}
