//! Scenes built from the grid's own arithmetic: extents and centres on the borders between its cells, one unit in the last
//! place of f64 to either side.
//!
//! A random coordinate comes within such a unit of a border once in 2⁵⁰ draws, so random scenes can't tell a cell that is
//! found by rounding half to even from one that is counted by a division rounding half away from zero. Here the lowest
//! centre, which is the grid's origin, is a number so small that moving it by its own last place moves a quotient by about
//! one of its own.

use sdop::bodies::Bodies;
use sdop::mesh::TriangleMesh;
use sdop::settings::{Finder, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Origin, Shape, ShapeSpec};

use super::scenes::Scene;
use super::{compare, run, settings};

const NO_TURN: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A thin body about its own origin, whose ball reaches as far as its ends.
fn bar(reach: f32) -> Shape {
    let half = reach / 2.0;
    let vertices = [
        [reach, 0.0, 0.0],
        [-reach, 0.0, 0.0],
        [0.0, half, 0.0],
        [0.0, 0.0, half],
    ];
    let faces = vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
    let mesh = TriangleMesh::new("bar", vertices.map(glam::Vec3::from).to_vec(), faces).unwrap();
    let spec = ShapeSpec {
        origin: Origin::File,
        ..ShapeSpec::default()
    };
    Shape::build(&mesh, &spec).unwrap()
}

/// A bar for each reach; of the bodies, `(shape, moves, centre)`.
fn scene(reaches: &[f32], bodies: impl IntoIterator<Item = (u32, bool, [f32; 3])>) -> Scene {
    let mut columns = Bodies::default();
    for (shape, moves, centre) in bodies {
        columns.push(shape, moves, NO_TURN, centre);
    }
    Scene {
        name: "borders",
        shapes: reaches.iter().map(|&reach| bar(reach)).collect(),
        bodies: columns,
        step: 0.0,
    }
}

/// The sorted pairs of one frame.
fn pairs(scene: &Scene, strategy: Strategy, finder: Finder, tier: Tier) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    run(scene, &settings(strategy, finder), tier, 1, 1, |culler| {
        found = culler.pairs().sorted();
    });
    found
}

/// Every finder in every tier and strategy against all pairs.
fn judge(scene: &Scene, strategies: &[Strategy], what: &str) {
    for &strategy in strategies {
        let wanted = [pairs(scene, strategy, Finder::AllPairs, Tier::SCALAR)];
        for &finder in Finder::ALL {
            for tier in Tier::available() {
                let found = [pairs(scene, strategy, finder, tier)];
                compare(
                    &found,
                    &wanted,
                    &format!("{what}, {strategy}, {finder}, {tier}"),
                );
            }
        }
    }
}

/// The extent between these two, 10.494775749…, lies one unit in the last place of f64 below 5½ cells of the bars below:
/// the division gave six cells, 0 to 5, and the farthest bar fell in number 6.
const ENDS: [f32; 2] = [2.255_456_088_562_368_7e-8, 10.494_775_772_094_727];
const REACH: f32 = 0.954_054_474_830_627_4;

fn between(n: usize) -> impl Iterator<Item = f32> {
    (1..=n).map(move |i| ENDS[1] * i as f32 / (n + 1) as f32)
}

#[test]
fn two_bars_whose_extent_is_just_below_a_border_have_their_cells() {
    let bars = ENDS.map(|x| (0, true, [x, 0.0, 0.0]));
    judge(&scene(&[REACH], bars), Strategy::ALL, "two bars");
}

#[test]
fn a_moving_bar_meets_the_farthest_static_one() {
    let fixed = ENDS.into_iter().chain(between(100));
    let bars = fixed.map(|x| (0, false, [x, 0.0, 0.0]));
    let moving = (0, true, [11.494_775_772_094_727, 0.0, 0.0]);
    let scene = scene(&[REACH], bars.chain([moving]));
    let wanted = pairs(&scene, Strategy::Sphere, Finder::AllPairs, Tier::SCALAR);
    assert!(wanted.contains(&[1, 102]));
    judge(&scene, Strategy::ALL, "static bars");
}

#[test]
fn a_giant_bar_meets_the_farthest_small_one() {
    // In three dimensions a cell beyond the box is in its table still: nothing panics, and the giant doesn't look there.
    let small = ENDS.into_iter().chain(between(1998)).zip(0..);
    let bars = small.map(|(x, i)| (0, true, [x, 2.0 * (i / 2 % 4) as f32, (i / 8 % 5) as f32]));
    let giant = (1, true, [ENDS[1] + 8.0 + 0.95, 0.0, 0.0]);
    let scene = scene(&[REACH, 8.0], bars.chain([giant]));
    let wanted = pairs(&scene, Strategy::Sphere, Finder::AllPairs, Tier::SCALAR);
    assert!(wanted.contains(&[1, 2000]));
    judge(&scene, &[Strategy::Sphere], "a giant bar");
}
