//! Shapes and bodies drawn by seed.

#![allow(dead_code, reason = "each test binary uses its own part of this support")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};
use sdop_judge::draw::bodies::rotation;

/// Every procedural shape at bounding radius 1, and an L-shape about its file's own origin, far off
/// its ball's centre.
pub fn shapes(directions: DirectionSet, axes: Axes) -> Vec<Shape> {
    let centred = ShapeSpec { origin: Origin::Ball, radius: Some(1.0), directions, axes };
    let about_file = ShapeSpec { origin: Origin::File, radius: None, ..centred };
    let mesh = |name| ProceduralShape::default_of(name).unwrap().build().unwrap();
    let mut shapes: Vec<Shape> = ProceduralShape::NAMES
        .iter()
        .map(|name| Shape::build(&mesh(name), &centred).unwrap())
        .collect();
    let mut off_centre = mesh("l-shape");
    for vertex in &mut off_centre.vertices {
        *vertex = (glam::Vec3::from(*vertex) + glam::Vec3::new(0.7, -0.3, 0.4)).to_array();
    }
    shapes.push(Shape::build(&off_centre, &about_file).unwrap());
    shapes
}

/// `n` bodies with uniform centres in a cube, uniform orientations of various norms, every tenth
/// body static.
pub fn random_bodies(seed: u64, n: usize, side: f32, shapes: usize) -> Bodies {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut bodies = Bodies::default();
    for i in 0..n {
        let (shape, q) = (rng.random_range(0..shapes as u32), rotation(&mut rng));
        let t = std::array::from_fn(|_| rng.random_range(0.0..side));
        bodies.push(shape, i % 10 != 3, q, t);
    }
    bodies
}
