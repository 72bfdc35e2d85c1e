//! Periodic meshes against exact meshes: no pair of which an image meets is missed, and each is
//! reported in one image.

use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{Culler, ProceduralShape, Shape, Strategy};
use sdop_reference::WidePose;

use super::*;

/// A step of all translations, so that a body moved by whole periods has an exact f64 translation.
const STEP: f64 = 1.0 / (1 << 20) as f64;

/// Meshes of all kinds, one of them away from its origin.
fn shapes(directions: DirectionSet) -> Vec<Shape> {
    let forms = [
        ProceduralShape::Box {
            x: 1.0,
            y: 0.5,
            z: 0.75,
        },
        ProceduralShape::Icosphere {
            radius: 0.5,
            subdivisions: 1,
        },
        ProceduralShape::LShape {
            x: 1.0,
            y: 0.75,
            arm: 0.25,
            thickness: 0.5,
        },
    ];
    let spec = ShapeSpec {
        directions,
        ..ShapeSpec::default()
    };
    let away = |shape: usize| forms[shape].build().unwrap();
    let mut meshes: Vec<_> = (0..3).map(away).collect();
    let moved = |v: &[f32; 3]| [v[0] + 2.5, v[1] - 1.0, v[2]];
    let far: Vec<_> = meshes[0].vertices.iter().map(moved).collect();
    meshes.push(sdop::TriangleMesh::from_f32(&far, &meshes[0].triangles).unwrap());
    meshes
        .iter()
        .map(|mesh| Shape::build(mesh, &spec).unwrap())
        .collect()
}

/// The mesh of a shape as the reference has it; of its volumes nothing is asked.
fn reference(shape: &Shape) -> sdop_reference::Shape {
    let ball = sdop_reference::Ball {
        centre: [0.0; 3],
        radius: 1.0,
    };
    let slabs = sdop_reference::Slabs {
        directions: sdop_reference::DirectionSet::K6,
        basis: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        lo: vec![-1.0; 3],
        hi: vec![1.0; 3],
    };
    let (vertices, triangles) = (shape.vertices.clone(), shape.triangles.clone());
    sdop_reference::Shape::new(ball, slabs, vertices, triangles).unwrap()
}

/// Whether two bodies meet, the second moved by whole periods.
fn meet(
    meshes: &[sdop_reference::Shape],
    [a, b]: [&Body; 2],
    periods: [Option<f64>; 3],
    image: [i32; 3],
) -> bool {
    let way = [0, 1, 2].map(|axis| f64::from(image[axis]) * periods[axis].unwrap_or(0.0));
    let at = [0, 1, 2].map(|axis| b.translation[axis] + way[axis]);
    for axis in 0..3 {
        assert_eq!(at[axis] - way[axis], b.translation[axis], "exact");
    }
    let pose = |body: &Body, at| WidePose::new(body.rotation.map(f64::from), at).unwrap();
    let of = |body: &Body| &meshes[body.shape as usize];
    sdop_reference::wide::meet((of(a), &pose(a, a.translation)), (of(b), &pose(b, at))).meets
}

fn random_body(lengths: [f64; 3], periods: [Option<f64>; 3], random: &mut Random) -> Body {
    let translation = [0, 1, 2].map(|axis| {
        let steps = (unit(random) * lengths[axis] / STEP).round() * STEP;
        let periods_away = random.below(9) as f64 - 4.0;
        steps + periods_away * periods[axis].unwrap_or(0.0)
    });
    Body {
        motion: motion(random),
        groups: groups(random),
        ..Body::at(
            random.below(4) as u32,
            [(); 4].map(|()| random.within(1.0)),
            translation,
        )
    }
}

/// The image in which the place of a body is nearest to that of another is one of these, as both
/// are at most four periods away.
fn images(periods: [Option<f64>; 3]) -> Vec<[i32; 3]> {
    let along = |axis: usize| {
        if periods[axis].is_some() {
            -10..=10
        } else {
            0..=0
        }
    };
    let all = along(0).flat_map(|x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])));
    all.collect()
}

/// Whether the origins of two bodies are near enough for their meshes to meet: 4 is more than the
/// distance of any vertex from its origin.
fn are_near([a, b]: [&Body; 2], periods: [Option<f64>; 3], image: [i32; 3]) -> bool {
    (0..3).all(|axis| {
        let way = f64::from(image[axis]) * periods[axis].unwrap_or(0.0);
        (b.translation[axis] + way - a.translation[axis]).abs() <= 8.0
    })
}

#[test]
fn no_meeting_image_is_missed() {
    let lengths = [5.0, 6.5, 4.25 + STEP];
    let mut random = Random(6);
    let strategies = [
        Strategy::SDopSequential,
        Strategy::OrDop,
        Strategy::Aabb,
        Strategy::Sphere,
    ];
    let (mut met, mut reported) = (0, 0);
    for (number, periods) in subsets(lengths).enumerate() {
        let directions = [DirectionSet::K18, DirectionSet::K6][number % 2];
        let shapes = shapes(directions);
        let meshes: Vec<_> = shapes.iter().map(reference).collect();
        let images = images(periods);
        for strategy in strategies {
            let builder = Culler::builder().strategy(strategy).k(directions);
            let mut world = PeriodicWorld::with(shapes.clone(), &builder, periods).unwrap();
            let body = |random: &mut Random| random_body(lengths, periods, random);
            let mut ids: Vec<BodyId> = (0..14)
                .map(|_| world.insert(body(&mut random)).unwrap())
                .collect();
            for round in 0..4 {
                let found = world.cull().unwrap().to_vec();
                let mut bodies: Vec<[BodyId; 2]> = found.iter().map(|pair| pair.bodies).collect();
                reported += bodies.len();
                bodies.dedup();
                assert_eq!(bodies.len(), found.len(), "each pair once");
                for (number, &a) in ids.iter().enumerate() {
                    for &b in &ids[..number] {
                        let [a, b] = [a.min(b), a.max(b)];
                        let pair = [world.body(a).unwrap(), world.body(b).unwrap()];
                        let [one, two] = [&pair[0], &pair[1]];
                        let are_fixed = !one.motion.is_dynamic() && !two.motion.is_dynamic();
                        if are_fixed || !one.groups.collide(two.groups) {
                            continue;
                        }
                        let near = images
                            .iter()
                            .filter(|image| are_near([one, two], periods, **image));
                        for &image in near {
                            if meet(&meshes, [one, two], periods, image) {
                                met += 1;
                                let pair = PeriodicPair {
                                    bodies: [a, b],
                                    image,
                                };
                                assert!(
                                    found.contains(&pair),
                                    "{periods:?} {strategy:?} {round} {pair:?}"
                                );
                            }
                        }
                    }
                }
                for _ in 0..4 {
                    let at = random.below(ids.len());
                    if random.below(3) == 0 {
                        world.remove(ids.swap_remove(at)).unwrap();
                        ids.push(world.insert(body(&mut random)).unwrap());
                    } else {
                        world.set(ids[at], body(&mut random)).unwrap();
                    }
                }
            }
        }
    }
    assert!(met > 500 && reported < 6 * met, "{met} of {reported}");
}
