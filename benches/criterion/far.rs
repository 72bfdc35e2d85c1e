//! The cost of distance from the origin: reported pairs and time per frame, for f32 poses, for f64
//! poses in a world, and for a world with bodies in many places. `cargo bench --bench far` prints
//! CSV.
//!
//! In every row the same bodies move in the same way; only the position differs. Pairs are compared
//! with those near the origin, where rounding is negligible: far out, f32 poses lose pairs and gain
//! others, f64 poses only where f64 rounds.

use std::collections::HashSet;
use std::time::Instant;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sdop::bodies::Bodies;
use sdop::culler::{Culler, CullerBuilder};
use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};
use sdop_bench::percentiles::Percentiles;

const BODIES: usize = 20_000;
const FRAMES: usize = 60;
/// Frames before the first that is counted.
const WARM: usize = 5;
/// How far a coordinate moves per frame at most; bodies have the radius 1.
const STEP: f64 = 0.03;
/// Places of the third series.
const PLACES: usize = 100;
const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const DISTANCES: [f64; 8] = [0.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e11];

/// Beyond this distance f32 has only a few positions, and nearly all pairs meet.
const FARTHEST_F32: f64 = 1e7;

/// Bodies as they are next to the origin, in places of equal numbers.
struct Swarm {
    places: usize,
    near: Vec<[f64; 3]>,
    random: ChaCha8Rng,
}

impl Swarm {
    fn new(places: usize) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        // Some two sphere overlaps per body.
        let half = 0.5 * (16.0 * (BODIES / places) as f64).cbrt();
        let near = (0..BODIES).map(|_| [(); 3].map(|()| random.random_range(-half..half)));
        Self { places, near: near.collect(), random }
    }

    fn sway(&mut self) {
        for x in self.near.as_flattened_mut() {
            *x += self.random.random_range(-STEP..STEP);
        }
    }

    /// Where a body is when its place is at this distance: on a line through the origin, for many
    /// places all along it.
    fn at(&self, body: usize, distance: f64) -> [f64; 3] {
        let place = 1 + body % self.places;
        let along = distance * place as f64 / self.places as f64;
        self.near[body].map(|x| along + x)
    }
}

/// Frames' pairs by bodies, and nanoseconds per body.
struct Run {
    pairs: HashSet<(usize, u32, u32)>,
    nanoseconds: f64,
}

fn run(places: usize, mut frame: impl FnMut(&Swarm) -> Vec<[u32; 2]>) -> Run {
    let mut swarm = Swarm::new(places);
    let (mut pairs, mut seconds) = (HashSet::new(), Vec::new());
    for number in 0..FRAMES {
        let start = Instant::now();
        let found = frame(&swarm);
        seconds.push(start.elapsed().as_secs_f64());
        pairs.extend(found.into_iter().map(|[i, j]| (number, i, j)));
        swarm.sway();
    }
    let median = Percentiles::of(seconds.split_off(WARM)).p50;
    Run { pairs, nanoseconds: median * 1e9 / BODIES as f64 }
}

fn builder() -> CullerBuilder {
    Culler::builder()
        .settings(&CullSettings { strategy: Strategy::SDopBatch, ..CullSettings::default() })
}

fn in_f32(shape: &Shape, places: usize, distance: f64) -> Run {
    let mut culler = None;
    run(places, |swarm| {
        let mut bodies = Bodies::default();
        for body in 0..BODIES {
            let place = swarm.at(body, distance).map(|x| x as f32);
            bodies.push(0, true, UNTURNED, place);
        }
        let culler = culler.get_or_insert_with(|| {
            let culler = builder().build(std::slice::from_ref(shape), &bodies);
            culler.expect("bodies within the contract")
        });
        culler.cull(&bodies).expect("the same bodies").sorted()
    })
}

fn in_f64(shape: &Shape, places: usize, distance: f64) -> Run {
    let mut world = World::with(vec![shape.clone()], &builder()).expect("a sound shape");
    let mut ids: Vec<BodyId> = Vec::new();
    run(places, |swarm| {
        for body in 0..BODIES {
            let place = swarm.at(body, distance);
            match ids.get(body) {
                Some(&id) => world.set_pose(id, UNTURNED, place),
                None => world.insert(Body::at(0, UNTURNED, place)).map(|id| ids.push(id)),
            }
            .expect("a body within the contract");
        }
        let pairs = world.cull().expect("places within reach");
        let slots = pairs.iter().map(|pair| pair.map(|id| id.slot() as u32));
        slots.collect()
    })
}

type Series = (&'static str, usize, fn(&Shape, usize, f64) -> Run);

fn main() {
    let ball = ProceduralShape::default_of("icosphere").and_then(|shape| shape.build().ok());
    let spec = ShapeSpec { radius: Some(1.0), ..ShapeSpec::default() };
    let shape = Shape::build(&ball.expect("a known shape"), &spec).expect("a sound mesh");
    println!("series,distance,pairs,lost,extra,ns_per_body");
    let series: [Series; 3] =
        [("f32", 1, in_f32), ("f64", 1, in_f64), ("f64, many places", PLACES, in_f64)];
    for (name, places, run) in series {
        // Next to the origin, each place by itself.
        let wanted = if places == 1 { in_f64(&shape, 1, 0.0) } else { in_f64(&shape, places, 1e6) };
        let is_shown = |&distance: &f64| match name {
            "f32" => distance <= FARTHEST_F32,
            _ => places == 1 || distance >= 1e5,
        };
        for distance in DISTANCES.into_iter().filter(is_shown) {
            let Run { pairs, nanoseconds } = run(&shape, places, distance);
            let lost = wanted.pairs.difference(&pairs).count();
            let extra = pairs.difference(&wanted.pairs).count();
            println!("\"{name}\",{distance:e},{},{lost},{extra},{nanoseconds:.1}", pairs.len());
        }
    }
}
