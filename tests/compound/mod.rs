//! Bodies of several shapes against exact truth: no two parts that meet are missed.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod corners;
mod misuse;
mod volumes;

use sdop::compound::{Compound, Part, PartCuller, PartPair};
use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{Body, BodyId, ProceduralShape, Shape, World};

use crate::histories::{HistoryKind, live};
use sdop_judge::draw::random::Random;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// The squared norm of the quaternions of bodies in tests with exact truth. Local translations are
/// multiples of it, so that turned ones are in whole steps.
const SQUARE: i64 = 105;

/// A step of all translations.
const STEP: f64 = 1.0 / 1024.0;

const DIRECTIONS: [DirectionSet; 4] =
    [DirectionSet::K6, DirectionSet::K14, DirectionSet::K18, DirectionSet::K26];

/// A quaternion of whole numbers with the squared norm [`SQUARE`].
fn whole_rotation(random: &mut Random) -> [i64; 4] {
    loop {
        let q = [(); 4].map(|()| random.below(21) as i64 - 10);
        if q.iter().map(|x| x * x).sum::<i64>() == SQUARE {
            return q;
        }
    }
}

/// |q|² times the rotation matrix.
fn turn([x, y, z, w]: [i64; 4]) -> [[i64; 3]; 3] {
    let [xx, yy, zz, ww] = [x * x, y * y, z * z, w * w];
    [
        [xx - yy - zz + ww, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), yy - xx - zz + ww, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), zz - xx - yy + ww],
    ]
}

fn apply(turn: [[i64; 3]; 3], v: [i64; 3]) -> [i64; 3] {
    turn.map(|row| (0..3).map(|i| row[i] * v[i]).sum())
}

/// Meshes of all kinds: with faces on the axes, round, thin, and with a dent.
fn shapes(directions: DirectionSet) -> Vec<Shape> {
    let forms = [
        ProceduralShape::Box { x: 1.0, y: 2.0, z: 1.5 },
        ProceduralShape::Icosphere { radius: 0.75, subdivisions: 1 },
        ProceduralShape::Needle { length: 3.0, radius: 0.25, sides: 8 },
        ProceduralShape::default_of("l-shape").unwrap(),
    ];
    let build = |form: ProceduralShape| {
        let spec = ShapeSpec { directions, ..ShapeSpec::default() };
        Shape::build(&form.build().unwrap(), &spec).unwrap()
    };
    forms.map(build).into()
}

/// Parts as the links of a tree: each at an end of an earlier one, turned by any angle.
fn tree(count: usize, shapes: usize, random: &mut Random) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for number in 0..count {
        let from = match number {
            0 => [0.0; 3],
            _ => parts[random.below(number)].translation,
        };
        let way = [(); 3].map(|()| (random.below(29) as i64 - 14) * SQUARE);
        parts.push(Part {
            shape: random.below(shapes) as u32,
            rotation: match number % 4 {
                0 => UNTURNED,
                _ => [(); 4].map(|()| random.within(1.0)),
            },
            translation: [0, 1, 2].map(|axis| from[axis] + way[axis] as f64 * STEP),
            rounded: false,
        });
    }
    parts
}

/// The pairs that a new culler reports.
fn afresh(world: &World, compounds: &[(u32, Compound)]) -> Vec<PartPair> {
    let mut culler = PartCuller::new();
    for (shape, compound) in compounds {
        culler.set_parts(*shape, compound.clone());
    }
    culler.cull(world).unwrap().to_vec()
}

fn pair(a: BodyId, b: BodyId, parts: [u32; 2]) -> PartPair {
    if a < b {
        PartPair { bodies: [a, b], parts }
    } else {
        let [i, j] = parts;
        PartPair { bodies: [b, a], parts: [j, i] }
    }
}

/// No two parts that meet are missed, whatever has happened to their bodies.
#[test]
fn histories_of_compounds() {
    live(HistoryKind::Compounds, 2..3);
}

/// Other parts of a shape number, and another shape that is alone, count from the next cull on.
#[test]
fn changed_parts_count_next_cull() {
    let (mut random, shapes) = (Random::new(5), shapes(DirectionSet::K18));
    let mut world = World::new(vec![shapes[3].clone(); 3]).unwrap();
    for body in 0..36 {
        let rotation = [(); 4].map(|()| random.within(1.0));
        let place = [(); 3].map(|()| f64::from(random.within(3.0)));
        world.insert(Body::at(body % 3, rotation, place)).unwrap();
    }
    let (mut culler, mut compounds) = (PartCuller::new(), Vec::new());
    for (round, number) in [0, 1, 2, 2, 0, 2, 1, 2].into_iter().enumerate() {
        if number == 2 {
            world.replace_shape(2, &shapes[round % 4]).unwrap();
        } else {
            let compound = Compound::build("t", &shapes, &tree(3 + round, 4, &mut random)).unwrap();
            world.replace_shape(number, compound.shape()).unwrap();
            culler.set_parts(number, compound.clone());
            compounds.retain(|(other, _)| *other != number);
            compounds.push((number, compound));
        }
        world.cull().unwrap();
        let found = culler.cull(&world).unwrap().to_vec();
        assert!(found.len() > 20 && found == afresh(&world, &compounds), "round {round}");
    }
}
