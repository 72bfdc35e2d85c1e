//! The arithmetic that the searches attack is the culler's: supports equal to the bit, decisions
//! equal on pairs near contact, with denormals kept and flushed.

use glam::Vec3;
use sdop::mesh::TriangleMesh;
use sdop::overlap::ordop::edges;
use sdop::overlap::ordop::slabs::LaneSlabs;
use sdop::overlap::ordop::support::support;
use sdop::overlap::ordop::table::members_of;
use sdop::overlap::ordop::{OrDopColumns, SlabTables};
use sdop::pairs::PairList;
use sdop::rounding::pose::{rotate, rotation, world_axes};
use sdop::settings::Overlap;
use sdop::simd::{Kernel, Lanes, ROW, Tier, dispatch};
use sdop::update::RowsByNumber;
use sdop::update::row::{O, Q, S, SHAPE, T};
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

use super::climb::Random;
use super::limit::limit;
use super::machine::F;
use super::ordop::{self, Axis, Frames, Row, Table};

const SETS: [(usize, DirectionSet); 4] = [
    (6, DirectionSet::K6),
    (14, DirectionSet::K14),
    (18, DirectionSet::K18),
    (26, DirectionSet::K26),
];

/// Whether the culler's support equals `expected`: neither is greater.
struct Equals<'a> {
    k: usize,
    ends: &'a [[f32; 2]; 13],
    e: [f32; 3],
    expected: f32,
}

impl Kernel for Equals<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> bool {
        let e = self.e.map(|x| l.splat(x));
        let ends = self.ends.map(|ends| ends.map(|end| l.splat(end)));
        let ends = LaneSlabs { ends };
        let found = match self.k {
            6 => support::<L, 6>(l, &ends, e),
            14 => support::<L, 14>(l, &ends, e),
            18 => support::<L, 18>(l, &ends, e),
            _ => support::<L, 26>(l, &ends, e),
        };
        let expected = l.splat(self.expected);
        l.bits(l.gt(found, expected) | l.gt(expected, found)) == 0
    }
}

pub fn supports_agree<const FLUSH: bool>(tier: Tier) {
    let mut random = Random::new(7);
    for step in 0..20_000 {
        let (k, _) = SETS[step % SETS.len()];
        let scale = 2.0f32.powi(-(random.below(150) as i32));
        let ends = [(); 13].map(|()| [(); 2].map(|()| random.between(0.0, 1.0) * scale));
        let table = ordop::table(26, |member| [-ends[member][1], ends[member][0]]);
        let mut e = [(); 3].map(|()| random.signed());
        if random.below(4) == 0 {
            e[random.below(3)] = e[random.below(3)]; // ties take other branches
        }
        let expected = ordop::support(k, &table, e.map(F::<FLUSH>::new)).get();
        assert!(
            dispatch(tier, Equals { k, ends: &ends, e, expected }),
            "k = {k}, e = {e:?}, scale {scale:e}"
        );
    }
}

/// The culler decides as the searches' arithmetic does at the last f32 distance that overlaps and
/// at the next one.
pub fn decisions_agree<const FLUSH: bool>(tier: Tier) {
    for (k, directions) in SETS {
        let shapes: Vec<Shape> = (0..6).map(|seed| shape(seed, directions)).collect();
        let tables = SlabTables::new(directions, shapes.iter().map(|shape| (shape, &shape.ordop)));
        for (overlap, count) in [(Overlap::TwoSided, 400), (Overlap::Full, 60)] {
            let apart = |a: &Body, b: &Body| {
                let table = |body: &Body| entries(k, &tables, body.shape);
                let frames = Frames::<FLUSH>::new(&row(&a.row), &row(&b.row));
                separated(k, overlap == Overlap::Full, &frames, &table(a), &table(b))
            };
            let bodies = at_the_limit(&shapes, count, apart);
            let rows: Vec<_> = bodies.iter().map(|body| body.row).collect();
            let first: Vec<u32> = (0..2 * count as u32).map(|pair| 2 * pair).collect();
            let second: Vec<u32> = first.iter().map(|i| i + 1).collect();
            let columns = OrDopColumns { rows: RowsByNumber::all(&rows), tables: &tables, overlap };
            let mut kept = PairList::default();
            columns.test_pairs(tier, &first, &second, &mut kept);
            // Pairs come in twos: overlapping, then an ulp farther.
            let expected: Vec<u32> = first.iter().copied().step_by(2).collect();
            assert_eq!(kept.first(), expected, "k = {k}, {overlap:?}");
        }
    }
}

fn separates<const FLUSH: bool>(axis: &Axis<FLUSH>) -> bool {
    axis.tau > axis.own + axis.other
}

/// The culler's decision in the searches' arithmetic.
fn separated<const FLUSH: bool>(
    k: usize,
    full: bool,
    frames: &Frames<FLUSH>,
    a: &Table,
    b: &Table,
) -> bool {
    let back = Frames {
        turn: [0, 1, 2].map(|j| frames.turn.map(|row| row[j])),
        gap: [frames.gap[1], frames.gap[0]],
    };
    let by_edges = || {
        edges::of(k).iter().any(|&f| {
            edges::of(k).iter().any(|&e| {
                let axis = frames.edge_axis(e, f);
                frames.free(k, axis, a, b).is_some_and(|axis| separates(&axis))
            })
        })
    };
    let normals = || members_of(k).iter();
    normals().any(|&i| separates(&frames.normal(k, i, a, b)))
        || normals().any(|&i| separates(&back.normal(k, i, b, a)))
        || full && by_edges()
}

#[derive(Clone, Copy)]
struct Body {
    row: [f32; ROW],
    shape: u32,
}

fn row<const FLUSH: bool>(row: &[f32; ROW]) -> Row<FLUSH> {
    let three = |i: usize| [row[i], row[i + 1], row[i + 2]];
    Row::new([three(Q), three(Q + 3), three(Q + 6)], three(T), three(O))
}

fn entries(k: usize, tables: &SlabTables, shape: u32) -> Table {
    let [low, high] = [0, 1].map(|half| tables.rows()[2 * shape as usize + half]);
    let ends = [low, high].concat();
    let place = |member: usize| members_of(k).iter().position(|&m| m == member).unwrap();
    ordop::table(k, |member| [-ends[2 * place(member) + 1], ends[2 * place(member)]])
}

/// Twelve random vertices, half of the shapes with the origin outside.
fn shape(seed: u64, directions: DirectionSet) -> Shape {
    let mut random = Random::new(seed);
    let away = if seed.is_multiple_of(2) { Vec3::ZERO } else { Vec3::new(1.5, -0.25, 0.5) };
    let mut vertex =
        || (Vec3::new(random.signed(), random.signed(), random.signed()) + away).to_array();
    let mesh = TriangleMesh {
        name: format!("cloud {seed}"),
        vertices: (0..12).map(|_| vertex()).collect(),
        triangles: (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..TriangleMesh::default()
    };
    let origin = if seed.is_multiple_of(2) { Origin::Ball } else { Origin::File };
    Shape::build(&mesh, &ShapeSpec { origin, radius: None, directions, axes: Axes::Principal })
        .unwrap()
}

/// `count` times A, B, A, B': B overlaps A, and B', an ulp of its distance farther, doesn't.
fn at_the_limit(shapes: &[Shape], count: usize, apart: impl Fn(&Body, &Body) -> bool) -> Vec<Body> {
    let mut random = Random::new(11);
    let mut bodies = Vec::new();
    for _ in 0..count {
        let [a, b] = [(); 2].map(|()| turned(&mut random, shapes));
        let way = Vec3::new(random.signed(), random.signed(), random.signed()).normalize();
        let at = |distance: f32| {
            let mut moved = b;
            for i in 0..3 {
                // At no distance the slabs' centres coincide, and every slab contains its centre.
                moved.row[T + i] = a.row[T + i] + a.row[O + i] - b.row[O + i] + distance * way[i];
            }
            moved
        };
        let [near, far] = limit(|distance| apart(&a, &at(distance)));
        bodies.extend([a, at(near), a, at(far)]);
    }
    bodies
}

/// A randomly turned shape somewhere near the world's origin.
fn turned(random: &mut Random, shapes: &[Shape]) -> Body {
    let which = random.below(shapes.len());
    let shape = &shapes[which];
    let turn = rotation([(); 4].map(|()| random.signed()));
    let offset = rotate(&turn, shape.ball.centre);
    let axes = world_axes(&turn, shape.ordop.basis.columns);
    let mut row = [0.0; ROW];
    row[Q..Q + 9].copy_from_slice(axes.as_flattened());
    for i in 0..3 {
        row[T + i] = random.signed();
        row[O + i] = offset[i] as f32;
    }
    row[S] = f32::from_bits(SHAPE + which as u32);
    Body { row, shape: which as u32 }
}
