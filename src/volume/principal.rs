//! Principal axes: eigenvectors of the covariance of the convex hull's surface.
//!
//! With A_i, m_i the area and centroid of triangle (p, q, r)_i, A = ΣA_i and μ = ΣA_i m_i / A
//! (Gottschalk 2000, §3.5): C = Σ A_i/(12A)·(9 m mᵀ + p pᵀ + q qᵀ + r rᵀ) − μ μᵀ. It is computed
//! over the hull's surface and not over the mesh's vertices, so neither interior detail nor
//! sampling density changes the axes.

use glam::{DMat3, DQuat, DVec3};

use super::jacobi::eigen;
use super::{Axes, Basis, Hull};
use crate::mesh::in_f64;

/// Eigenvalues closer than this share of the largest are tied: rounding alone would decide the axes
/// of a gear or a cube. It is far above f32 rounding (2⁻²⁴), so that a symmetric mesh is recognised
/// after any rotation.
const EIGENVALUE_TIE: f64 = 1.0 / 8192.0;

impl Axes {
    /// The basis for these vertices. Only principal axes need the hull.
    #[must_use]
    pub fn basis(self, vertices: &[impl Into<[f32; 3]> + Copy]) -> Basis {
        match self {
            Self::Principal => Basis::principal(&Hull::of(vertices), vertices),
            Self::Model => Basis::MODEL,
        }
    }
}

impl Basis {
    /// The principal axes, longest first, rounded to an exact basis; the model axes if two are tied
    /// or the hull is flat.
    #[must_use]
    pub fn principal(hull: &Hull, vertices: &[impl Into<[f32; 3]> + Copy]) -> Self {
        surface_covariance(hull, vertices)
            .and_then(principal_rotation)
            .map_or(Self::MODEL, |rotation| Self::snapped(DQuat::from_mat3(&rotation)))
    }
}

/// The covariance of the hull's surface, relative to its size; `None` without facets.
fn surface_covariance(hull: &Hull, vertices: &[impl Into<[f32; 3]> + Copy]) -> Option<DMat3> {
    let origin = in_f64(&vertices[*hull.facets.first()?.first()? as usize].into());
    let corner = |i: u32| in_f64(&vertices[i as usize].into()) - origin;
    let scale = 1.0 / hull.vertices.iter().map(|&i| corner(i).length()).fold(0.0, f64::max);
    let (mut area, mut mean, mut moment) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for facet in &hull.facets {
        let corners = facet.map(|i| corner(i) * scale);
        let [p, q, r] = corners;
        let doubled = (q - p).cross(r - p).length();
        let centroid = (p + q + r) / 3.0;
        area += doubled;
        mean += centroid * doubled;
        moment += outer(centroid) * (9.0 * doubled);
        for corner in corners {
            moment += outer(corner) * doubled;
        }
    }
    Some(moment * (1.0 / (12.0 * area)) - outer(mean / area))
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Eigenvectors by falling eigenvalue as a right-handed rotation; `None` if two eigenvalues are
/// tied.
fn principal_rotation(covariance: DMat3) -> Option<DMat3> {
    let [(first, x), (second, y), (third, _)] = eigen(covariance);
    let gap = (first - second).min(second - third);
    let separate = gap > EIGENVALUE_TIE * first; // false for NaN
    if !separate {
        return None;
    }
    let [x, y] = [x, y].map(|axis| axis * sign_of_largest(axis));
    Some(DMat3::from_cols(x, y, x.cross(y)))
}

/// The sign of the largest component, or of the first one if others equal it up to rounding.
fn sign_of_largest(v: DVec3) -> f64 {
    let limit = v.abs().max_element() * (1.0 - 1e-6);
    let largest = v.to_array().into_iter().find(|c| c.abs() >= limit);
    largest.map_or(1.0, f64::signum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a box with these half sides, wherever it is: (bc·a² + (ab + ca)·a²/3)/(ab + bc + ca)
    /// along a, in units of its diagonal.
    #[test]
    fn box_covariance_is_its_surface_s() {
        let [a, b, c] = [1.0, 2.0, 4.0];
        let area = a * b + b * c + c * a;
        let along = |x: f64| x * x * (area / 3.0 + 2.0 / 3.0 * (a * b * c / x)) / area;
        for size in [1.0, 2f64.powi(-140), 2f64.powi(60)] {
            let corner = |i: u32| {
                let sign = |axis: u32| if i >> axis & 1 == 1 { size } else { -size };
                (DVec3::new(a * sign(0), b * sign(1), c * sign(2))
                    + size * DVec3::new(3.0, 5.0, -2.0))
                .as_vec3()
            };
            let vertices: Vec<_> = (0..8).map(corner).collect();
            let found = surface_covariance(&Hull::of(&vertices), &vertices).unwrap_or_default();
            let squared = 4.0 * (a * a + b * b + c * c);
            let wanted = DMat3::from_diagonal(DVec3::new(along(a), along(b), along(c)) / squared);
            assert!(found.abs_diff_eq(wanted, 1e-15), "{found} of {wanted}");
        }
    }

    /// Principal axes are found unless two of them tie.
    #[test]
    fn tied_axes_are_detected() {
        let axes = |x, y, z| principal_rotation(DMat3::from_diagonal(DVec3::new(x, y, z)));
        let wanted = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z);
        for size in [1.0, 1e6, 1e-6] {
            assert_eq!(axes(2.0 * size, 3.0 * size, size), Some(wanted));
            let near = 1.0 - 0.9 * EIGENVALUE_TIE;
            assert_eq!(axes(size, near * size, 0.1 * size), None);
            assert_eq!(axes(size, 0.1 * size, (0.1 - 0.9 * EIGENVALUE_TIE) * size), None);
            let apart = 1.0 - 1.1 * EIGENVALUE_TIE;
            assert!(axes(size, apart * size, 0.1 * size).is_some());
        }
        assert_eq!(axes(0.0, 0.0, 0.0), None);
    }

    /// The largest component is positive the first one of equals.
    #[test]
    fn largest_component_is_positive() {
        for (v, sign) in [
            ([-3.0, 1.0, 2.0], -1.0),
            ([1.0, -2.0, 1.9], -1.0),
            ([1.0, 1.0, 2.0], 1.0),
            ([1.0, -1.0, 0.5], 1.0),
            ([-1.0, 1.0 + 1e-7, 0.5], -1.0),
            ([-1.0, 1.0 + 1e-5, 0.5], 1.0),
        ] {
            assert_eq!(sign_of_largest(DVec3::from(v)), sign, "{v:?}");
        }
    }
}
