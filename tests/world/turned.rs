//! Numbers in f64: what meets exactly is reported, whatever f32 makes of rotations and vertices.

use sdop::compound::{Compound, Part, PartCuller};
use sdop::mesh::TriangleMesh;
use sdop::periodic::PeriodicWorld;
use sdop::query::QueryShape;
use sdop::{QueryIndex, QueryVolume};
use sdop_judge::ours::reference_shapes::Shapes;
use sdop_reference::{WidePose, wide};

use super::*;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const TIP: f64 = 101.0;

/// A needle whose tip is far from its origin, so that rotations in f32 move it.
fn needle() -> TriangleMesh {
    let vertices =
        [[TIP as f32, 0.0, 0.0], [100.0, 0.125, 0.0], [100.0, -0.125, 0.125], [100.0, 0.0, -0.125]];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    TriangleMesh::new("needle", vertices, faces).unwrap()
}

/// The tip alone: no volume reaches farther.
fn tip() -> TriangleMesh {
    TriangleMesh::new("tip", [[TIP as f32, 0.0, 0.0]], vec![[0, 0, 0]]).unwrap()
}

/// A mesh, and a plate from 0 on along x.
fn with_plate(mesh: TriangleMesh) -> Shapes {
    let plate = ProceduralShape::Box { x: 1.0, y: 512.0, z: 512.0 }.build().unwrap();
    let vertices = plate.vertices.iter().map(|[x, y, z]| [x + 0.5, *y, *z]);
    let plate = TriangleMesh::new("plate", vertices, plate.triangles.clone()).unwrap();
    let shape = |mesh| Shape::build(&mesh, &ShapeSpec::default()).unwrap();
    Shapes::new(vec![shape(mesh), shape(plate)]).unwrap()
}

/// A rotation in f64 and a translation in f32 with which the needle's tip just touches the plate:
/// the last of all rotations in f64 between one that meets and one that doesn't.
fn touch(random: &mut Random, shapes: &Shapes) -> ([f64; 4], [f64; 3]) {
    let plate = WidePose::new([0.0, 0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    loop {
        let [x, y, z, w] = [(); 4].map(|()| f64::from(random.unit()));
        // About z, by an angle that grows with s.
        let turned = |s: f64| [x + y * s, y - x * s, z + w * s, w - z * s];
        let [i, j, k, l] = turned(0.0);
        let along = (i * i - j * j - k * k + l * l) / (i * i + j * j + k * k + l * l);
        if !(0.3..0.9).contains(&along) {
            continue;
        }
        let t = [f64::from((-along * TIP) as f32), 0.0, 0.0];
        let meets = |s: f64| {
            let needle = WidePose::new(turned(s), t).unwrap();
            wide::meet((&shapes.judged[0], &needle), (&shapes.judged[1], &plate)).meets
        };
        let (mut inside, mut outside) = (1.0e-3, -1.0e-3);
        if !meets(inside) {
            (inside, outside) = (outside, inside);
        }
        if !meets(inside) || meets(outside) {
            continue;
        }
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            *if meets(middle) { &mut inside } else { &mut outside } = middle;
        }
        return (turned(inside), t);
    }
}

/// Volumes that reach hardly farther than the mesh, and all others.
#[test]
fn turned_bodies_that_touch_are_reported() {
    let shapes = with_plate(needle());
    let mut random = Random(ChaCha8Rng::seed_from_u64(31));
    let touches: Vec<_> = (0..24).map(|_| touch(&mut random, &shapes)).collect();
    let mut lost = 0;
    for way in ways().into_iter().filter(|way| way.strategy != Strategy::None) {
        let culler = Culler::builder().settings(&way);
        let mut world = World::with(shapes.built.clone(), &culler).unwrap();
        let fixed = world.insert(Body::at(1, UNTURNED, [0.0; 3]).fixed()).unwrap();
        let body = world.insert(Body::default()).unwrap();
        for &(q, t) in &touches {
            world.set_pose_f64(body, q, t).unwrap();
            assert!(world.cull().unwrap().iter().eq([[fixed, body]]), "{way:?}: {q:?} {t:?}");
            // What a caller does who rounds.
            world.set_pose(body, q.map(|x| x as f32), t).unwrap();
            lost += usize::from(world.cull().unwrap().is_empty() && way.strategy == Strategy::Aabb);
            world.set(body, Body::at(0, UNTURNED, [t[0] - 0.125, 0.0, 0.0]).turned(q)).unwrap();
            let is_sharp = [Strategy::Aabb, Strategy::KDop].contains(&way.strategy);
            assert!(world.cull().unwrap().is_empty() || !is_sharp, "{way:?}: an eighth apart");
        }
    }
    assert!(lost > 100, "{lost}: rounding would do");
}

/// The same touches, in an index of queries, of parts and of whole bodies, and across a border.
#[test]
fn turned_queries_parts_and_images_are_found() {
    let shapes = with_plate(tip());
    let [tip, plate] = &shapes.built[..] else { panic!("two shapes") };
    let mut random = Random(ChaCha8Rng::seed_from_u64(32));
    let alone = |shape: &Shape| World::new(vec![shape.clone()]).unwrap();
    let (mut with_tip, mut plates) = (alone(tip), alone(plate));
    let body = with_tip.insert(Body::default()).unwrap();
    let fixed = plates.insert(Body::default()).unwrap();
    let (min, max) = ([0.0, -256.0, -256.0], [1.0, 256.0, 256.0]);
    let (mut index, mut of_plate) = (QueryIndex::new(), QueryIndex::new());
    of_plate.update(&plates);
    let asked = QueryShape::new(tip);
    let [mut lost, mut lost_queries] = [0; 2];
    for _ in 0..60 {
        let (q, t) = touch(&mut random, &shapes);
        let turned = Body::at(0, UNTURNED, t).turned(q);
        let near = |index: &QueryIndex| index.touching(&QueryVolume::Box { min, max }).unwrap();
        with_tip.set(body, turned).unwrap();
        index.update(&with_tip);
        assert_eq!(near(&index), [body], "{q:?} {t:?}");
        with_tip.set(body, Body { rounded: false, ..turned }).unwrap();
        index.update(&with_tip);
        lost += usize::from(near(&index).is_empty());

        let found = of_plate.touching(&QueryVolume::shape(&asked, q, t, 0.0)).unwrap();
        assert_eq!(found, [fixed], "{q:?} {t:?}");
        let Body { rotation, translation, .. } = turned;
        let nearest = QueryVolume::Shape { shape: &asked, rotation, translation, margin: 0.0 };
        lost_queries += usize::from(of_plate.touching(&nearest).unwrap().is_empty());

        // A part that is turned in its body, and a body that is turned with its part.
        let part = Part { translation: t, ..Part::default() }.turned(q);
        for (part, body) in [(part, Body::default()), (Part::default(), turned)] {
            let compound = Compound::build("one", &shapes.built, &[part, part]).unwrap();
            let mut world = World::new(vec![compound.shape().clone(), plate.clone()]).unwrap();
            let a = world.insert(body).unwrap();
            let b = world.insert(Body::at(1, UNTURNED, [0.0; 3]).fixed()).unwrap();
            assert!(world.cull().unwrap().iter().eq([[a, b]]), "{q:?} {t:?}");
            let mut parts = PartCuller::new();
            parts.set_parts(0, compound);
            assert_eq!(parts.cull(&world).unwrap().len(), 2, "{q:?} {t:?}");
        }

        let shapes = shapes.built.clone();
        let mut world = PeriodicWorld::new(shapes, [Some(4096.0), None, Some(8192.0)]).unwrap();
        let a = world.insert(Body { translation: [t[0] - 4096.0, t[1], t[2]], ..turned }).unwrap();
        let b = world.insert(Body::at(1, UNTURNED, [4096.0, 0.0, 0.0]).fixed()).unwrap();
        let pairs = world.cull().unwrap();
        assert_eq!((pairs[0].bodies, pairs[0].image), ([a, b], [-2, 0, 0]), "{q:?} {t:?}");
    }
    assert!(lost > 10 && lost_queries > 10, "{lost}, {lost_queries}: rounding would do");
}

/// What a body says of its rotation survives being read, set, saved and restored.
#[test]
fn bodies_know_rounded_rotations() {
    let mut world = World::new(with_plate(needle()).built).unwrap();
    let exact = Body::at(0, [0.0, 0.0, 0.75, 1.0], [0.1, 0.0, 0.0]);
    assert_eq!(Body::at(0, UNTURNED, exact.translation).turned([0.0, 0.0, 0.75, 1.0]), exact);
    let id = world.insert(exact.turned([0.0, 0.0, 0.6, 0.8])).unwrap();
    let body = world.body(id).unwrap();
    assert_eq!((body.rotation, body.rounded), ([0.0, 0.0, 0.6, 0.8], true));
    world.set_motion(id, Motion::Resting).unwrap();
    let saved = serde_json::to_string(&world.snapshot()).unwrap();
    let mut other = World::new(with_plate(needle()).built).unwrap();
    other.restore(&serde_json::from_str(&saved).unwrap()).unwrap();
    assert_eq!(other.body(id).unwrap(), world.body(id).unwrap());
    assert_eq!(other.snapshot(), world.snapshot());
    assert!(other.body(id).unwrap().rounded);
    // Without the rounding it is another body, though its numbers are the same.
    let rests = other.snapshot();
    other.set_pose(id, body.rotation, body.translation).unwrap();
    assert!(!other.body(id).unwrap().rounded && other.snapshot() != rests);
    let damaged = saved.replace("\"rounded\":[0]", "\"rounded\":[7]");
    let refused = other.restore(&serde_json::from_str(&damaged).unwrap()).unwrap_err();
    assert!(refused.to_string().contains("slot 7 of 1 is rounded"), "{refused}");
    let zero = world.set_pose_f64(id, [0.0; 4], [0.0; 3]).unwrap_err();
    assert!(zero.to_string().contains("rotation [0.0, 0.0, 0.0, 0.0]"), "{zero}");
    assert!(world.set_pose_f64(id, [f64::NAN, 0.0, 0.0, 1.0], [0.0; 3]).is_err());
}

/// A box that ends at 1 + 2⁻²⁶, which f32 rounds to 1, and 1 farther a plate from 2⁻²⁶ on: they
/// touch.
#[test]
fn meshes_in_f64_that_touch_are_reported() {
    let least = 2.0_f64.powi(-26);
    let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build().unwrap();
    let along = |from: f64, to: f64| -> Vec<[f64; 3]> {
        let end = |x: f32| if x < 0.0 { from } else { to };
        let ends = |&[x, y, z]: &[f32; 3]| [end(x), f64::from(y), f64::from(z)];
        cube.vertices.iter().map(ends).collect()
    };
    let wide = along(0.0, 1.0 + least);
    let narrow: Vec<[f32; 3]> = wide.iter().map(|point| point.map(|x| x as f32)).collect();
    let given = TriangleMesh::from_f64(&wide, &cube.triangles).unwrap();
    let rounded = TriangleMesh::from_f32(&narrow, &cube.triangles).unwrap();
    let plate = TriangleMesh::from_f64(&along(least, 0.5), &cube.triangles).unwrap();
    assert_eq!((&given.vertices, plate.rounding, rounded.rounding), (&rounded.vertices, 0.0, 0.0));
    assert!(!given.is_far() && f64::from(given.rounding) >= least);
    for way in ways().into_iter().filter(|way| way.strategy != Strategy::None) {
        let found = |mesh: &TriangleMesh, at: f64| {
            let shape = |mesh| Shape::build(mesh, &ShapeSpec::default()).unwrap();
            let shapes = vec![shape(mesh), shape(&plate)];
            let mut world = World::with(shapes, &Culler::builder().settings(&way)).unwrap();
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
