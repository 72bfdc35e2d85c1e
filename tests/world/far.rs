//! Meshes far from their origin, in worlds: judged in the file's coordinates, in f64.

use sdop::mesh::TriangleMesh;
use sdop::settings::{CullSettings, DirectionSet};
use sdop::volume::Axes;
use sdop::world::PairTest;
use sdop::{Bodies, CullError};

use super::*;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// A corner of edge 1 at this place.
fn tetrahedron(at: [f64; 3]) -> TriangleMesh {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let points = corners.map(|c| std::array::from_fn(|i| at[i] + c[i]));
    TriangleMesh::from_f64(&points, &TETRAHEDRON).unwrap()
}

fn world_of(way: &CullSettings, meshes: &[TriangleMesh]) -> World {
    let spec = ShapeSpec { directions: way.k, axes: Axes::Model, ..ShapeSpec::default() };
    let shape = |mesh| Shape::build(mesh, &spec).unwrap();
    let culler = Culler::builder().settings(way).budget(Budget::Tests(9));
    World::with(meshes.iter().map(shape).collect(), &culler).unwrap()
}

/// Ways that report what touches, and little else: boxes of all kinds.
fn sharp_ways() -> Vec<CullSettings> {
    let sharp =
        [Strategy::Aabb, Strategy::KDop, Strategy::Obb, Strategy::OrDop, Strategy::SDopSequential];
    let ways = ways().into_iter();
    ways.filter(|way| sharp.contains(&way.strategy) && way.k != DirectionSet::K26).collect()
}

#[test]
fn far_tetrahedra_that_overlap_are_reported() {
    let far = 1_000_000_031.5;
    let meshes = [0.0, 0.7, 1.2].map(|x| tetrahedron([far + x, 0.25, -far]));
    for way in sharp_ways() {
        let mut world = world_of(&way, &meshes);
        let ids = [0, 1, 2].map(|shape| world.insert(Body::at(shape, UNTURNED, [0.0; 3])).unwrap());
        world.cull().unwrap();
        let pairs: Vec<_> = world.pairs().collect();
        assert!(pairs.contains(&[ids[0], ids[1]]), "{way:?}: by 0.3");
        assert!(pairs.contains(&[ids[1], ids[2]]), "{way:?}: by 0.5");
        assert!(!pairs.contains(&[ids[0], ids[2]]), "{way:?}: 0.2 apart");
    }
}

/// A box of f64 corners that f32 has to round, and its length along x.
fn rounded_box(random: &mut Random) -> (TriangleMesh, f64) {
    // Multiples of 2⁻³⁶, all f64 below 2¹⁷.
    let fine = |random: &mut Random| f64::from(random.below(1 << 30)) * 2f64.powi(-36);
    let lo: [f64; 3] = [(); 3].map(|()| 100_000.0 + fine(random));
    let size = [(); 3].map(|()| 1.0 + 64.0 * fine(random));
    let corner = |i: usize| {
        std::array::from_fn(|axis| lo[axis] + if i >> axis & 1 == 1 { size[axis] } else { 0.0 })
    };
    let points: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 2, 4], [6, 4, 2], [1, 3, 5], [7, 5, 3], [0, 1, 2], [4, 5, 6]];
    let length = points[1][0] - points[0][0];
    (TriangleMesh::from_f64(&points, &faces).unwrap(), length)
}

/// Boxes that touch along a face, at places that neither f32 nor a re-centred mesh holds exactly. A
/// turn of a quarter about z has the offset go round, too.
#[test]
fn far_boxes_that_touch_are_reported() {
    let mut random = Random::new(21);
    let mut moved = 0;
    for round in 0..40 {
        let (mesh, length) = rounded_box(&mut random);
        assert!(mesh.is_far());
        moved += usize::from(mesh.rounding > 0.0);
        for way in sharp_ways() {
            let mut world = world_of(&way, std::slice::from_ref(&mesh));
            let turns =
                [(UNTURNED, [length, 0.0, 0.0]), ([0.0, 0.0, 3.0, 3.0], [0.0, length, 0.0])];
            for (q, t) in turns {
                let a = world.insert(Body::at(0, q, [0.0; 3])).unwrap();
                let b = world.insert(Body::at(0, q, t)).unwrap();
                world.cull().unwrap();
                assert_eq!(world.pairs().collect::<Vec<_>>(), [[a, b]], "{round}: {way:?}");
                let apart = t.map(|x| x * 1.001);
                world.set_pose(b, q, apart).unwrap();
                world.cull().unwrap();
                assert_eq!(world.pairs().len(), 0, "{round}: {way:?}, a thousandth apart");
                world.remove(a).unwrap();
                world.remove(b).unwrap();
            }
        }
    }
    assert!(moved > 30, "{moved}");
}

/// Poses in f32 refuse a far shape.
#[test]
fn f32_poses_reject_far_shape() {
    let mesh = tetrahedron([1.0e9, 0.0, 0.0]);
    let far = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
    assert_eq!((far.offset, far.pose_offset), (mesh.offset, mesh.offset));
    let mut bodies = Bodies::default();
    bodies.push(0, true, UNTURNED, [0.0; 3]);
    let mends = |error: CullError| {
        let help = error.help();
        assert!(error.to_string().contains("far from the origin"), "{error}");
        assert!(help.contains("`World`") && help.contains("`Origin::Ball`"), "{help}");
    };
    mends(Culler::new(std::slice::from_ref(&far), &bodies).unwrap_err());
    let ball = ShapeSpec { origin: Origin::Ball, ..ShapeSpec::default() };
    let near = Shape::build(&mesh, &ball).unwrap();
    assert_eq!(near.pose_offset, [0.0; 3]);
    assert!((near.offset[0] - 1.0e9).abs() < 1.0);
    let mut culler = Culler::new(std::slice::from_ref(&near), &bodies).unwrap();
    mends(culler.add_shape(&far).unwrap_err());
    let refused = PairTest::new(DirectionSet::K18).add(&far).unwrap_err();
    assert!(refused.hint.contains("`World`"), "{refused}");
    assert!(PairTest::new(DirectionSet::K18).add(&near).is_ok());
}

/// An object of 1 m some 20 m from its file's origin along all axes: in f32, decimals there are off
/// by more than 2⁻²⁰ of it.
#[test]
fn decimal_meshes_are_told_the_remedy() {
    let mut bodies = Bodies::default();
    bodies.push(0, true, UNTURNED, [0.0; 3]);
    let culler = |at: [f64; 3]| {
        let shape = Shape::build(&tetrahedron(at), &ShapeSpec::default()).unwrap();
        Culler::new(&[shape], &bodies)
    };
    assert!(culler([20.125, 20.25, 20.5]).is_ok(), "all f32");
    assert!(culler([2.1, 2.2, 2.3]).is_ok(), "near");
    let error = culler([20.1, 20.2, 20.3]).unwrap_err();
    assert!(error.to_string().contains("more than 2^-20 of its size"), "{error}");
    let help = error.help();
    for remedy in ["`World`", "near its origin", "`Origin::Ball`"] {
        assert!(help.contains(remedy), "{help}");
    }
    let mut world = world_of(&CullSettings::default(), &[tetrahedron([20.1, 20.2, 20.3])]);
    world.insert(Body::at(0, UNTURNED, [0.0; 3])).unwrap();
    world.insert(Body::at(0, UNTURNED, [0.3, 0.0, 0.0])).unwrap();
    assert_eq!(world.cull().unwrap().sorted().len(), 1);
}

/// The radius scales about the file's own origin, however far that is.
#[test]
fn scaled_far_mesh_keeps_origin() {
    let mesh = tetrahedron([1.0e6 + 0.1234, 0.1, 0.0]);
    let plain = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
    let spec = ShapeSpec { radius: Some(2.0 * plain.ball.radius), ..ShapeSpec::default() };
    let twice = Shape::build(&mesh, &spec).unwrap();
    assert!((twice.scale - 2.0).abs() < 1e-6, "{}", twice.scale);
    for (vertex, point) in twice.vertices.iter().zip(mesh.points()) {
        for i in 0..3 {
            let exact = twice.scale * point[i];
            let found = twice.pose_offset[i] + f64::from(vertex[i]);
            let most = f64::from(twice.rounding) + 1e-9;
            assert!((found - exact).abs() <= most, "{found} {exact}");
        }
    }
    assert!(twice.rounding > 0.0 && twice.rounding < 1e-6);
}

/// The origin follows bodies that go far away and come back, and is no part of a snapshot.
#[test]
fn restored_worlds_round_about_one_origin() {
    let far = 1.0e9 + 0.1;
    let mut world = World::new(shapes()).unwrap();
    let ids = [0.0, 1.0, 2.5].map(|x| world.insert(Body::at(0, UNTURNED, [far + x, 0.1, 0.0])));
    world.cull().unwrap();
    let back = |world: &mut World, share: f64| {
        for (x, id) in [0.0, 1.0, 2.5].into_iter().zip(&ids) {
            let translation = [share * far + x, 0.1, 0.0];
            world.set_pose(*id.as_ref().unwrap(), UNTURNED, translation).unwrap();
        }
        world.cull().unwrap().sorted()
    };
    let saved = world.snapshot();
    let mut other = World::new(shapes()).unwrap();
    other.restore(&saved).unwrap();
    assert_eq!(other.snapshot(), saved);
    for share in [1.0, 1.000_000_000_1, 0.999_999, -1.0] {
        assert_eq!(back(&mut world, share), back(&mut other, share), "{share}");
        assert_eq!(world.snapshot(), other.snapshot(), "{share}");
    }
}
