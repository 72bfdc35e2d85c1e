//! Worlds of many shapes, margins and places: whether a pair is reported depends only on its two
//! bodies, and not on others.

use sdop::culler::Culler;
use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};

use super::Random;

/// More than the sixteen that are looked up as columns.
const SHAPES: u32 = 24;

/// Half the sides of a shape: cubes of very different sizes, so that a mistaken one shows.
fn half_side(shape: u32) -> f64 {
    f64::from(1 + shape % 8) * 0.25 + f64::from(shape / 8)
}

fn shapes() -> Vec<Shape> {
    let cube = |shape: u32| {
        let side = (2.0 * half_side(shape)) as f32;
        let [x, y, z] = [side; 3];
        let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
        Shape::build(&mesh, &ShapeSpec::default()).unwrap()
    };
    (0..SHAPES).map(cube).collect()
}

/// Far apart, and where f32 rounds; the middle of them is the origin, whose bodies keep their
/// places.
const PLACES: [f64; 5] = [0.0, 3.0e5 + 0.3, -3.0e5 - 0.3, 7.0e6 + 0.1, -7.0e6 - 0.1];

/// How far a body of size `half` may be moved by rounding at most, and be grown for it: by the
/// place's distance, and 2⁻¹² of its size.
fn rounding(body: &Body) -> f64 {
    let far = body.translation.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
    far * 2.0_f64.powi(-21) + 1.75 * half_side(body.shape) * 2.0_f64.powi(-11)
}

fn drawn(random: &mut Random) -> Body {
    let margin = match random.below(3) {
        0 => 0.0,
        _ => 0.01 * 1.6_f32.powi(random.below(12)) * (1.0 + 0.05 * random.within(1.0)),
    };
    let place = PLACES[random.below(PLACES.len() as u32) as usize];
    let mut translation = [(); 3].map(|()| f64::from(random.within(1.0)) * 16.0);
    translation[random.below(2) as usize] += place;
    Body {
        shape: random.below(SHAPES),
        margin,
        translation,
        motion: super::motion(random.below(4) > 0),
        ..Body::default()
    }
}

/// How far the cubes of two bodies are apart, axis by axis; negative where they overlap.
fn gaps(a: &Body, b: &Body) -> [f64; 3] {
    std::array::from_fn(|i| {
        let apart = (a.translation[i] - b.translation[i]).abs();
        apart - half_side(a.shape) - half_side(b.shape)
    })
}

/// Whether two cubes, grown by their margins, meet.
fn meet(a: &Body, b: &Body) -> bool {
    let squares = gaps(a, b).map(|gap| gap.max(0.0).powi(2));
    let reach = f64::from(a.margin) + f64::from(b.margin);
    squares.iter().sum::<f64>() <= reach * reach
}

/// Whether no strategy of these volumes may report them: margins are rounded up by an eighth at
/// most.
fn are_apart(strategy: Strategy, a: &Body, b: &Body) -> bool {
    let grown = 1.13 * (f64::from(a.margin) + f64::from(b.margin)) + rounding(a) + rounding(b);
    match strategy {
        Strategy::Aabb | Strategy::KDop => gaps(a, b).iter().any(|&gap| gap > grown + 1e-5),
        _ => {
            let squares = a.translation.iter().zip(b.translation).map(|(a, b)| (a - b).powi(2));
            let radii = 3.0_f64.sqrt() * (half_side(a.shape) + half_side(b.shape));
            squares.sum::<f64>().sqrt() > radii + grown + 1e-5
        }
    }
}

#[test]
fn pairs_follow_from_their_own_bodies() {
    let (mut touching, mut separated) = (0, 0);
    for (seed, strategy) in [
        (1, Strategy::Sphere),
        (2, Strategy::SDopSequential),
        (3, Strategy::Aabb),
        (4, Strategy::KDop),
    ] {
        for finder in [Finder::AllPairs, Finder::Auto] {
            let settings = CullSettings { strategy, pairs: finder, ..CullSettings::default() };
            let builder = Culler::builder().settings(&settings);
            let mut world = World::with(shapes(), &builder).unwrap();
            let mut random = Random::new(seed);
            for _ in 0..400 {
                world.insert(drawn(&mut random)).unwrap();
            }
            for frame in 0..6 {
                let pairs = world.cull().unwrap().sorted();
                let bodies: Vec<(BodyId, Body)> = world.bodies().collect();
                for (at, (i, a)) in bodies.iter().enumerate() {
                    for (j, b) in &bodies[at + 1..] {
                        if !a.motion.is_dynamic() && !b.motion.is_dynamic() {
                            continue;
                        }
                        let is_reported = pairs.binary_search(&[*i, *j]).is_ok();
                        let what = || format!("{strategy}, {finder}, {frame}: {a:?}, {b:?}");
                        assert!(is_reported || !meet(a, b), "missed: {}", what());
                        let are_apart = are_apart(strategy, a, b);
                        assert!(!is_reported || !are_apart, "reported: {}", what());
                        touching += u32::from(meet(a, b));
                        separated += u32::from(are_apart);
                    }
                }
                // Shapes, margins and places change; many bodies keep theirs.
                for (id, _) in bodies {
                    if random.below(3) == 0 {
                        world.set(id, drawn(&mut random)).unwrap();
                    }
                }
            }
        }
    }
    assert!(touching > 10_000 && separated > 1_000_000, "{touching}, {separated}");
}
