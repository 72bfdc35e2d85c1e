//! A second formulation of every decision, in rationals and world coordinates, sharing nothing with
//! the cascade but the input: poses by the quaternion sandwich q x q̄/|q|², and brute force in
//! place of frames, trees and programs.

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use crate::exact::mesh::Mesh;
use crate::number::dyadic;
use crate::{Ball, Pose};

/// A point or vector.
pub type Rational3 = [RBig; 3];

/// The exact value of a float.
pub fn rational(x: f64) -> RBig {
    let (mantissa, exponent) = dyadic(x);
    let shift = exponent.unsigned_abs() as usize;
    let mantissa = IBig::from(mantissa);
    if exponent < 0 {
        RBig::from_parts(mantissa, UBig::ONE << shift)
    } else {
        RBig::from(mantissa << shift)
    }
}

/// Each component.
pub fn rational3(v: [f32; 3]) -> Rational3 {
    v.map(|x| rational(f64::from(x)))
}

/// Hamilton product of (x, y, z, w) quaternions.
fn hamilton(a: &[RBig; 4], b: &[RBig; 4]) -> [RBig; 4] {
    let [ax, ay, az, aw] = a;
    let [bx, by, bz, bw] = b;
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// q x q̄/|q|²
fn turned(q: &[RBig; 4], x: &Rational3) -> Rational3 {
    let [qx, qy, qz, qw] = q;
    let norm = qx * qx + qy * qy + qz * qz + qw * qw;
    let [x0, x1, x2] = x.clone();
    let [x, y, z, _] = hamilton(&hamilton(q, &[x0, x1, x2, RBig::ZERO]), &conjugate(q));
    [x, y, z].map(|component| component / &norm)
}

fn conjugate([x, y, z, w]: &[RBig; 4]) -> [RBig; 4] {
    [-x, -y, -z, w.clone()]
}

/// Where the pose puts a point, in world coordinates.
pub fn posed(pose: &Pose, x: &Rational3) -> Rational3 {
    let t = pose.translation().map(rational);
    let x = turned(&pose.quaternion().map(rational), x);
    [0, 1, 2].map(|i| &x[i] + &t[i])
}

/// Which point the pose puts there.
pub fn unposed(pose: &Pose, p: &Rational3) -> Rational3 {
    turned(&conjugate(&pose.quaternion().map(rational)), &sub(p, &pose.translation().map(rational)))
}

/// a·b
pub fn dot(a: &Rational3, b: &Rational3) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a × b
pub fn cross(a: &Rational3, b: &Rational3) -> Rational3 {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

/// a − b
pub fn sub(a: &Rational3, b: &Rational3) -> Rational3 {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// Whether ‖cB − cA‖ ≤ rA + rB.
pub fn balls_overlap(a: (&Ball, &Pose), b: (&Ball, &Pose)) -> bool {
    let centre = |(ball, pose): (&Ball, &Pose)| posed(pose, &rational3(ball.centre));
    let d = sub(&centre(b), &centre(a));
    let reach = rational(f64::from(a.0.radius)) + rational(f64::from(b.0.radius));
    dot(&d, &d) <= &reach * &reach
}

/// Whether the axis separates the point sets strictly.
pub fn separates(axis: &Rational3, a: &[Rational3], b: &[Rational3]) -> bool {
    let range = |points: &[Rational3]| {
        let heights: Vec<RBig> = points.iter().map(|p| dot(axis, p)).collect();
        Some((heights.iter().min()?.clone(), heights.iter().max()?.clone()))
    };
    match (range(a), range(b)) {
        (Some((lo_a, hi_a)), Some((lo_b, hi_b))) => hi_a < lo_b || hi_b < lo_a,
        _ => true,
    }
}

/// Whether two triangles of any kind share a point: no axis of a set that is complete for points,
/// segments and triangles separates them. Edges give normals (edge × edge), in-plane normals
/// (normal × edge) and lines (edges, differences of corners).
pub fn triangles_meet(a: &[Rational3; 3], b: &[Rational3; 3]) -> bool {
    let lines: Vec<Rational3> = [a, b]
        .iter()
        .flat_map(|t| [(0, 1), (1, 2), (2, 0)].map(|(i, j)| sub(&t[j], &t[i])))
        .collect();
    let apart = |axis: &Rational3| separates(axis, a, b);
    let between: Vec<Rational3> = a.iter().flat_map(|p| b.iter().map(move |q| sub(q, p))).collect();
    if lines.iter().chain(&between).any(&apart) {
        return false;
    }
    let crossed = |u: &[Rational3], v: &[Rational3]| -> Vec<Rational3> {
        u.iter().flat_map(|x| v.iter().map(move |y| cross(x, y))).collect()
    };
    let normals = crossed(&lines, &lines);
    if normals.iter().any(&apart) {
        return false;
    }
    // Perpendicular to a line and as near as possible to a difference: it separates a segment from
    // a point next to it.
    let beside: Vec<Rational3> =
        lines.iter().flat_map(|l| between.iter().map(|d| cross(&cross(l, d), l))).collect();
    !crossed(&normals, &lines).iter().chain(&beside).any(apart)
}

/// Triangles in world coordinates.
pub fn world_triangles((mesh, pose): (&Mesh, &Pose)) -> Vec<[Rational3; 3]> {
    let corner = |p: &[f64; 3]| posed(pose, &p.map(rational));
    mesh.triangles.iter().map(|t| t.each_ref().map(corner)).collect()
}

/// Whether two posed meshes intersect: every pair of triangles, then a ray from every vertex.
pub fn meshes_meet(a: (&Mesh, &Pose), b: (&Mesh, &Pose)) -> bool {
    let (world_a, world_b) = (world_triangles(a), world_triangles(b));
    let touching = world_a.iter().any(|t| world_b.iter().any(|s| triangles_meet(t, s)));
    touching || some_inside(&world_a, a.0, &world_b) || some_inside(&world_b, b.0, &world_a)
}

fn some_inside(triangles: &[[Rational3; 3]], mesh: &Mesh, others: &[[Rational3; 3]]) -> bool {
    let closed = (0..mesh.components.len()).filter(|c| mesh.components[*c].closed);
    let mut shells = closed.map(|c| {
        let of_shell =
            triangles.iter().zip(&mesh.component_of).filter(|(_, of)| **of as usize == c);
        of_shell.map(|(t, _)| t.clone()).collect::<Vec<_>>()
    });
    shells.any(|shell| others.iter().flatten().any(|point| odd_crossings(&shell, point)))
}

/// Ray parity by solving point + s·direction = a + u(b − a) + v(c − a); the next direction when a
/// ray meets a border.
fn odd_crossings(shell: &[[Rational3; 3]], point: &Rational3) -> bool {
    let directions =
        (1..).map(|n: i32| [RBig::from(n), RBig::from(7 * n * n + 1), RBig::from(3 - 5 * n)]);
    let counts = |direction: &Rational3| {
        let hits =
            shell.iter().map(|t| ray_hits(t, point, direction)).collect::<Option<Vec<bool>>>()?;
        Some(hits.into_iter().filter(|hit| *hit).count() % 2 == 1)
    };
    directions.take(50).find_map(|d| counts(&d)).unwrap()
}

fn ray_hits([a, b, c]: &[Rational3; 3], point: &Rational3, direction: &Rational3) -> Option<bool> {
    let (e, f, p) = (sub(b, a), sub(c, a), sub(point, a));
    let normal = cross(&e, &f);
    let determinant = dot(&normal, direction);
    if normal.iter().all(|x| *x == RBig::ZERO) {
        return Some(false);
    }
    if determinant == RBig::ZERO {
        return if dot(&normal, &p) == RBig::ZERO { None } else { Some(false) };
    }
    let ahead = -dot(&normal, &p) / &determinant;
    let u = dot(&cross(&f, direction), &p) / &determinant;
    let v = dot(&cross(direction, &e), &p) / &determinant;
    let w = RBig::ONE - &u - &v;
    let smallest = ahead.min(u).min(v).min(w);
    if smallest == RBig::ZERO { None } else { Some(smallest > RBig::ZERO) }
}
