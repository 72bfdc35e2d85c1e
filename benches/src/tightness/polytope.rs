//! The sizes of volumes, for tables of volume over hull volume.
//!
//! In the coordinates u_j = column_j·x, a k-DOP is lo ≤ c·u ≤ hi with integer normals c, and its
//! volume is ‖column‖³ times as large. Its volume is the sum over its faces of area·distance/3 from
//! any one point (divergence theorem); a face is a large square in the face's plane, clipped by all
//! other half-spaces. A half-space that touches nowhere leaves no polygon.

use glam::DVec3;
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

use sdop::volume::{Basis, DirectionSet, OrDop};

/// normal·u ≤ end.
struct HalfSpace {
    normal: DVec3,
    end: f64,
}

/// The size of a bounding polytope.
pub trait PolytopeVolume {
    /// The polytope's volume; 0 for a flat one.
    #[must_use]
    fn volume(&self) -> f64;
}

impl PolytopeVolume for OrDop {
    fn volume(&self) -> f64 {
        let slabs = self.directions.coefficients().iter().zip(self.lo.iter().zip(&self.hi));
        let half_spaces: Vec<HalfSpace> = slabs
            .flat_map(|(&c, (&lo, &hi))| {
                let normal = DVec3::from_array(c.map(f64::from));
                let (lo, hi) = (f64::from(lo), f64::from(hi));
                [HalfSpace { normal, end: hi }, HalfSpace { normal: -normal, end: -lo }]
            })
            .collect();
        let ends = |column: &[f32]| DVec3::from_array([0, 1, 2].map(|i| f64::from(column[i])));
        let (lo, hi) = (ends(&self.lo), ends(&self.hi));
        let (centre, size) = ((lo + hi) / 2.0, (hi - lo).length());
        let volume: f64 = (0..half_spaces.len())
            .map(|i| {
                let HalfSpace { normal, end } = half_spaces[i];
                let distance = (end - normal.dot(centre)) / normal.length();
                let foot = centre + normal.normalize() * distance;
                let others = half_spaces.iter().enumerate().filter(|&(j, _)| j != i);
                let face =
                    others.fold(square(foot, normal, size), |face, (_, other)| clip(&face, other));
                area(&face) * distance / 3.0
            })
            .sum();
        volume.max(0.0) / self.basis.norm().powi(3)
    }
}

/// A square about `foot` in the plane with this normal, of half-side `size`.
fn square(foot: DVec3, normal: DVec3, size: f64) -> Vec<DVec3> {
    let (a, b) = normal.normalize().any_orthonormal_pair();
    [a + b, b - a, -a - b, a - b].iter().map(|&corner| foot + corner * size).collect()
}

/// The part of a convex polygon inside a half-space (Sutherland & Hodgman 1974).
fn clip(polygon: &[DVec3], half_space: &HalfSpace) -> Vec<DVec3> {
    let depth = |p: DVec3| half_space.end - half_space.normal.dot(p);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &to) in polygon.iter().enumerate() {
        let from = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (before, after) = (depth(from), depth(to));
        if (before < 0.0) != (after < 0.0) {
            kept.push(from + (to - from) * (before / (before - after)));
        }
        if after >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

fn area(polygon: &[DVec3]) -> f64 {
    let Some(&origin) = polygon.first() else {
        return 0.0;
    };
    let cross = |pair: &[DVec3]| (pair[0] - origin).cross(pair[1] - origin);
    polygon.windows(2).map(cross).sum::<DVec3>().length() / 2.0
}

/// The mean volume of a world-aligned k-DOP, re-fitted after each of `turns` uniformly random
/// rotations of its body.
///
/// Turning the body one way is turning the directions the other way, so each turn is an or-DOP on a
/// random basis. Hull vertices suffice. The rotations are the same in every call.
#[must_use]
pub fn mean_world_aligned_volume(
    vertices: &[impl Into<[f32; 3]> + Copy],
    directions: DirectionSet,
    turns: u32,
) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let volume = |_| OrDop::build(vertices, random_basis(&mut random), directions).volume();
    (0..turns).map(volume).sum::<f64>() / f64::from(turns)
}

/// A uniformly random integer quaternion: a lattice point of a shell in four dimensions.
fn random_basis(random: &mut impl Rng) -> Basis {
    loop {
        // Twelve bits each: −2048 ≤ component < 2048.
        let q = [(); 4].map(|()| (random.next_u32() >> 20).cast_signed() - 2048);
        let norm_squared: i32 = q.iter().map(|c| c * c).sum();
        if norm_squared > 1 << 20
            && let Some(basis) = Basis::from_integer_quaternion(q)
        {
            return basis;
        }
    }
}
