//! Cubes and octahedra that touch exactly: all coordinates are short binary numbers, so nothing
//! rounds. In oblique directions, rotations have whole numbers for a quaternion. The columns of
//! such a matrix, times the square of the quaternion's length, are Pythagorean: four whole numbers
//! with a² + b² + c² = d². Therefore balls, boxes, or-DOPs, hulls and meshes touch exactly there.

use glam::Vec3;
use rand::{Rng, RngExt};

use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use sdop::bodies::Bodies;
use sdop::mesh::TriangleMesh;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

/// What touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// Faces of two cubes.
    Faces,
    /// Edges of two cubes.
    Edges,
    /// Corners of two cubes.
    Corners,
    /// An octahedron's tip and a cube's face.
    TipOnFace,
    /// Tips of two octahedra.
    Tips,
}

/// A cube with corners (±s, ±s, ±s) and an octahedron with tips at ±s on the axes.
pub fn solids(size: f32) -> Result<[Shape; 2], CatalogueError> {
    let tips = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z].map(|tip| tip * size);
    let sides =
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let octahedron = TriangleMesh::new("octahedron", tips, sides.to_vec())?;
    Ok([cuboid("cube", [size; 3])?, built(&octahedron)?])
}

/// A box with corners at ± its half sides.
pub fn cuboid(name: &str, half: [f32; 3]) -> Result<Shape, CatalogueError> {
    let end = |n: u32, i: usize| if n >> i & 1 == 1 { half[i] } else { -half[i] };
    let corner = |n: u32| Vec3::from([0, 1, 2].map(|i| end(n, i)));
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let triangles = quads.into_iter().flat_map(halves).collect();
    built(&TriangleMesh::new(name, (0..8).map(corner), triangles)?)
}

fn built(mesh: &TriangleMesh) -> Result<Shape, CatalogueError> {
    let spec = ShapeSpec {
        origin: Origin::File,
        radius: None,
        directions: DirectionSet::K18,
        axes: Axes::Model,
    };
    Ok(Shape::build(mesh, &spec)?)
}

/// Rotations by multiples of a quarter turn, exact as matrices: they map the two solids onto
/// themselves.
pub(super) const TURNS: [[f32; 4]; 5] = [
    [0.0, 0.0, 0.0, 1.0],
    [1.0, 0.0, 0.0, 1.0],
    [0.0, 2.0, 0.0, -2.0],
    [0.5, 0.5, 0.5, 0.5],
    [0.0, 0.0, 3.0, 0.0],
];

/// A rotation by a quaternion of whole numbers.
pub(super) struct WholeTurn {
    quaternion: [i32; 4],
    /// The square of its length.
    pub norm: i32,
    /// The rotation's matrix times that, by rows.
    pub matrix: [[i32; 3]; 3],
}

impl WholeTurn {
    const NONE: Self =
        Self { quaternion: [0, 0, 0, 1], norm: 1, matrix: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };

    /// Draws a rotation. In f32, the squares of some column of its matrix have a sum above the
    /// column's true squared length, so a ball test in f32 takes touching for apart.
    pub fn draw(rng: &mut impl Rng) -> Self {
        let [x, y, z, w] = std::array::from_fn(|_| rng.random_range(40..=80));
        let drawn = Self {
            quaternion: [x, y, z, w],
            norm: x * x + y * y + z * z + w * w,
            matrix: [
                [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
            ],
        };
        let norm = drawn.norm as f32;
        let square = |column: usize| {
            let [a, b, c] = drawn.matrix.map(|row| row[column] as f32);
            a * a + b * b + c * c
        };
        if (0..3).any(|column| square(column) > norm * norm) { drawn } else { Self::draw(rng) }
    }

    /// The rotation after another one.
    fn after(&self, [a, b, c, d]: [f32; 4]) -> [f32; 4] {
        let [x, y, z, w] = self.quaternion.map(|n| n as f32);
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ]
    }

    /// A vector of eighths, turned and times the norm.
    fn turned(&self, v: [f32; 3]) -> [f32; 3] {
        self.matrix.map(|row| (0..3).map(|i| row[i] as f32 * v[i]).sum())
    }
}

/// A dynamic body at a lattice point with partners that touch it; every third one is an ulp further
/// out or in.
pub fn touching(
    (touch, is_oblique): (Touch, bool),
    number: u32,
    partners: usize,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let unit = 2_f32.powi(rng.random_range(-12..=12));
    let whole = if is_oblique { WholeTurn::draw(rng) } else { WholeTurn::NONE };
    let shapes = solids(unit * whole.norm as f32)?.to_vec();
    let (first, second) = match touch {
        Touch::Faces | Touch::Edges | Touch::Corners => (0, 0),
        Touch::TipOnFace => (0, 1),
        Touch::Tips => (1, 1),
    };
    let far = if is_oblique { 1 << 19 } else { 512 };
    let at: [f32; 3] = std::array::from_fn(|_| rng.random_range(-far..=far) as f32);
    let mut bodies = Bodies::default();
    let turn = |rng: &mut _| whole.after(TURNS[RngExt::random_range(rng, 0..TURNS.len())]);
    for n in 0..partners {
        if n == partners / 2 {
            bodies.push(first, true, turn(rng), at.map(|x| x * unit));
        }
        let (offset, axis) = offset(touch, rng);
        let offset = whole.turned(offset);
        let mut t: [f32; 3] = std::array::from_fn(|i| (at[i] + offset[i]) * unit);
        if (n + number as usize) % 3 == 2 {
            t[axis] =
                if rng.random_range(0..2) == 0 { t[axis].next_up() } else { t[axis].next_down() };
        }
        bodies.push(second, false, turn(rng), t);
    }
    let frames = vec![Frame::fitted(bodies, &shapes)];
    Ok(DrawnCase { shapes, frames })
}

/// Where the partner is, in half sizes, and an axis along which the contact ends.
fn offset(touch: Touch, rng: &mut impl Rng) -> ([f32; 3], usize) {
    let axis = rng.random_range(0..3);
    let sign = |rng: &mut _| {
        if RngExt::random_range(rng, 0..2) == 0 { 2.0 } else { -2.0 }
    };
    let beside = |rng: &mut _| RngExt::random_range(rng, -8..=8) as f32 / 8.0;
    let mut offset: [f32; 3] = match touch {
        Touch::Tips => [0.0; 3],
        Touch::Corners => std::array::from_fn(|_| sign(rng)),
        _ => std::array::from_fn(|_| beside(rng)),
    };
    offset[axis] = sign(rng);
    if touch == Touch::Edges {
        offset[(axis + 1) % 3] = sign(rng);
    }
    (offset, axis)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::Claim;
    use crate::truth::Truth;

    /// In oblique directions meshes touch to the bit, too: those meet that are not an ulp away, and
    /// of the others some don't. Balls touch where tips or corners do.
    #[test]
    fn oblique_touches_are_exact() {
        for touch in [Touch::Faces, Touch::Edges, Touch::Corners, Touch::TipOnFace, Touch::Tips] {
            let (mut apart, mut balls_apart) = (0, 0);
            for number in 0..6 {
                let mut rng = ChaCha8Rng::seed_from_u64(number.into());
                let case = touching((touch, true), number, 8, &mut rng).unwrap();
                let truth = Truth::new(Claim::Mesh, &case.shapes).unwrap();
                let balls = Truth::new(Claim::Sphere, &case.shapes).unwrap();
                for n in 0..8_u32 {
                    let pair = [n.min(4), if n < 4 { 4 } else { n + 1 }];
                    let meet = truth.pair(&case.frames[0], pair).unwrap();
                    let is_away = (n + number) % 3 == 2;
                    assert!(meet || is_away, "{touch:?}, partner {n} of {number}");
                    apart += u32::from(!meet);
                    let of_balls = balls.pair(&case.frames[0], pair).unwrap();
                    assert!(of_balls || is_away, "{touch:?}, partner {n} of {number}");
                    balls_apart += u32::from(!of_balls);
                }
            }
            assert!(apart > 4, "{touch:?}: {apart}");
            let have_balls = matches!(touch, Touch::Tips | Touch::Corners);
            assert_eq!(balls_apart > 0, have_balls, "{touch:?}: {balls_apart}");
        }
    }
}
