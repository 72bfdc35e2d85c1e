//! Margins: bodies that touch to the ulp once they are grown, along faces, edges and corners.

use sdop::culler::Culler;
use sdop::mesh::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Strategy};
use sdop::volume::{Axes, DirectionSet, Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};
use sdop_judge::configuration::{variants, ways};

/// A cube of edge 2.
fn cube(directions: DirectionSet, axes: Axes) -> Shape {
    sized(directions, axes, 2.0)
}

fn sized(directions: DirectionSet, axes: Axes, edge: f32) -> Shape {
    let [x, y, z] = [edge; 3];
    let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
    let spec = ShapeSpec { directions, axes, ..ShapeSpec::default() };
    Shape::build(&mesh, &spec).unwrap()
}

/// Two bodies in a world that culls in this way; what a strategy looks at or spends is given.
fn two(way: &CullSettings, shape: &Shape, bodies: [Body; 2]) -> (World, [BodyId; 2]) {
    let culler = Culler::builder().settings(way).budget(Budget::Tests(1));
    let mut world = World::with(vec![shape.clone()], &culler).unwrap();
    let ids = bodies.map(|body| world.insert(body).unwrap());
    world.set_interest(&ids).unwrap();
    (world, ids)
}

fn is_reported(world: &mut World) -> bool {
    world.cull().unwrap();
    world.pairs().len() == 1
}

/// The largest δ of whole 2⁻²², so that 2 + δ is an f32, with n·δ² ≤ reach²: cubes that are δ apart
/// in n coordinates are no farther apart than `reach`, decided in integers.
fn farthest(n: u64, reach: f64) -> f64 {
    let step = f64::from(1 << 22);
    let unit = 2_f64.powi(26);
    // Margins here are whole multiples of 2⁻²⁶, so their sum's square is an integer of 2⁻⁵².
    let reach = (reach * unit) as u128;
    assert!(reach < 1 << 60);
    let mut steps = (f64::sqrt(1.0 / n as f64) * reach as f64 / unit * step) as u128 + 2;
    while u128::from(n) * (steps << 4) * (steps << 4) > reach * reach {
        steps -= 1;
    }
    steps as f64 / step
}

/// Just below each is a class of margins, to which the culler rounds up: here by one ulp.
const CLASSES: [f32; 3] = [0.5, 0.171875, 1.75];

/// Whether a direction set has a slab across the contact in `n` coordinates.
fn sees(k: DirectionSet, n: usize) -> bool {
    let has = |c: &[i8; 3]| c.iter().filter(|x| **x != 0).count() == n;
    k.coefficients().iter().any(has)
}

/// Bodies that touch to the ulp once grown are reported.
#[test]
fn grown_bodies_touch_to_the_ulp() {
    let mut too_far = 0;
    for (k, axes) in variants() {
        let shape = cube(k, axes);
        for way in ways(k, axes) {
            if way.strategy == Strategy::None {
                continue;
            }
            let (mut world, [a, b]) = two(&way, &shape, [Body::default(); 2]);
            for (margin, other) in [(0, 0), (1, 2), (2, 0), (0, 1)] {
                let margins = [margin, other].map(|class| CLASSES[class].next_down());
                let reach = margins.iter().map(|&m| f64::from(m)).sum();
                for n in 1..=3 {
                    let gap = farthest(n as u64, reach) as f32;
                    let mut reported = |gap: f32| {
                        let t = |i: usize| if i < n { f64::from(2.0 + gap) } else { 0.25 };
                        for (id, translation, margin) in
                            [(a, [0.0; 3], margins[0]), (b, [t(0), -t(1), t(2)], margins[1])]
                        {
                            let body = Body { margin, translation, ..Body::default() };
                            world.set(id, body).unwrap();
                        }
                        is_reported(&mut world)
                    };
                    let what = || format!("{way:?}, {margins:?}, {n} coordinates");
                    assert!(reported(gap), "{}", what());
                    // Half a thousandth beyond, a slab across the contact decides.
                    let told = way.strategy == Strategy::OrDop && sees(k, n);
                    if told {
                        assert!(!reported(gap * 1.0005), "{}", what());
                        too_far += 1;
                    }
                }
            }
        }
    }
    assert!(too_far > 100);
}

/// Cubes that touch along a face, an edge or a corner, where f32 about the origin moves each of
/// them away from the other by all but its last half step in every coordinate: 2²⁵ away, 2 each. A
/// giant at the origin is wide enough that all are one region.
#[test]
fn rounded_touching_bodies_are_reported() {
    let first = 2_f64.powi(25) + 2.0;
    assert_eq!([first, first + 2.0].map(|x| x as f32 - first as f32), [0.0, 4.0]);
    for (k, axes) in variants() {
        let shape = cube(k, axes);
        for way in ways(k, axes) {
            if way.strategy == Strategy::None {
                continue;
            }
            let (mut world, [a, b]) = two(&way, &shape, [Body::default(); 2]);
            let giant = world.add_shape(sized(k, axes, 32_768.0)).unwrap();
            let giant = Body::at(giant, Body::default().rotation, [0.0; 3]);
            world.insert(giant).unwrap();
            for margins in [[0.0; 2], [0.0, 0.25], [17.0, 46.0_f32.next_down()]] {
                let reach: f64 = margins.iter().map(|&m| f64::from(m)).sum();
                for n in 1..=3 {
                    for sign in [1.0, -1.0] {
                        let apart = 2.0 + farthest(n as u64, reach);
                        let place = |i: usize, by: f64| match i {
                            _ if i >= n => 0.0,
                            1 => -(first + by),
                            _ => sign * (first + by),
                        };
                        for (id, by, margin) in [(a, 0.0, margins[0]), (b, apart, margins[1])] {
                            let body = Body {
                                margin,
                                translation: std::array::from_fn(|i| place(i, by)),
                                ..Body::default()
                            };
                            world.set(id, body).unwrap();
                        }
                        world.cull().unwrap();
                        let reported = world.pairs().any(|pair| pair == [a, b]);
                        assert!(reported, "{way:?}, {margins:?}, {n} coordinates");
                    }
                }
            }
        }
    }
}

/// Bodies at rest keep the margin that they have, while another body has had so many that unused
/// ones are removed.
#[test]
fn resting_bodies_keep_their_margins() {
    let shape = cube(DirectionSet::K6, Axes::Model);
    let spheres = Culler::builder().strategy(Strategy::Sphere);
    let mut world = World::with(vec![shape], &spheres).unwrap();
    let at = |x: f64, margin| Body { margin, translation: [x; 3], ..Body::default() };
    let still: Vec<BodyId> = (0..40)
        .map(|number| world.insert(at(100.0 * f64::from(number), 1.0).fixed()).unwrap())
        .collect();
    let mover = world.insert(at(50.0, 0.0)).unwrap(); // between two others
    world.cull().unwrap();
    let apart = 2.5; // then corners are √3/2 apart, and no origin changes
    for number in 0..200 {
        let margin = 1.0e-9 * 1.1_f32.powi(number);
        let other = number as usize % still.len();
        let near = world.body(still[other]).unwrap().translation[0] + apart;
        for (place, pairs) in [(50.0, vec![]), (near, vec![[still[other], mover]])] {
            world.set(mover, at(place, margin)).unwrap();
            world.cull().unwrap();
            assert!(world.pairs().eq(pairs), "margin {margin} at {place}");
        }
    }
    assert!(world.counters().rest.kept > 300 * 40, "few bodies change");
}
