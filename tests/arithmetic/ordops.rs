//! Pairs of or-DOPs at the distance at which the culler's verdict changes, and an ulp farther.

use sdop::mesh::TriangleMesh;
use sdop::overlap::ordop::table::members_of;
use sdop::overlap::ordop::{OrDopColumns, SlabTables};
use sdop::pairs::PairList;
use sdop::rounding::pose::{rotate, rotation, world_axes};
use sdop::settings::Overlap;
use sdop::simd::{ROW, Tier};
use sdop::update::RowsByNumber;
use sdop::update::row::{O, Q, S, SHAPE, T};
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

use super::case::Case;
use super::inputs::Inputs;
use super::limit::limit;

const SETS: [(usize, DirectionSet); 4] = [
    (6, DirectionSet::K6),
    (14, DirectionSet::K14),
    (18, DirectionSet::K18),
    (26, DirectionSet::K26),
];
const SHAPES: u32 = 6;

struct Set {
    k: usize,
    shapes: Vec<Shape>,
    tables: SlabTables,
}

pub struct Pairs {
    inputs: Inputs,
    sets: [Set; 4],
    waiting: Option<Case>,
}

type Row = [f32; ROW];

impl Pairs {
    pub fn new(seed: u64) -> Self {
        let mut inputs = Inputs::new(seed);
        let sets = SETS.map(|(k, directions)| {
            let shapes: Vec<Shape> = (0..SHAPES).map(|_| shape(&mut inputs, directions)).collect();
            let tables =
                SlabTables::new(directions, shapes.iter().map(|shape| (shape, &shape.ordop)));
            Set { k, shapes, tables }
        });
        Self { inputs, sets, waiting: None }
    }

    /// The next pair: every second one is the one before, an ulp farther.
    pub fn next(&mut self, tier: Tier) -> Case {
        if let Some(case) = self.waiting.take() {
            return case;
        }
        let set = &self.sets[self.inputs.below(4) as usize];
        let overlap = [Overlap::TwoSided, Overlap::Full][self.inputs.below(2) as usize];
        let [a, b] = [(); 2].map(|()| turned(&mut self.inputs, set));
        let way = self.inputs.direction();
        let at = |distance: f32| {
            let mut moved = b;
            for i in 0..3 {
                moved[T + i] = a[T + i] + a[O + i] - b[O + i] + distance * way[i] as f32;
            }
            moved
        };
        let limit = limit(|distance| set.apart(tier, overlap, [a, at(distance)]));
        let [touching, apart] = limit.map(|distance| set.case(tier, overlap, [a, at(distance)]));
        self.waiting = Some(apart);
        touching
    }
}

impl Set {
    fn apart(&self, tier: Tier, overlap: Overlap, rows: [Row; 2]) -> bool {
        let rows = RowsByNumber::all(&rows);
        let columns = OrDopColumns { rows, tables: &self.tables, overlap };
        let mut kept = PairList::default();
        columns.test_pairs(tier, &[0], &[1], &mut kept);
        kept.first().is_empty()
    }

    /// The ends of a row's slabs, by direction of k = 26.
    fn ends(&self, row: &Row) -> [[f32; 2]; 13] {
        let shape = (row[S].to_bits() - SHAPE) as usize;
        let numbers = self.tables.rows()[2 * shape..2 * shape + 2].as_flattened();
        let mut ends = [[0.0; 2]; 13];
        for (place, &member) in members_of(self.k).iter().enumerate() {
            ends[member] = [numbers[2 * place], numbers[2 * place + 1]];
        }
        ends
    }

    fn case(&self, tier: Tier, overlap: Overlap, rows: [Row; 2]) -> Case {
        let full = overlap == Overlap::Full;
        let mut case = Case::of("ordops").number(self.k as u64).bit(full);
        for row in rows {
            case = case.f32s(&row[..S]);
        }
        for row in rows {
            case = case.f32s(self.ends(&row).as_flattened());
        }
        case.gives().bit(self.apart(tier, overlap, rows))
    }
}

/// Twelve random vertices, some with the origin outside.
fn shape(inputs: &mut Inputs, directions: DirectionSet) -> Shape {
    let away = f64::from(inputs.below(2)) * 1.5;
    let mut vertex = || [(); 3].map(|()| (inputs.signed() + away) as f32);
    let mesh = TriangleMesh {
        name: "cloud".into(),
        vertices: (0..12).map(|_| vertex()).collect(),
        triangles: (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..TriangleMesh::default()
    };
    let origin = if away == 0.0 { Origin::Ball } else { Origin::File };
    let spec = ShapeSpec { origin, radius: None, directions, axes: Axes::Principal };
    Shape::build(&mesh, &spec).unwrap()
}

/// The row of a randomly turned shape near the world's origin.
fn turned(inputs: &mut Inputs, set: &Set) -> Row {
    let which = inputs.below(SHAPES);
    let shape = &set.shapes[which as usize];
    let turn = rotation([(); 4].map(|()| inputs.signed() as f32));
    let offset = rotate(&turn, shape.ball.centre);
    let mut row = [0.0; ROW];
    row[Q..Q + 9].copy_from_slice(world_axes(&turn, shape.ordop.basis.columns).as_flattened());
    for i in 0..3 {
        row[T + i] = inputs.signed() as f32;
        row[O + i] = offset[i] as f32;
    }
    row[S] = f32::from_bits(SHAPE + which);
    row
}
