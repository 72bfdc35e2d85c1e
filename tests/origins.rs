//! Poses refer to the mesh's own origin: what a user writes first, every example and the pair
//! test are judged in the coordinates of the file, by an L-shaped bracket next to its origin.
//! Rapier's seam is judged in its own package.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../examples/cull.rs"]
#[allow(dead_code, reason = "a test calls what `main` does")]
mod cull;
#[path = "../examples/judge/main.rs"]
#[allow(dead_code, reason = "a test calls what `main` does")]
mod judge;
#[path = "../examples/world_glam.rs"]
#[allow(dead_code, reason = "a test calls what `main` does")]
mod world_glam;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::world::PairTest;
use sdop::{
    Bodies, Body, Culler, DirectionSet, ProceduralShape, Shape, ShapeSpec, TriangleMesh, World,
};
use sdop_judge::{Claim, Contestant, Scene};
use sdop_reference as reference;

const POSES: usize = 300;
const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

type Pose = ([f32; 4], [f32; 3]);

/// Two arms of a corner that is the origin.
fn bracket() -> TriangleMesh {
    let form = ProceduralShape::LShape { x: 2.0, y: 1.5, arm: 0.25, thickness: 0.25 };
    let mut mesh = form.build().unwrap();
    let least = mesh.vertices.iter().fold(glam::Vec3::INFINITY, |m, v| m.min(glam::Vec3::from(*v)));
    for vertex in &mut mesh.vertices {
        *vertex = (glam::Vec3::from(*vertex) - least).to_array();
    }
    mesh
}

/// Random poses about the origin, at which a first bracket is not rotated.
fn poses() -> Vec<Pose> {
    let mut random = ChaCha8Rng::seed_from_u64(40);
    let mut unit = move || (random.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0;
    (0..POSES).map(|_| ([(); 4].map(|()| unit()), [(); 3].map(|()| 0.8 * unit()))).collect()
}

/// Which poses let the brackets meet, exactly, the vertices being the file's.
fn meeting(mesh: &TriangleMesh, poses: &[Pose]) -> Vec<bool> {
    let shape = reference::Shape::of_mesh(mesh.vertices.clone(), mesh.triangles.clone()).unwrap();
    let body = |(q, t): Pose| reference::Body {
        shape: &shape,
        pose: reference::Pose::new(q, t).unwrap(),
        dynamic: true,
    };
    let first = body((UNTURNED, [0.0; 3]));
    let meets = |pose: &Pose| {
        let bodies = [first, body(*pose)];
        !reference::exact::judge::meeting_pairs(&bodies).0.is_empty()
    };
    poses.iter().map(meets).collect()
}

/// Judges a way of asking whether brackets at the origin and in a pose may touch.
fn assert_nothing_missed(what: &str, may_touch: impl FnMut(&Pose) -> bool) {
    let poses = poses();
    let meets = meeting(&bracket(), &poses);
    let reported: Vec<bool> = poses.iter().map(may_touch).collect();
    let missed = meets.iter().zip(&reported).filter(|&(m, r)| *m && !r).count();
    let meet = meets.iter().filter(|meets| **meets).count();
    assert_eq!(missed, 0, "{what}: missed of {meet} pairs that meet");
    let spared = reported.iter().filter(|reported| !**reported).count();
    assert!(meet > 100 && spared > 20, "{what}: {meet} meet, {spared} spared");
}

fn bodies(pose: &Pose) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.push(0, true, UNTURNED, [0.0; 3]);
    bodies.push(0, true, pose.0, pose.1);
    bodies
}

/// What a culler of these volumes says of the brackets.
fn by_culler(shape: Shape) -> impl FnMut(&Pose) -> bool {
    move |pose| {
        let bodies = bodies(pose);
        let mut culler = Culler::new(std::slice::from_ref(&shape), &bodies).unwrap();
        culler.cull(&bodies).unwrap().len() == 1
    }
}

/// What a world of these volumes says of the brackets.
fn by_world(shape: Shape) -> impl FnMut(&Pose) -> bool {
    let mut world = World::new(vec![shape]).unwrap();
    world.insert(Body::at(0, UNTURNED, [0.0; 3])).unwrap();
    let other = world.insert(Body::at(0, UNTURNED, [0.0; 3])).unwrap();
    move |&(rotation, translation)| {
        let translation = translation.map(f64::from);
        world.set_pose(other, rotation, translation).unwrap();
        world.cull().unwrap();
        world.pairs().len() == 1
    }
}

#[test]
fn the_default_keeps_the_origin() {
    let shape = Shape::build(&bracket(), &ShapeSpec::default()).unwrap();
    assert_eq!((shape.offset, shape.scale), ([0.0; 3], 1.0));
    assert_nothing_missed("culler", by_culler(shape.clone()));
    assert_nothing_missed("world", by_world(shape));
}

/// The text's examples build shapes by default, and nothing else.
#[test]
fn the_pages_use_the_default() {
    for page in ["README.md", "src/lib.rs", "src/world/mod.rs"] {
        let text = std::fs::read_to_string(page).unwrap();
        let built = text.matches("Shape::build(").count();
        assert_eq!(built, text.matches("&ShapeSpec::default())").count(), "{page}");
        assert!(built > 0, "{page}");
    }
}

#[test]
fn the_examples_keep_the_origin() {
    let mesh = bracket();
    assert_nothing_missed("cull.rs", by_culler(cull::volumes(&mesh).unwrap()));
    assert_nothing_missed("world_glam.rs", by_world(world_glam::volumes(&mesh).unwrap()));
}

#[test]
fn the_judged_grid_keeps_the_origin() {
    let shape = Shape::build(&bracket(), &ShapeSpec::default()).unwrap();
    assert_nothing_missed("judge", |pose| {
        let bodies = bodies(pose);
        let scene = Scene {
            claim: Claim::Mesh,
            shapes: std::slice::from_ref(&shape),
            bodies: &bodies,
            boxes: &[],
        };
        let mut grid = judge::Grid::new(&scene, false);
        grid.frame(&bodies);
        grid.pairs().len() == 1
    });
}

#[test]
fn a_pair_test_keeps_the_origin() {
    let shape = Shape::build(&bracket(), &ShapeSpec::default()).unwrap();
    let mut test = PairTest::new(DirectionSet::K18);
    let number = test.add(&shape).unwrap();
    assert_nothing_missed("pair test", |&(rotation, translation)| {
        test.may_touch(number, number, rotation, translation)
    });
}
