//! Scenes that are hard for a pair finder.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::volume::{DirectionSet, Origin, Shape, ShapeSpec};
use sdop_judge::draw::bodies::rotation;

use crate::finders::support::{self, shapes};

pub struct Scene {
    pub name: &'static str,
    pub shapes: Vec<Shape>,
    pub bodies: Bodies,
    /// How far a coordinate may move in a frame.
    pub step: f32,
}

/// A boxy shape with the bounding radius asked for.
fn shape_of_radius(radius: f32) -> Shape {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let spec = ShapeSpec { origin: Origin::Ball, radius: Some(radius), ..ShapeSpec::default() };
    Shape::build(&mesh, &spec).unwrap()
}

impl Scene {
    /// Bodies of the given radii, one shape a radius, at points drawn by `place`.
    pub fn new(
        name: &'static str,
        radii: &[f32],
        n: usize,
        mut place: impl FnMut(usize, &mut ChaCha8Rng) -> [f32; 3],
    ) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
        let mut bodies = Bodies::default();
        for i in 0..n {
            let (shape, q) = ((i % radii.len()) as u32, rotation(&mut rng));
            bodies.push(shape, i % 7 != 3, q, place(i, &mut rng));
        }
        Self {
            name,
            shapes: radii.iter().map(|&r| shape_of_radius(r)).collect(),
            bodies,
            step: 0.1 * radii[0],
        }
    }
}

pub fn uniform(rng: &mut ChaCha8Rng, side: f32) -> [f32; 3] {
    std::array::from_fn(|_| rng.random_range(0.0..side))
}

/// Scenes that have cost pair finders pairs, time or their composure.
pub fn hard_scenes() -> Vec<Scene> {
    let mut scenes = vec![
        Scene::new("none", &[1.0], 0, |_, _| [0.0; 3]),
        Scene::new("one", &[1.0], 1, |_, _| [5.0; 3]),
        Scene::new("two", &[1.0], 2, |i, _| [i as f32; 3]),
        Scene::new("uniform", &[1.0], 700, |_, rng| uniform(rng, 20.0)),
        Scene::new("sparse", &[1.0], 300, |_, rng| uniform(rng, 300.0)),
        Scene::new("crowded", &[1.0], 400, |_, rng| uniform(rng, 6.0)),
        Scene::new("coincident", &[1.0], 150, |_, _| [3.0, -2.0, 7.0]),
        Scene::new("on cell borders", &[1.0], 500, |i, _| {
            // Diameters of a little more than 2: neighbours touch, and the grid's borders run
            // between them.
            [i % 8, i / 8 % 8, i / 64].map(|k| k as f32 * 2.000_002)
        }),
        Scene::new("half a cell off", &[1.0], 500, |i, _| {
            [i % 8, i / 8 % 8, i / 64].map(|k| k as f32 * 2.0 + 1.0)
        }),
        Scene::new("line along x", &[1.0], 300, |_, rng| [rng.random_range(0.0..900.0), 1.0, 2.0]),
        Scene::new("line along z", &[1.0], 300, |_, rng| [1.0, 2.0, rng.random_range(0.0..900.0)]),
        Scene::new("diagonal line", &[1.0], 300, |_, rng| [rng.random_range(0.0..600.0); 3]),
        Scene::new("plane", &[1.0], 500, |_, rng| {
            [rng.random_range(0.0..40.0), 3.0, rng.random_range(0.0..40.0)]
        }),
        Scene::new("slanted plane", &[1.0], 500, |_, rng| {
            let [x, y, _] = uniform(rng, 60.0);
            [x, y, -0.7 * x + 0.4 * y]
        }),
        Scene::new("clusters far apart", &[1.0], 500, |i, rng| {
            let centre = [1e4, -3e5, 7e3].map(|x: f32| x * (i % 5) as f32);
            let by = uniform(rng, 6.0);
            std::array::from_fn(|k| centre[k] + by[k])
        }),
        Scene::new("one far away", &[1.0], 400, |i, rng| match i {
            17 => [1e9, -1e9, 3e8],
            _ => uniform(rng, 15.0),
        }),
        Scene::new("far from the origin", &[1.0], 300, |_, rng| {
            uniform(rng, 64.0).map(|x| x + 1e8)
        }),
        Scene::new("at the contract's corners", &[1e16], 60, |i, _| {
            [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.1e18 } else { -1.1e18 })
        }),
        Scene::new("tiny", &[1e-30], 300, |_, rng| uniform(rng, 1e-29)),
        Scene::new("radii 1:16", &[1.0, 2.3, 5.1, 16.0], 400, |_, rng| uniform(rng, 60.0)),
        Scene::new("radii 1:1000", &[0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0], 600, |_, rng| {
            uniform(rng, 25.0)
        }),
        Scene::new("points", &[1e-6, 1.0], 400, |_, rng| uniform(rng, 12.0)),
    ];
    let mut giant =
        Scene::new("a giant among tiny ones", &[0.05, 40.0], 600, |_, rng| uniform(rng, 5.0));
    giant.bodies.shape.iter_mut().for_each(|shape| *shape = 0);
    giant.bodies.shape[5] = 1;
    scenes.push(giant);
    let mut nested = Scene::new("tiny cluster beside giants", &[0.01, 10.0], 400, |i, rng| {
        uniform(rng, if i % 2 == 0 { 0.1 } else { 200.0 })
    });
    nested.step = 0.001;
    scenes.push(nested);
    let mut all_static = Scene::new("all static", &[1.0], 100, |_, rng| uniform(rng, 6.0));
    all_static.bodies.dynamic.fill(false);
    scenes.push(all_static);
    let many = random_scene();
    scenes.push(many);
    scenes
}

/// Shapes of all kinds, one of them about an origin far off its ball.
fn random_scene() -> Scene {
    let shapes = shapes(DirectionSet::K18, sdop::volume::Axes::Principal);
    let bodies = support::random_bodies(5, 300, 9.0, shapes.len());
    Scene { name: "every shape", shapes, bodies, step: 0.1 }
}

/// Pairs of equal balls whose distance is that of touching up to a few roundings, in any direction
/// or along an axis.
pub fn near_touching(seed: u64, radius: f32, offset: f32) -> Scene {
    let mut scene = Scene::new("near-touching", &[radius], 1200, |_, _| [0.0; 3]);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let reach = 2.0 * f64::from(scene.shapes[0].ball.radius);
    let centres = &mut scene.bodies.translation;
    for (pair, centres) in centres.chunks_exact_mut(2).enumerate() {
        let way = match pair % 4 {
            0..3 => std::array::from_fn(|axis| f64::from(u8::from(axis == pair % 4))),
            _ => direction(&mut rng),
        };
        let [x, y, z] = uniform(&mut rng, 40.0 * radius).map(|x| x + offset);
        let distance = reach * (1.0 + rng.random_range(-12.0..12.0) * f64::from(f32::EPSILON));
        centres[0] = [x, y, z];
        centres[1] = std::array::from_fn(|k| (f64::from(centres[0][k]) + distance * way[k]) as f32);
    }
    scene.bodies.dynamic.fill(true);
    scene
}

/// Pairs of unequal balls that touch to the last bit along an axis, on either side of its origin:
/// there the difference of centres and the sum of radii round, so that a test reports pairs whose
/// exact ends lie apart.
pub fn unequal_near_touching(seed: u64) -> Scene {
    let mut scene = Scene::new("unequal near-touching", &[1.0, 0.37], 1200, |_, _| [0.0; 3]);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let [a, b] = [0, 1].map(|shape: usize| f64::from(scene.shapes[shape].ball.radius));
    for (pair, centres) in scene.bodies.translation.chunks_exact_mut(2).enumerate() {
        let axis = pair % 3;
        // The radii that are tested are wider by four ulps.
        let ulps = 4.0 + rng.random_range(-1.0..1.0);
        let distance = (a + b) * (1.0 + ulps * f64::from(f32::EPSILON));
        let at = uniform(&mut rng, 40.0);
        (centres[0], centres[1]) = (at, at);
        centres[0][axis] = (-distance * rng.random_range(0.1..0.9)) as f32;
        centres[1][axis] = (f64::from(centres[0][axis]) + distance) as f32;
    }
    scene.bodies.dynamic.fill(true);
    scene
}

fn direction(rng: &mut ChaCha8Rng) -> [f64; 3] {
    let v: [f64; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
    let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / norm)
}
