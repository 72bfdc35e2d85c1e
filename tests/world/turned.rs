//! Numbers in f64: what meets exactly is reported, whatever f32 makes of rotations and vertices.

use sdop::compound::{Compound, Part, PartCuller};
use sdop::mesh::TriangleMesh;
use sdop::query::QueryShape;
use sdop::world::PeriodicWorld;
use sdop::{QueryIndex, QueryVolume};
use sdop_judge::truth::reference_shapes::Shapes;
use sdop_reference::{WidePose, wide};

use super::*;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const TIP: f32 = 101.0;

/// A point far from its origin, so that rotations in f32 move it, and a plate from 0 on along x.
fn tip_and_plate() -> Shapes {
    let tip = TriangleMesh::new("tip", [[TIP, 0.0, 0.0]], vec![[0, 0, 0]]).unwrap();
    let mut plate = ProceduralShape::Box { x: 1.0, y: 512.0, z: 512.0 }.build().unwrap();
    plate.vertices.iter_mut().for_each(|vertex| vertex[0] += 0.5);
    let shape = |mesh| Shape::build(mesh, &ShapeSpec::default()).unwrap();
    Shapes::new(vec![shape(&tip), shape(&plate)]).unwrap()
}

/// A rotation in f64 and a translation in f32 with which the tip just touches the plate: the last
/// of all rotations between one that meets and one that doesn't.
fn touch(random: &mut Random, shapes: &Shapes) -> ([f64; 4], [f64; 3]) {
    let plate = WidePose::new([0.0, 0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    loop {
        let [x, y, z, w] = [(); 4].map(|()| f64::from(random.within(1.0)));
        // About z, by an angle that grows with s.
        let turned = |s: f64| [x + y * s, y - x * s, z + w * s, w - z * s];
        let along = (x * x - y * y - z * z + w * w) / (x * x + y * y + z * z + w * w);
        let t = [f64::from((-along * f64::from(TIP)) as f32), 0.0, 0.0];
        let meets = |s: f64| {
            let tip = WidePose::new(turned(s), t).unwrap();
            wide::meet((&shapes.judged[0], &tip), (&shapes.judged[1], &plate)).meets
        };
        let (mut inside, mut outside) =
            if meets(1.0e-3) { (1.0e-3, -1.0e-3) } else { (-1.0e-3, 1.0e-3) };
        if !(0.3..0.9).contains(&along) || !meets(inside) || meets(outside) {
            continue;
        }
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            *if meets(middle) { &mut inside } else { &mut outside } = middle;
        }
        return (turned(inside), t);
    }
}

#[test]
fn turned_bodies_that_touch_are_reported() {
    let shapes = tip_and_plate();
    let mut random = Random::new(31);
    let touches: Vec<_> = (0..24).map(|_| touch(&mut random, &shapes)).collect();
    let mut lost = 0;
    for way in ways().into_iter().filter(|way| way.strategy != Strategy::None) {
        let culler = Culler::builder().settings(&way);
        let mut world = World::with(shapes.built.clone(), &culler).unwrap();
        let fixed = world.insert(Body::at(1, UNTURNED, [0.0; 3]).fixed()).unwrap();
        let body = world.insert(Body::default()).unwrap();
        let is_sharp = [Strategy::Aabb, Strategy::KDop].contains(&way.strategy);
        for &(q, t) in &touches {
            world.set_pose_f64(body, q, t).unwrap();
            assert!(world.cull().unwrap().iter().eq([[fixed, body]]), "{way:?}: {q:?} {t:?}");
            // What a caller does who rounds.
            world.set_pose(body, q.map(|x| x as f32), t).unwrap();
            lost += usize::from(world.cull().unwrap().is_empty() && is_sharp);
            world.set(body, Body::at(0, UNTURNED, [t[0] - 0.125, 0.0, 0.0]).turned(q)).unwrap();
            assert!(world.cull().unwrap().is_empty() || !is_sharp, "{way:?}: an eighth apart");
        }
    }
    assert!(lost > 100, "{lost}: rounding would do");
}

/// The same touches, in an index of queries, of parts and of whole bodies, and across a border.
#[test]
fn turned_queries_parts_and_images_are_found() {
    let shapes = tip_and_plate();
    let [tip, plate] = &shapes.built[..] else { panic!("two shapes") };
    let mut random = Random::new(32);
    let [mut tips, mut plates] = [tip, plate].map(|shape| World::new(vec![shape.clone()]).unwrap());
    let id = tips.insert(Body::default()).unwrap();
    let fixed = plates.insert(Body::default()).unwrap();
    let (mut index, mut of_plate) = (QueryIndex::new(), QueryIndex::new());
    of_plate.update(&plates);
    let asked = QueryShape::new(tip);
    let mut lost = [0; 2];
    for _ in 0..60 {
        let (q, t) = touch(&mut random, &shapes);
        let turned = Body::at(0, UNTURNED, t).turned(q);
        let Body { rotation, translation, .. } = turned;
        let mut near = |body: Body| {
            tips.set(id, body).unwrap();
            index.update(&tips);
            let (min, max) = ([0.0, -256.0, -256.0], [1.0, 256.0, 256.0]);
            index.touching(&QueryVolume::Box { min, max }).unwrap()
        };
        assert_eq!(near(turned), [id], "{q:?} {t:?}");
        lost[0] += usize::from(near(Body { rounded: false, ..turned }).is_empty());
        let found = of_plate.touching(&QueryVolume::shape(&asked, q, t, 0.0)).unwrap();
        assert_eq!(found, [fixed], "{q:?} {t:?}");
        let nearest = QueryVolume::Shape { shape: &asked, rotation, translation, margin: 0.0 };
        lost[1] += usize::from(of_plate.touching(&nearest).unwrap().is_empty());

        // A part that is turned in its body, and a body that is turned with its part.
        let part = Part { translation: t, ..Part::default() }.turned(q);
        for (part, body) in [(part, Body::default()), (Part::default(), turned)] {
            let compound = Compound::build("one", &shapes.built, &[part, part]).unwrap();
            let mut world = World::new(vec![compound.shape().clone(), plate.clone()]).unwrap();
            world.insert(body).unwrap();
            world.insert(Body::at(1, UNTURNED, [0.0; 3]).fixed()).unwrap();
            world.cull().unwrap();
            let mut parts = PartCuller::new();
            parts.set_parts(0, compound);
            assert_eq!(parts.cull(&world).unwrap().len(), 2, "{q:?} {t:?}");
        }

        let periods = [Some(4096.0), None, Some(8192.0)];
        let mut world = PeriodicWorld::new(shapes.built.clone(), periods).unwrap();
        world.insert(Body { translation: [t[0] - 4096.0, t[1], t[2]], ..turned }).unwrap();
        world.insert(Body::at(1, UNTURNED, [4096.0, 0.0, 0.0]).fixed()).unwrap();
        let pairs = world.cull().unwrap();
        assert!(pairs.len() == 1 && pairs[0].image == [-2, 0, 0], "{q:?} {t:?}");
    }
    assert!(lost.iter().all(|&lost| lost > 10), "{lost:?}: rounding would do");
}

/// What a body says of its rotation survives being read, set, saved and restored.
#[test]
fn bodies_know_rounded_rotations() {
    let world = || World::new(tip_and_plate().built).unwrap();
    let (mut first, mut other) = (world(), world());
    let exact = Body::at(0, [0.0, 0.0, 0.75, 1.0], [0.1, 0.0, 0.0]);
    assert_eq!(exact.turned([0.0, 0.0, 0.75, 1.0]), exact);
    let id = first.insert(exact.turned([0.0, 0.0, 0.6, 0.8])).unwrap();
    let body = first.body(id).unwrap();
    assert_eq!((body.rotation, body.rounded), ([0.0, 0.0, 0.6, 0.8], true));
    first.set_motion(id, Motion::Resting).unwrap();
    let saved = serde_json::to_string(&first.snapshot()).unwrap();
    other.restore(&serde_json::from_str(&saved).unwrap()).unwrap();
    assert!(other.snapshot() == first.snapshot() && other.body(id).unwrap().rounded);
    other.set_pose(id, body.rotation, body.translation).unwrap();
    assert!(!other.body(id).unwrap().rounded && other.snapshot() != first.snapshot());
    let damaged = saved.replace("\"rounded\":[0]", "\"rounded\":[7]");
    let refused = other.restore(&serde_json::from_str(&damaged).unwrap()).unwrap_err();
    assert!(refused.to_string().contains("bodies that are rounded"), "{refused}");
    for bad in [[0.0; 4], [f64::NAN, 0.0, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0, 1.0]] {
        let refused = first.set_pose_f64(id, bad, [0.0; 3]).unwrap_err();
        assert!(refused.to_string().contains(&format!("rotation {:?}", bad.map(|x| x as f32))));
    }
}

/// A box that ends at 1 + 2⁻²⁶, which f32 rounds to 1, and 1 farther a plate from 2⁻²⁶ on: they
/// touch.
#[test]
fn meshes_in_f64_that_touch_are_reported() {
    let least = 2.0_f64.powi(-26);
    let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build().unwrap();
    let along = |from: f64, to: f64| {
        let ends = |v: &[f32; 3]| [if v[0] < 0.0 { from } else { to }, v[1].into(), v[2].into()];
        let points: Vec<[f64; 3]> = cube.vertices.iter().map(ends).collect();
        TriangleMesh::from_f64(&points, &cube.triangles).unwrap()
    };
    let (given, plate) = (along(0.0, 1.0 + least), along(least, 0.5));
    let rounded = TriangleMesh { rounding: 0.0, ..given.clone() };
    assert!(plate.rounding == 0.0 && f64::from(given.rounding) >= least && !given.is_far());
    for way in ways().into_iter().filter(|way| way.strategy != Strategy::None) {
        let found = |mesh: &TriangleMesh, at: f64| {
            let shape = |mesh| Shape::build(mesh, &ShapeSpec::default()).unwrap();
            let culler = Culler::builder().settings(&way);
            let mut world = World::with(vec![shape(mesh), shape(&plate)], &culler).unwrap();
            world.insert(Body::at(0, UNTURNED, [at, 0.0, 0.0])).unwrap();
            world.insert(Body::at(1, UNTURNED, [0.0; 3])).unwrap();
            world.cull().unwrap().len()
        };
        assert_eq!(found(&given, -1.0), 1, "{way:?}");
        if way.strategy == Strategy::Aabb {
            assert_eq!([found(&rounded, -1.0), found(&given, -1.0 - 2.0_f64.powi(-20))], [0, 0]);
        }
    }
}
