//! Draws percentages over N, ours and the paper's, for the sphere figure and Fig. 14.

use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use sdop::settings::Strategy;
use sdop_bench::reproduce::readings::{Reading, Table1Cell};

use super::style::{ends, quiet};
use super::{Area, DrawError, DrawResult};
use crate::commands::reproduce::rows::Drawings;

/// A chart of percentages over N.
type Chart<'a, 'b, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, Y>>;

/// Axes up to the most bodies of any scene.
pub fn chart<'a, 'b, Y>(
    area: &Area<'b>,
    tables: &Drawings,
    range: Y,
    unit: &str,
) -> Result<Chart<'a, 'b, Y::CoordDescType>, DrawError>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..right(tables), range)?;
    quiet(&mut chart.configure_mesh())
        .x_desc("objects")
        .y_desc(unit)
        .y_label_formatter(&|percent| format!("{}", (10.0 * percent).round() / 10.0))
        .x_label_formatter(&|n| format!("{n:.0}"))
        .draw()?;
    Ok(chart)
}

/// Where the axis of N ends.
pub fn right(tables: &Drawings) -> f64 {
    let most = tables.table_1.iter().map(|cell| cell.bodies).max();
    1.06 * most.unwrap_or(1) as f64
}

/// A strategy's percentages in the paper's box.
pub fn cells(tables: &Drawings, strategy: Strategy) -> Vec<&Table1Cell> {
    let reading = Reading::shown(strategy);
    let of = |cell: &&Table1Cell| {
        cell.strategy == strategy && cell.reading == reading && cell.in_papers_box
    };
    tables.table_1.iter().filter(of).collect()
}

/// A cell's mean.
pub fn point(cell: &&Table1Cell) -> (f64, f64) {
    (cell.bodies as f64, cell.measured.mean)
}

/// Means with whiskers, cut off at `lo` and `hi`, and the paper's numbers as hollow marks on a
/// dashed line.
pub fn marks<Y>(
    chart: &mut Chart<'_, '_, Y>,
    cells: &[&Table1Cell],
    colour: RGBColor,
    [lo, hi]: [f64; 2],
) -> DrawResult
where
    Y: Ranged<ValueType = f64>,
{
    chart.draw_series(cells.iter().map(|cell| {
        let (x, ends) = (cell.bodies as f64, ends(&cell.measured));
        let whisker = ends.map(|end| (x, end.clamp(lo, hi))).to_vec();
        PathElement::new(whisker, colour.stroke_width(2))
    }))?;
    let dot = |cell| Circle::new(point(cell), 5, colour.filled());
    chart.draw_series(cells.iter().map(dot))?;
    let paper: Vec<_> =
        cells.iter().filter_map(|cell| Some((cell.bodies as f64, cell.paper?))).collect();
    let thin = colour.stroke_width(1);
    chart.draw_series(DashedLineSeries::new(paper.clone(), 5, 4, thin))?;
    let ring = |at| Circle::new(at, 5, colour.stroke_width(2));
    chart.draw_series(paper.into_iter().map(ring))?;
    Ok(())
}
