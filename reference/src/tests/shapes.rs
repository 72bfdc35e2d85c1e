//! Procedural meshes, their volumes and random poses for the suites.

use dashu_ratio::RBig;
use proptest::prelude::*;

use crate::linear::{Vector, dot, integers, transpose};
use crate::{Ball, DirectionSet, Pose, Shape, Slabs};

/// Vertices and triangles.
pub type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A closed box of the given half sizes.
pub fn cuboid(half: [f32; 3]) -> Mesh {
    let corner = |n: usize| [0, 1, 2].map(|i| if n >> i & 1 == 1 { half[i] } else { -half[i] });
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let split = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    ((0..8).map(corner).collect(), quads.into_iter().flat_map(split).collect())
}

/// A closed tetrahedron with legs 1 : 2 : 3 about no centre of symmetry: what a mirrored formula
/// would show on.
pub fn wedge(size: f32) -> Mesh {
    let vertices = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]];
    (
        vertices.map(|v| v.map(|x| x * size)).to_vec(),
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    )
}

/// A closed torus of `rings` × `sides` quads.
pub fn torus(major: f32, minor: f32, rings: u32, sides: u32) -> Mesh {
    let point = |n: u32| {
        let turn = |i: u32, of: u32| i as f32 / of as f32 * std::f32::consts::TAU;
        let (u, v) = (turn(n / sides, rings), turn(n % sides, sides));
        let reach = major + minor * v.cos();
        [reach * u.cos(), reach * u.sin(), minor * v.sin()]
    };
    let index = |ring: u32, side: u32| ring % rings * sides + side % sides;
    let quad = |n: u32| {
        let (r, s) = (n / sides, n % sides);
        let [a, b, c, d] = [index(r, s), index(r + 1, s), index(r + 1, s + 1), index(r, s + 1)];
        [[a, b, c], [a, c, d]]
    };
    ((0..rings * sides).map(point).collect(), (0..rings * sides).flat_map(quad).collect())
}

/// A basis whose columns have equal norm and are orthogonal in exact arithmetic: R of a small
/// integer quaternion.
pub fn exact_basis(q: [i32; 4]) -> [[f32; 3]; 3] {
    let columns = transpose(&crate::linear::rotation(&q.map(f64::from)));
    columns.map(|column| column.map(|x| x as f32))
}

/// The next f32 not below / not above an f64 that may itself be off by rounding.
fn outward(x: f64, up: bool) -> f32 {
    let nearest = x as f32;
    if up { nearest.next_up() } else { nearest.next_down() }
}

/// Slabs about the vertices, rounded outward.
pub fn slabs(directions: DirectionSet, basis: [[f32; 3]; 3], vertices: &[[f32; 3]]) -> Slabs {
    let columns = transpose(&basis.map(|column| column.map(f64::from)));
    let heights = |c: [i32; 3]| {
        let d: Vector<f64> = crate::linear::apply(&columns, &integers(c));
        vertices.iter().map(move |v| dot(&d, &v.map(f64::from)))
    };
    let ends = |c: &[i32; 3]| {
        (
            outward(heights(*c).fold(f64::INFINITY, f64::min), false),
            outward(heights(*c).fold(f64::NEG_INFINITY, f64::max), true),
        )
    };
    let (lo, hi) = directions.coefficients().iter().map(ends).unzip();
    Slabs { directions, basis, lo, hi }
}

/// Slabs whose ends are the vertices' exact heights where an f32 holds them, infinite elsewhere.
pub fn exact_slabs(directions: DirectionSet, basis: [[f32; 3]; 3], vertices: &[[f32; 3]]) -> Slabs {
    let rational = |v: [f32; 3]| v.map(|x| super::rational::rational(f64::from(x)));
    let columns = basis.map(rational);
    let end = |c: &[i32; 3], highest: bool| {
        let heights = vertices.iter().map(|v| {
            let h = [0, 1, 2]
                .map(|j| super::rational::dot(&columns[j], &rational(*v)) * RBig::from(c[j]));
            h.into_iter().fold(RBig::ZERO, |sum, x| sum + x)
        });
        let exact = if highest { heights.max() } else { heights.min() }.unwrap();
        let nearest = exact.to_f32().value();
        if super::rational::rational(f64::from(nearest)) == exact { nearest } else { f32::INFINITY }
    };
    let ends = |c: &[i32; 3]| (end(c, false), end(c, true));
    let (lo, hi) = directions.coefficients().iter().map(ends).unzip();
    Slabs { directions, basis, lo, hi }
}

/// A shape whose volumes contain the mesh.
pub fn shape((vertices, triangles): Mesh, directions: DirectionSet, basis: [[f32; 3]; 3]) -> Shape {
    let norm = |v: &[f32; 3]| dot(&v.map(f64::from), &v.map(f64::from)).sqrt();
    let radius = outward(vertices.iter().map(norm).fold(0.0, f64::max), true);
    let ball = Ball { centre: [0.0; 3], radius };
    let slabs = slabs(directions, basis, &vertices);
    Shape::new(ball, slabs, vertices, triangles).unwrap()
}

/// Quaternions that are not normalised.
pub fn quaternions() -> impl Strategy<Value = [f32; 4]> {
    prop::array::uniform4(-1.0f32..1.0).prop_filter("non-zero", |q| q.iter().any(|x| x.abs() > 0.1))
}

/// Poses whose translation is within `reach` in each coordinate, most of them of f64.
pub fn poses(reach: f32) -> impl Strategy<Value = Pose> {
    let reach = f64::from(reach);
    let coordinate = prop_oneof![
        1 => (-reach..reach).prop_map(|x| f64::from(x as f32)),
        2 => -reach..reach,
    ];
    let translations = prop::array::uniform3(coordinate);
    (quaternions(), translations).prop_map(|(q, t)| Pose::from_f64(q, t).unwrap())
}

/// Seeded draws (SplitMix64) for suites that count, where shrinking means nothing.
pub struct Draws(pub u64);

impl Draws {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// Uniform in [−reach, reach).
    pub fn signed(&mut self, reach: f32) -> f32 {
        let unit = (self.bits() >> 40) as f32 / (1 << 23) as f32;
        reach * (unit - 1.0)
    }

    /// A vector with components in [−reach, reach).
    pub fn vector(&mut self, reach: f32) -> [f32; 3] {
        [(); 3].map(|()| self.signed(reach))
    }

    /// A uniformly distributed rotation, by rejection, and a translation.
    pub fn pose(&mut self, reach: f32) -> Pose {
        let q = loop {
            let q = [(); 4].map(|()| self.signed(1.0));
            let norm: f32 = q.iter().map(|x| x * x).sum();
            if (0.01..1.0).contains(&norm) {
                break q;
            }
        };
        Pose::new(q, self.vector(reach)).unwrap()
    }
}
