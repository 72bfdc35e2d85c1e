//! Scenes drawn by seed and handed to both sides: the culler, and the reference that shares no code with it.

#![allow(
    dead_code,
    reason = "each test binary uses its own part of this support"
)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::mesh::shapes::ProceduralShape;
use sdop::scene::bodies::Bodies;
use sdop::scene::settings::Overlap;
use sdop::volume::{Axes, DirectionSet, Hull, OrDop, Origin, Shape, ShapeSpec};
use sdop_reference as reference;

/// A frame of bodies with the shapes as the culler and as the reference knows them.
pub struct Frame {
    pub shapes: Vec<Shape>,
    pub bodies: Bodies,
    judged: Vec<reference::Shape>,
}

impl Frame {
    pub fn new(shapes: Vec<Shape>, bodies: Bodies) -> Self {
        let judged = shapes.iter().map(judged_shape).collect();
        Self {
            shapes,
            bodies,
            judged,
        }
    }

    /// The bodies as the reference takes them.
    pub fn judged_bodies(&self) -> Vec<reference::Body<'_>> {
        let b = &self.bodies;
        (0..b.shape.len())
            .map(|i| reference::Body {
                shape: &self.judged[b.shape[i] as usize],
                pose: reference::Pose::new(b.rotation[i], b.translation[i]).unwrap(),
                dynamic: b.dynamic[i],
            })
            .collect()
    }
}

/// A shape in the reference's own terms: numbers, nothing shared.
pub fn judged_shape(shape: &Shape) -> reference::Shape {
    let ball = reference::Ball {
        centre: shape.ball.centre.to_array(),
        radius: shape.ball.radius,
    };
    let vertices = shape.vertices.iter().map(|v| v.to_array()).collect();
    let judged = reference::Shape::new(
        ball,
        judged_slabs(&shape.ordop),
        vertices,
        shape.triangles.clone(),
    );
    let obb = judged_slabs(&shape.obb(&Hull::of(&shape.vertices)));
    judged.unwrap().with_obb(&obb).unwrap()
}

fn judged_slabs(ordop: &OrDop) -> reference::Slabs {
    reference::Slabs {
        directions: judged_directions(ordop.directions),
        basis: ordop.basis.columns.map(|column| column.to_array()),
        lo: ordop.lo.clone(),
        hi: ordop.hi.clone(),
    }
}

pub fn judged_directions(directions: DirectionSet) -> reference::DirectionSet {
    match directions {
        DirectionSet::K6 => reference::DirectionSet::K6,
        DirectionSet::K14 => reference::DirectionSet::K14,
        DirectionSet::K18 => reference::DirectionSet::K18,
        DirectionSet::K26 => reference::DirectionSet::K26,
    }
}

pub fn judged_overlap(overlap: Overlap) -> reference::Overlap {
    match overlap {
        Overlap::OneSided => reference::Overlap::OneSided,
        Overlap::TwoSided => reference::Overlap::TwoSided,
        Overlap::Full => reference::Overlap::Full,
    }
}

/// Every procedural shape at bounding radius 1, and an L-shape about its file's own origin, far off its ball's centre.
pub fn shapes(directions: DirectionSet, axes: Axes) -> Vec<Shape> {
    let centred = ShapeSpec {
        origin: Origin::Ball,
        radius: Some(1.0),
        directions,
        axes,
    };
    let about_file = ShapeSpec {
        origin: Origin::File,
        radius: None,
        ..centred
    };
    let mesh = |name| ProceduralShape::default_of(name).unwrap().build().unwrap();
    let mut shapes: Vec<Shape> = ProceduralShape::NAMES
        .iter()
        .map(|name| Shape::build(&mesh(name), &centred).unwrap())
        .collect();
    let mut off_centre = mesh("l-shape");
    for vertex in &mut off_centre.vertices {
        *vertex += glam::Vec3::new(0.7, -0.3, 0.4);
    }
    shapes.push(Shape::build(&off_centre, &about_file).unwrap());
    shapes
}

/// `n` bodies with uniform centres in a cube, uniform orientations of various norms, every tenth body static.
pub fn random_bodies(seed: u64, n: usize, side: f32, shapes: usize) -> Bodies {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut bodies = Bodies::default();
    for i in 0..n {
        bodies.shape.push(rng.random_range(0..shapes as u32));
        bodies.dynamic.push(i % 10 != 3);
        bodies.rotation.push(random_quaternion(&mut rng));
        bodies
            .translation
            .push(std::array::from_fn(|_| rng.random_range(0.0..side)));
        bodies.velocity.push([0.0; 3]);
        bodies.spin.push([0.0; 3]);
    }
    bodies
}

pub fn random_quaternion(rng: &mut impl Rng) -> [f32; 4] {
    loop {
        let q: [f32; 4] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let norm: f32 = q.iter().map(|x| x * x).sum();
        if (0.01..=1.0).contains(&norm) {
            return q;
        }
    }
}
