//! The bodies and hashes are those of `python/tests/test_hashes.py`: answers are the same in both
//! languages.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::forms;
use std::collections::HashMap;

use sdop::compound::{Compound, Part, PartCuller};
use sdop::{
    Bodies, Body, BodyId, Culler, QueryIndex, QueryVolume, Shape, ShapeSpec, TriangleMesh, World,
};
use sha2::{Digest, Sha256};

use forms::BOX_FACES;

const BODIES: u32 = 1600;
const PAIRS: &str = "dd975ffe385c67426ced847af96edb364ab60e6bc5da94ab79f2bc33dbce7a22";
const TOUCHING: &str = "11e4060fa18adb68bc45bf942c8b3549ee37c7d734098993f9b60d578626d9d6";
const PARTS: &str = "955ba31aadad357eae3d7054477333fbe62551f35855c8eee73c8962aafeb42e";

/// A mesh in the form of an L, from two boxes.
fn bracket() -> Shape {
    let cuboid = |x: f64, y: f64| {
        let corners = (0..8).map(move |i| [0, 1, 2].map(|axis| f64::from(i >> axis & 1)));
        corners.map(move |[a, b, c]| [a * x, b * y, c])
    };
    let vertices: Vec<_> = cuboid(4.0, 1.0).chain(cuboid(1.0, 3.0)).collect();
    let second = BOX_FACES.map(|face| face.map(|i| i + 8));
    let mesh = TriangleMesh::from_f64(&vertices, &[BOX_FACES, second].concat()).unwrap();
    Shape::build(&mesh, &ShapeSpec::default()).unwrap()
}

/// Small whole numbers as a quaternion, and eighths as a translation: exact in every language.
fn pose(i: u32) -> ([f32; 4], [f32; 3]) {
    let whole = |n: u32, less: i16| f32::from(n as i16 - less);
    let rotation =
        [whole(7 * i % 13, 6), whole(5 * i % 11, 5), whole(3 * i % 7, 3), whole(i % 4, -1)];
    let translation = [131 * i % 509, 577 * i % 521, 29 * i % 503];
    (rotation, translation.map(|n| whole(n, 0) / 8.0))
}

fn hash(numbers: impl IntoIterator<Item = u32>) -> String {
    let mut hash = Sha256::new();
    for number in numbers {
        hash.update(number.to_le_bytes());
    }
    let bytes = hash.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A world of all bodies, each fifth fixed, and their numbers.
fn world(shape: Shape) -> (World, HashMap<BodyId, u32>) {
    let mut world = World::new(vec![shape]).unwrap();
    let mut insert = |i: u32| {
        let (rotation, translation) = pose(i);
        let body = Body::at(0, rotation, translation.map(f64::from));
        let body = if i.is_multiple_of(5) { body.fixed() } else { body };
        (world.insert(body).unwrap(), i)
    };
    let numbers = (0..BODIES).map(&mut insert).collect();
    (world, numbers)
}

#[test]
fn pairs_have_pythons_hash() {
    let mut bodies = Bodies::default();
    for i in 0..BODIES {
        let (rotation, translation) = pose(i);
        bodies.push(0, !i.is_multiple_of(5), rotation, translation);
    }
    let mut culler = Culler::new(&[bracket()], &bodies).unwrap();
    let pairs = culler.cull(&bodies).unwrap().sorted();
    assert!(pairs.len() > 300);
    assert_eq!(hash(pairs.into_flattened()), PAIRS);
}

#[test]
fn queries_have_pythons_hash() {
    let (world, numbers) = world(bracket());
    let mut index = QueryIndex::new();
    index.update(&world);
    let balls = (0..50).map(|i: u32| QueryVolume::Ball {
        centre: pose(i + BODIES).1.map(f64::from),
        radius: f64::from(i % 9),
    });
    let answers = index.touching_all(&balls.collect::<Vec<_>>()).unwrap();
    let (rows, numbers) = ((0..).zip(answers.iter()), &numbers);
    let rows: Vec<_> = rows
        .flat_map(|(query, found)| found.iter().flat_map(move |id| [query, numbers[id]]))
        .collect();
    assert!(rows.len() > 100);
    assert_eq!(hash(rows), TOUCHING);
}

#[test]
fn parts_have_pythons_hash() {
    let shapes = [bracket()];
    let parts = [0.0, 1.5, 3.0].map(|z| Part { translation: [0.0, z, z], ..Part::default() });
    let compound = Compound::build("three", &shapes, &parts).unwrap();
    let (mut world, numbers) = world(compound.shape().clone());
    let mut culler = PartCuller::new();
    culler.set_parts(0, compound);
    world.cull().unwrap();
    let pairs = culler.cull(&world).unwrap();
    assert!(pairs.len() > 1000);
    let rows =
        pairs.iter().flat_map(|pair| [pair.bodies.map(|id| numbers[&id]), pair.parts].concat());
    assert_eq!(hash(rows.collect::<Vec<_>>()), PARTS);
}
