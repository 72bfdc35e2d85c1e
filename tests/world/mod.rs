//! Long-lived worlds: whatever has come and gone, a world reports what a newly built culler would.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod changed_shapes;
mod counters;
mod excluded;
mod far;
mod lives;
mod margins;
mod pair_test;
mod regions;
mod saves;
mod single_changes;
mod turned;

use crate::forms;
use crate::histories::{HistoryKind, live};
use sdop_judge::draw::random::Random;

use sdop::culler::Culler;
use sdop::mesh::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Finder, Strategy, Updates};
use sdop::volume::{Origin, Shape, ShapeSpec};
use sdop::world::{Body, Groups, Motion, World, WorldError};

use forms::FORMS;

fn drawn(random: &mut Random, shapes: u32) -> Body {
    Body {
        shape: random.below(shapes),
        motion: motion(random.below(4) > 0),
        rotation: [(); 4].map(|()| random.within(1.0)),
        translation: [(); 3].map(|()| f64::from(random.within(6.0))),
        groups: Groups { member: 1 << random.below(3), mask: 7 & !(1 << random.below(3)) },
        ..Body::default()
    }
}

/// Of a body that moves, or of one that is fixed.
fn motion(moves: bool) -> Motion {
    if moves { Motion::Dynamic } else { Motion::Fixed }
}

fn shapes() -> Vec<Shape> {
    let build = |form: &ProceduralShape| {
        Shape::build(&form.build().unwrap(), &ShapeSpec::default()).unwrap()
    };
    FORMS.iter().map(build).collect()
}

/// Every way to cull; strategies that spend or look get what they need.
fn ways() -> Vec<CullSettings> {
    let mut ways = Vec::new();
    for &strategy in Strategy::ALL {
        for &pairs in Finder::ALL {
            for &updates in Updates::ALL {
                ways.push(CullSettings {
                    strategy,
                    pairs,
                    updates,
                    budget: (strategy == Strategy::SDopTimeCritical).then_some(Budget::Tests(5)),
                    ..CullSettings::all_pairs()
                });
            }
        }
    }
    ways
}

fn world_of(shapes: &[Shape], way: &CullSettings) -> World {
    World::with(shapes.to_vec(), &Culler::builder().settings(way)).unwrap()
}

/// Whatever has happened to its bodies, a world reports what a new one would.
#[test]
fn histories_of_worlds() {
    live(HistoryKind::Meshes, 2..4);
}

/// Two unit cubes, one next to the other with a gap, under every strategy.
#[test]
fn margins_have_stated_reach() {
    let form = ProceduralShape::Box { x: 2.0, y: 2.0, z: 2.0 };
    let shape = Shape::build(&form.build().unwrap(), &ShapeSpec::default()).unwrap();
    let volumes =
        [Strategy::OrDop, Strategy::Aabb, Strategy::KDop, Strategy::Obb, Strategy::SDopBatch];
    for strategy in volumes {
        let way = CullSettings { strategy, ..CullSettings::all_pairs() };
        let mut world =
            World::with(vec![shape.clone()], &Culler::builder().settings(&way)).unwrap();
        let first = Body { margin: 0.3, ..Body::default() };
        world.insert(first).unwrap();
        let second = world.insert(Body { margin: 0.7, ..first }).unwrap();
        let mut reported = |gap: f64| {
            world.set_pose(second, first.rotation, [2.0 + gap, 0.0, 0.0]).unwrap();
            world.cull().unwrap();
            world.pairs().len() == 1
        };
        assert!(reported(0.0) && reported(1.0), "{strategy}");
        assert!(!reported(1.0 * 1.125 + 1e-4), "{strategy}: rounded up by an eighth at most");
    }
}

/// Spheres of f64 translations far out that touch exactly, by Pythagorean quadruples: sizes of
/// thousands, 10⁹ away, where f32 steps by 64.
#[test]
fn touching_spheres_meet_in_f64() {
    let mut random = Random::new(3);
    let form = ProceduralShape::Icosphere { radius: 1.0, subdivisions: 0 };
    let (mut tried, mut rounded) = (0, 0);
    while tried < 2_000 {
        let [m, n, p, q] = [(); 4].map(|()| i64::from(random.below(1 << 9)));
        let way = [m * m + n * n - p * p - q * q, 2 * (m * q + n * p), 2 * (n * q - m * p)];
        let length = m * m + n * n + p * p + q * q;
        let scale = 2.0f64.powi(-8);
        // Both radii are the shape's own, whose ball is built to contain it: half the distance,
        // rounded down to f32.
        let radius = (length as f64 * scale / 2.0) as f32;
        if length % 2 == 1 || f64::from(radius) != length as f64 * scale / 2.0 || radius < 1.0 {
            continue;
        }
        tried += 1;
        let spec = ShapeSpec { origin: Origin::Ball, radius: Some(radius), ..ShapeSpec::default() };
        let shape = Shape::build(&form.build().unwrap(), &spec).unwrap();
        let touching = f64::from(shape.ball.radius) >= f64::from(radius);
        assert!(touching, "the ball contains the radius that it was built for");
        let base = [1.0e9 + 0.375, -3.0e8 - 0.625, 77.0];
        let away: [f64; 3] = std::array::from_fn(|i| base[i] + way[i] as f64 * scale);
        rounded += usize::from(away.map(|x| f64::from(x as f32)) != away);
        let settings = CullSettings { strategy: Strategy::Sphere, ..CullSettings::all_pairs() };
        let mut world = World::with(vec![shape], &Culler::builder().settings(&settings)).unwrap();
        world.insert(Body { translation: base, ..Body::default() }).unwrap();
        world.insert(Body { translation: away, ..Body::default() }).unwrap();
        world.insert(Body { translation: [0.1, 0.2, 0.3], ..Body::default() }).unwrap();
        world.cull().unwrap();
        assert!(world.pairs().len() >= 1, "{way:?} / {length}");
    }
    assert!(rounded > tried / 2, "{rounded}: f32 alone would do");
}
