//! The smallest enclosing ball (Welzl's problem), by pivoting: Gärtner, "Fast and robust smallest
//! enclosing balls", 1999.
//!
//! In each step the support set (at most four vertices) and the farthest vertex give a new support
//! set, until no vertex is outside. The ball of those few points needs no tolerance for duplicate,
//! collinear or cospherical points: its centre is the circumcentre of the subset whose farthest
//! point is nearest. The radius grows in each step, so no support set occurs twice. A dozen sweeps
//! over the vertices are typical.

use glam::DVec3;

use crate::mesh::in_f64;
use crate::rounding::up;

/// A ball that contains every vertex of its mesh exactly: ‖v − c‖ ≤ r in real arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre in the body frame.
    pub centre: [f32; 3],
    /// Radius, rounded up.
    pub radius: f32,
}

impl Ball {
    /// The smallest ball about `centre` that contains all vertices.
    #[must_use]
    pub fn about(centre: impl Into<[f32; 3]>, vertices: &[impl Into<[f32; 3]> + Copy]) -> Self {
        let centre = centre.into();
        Self { centre, radius: farthest_distance(centre, vertices) }
    }

    /// The smallest enclosing ball with its centre rounded to f32. It is larger than the optimum by
    /// about one ulp of |c| and r.
    #[must_use]
    pub fn smallest(vertices: &[impl Into<[f32; 3]> + Copy]) -> Self {
        Self::about(smallest_enclosing(vertices).0.as_vec3(), vertices)
    }

    /// The ball's volume.
    #[must_use]
    pub fn volume(&self) -> f64 {
        f64::from(self.radius).powi(3) * std::f64::consts::PI * 4.0 / 3.0
    }
}

/// max ‖v − c‖, rounded up; exactly 0 when every vertex is c.
///
/// The f64 steps have a relative error below 2⁻⁵⁰ in total (squares of f32 differences can't
/// underflow); `up` covers 2⁻²⁶.
pub(super) fn farthest_distance(centre: [f32; 3], vertices: &[impl Into<[f32; 3]> + Copy]) -> f32 {
    let centre = in_f64(&centre);
    let squared =
        vertices.iter().map(|&v| in_f64(&v.into()).distance_squared(centre)).fold(0.0, f64::max);
    if squared == 0.0 { 0.0 } else { up(squared.sqrt()) }
}

/// Centre and radius of the smallest enclosing ball, in f64; the origin and 0 for no vertices.
pub(super) fn smallest_enclosing(vertices: &[impl Into<[f32; 3]> + Copy]) -> (DVec3, f64) {
    let Some(&first) = vertices.first() else {
        return (DVec3::ZERO, 0.0);
    };
    let mut support = vec![in_f64(&first.into())];
    let (mut centre, mut squared) = (support[0], 0.0);
    loop {
        let (farthest, distance) = farthest_from(centre, vertices);
        if distance <= squared {
            break;
        }
        support.push(farthest);
        let (next_support, next_centre, next_squared) = smallest_of_few(&support);
        if next_squared <= squared {
            break; // the rest is rounding error
        }
        (support, centre, squared) = (next_support, next_centre, next_squared);
    }
    (centre, farthest_from(centre, vertices).1.sqrt())
}

fn farthest_from(centre: DVec3, vertices: &[impl Into<[f32; 3]> + Copy]) -> (DVec3, f64) {
    let mut best = (centre, 0.0);
    for &v in vertices {
        let v = in_f64(&v.into());
        let distance = v.distance_squared(centre);
        if distance > best.1 {
            best = (v, distance);
        }
    }
    best
}

/// The smallest ball of up to five points: (the subset on its boundary, centre, squared radius).
fn smallest_of_few(points: &[DVec3]) -> (Vec<DVec3>, DVec3, f64) {
    let mut best = (Vec::new(), DVec3::ZERO, f64::INFINITY);
    for mask in 1_u32..1 << points.len() {
        if mask.count_ones() > 4 {
            continue;
        }
        let chosen = (0..points.len()).filter(|i| mask >> i & 1 == 1);
        let subset: Vec<DVec3> = chosen.map(|i| points[i]).collect();
        let centre = circumcentre(&subset);
        let farthest = points.iter().map(|p| p.distance_squared(centre)).fold(0.0, f64::max);
        // A degenerate subset has a NaN centre, which `max` would hide.
        if centre.is_finite() && farthest < best.2 {
            best = (subset, centre, farthest);
        }
    }
    best
}

/// The point of the affine hull that is equally far from one to four points; not finite when they
/// are dependent.
fn circumcentre(points: &[DVec3]) -> DVec3 {
    match *points {
        [p] => p,
        [p, q] => (p + q) * 0.5,
        [p, q, r] => {
            let (a, b) = (q - p, r - p);
            let normal = a.cross(b);
            let numerator = (b * a.length_squared() - a * b.length_squared()).cross(normal);
            p + numerator / (2.0 * normal.length_squared())
        }
        [p, q, r, s] => {
            let (a, b, c) = (q - p, r - p, s - p);
            let numerator = b.cross(c) * a.length_squared()
                + c.cross(a) * b.length_squared()
                + a.cross(b) * c.length_squared();
            p + numerator / (2.0 * a.dot(b.cross(c)))
        }
        _ => DVec3::NAN,
    }
}
