//! [`PosedOrDops`]: the or-DOPs of one frame, without a culler, to test listed pairs.

use sdop::bodies::{Bodies, Places};
use sdop::overlap::ordop::{OrDopColumns, SlabTables};
use sdop::settings::Overlap;
use sdop::simd::Tier;
use sdop::threads::Threads;
use sdop::update::{OrDopRows, RowsByNumber, ShapeFrame, ShapeFrames, UpdateInputs};
use sdop::volume::{DirectionSet, OrDop, Shape};

/// Rows and tables in the order of the bodies' columns, so that pairs of rows are pairs of bodies.
#[derive(Debug)]
pub struct PosedOrDops {
    rows: OrDopRows,
    tables: SlabTables,
}

impl PosedOrDops {
    /// Updates the or-DOPs to the bodies' poses. All shapes have the same slab directions.
    #[must_use]
    pub fn new<'a>(
        shapes: impl Iterator<Item = (&'a Shape, &'a OrDop)> + Clone,
        bodies: &Bodies,
        tier: Tier,
    ) -> Self {
        let directions = shapes.clone().next().map(|(_, ordop)| ordop.directions);
        let frames: ShapeFrames =
            shapes.clone().map(|(shape, ordop)| ShapeFrame::new(shape, &ordop.basis)).collect();
        let n = bodies.len();
        let (body, shape) = ((0..n as u32).collect(), bodies.shape.clone());
        let places = Places { body, shape, moving: n };
        let mut rows = OrDopRows::new(n);
        let posed = UpdateInputs { frames: &frames, bodies, places: &places, balls: &[] };
        let pool = Threads::default();
        rows.update(pool.executor(tier), posed, 0..n, 1);
        Self { rows, tables: SlabTables::new(directions.unwrap_or(DirectionSet::K6), shapes) }
    }

    /// The form that the pair test takes.
    #[must_use]
    pub fn columns(&self, overlap: Overlap) -> OrDopColumns<'_> {
        OrDopColumns { rows: RowsByNumber::all(&self.rows.rows), tables: &self.tables, overlap }
    }
}
