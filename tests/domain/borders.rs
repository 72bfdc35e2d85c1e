//! Hard cases at borders between ranks, compared with the exact reference and with one process.

use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};
use sdop_bench::tradeoff::truth::ExactJudge;
use sdop_judge::configuration::cullers::settings;

use crate::domain::{pairs_alone, pairs_on, support};

const NO_TURN: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

fn shape(name: &str, radius: f32) -> Shape {
    let mesh = ProceduralShape::default_of(name).unwrap().build().unwrap();
    let spec = ShapeSpec {
        origin: Origin::Ball,
        radius: Some(radius),
        directions: DirectionSet::K18,
        axes: Axes::Model,
    };
    Shape::build(&mesh, &spec).unwrap()
}

/// Bodies of shape 0 unless noted, all moving.
fn bodies(of: impl IntoIterator<Item = (u32, [f32; 3])>) -> Bodies {
    let mut columns = Bodies::default();
    for (shape, at) in of {
        columns.push(shape, true, NO_TURN, at);
    }
    columns
}

/// Every strategy and finder on every number of ranks reports what one process does, once, and
/// nothing that meets is missing.
fn judge(what: &str, shapes: &[Shape], frames: &[Bodies]) {
    let judge = ExactJudge::new(shapes).unwrap();
    let truth: Vec<_> = frames.iter().map(|poses| judge.meetings(poses, None).unwrap()).collect();
    // Every strategy and finder on eight ranks, and each on one more number of them in turn.
    let mut others = [2, 13, 3, 1].into_iter().cycle();
    for &strategy in Strategy::ALL.iter().filter(|s| s.scheme().culls() && !s.scheme().has_budget())
    {
        for &finder in Finder::ALL {
            let base = CullSettings { pairs: finder, ..CullSettings::default() };
            let settings = settings(strategy, &base, frames[0].len());
            let alone = pairs_alone(shapes, frames, &settings);
            for ranks in [8].into_iter().chain(others.next()) {
                let shared = pairs_on(ranks, shapes, frames, &settings);
                assert_eq!(shared, alone, "{what}: {strategy} over {finder} on {ranks} ranks");
                for (shared, truth) in shared.iter().zip(&truth) {
                    let missed = truth.iter().find(|pair| shared.binary_search(pair).is_err());
                    assert_eq!(missed, None, "{what}: {strategy} over {finder} on {ranks} ranks");
                }
            }
        }
    }
}

/// A row of balls, each touching the next to the last bit: wherever the plane is, a pair touches
/// across it.
#[test]
fn touching_across_a_cut() {
    let ball = shape("icosphere", 1.0);
    let (step, n) = (2.0 * ball.ball.radius, 24);
    for axis in 0..3 {
        let at = |i: i32| std::array::from_fn(|k| if k == axis { step * i as f32 } else { 0.0 });
        judge("touching", std::slice::from_ref(&ball), &[bodies((0..n).map(|i| (0, at(i))))]);
    }
}

/// Eight boxes about one point, and eight more around each of their far corners: planes meet where
/// boxes do.
#[test]
fn at_a_corner_of_eight() {
    let half = 0.5_f32;
    let cube = shape("box", libm::sqrtf(3.0) * half);
    let lattice =
        (0..64).map(|i| (0, [i % 4, i / 4 % 4, i / 16].map(|x| (2.0 * x as f32 - 3.0) * half)));
    judge("corners", &[cube], &[bodies(lattice)]);
}

/// One body over all domains, whose ball and box reach every other, and another that just reaches
/// some.
#[test]
fn a_giant_over_all_domains() {
    let shapes = [shape("icosphere", 0.5), shape("l-shape", 40.0), shape("box", 9.0)];
    let small = support::random_bodies(3, 120, 40.0, 1);
    let small = small.translation.into_iter().map(|at| (0, at));
    let giants = [(1, [20.0, 20.0, 20.0]), (2, [3.0, 20.0, 20.0]), (2, [37.0, 20.0, 20.0])];
    let first = bodies(small.clone().chain(giants));
    let last = bodies(giants.into_iter().chain(small));
    judge("the giant has the highest number", &shapes, &[first]);
    judge("the giant has the lowest number", &shapes, &[last]);
}

/// All centres in one point: one rank owns all, the others nothing. And fewer bodies than ranks.
#[test]
fn empty_ranks_are_fine() {
    let shapes = [shape("box", 1.0), shape("icosphere", 0.25)];
    let one_point = (0..20).map(|i| (i % 2, [7.0, -3.0, 0.5]));
    judge("one point", &shapes, &[bodies(one_point)]);
    let on_a_plane =
        (0..30).map(|i| (i % 2, [if i < 20 { 1.0 } else { 2.0 }, 0.0, i as f32 * 0.1]));
    judge("equal coordinates at the cut", &shapes, &[bodies(on_a_plane)]);
    judge("three bodies", &shapes, &[bodies([(0, [0.0; 3]), (0, [0.5; 3]), (1, [9.0; 3])])]);
    judge("one body", &shapes, &[bodies([(0, [0.0; 3])])]);
}

/// Bodies that jump to the far end, all to one place, and back: owners change, domains empty and
/// fill.
#[test]
fn teleports() {
    let shapes = support::shapes(DirectionSet::K18, Axes::Principal);
    let start = support::random_bodies(11, 150, 9.0, shapes.len());
    let moved = |to: &dyn Fn(usize, [f32; 3]) -> [f32; 3]| {
        let mut poses = start.clone();
        for body in (0..poses.len()).filter(|&body| start.dynamic[body]) {
            poses.translation[body] = to(body, start.translation[body]);
        }
        poses
    };
    let frames = [
        start.clone(),
        moved(&|body, t| if body % 5 == 0 { t.map(|x| 9.0 - x) } else { t }),
        moved(&|_, [x, y, z]| [x + 1.0e6, y, z]),
        moved(&|_, _| [4.0, 4.0, 4.0]),
        moved(&|body, [x, y, z]| [x, y + 1.0e7 * (body % 3) as f32, z]),
        start.clone(),
    ];
    judge("teleports", &shapes, &frames);
}

/// Steps far below and just above the skin: owners stay for some frames, and ghosts come into reach
/// meanwhile.
#[test]
fn slow_drift() {
    let shapes = [shape("box", 1.0), shape("icosphere", 0.5)];
    let start = support::random_bodies(5, 200, 9.0, shapes.len());
    let frame = |n: u32| {
        let mut poses = start.clone();
        for (body, t) in poses.translation.iter_mut().enumerate() {
            let way = [body % 3, body % 5, body % 7].map(|x| x as f32 - 2.0);
            if start.dynamic[body] {
                *t = std::array::from_fn(|axis| t[axis] + 0.013 * n as f32 * way[axis]);
            }
        }
        poses
    };
    judge("drift", &shapes, &(0..12).map(frame).collect::<Vec<_>>());
}

/// Many near-touching pairs at distances around 2R, over the border or not: what a reach a little
/// small would lose.
#[test]
fn near_touching_pairs_on_either_side() {
    let ball = shape("icosphere", 1.0);
    let reach = 2.0 * ball.ball.radius;
    // Pairs along x, at the distance that is still reported and just above: all at the same x, so
    // that the cut is between.
    let pair = |i: usize| {
        let apart = f32::from_bits(reach.to_bits() + (i % 12) as u32);
        let (y, z) = ((i % 8) as f32 * 3.0, (i / 8) as f32 * 3.0);
        [(0, [0.0, y, z]), (0, [apart, y, z])]
    };
    let all: Vec<_> = (0..96).flat_map(pair).collect();
    // A crowd on either side keeps the plane between 0 and 2.
    let crowd =
        (0..200).map(|i| (0, [if i % 2 == 0 { -90.0 } else { 90.0 }, 0.3 * i as f32, 40.0]));
    judge("near-touching", &[ball], &[bodies(all.into_iter().chain(crowd))]);
}
/// Pairs that stand as far apart as the skin lets them be forgotten, and then come to touch, each
/// by a little less than a skin: the ghosts found before must have been those that are needed now.
#[test]
fn pairs_approach_by_a_skin() {
    let ball = shape("icosphere", 1.0);
    let (reach, step) = (ball.ball.radius, 0.4999 * ball.ball.radius);
    let frame = |apart: f32| {
        // The right one has the higher number, then the lower; a crowd on either side keeps the
        // first plane on the right ones.
        let pair = |i: usize| {
            let (y, z) = ((i % 8) as f32 * 5.0, (i / 8) as f32 * 5.0);
            let (left, right) = ((0, [-reach - apart, y, z]), (0, [reach + apart, y, z]));
            if i.is_multiple_of(2) { [left, right] } else { [right, left] }
        };
        let crowd =
            |i: usize| (0, [if i.is_multiple_of(2) { -90.0 } else { 90.0 }, 0.3 * i as f32, 40.0]);
        bodies((0..24).flat_map(pair).chain((0..200).map(crowd)))
    };
    judge("a skin each", std::slice::from_ref(&ball), &[frame(step), frame(0.0)]);
}
