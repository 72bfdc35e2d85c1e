//! Bodies for benches of pair finders, with 1.5 sphere partners each. They move a tenth of the
//! smallest radius per frame unless noted.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::{Origin, Shape, ShapeSpec};

/// Warm-up frames, after which the order of places has settled and buffers have grown.
const WARM_UP: usize = 64;

/// How bodies and their radii are distributed.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Uniformly, all of one radius.
    Uniform,
    /// On a plane.
    Plane,
    /// Ten clusters far apart.
    Clusters,
    /// Radii 1:16, log-uniform.
    Mixed,
    /// Radii 1:1000, log-uniform.
    Wild,
}

/// Bodies that move to and fro about fixed positions.
pub struct Swarm {
    shapes: Vec<Shape>,
    /// Their present poses.
    pub bodies: Bodies,
    step: Vec<[f32; 3]>,
    frame: usize,
}

impl Swarm {
    /// `n` bodies of a kind that move a tenth of the smallest radius per frame.
    pub fn new(kind: Kind, n: usize) -> Self {
        Self::moving(kind, n, 0.1)
    }

    /// `n` bodies of a kind whose coordinates change by up to `most` smallest radii per frame.
    pub fn moving(kind: Kind, n: usize, most: f32) -> Self {
        let octaves = match kind {
            Kind::Mixed => 4,
            Kind::Wild => 10,
            _ => 0,
        };
        let radii: Vec<f32> = (0..=8 * octaves).map(|i| 2f32.powf(i as f32 / 8.0)).collect();
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = |&radius: &f32| {
            let radius = Some(radius);
            let spec = ShapeSpec { origin: Origin::Ball, radius, ..ShapeSpec::default() };
            Shape::build(&mesh, &spec).unwrap()
        };
        let shapes: Vec<Shape> = radii.iter().map(shape).collect();
        // The mean of (r_a + r_b)³ over pairs, from the radii's moments.
        let moment = |p: i32| radii.iter().map(|r| r.powi(p)).sum::<f32>() / radii.len() as f32;
        let cubes = 2.0 * moment(3) + 6.0 * moment(1) * moment(2);
        let side = (n as f32 * 4.189 * cubes / 1.5).cbrt();
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let (mut bodies, mut step) = (Bodies::default(), Vec::new());
        for i in 0..n {
            let mut at: [f32; 3] = std::array::from_fn(|_| rng.random_range(0.0..side));
            match kind {
                Kind::Plane => {
                    let side = (n as f32 * 12.57 / 1.5).sqrt();
                    at = [rng.random_range(0.0..side), 3.0, rng.random_range(0.0..side)];
                }
                Kind::Clusters => {
                    let centre = [3.0, 5.0, 7.0].map(|k| k * 10.0 * side * (i % 10) as f32);
                    at = std::array::from_fn(|k| centre[k] + 0.464 * at[k]);
                }
                Kind::Uniform | Kind::Mixed | Kind::Wild => {}
            }
            bodies.push(rng.random_range(0..radii.len() as u32), true, [0.0, 0.0, 0.0, 1.0], at);
            step.push(std::array::from_fn(|_| rng.random_range(-most..most)));
        }
        Self { shapes, bodies, step, frame: 0 }
    }

    /// Advances one frame: sixteen frames in one direction, then sixteen back.
    pub fn sway(&mut self) {
        let sign = if (self.frame / 16).is_multiple_of(2) { 1.0 } else { -1.0 };
        for (t, step) in self.bodies.translation.iter_mut().zip(&self.step) {
            for (x, by) in t.iter_mut().zip(step) {
                *x += sign * by;
            }
        }
        self.frame += 1;
    }

    /// A culler of the bodies' spheres that has culled the warm-up frames.
    pub fn culler(&mut self, finder: Finder, threads: usize) -> Culler {
        self.culler_by(Strategy::Sphere, finder, threads)
    }

    /// As [`Self::culler`], with another strategy.
    pub fn culler_by(&mut self, strategy: Strategy, finder: Finder, threads: usize) -> Culler {
        let settings = CullSettings { strategy, pairs: finder, ..CullSettings::all_pairs() };
        let mut culler = Culler::builder()
            .settings(&settings)
            .threads(threads)
            .build(&self.shapes, &self.bodies)
            .unwrap();
        for _ in 0..WARM_UP {
            self.sway();
            culler.cull(&self.bodies).unwrap();
        }
        culler
    }
}
