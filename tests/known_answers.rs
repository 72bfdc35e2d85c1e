//! Shares of pairs that or-DOPs and hulls separate, compared with known answers from integral
//! geometry and from the literature.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its input has failed")]

use std::f64::consts::PI;

use sdop::mesh::ProceduralShape;
use sdop::rounding::pose::{rotate, rotation};
use sdop::settings::{Axes, DirectionSet, Overlap};
use sdop::simd::Tier;
use sdop::volume::{OrDop, Origin, Shape, ShapeSpec};
use sdop_bench::random::Stream;
use sdop_bench::tradeoff::Estimate;

use crate::drawn_pairs::DrawnPairs;

const PAIRS: u32 = 40_000;
const BATCHES: u64 = 8;

fn cuboid([x, y, z]: [f32; 3]) -> Shape {
    let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
    Shape::build(&mesh, &ShapeSpec::default()).unwrap()
}

fn draws(shapes: &[Shape], stretch: f32, pairs: u32) -> Vec<DrawnPairs> {
    (0..BATCHES)
        .map(|batch| DrawnPairs::new(shapes, stretch, pairs / BATCHES as u32, batch))
        .collect()
}

fn ordops(shapes: &[Shape], k: DirectionSet) -> Vec<OrDop> {
    shapes.iter().map(|s| s.ordop_along(Axes::Principal, k)).collect()
}

/// (2V + SM/2π)/(32πR³/3) of a box: its mean width integral is M = π(x + y + z).
fn minkowski([x, y, z]: [f64; 3]) -> f64 {
    let (volume, area) = (x * y * z, 2.0 * (x * y + y * z + z * x));
    let radius = 0.5 * (x * x + y * y + z * z).sqrt();
    (2.0 * volume + area * PI * (x + y + z) / (2.0 * PI)) / (32.0 * PI * radius.powi(3) / 3.0)
}

/// Boxes meet as often as their mean minkowski volume says.
#[test]
fn boxes_match_minkowski_volume() {
    let tier = Tier::detect();
    for (sizes, known) in [([1.0, 1.0, 1.0], 0.505), ([1.0, 1.0, 2.0], 0.390)] {
        let exact = minkowski(sizes);
        assert!((exact - known).abs() < 0.003, "{sizes:?}: {exact}");
        let shapes = [cuboid(sizes.map(|x| x as f32))];
        let draws = draws(&shapes, 1.0, PAIRS);
        let boxes = ordops(&shapes, DirectionSet::K6);
        let hits =
            |drawn: &DrawnPairs, overlap| drawn.ordop_hits(&shapes, &boxes, overlap, tier).len();
        let full = share(&draws, |drawn| hits(drawn, Overlap::Full));
        let hulls = share(&draws, |drawn| drawn.hull_hits(&shapes));
        assert!(full.covers(exact), "{sizes:?}: {full:?} for {exact}");
        assert!(hulls.covers(exact), "{sizes:?}: {hulls:?} for {exact}");
        assert!(full.half_width < 0.01);
        // The estimate is sharp enough to tell the box from its six-axes test.
        let normals = share(&draws, |drawn| hits(drawn, Overlap::TwoSided));
        assert!(!normals.covers(exact));
    }
}

/// Van den Bergen, in Ericson, Real-Time Collision Detection, section 4.4: without the last nine of
/// its fifteen axes the box test finds 6 to 7 % of disjoint pairs colliding. His boxes are random;
/// ours have uniform sizes, and overlapping spheres.
#[test]
fn six_axes_keep_seven_percent() {
    let mut sizes = Stream::new(7, 0);
    let shapes: Vec<Shape> =
        (0..200).map(|_| cuboid([(); 3].map(|()| sizes.between(0.05, 1.0)))).collect();
    let boxes = ordops(&shapes, DirectionSet::K6);
    let tier = Tier::detect();
    let kept: Vec<f64> = draws(&shapes, 1.0, 2 * PAIRS)
        .iter()
        .map(|drawn| {
            let hits = |overlap| drawn.ordop_hits(&shapes, &boxes, overlap, tier).len() as f64;
            let (normals, full) = (hits(Overlap::TwoSided), hits(Overlap::Full));
            (normals - full) / (drawn.pairs().len() as f64 - full)
        })
        .collect();
    let kept = Estimate::of(&kept);
    let [lo, hi] = [kept.mean - kept.half_width, kept.mean + kept.half_width];
    assert!(lo <= 0.07 && hi >= 0.06, "{kept:?}");
    assert!(kept.half_width < 0.005, "{kept:?}");
}

/// Corners of an 18-DOP stick out of the bounding ball where the mesh nearly fills it. Of bodies
/// that don't, or-DOPs practically never meet while the spheres don't; round ones are the exception
/// that shows the count can be large.
#[test]
fn ordops_rarely_meet_outside_spheres() {
    for (shape, limit) in [("cube", 3e-4), ("box 1:1:2", 3e-4), ("l-shape", 3e-4), ("plate", 3e-4)]
    {
        let share = outside(shape);
        assert!(share <= limit, "{shape}: {share}");
    }
    let round = outside("icosphere");
    assert!((0.25..0.45).contains(&round), "{round}");
}

/// 18-DOP hits outside of the spheres' hits, per hit inside. A ball's 18-DOP reaches 1.23 radii.
fn outside(name: &str) -> f64 {
    let form = match name {
        "cube" => ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 },
        "box 1:1:2" => ProceduralShape::Box { x: 1.0, y: 1.0, z: 2.0 },
        name => ProceduralShape::default_of(name).unwrap(),
    };
    let spec = ShapeSpec { origin: Origin::Ball, ..ShapeSpec::default() };
    let shape = [Shape::build(&form.build().unwrap(), &spec).unwrap()];
    let drawn = DrawnPairs::new(&shape, 1.3, 8 * PAIRS, BATCHES);
    let ordop = ordops(&shape, DirectionSet::K18);
    let found = drawn.ordop_hits(&shape, &ordop, Overlap::Full, Tier::detect());
    let centre = |body: u32| {
        let body = body as usize;
        let offset = rotate(&rotation(drawn.bodies.rotation[body]), shape[0].ball.centre);
        [0, 1, 2].map(|axis| f64::from(drawn.bodies.translation[body][axis]) + offset[axis])
    };
    let reach = 2.0 * f64::from(shape[0].ball.radius);
    let is_far = |&[i, j]: &[u32; 2]| {
        let squared: f64 = centre(i).iter().zip(centre(j)).map(|(a, b)| (a - b).powi(2)).sum();
        squared > reach * reach
    };
    let beyond = found.iter().filter(is_far).count();
    beyond as f64 / (found.len() - beyond) as f64
}

/// The share of hits over equally large draws.
fn share(drawn: &[DrawnPairs], hits: impl Fn(&DrawnPairs) -> usize) -> Estimate {
    let share = |one: &DrawnPairs| hits(one) as f64 / one.pairs().len() as f64;
    Estimate::of(&drawn.iter().map(share).collect::<Vec<_>>())
}
