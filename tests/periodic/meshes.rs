//! Periodic meshes against exact meshes: no pair of which an image meets is missed, and each is
//! reported in one image.

use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{Culler, ProceduralShape, Shape};
use sdop_reference::WidePose;
use sdop_reference::exact::period::separation;

use super::*;

/// A step of all translations, so that a body moved by whole periods has an exact f64 translation.
const STEP: f64 = 1.0 / (1 << 20) as f64;

/// Meshes of all kinds, one of them away from its origin.
fn shapes(directions: DirectionSet) -> Vec<Shape> {
    let forms = [
        ProceduralShape::Box { x: 1.0, y: 0.5, z: 0.75 },
        ProceduralShape::Icosphere { radius: 0.5, subdivisions: 1 },
        ProceduralShape::LShape { x: 1.0, y: 0.75, arm: 0.25, thickness: 0.5 },
    ];
    let spec = ShapeSpec { directions, ..ShapeSpec::default() };
    let away = |shape: usize| forms[shape].build().unwrap();
    let mut meshes: Vec<_> = (0..3).map(away).collect();
    let moved = |v: &[f32; 3]| [v[0] + 2.5, v[1] - 1.0, v[2]];
    let far: Vec<_> = meshes[0].vertices.iter().map(moved).collect();
    meshes.push(sdop::TriangleMesh::from_f32(&far, &meshes[0].triangles).unwrap());
    meshes.iter().map(|mesh| Shape::build(mesh, &spec).unwrap()).collect()
}

/// The mesh of a shape as the reference has it.
fn reference(shape: &Shape) -> sdop_reference::Shape {
    sdop_reference::Shape::of_mesh(shape.vertices.clone(), shape.triangles.clone()).unwrap()
}

/// Whether two bodies meet, the second moved by whole periods.
fn meet(
    meshes: &[sdop_reference::Shape],
    [a, b]: [&Body; 2],
    periods: [Option<f64>; 3],
    image: [i32; 3],
) -> bool {
    let image = image.map(i64::from);
    let apart = separation(a.translation, b.translation, image, periods).unwrap();
    let pose = |body: &Body, at| WidePose::new(body.rotation.map(f64::from), at).unwrap();
    let of = |body: &Body| &meshes[body.shape as usize];
    sdop_reference::wide::meet((of(a), &pose(a, [0.0; 3])), (of(b), &pose(b, apart))).meets
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
        ..Body::at(random.below(4) as u32, [(); 4].map(|()| random.within(1.0)), translation)
    }
}

/// Where the middle of a body's ball is, to a few places.
fn middle(shapes: &[Shape], body: &Body) -> [f64; 3] {
    let [x, y, z, w] = body.rotation.map(f64::from);
    let centre = shapes[body.shape as usize].ball.centre.map(f64::from);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        let at = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
        [at(1, 2), at(2, 0), at(0, 1)]
    };
    let once = cross([x, y, z], centre);
    let twice = cross([x, y, z], once);
    let square = x * x + y * y + z * z + w * w;
    let turned = |axis: usize| centre[axis] + 2.0 * (w * once[axis] + twice[axis]) / square;
    [0, 1, 2].map(|axis| turned(axis) + body.translation[axis])
}

/// The images of the second body that are near enough to meet the first: radii are below 0.7.
fn near_images([a, b]: [[f64; 3]; 2], periods: [Option<f64>; 3]) -> Vec<[i32; 3]> {
    let nearest = |axis: usize| match periods[axis] {
        Some(period) => ((a[axis] - b[axis]) / period).round() as i32,
        None => 0,
    };
    let along = |axis: usize| match periods[axis] {
        Some(_) => nearest(axis) - 1..=nearest(axis) + 1,
        None => 0..=0,
    };
    let is_near = |image: &[i32; 3]| {
        (0..3).all(|axis| {
            let way = f64::from(image[axis]) * periods[axis].unwrap_or(0.0);
            (b[axis] + way - a[axis]).abs() <= 1.5
        })
    };
    let all = along(0).flat_map(|x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])));
    all.filter(is_near).collect()
}

#[test]
fn no_meeting_image_is_missed() {
    let lengths = [3.0, 3.5, 2.75 + STEP];
    let mut random = Random::new(6);
    let strategies = forms::strategies_that_report_all();
    let (mut met, mut reported) = (0, 0);
    for (number, periods) in subsets(lengths).enumerate() {
        let directions = [DirectionSet::K18, DirectionSet::K6][number % 2];
        let shapes = shapes(directions);
        let meshes: Vec<_> = shapes.iter().map(reference).collect();
        for &strategy in &strategies {
            let builder = Culler::builder().strategy(strategy).k(directions);
            let mut world = PeriodicWorld::with(shapes.clone(), &builder, periods).unwrap();
            let body = |random: &mut Random| random_body(lengths, periods, random);
            let mut ids: Vec<BodyId> =
                (0..14).map(|_| world.insert(body(&mut random)).unwrap()).collect();
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
                        let middles = [one, two].map(|body| middle(&shapes, body));
                        for image in near_images(middles, periods) {
                            if meet(&meshes, [one, two], periods, image) {
                                met += 1;
                                let pair = PeriodicPair { bodies: [a, b], image };
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
    assert!(met > 200 && reported < 8 * met, "{met} of {reported}");
}
