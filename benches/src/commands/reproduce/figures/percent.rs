//! Percentages over N, ours and the paper's: the sphere percentage, compared with the closed form
//! for its one box, and the paper's Fig. 14, the percentages of Table 1.

use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use sdop::settings::Strategy;
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::readings::{Reading, TABLE_1_STRATEGIES, Table1Cell};

use crate::commands::reproduce::rows::Drawings;
use crate::commands::style::{
    Area, DrawError, DrawResult, GREY, colour, ends, legend, plain, quiet, titled,
};

/// The percentages that are shown of spheres, and of all strategies.
const SPHERE_RANGE: [f64; 2] = [0.7, 1.3];
const TESTS_RANGE: [f64; 2] = [0.3, 100.0];

/// A chart of percentages over N.
type Chart<'a, 'b, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, Y>>;

/// Axes up to the most bodies of any scene.
fn chart<'a, 'b, Y>(
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
        .y_label_formatter(&plain)
        .x_label_formatter(&|n| format!("{n:.0}"))
        .draw()?;
    Ok(chart)
}

/// Where the axis of N ends.
fn right(tables: &Drawings) -> f64 {
    let most = tables.table_1.iter().map(|cell| cell.bodies).max();
    1.06 * most.unwrap_or(1) as f64
}

/// A strategy's percentages in the paper's box.
fn cells(tables: &Drawings, strategy: Strategy) -> Vec<&Table1Cell> {
    let reading = Reading::shown(strategy);
    let of = |cell: &&Table1Cell| {
        cell.strategy == strategy && cell.reading == reading && cell.in_papers_box
    };
    tables.table_1.iter().filter(of).collect()
}

/// A cell's mean.
fn point(cell: &&Table1Cell) -> (f64, f64) {
    (cell.bodies as f64, cell.measured.mean)
}

/// Means with whiskers, cut off at `lo` and `hi`, and the paper's numbers as hollow marks on a
/// dashed line.
fn marks<Y>(
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

/// The share of sphere tests that hit.
pub fn sphere(area: &Area<'_>, tables: &Drawings) -> DrawResult {
    let body = titled(area, "Share of sphere tests that hit: a fixed box has one, whatever N")?;
    let (keys, body) = body.split_vertically(30);
    let own = colour(Strategy::Sphere);
    legend(
        &keys,
        (14, 12),
        &[
            ("measured, 95 % over seeds", own, false),
            ("the paper's Table 1", own, true),
            ("closed form P(2r/L)", GREY, false),
        ],
    )?;
    let cells = cells(tables, Strategy::Sphere);
    let mut chart = chart(&body, tables, SPHERE_RANGE[0]..SPHERE_RANGE[1], "percent")?;
    let of_box = |scene: &str| tables.boxes.iter().find(|row| row.scene == scene);
    if let Some(row) = cells.first().and_then(|cell| of_box(&cell.scene)) {
        let line = vec![(0.0, row.percent), (right(tables), row.percent)];
        chart.draw_series([PathElement::new(line, GREY.stroke_width(2))])?;
    }
    marks(&mut chart, &cells, own, SPHERE_RANGE)
}

/// Percent over N, logarithmic, one line per strategy.
pub fn useful_tests(area: &Area<'_>, tables: &Drawings) -> DrawResult {
    let body = titled(
        area,
        "Collisions detected in percent of tests (ALL S-DOP: list entries count as tests)",
    )?;
    let (keys, body) = body.split_vertically(52);
    let filled: Vec<_> =
        TABLE_1_STRATEGIES.iter().map(|&s| (paper_name(s), colour(s), false)).collect();
    legend(&keys, (14, 12), &filled)?;
    legend(
        &keys,
        (14, 36),
        &[
            ("measured, mean and 95 % interval over seeds", GREY, false),
            ("the paper's Table 1", GREY, true),
        ],
    )?;
    let range = (TESTS_RANGE[0]..TESTS_RANGE[1]).log_scale();
    let mut chart = chart(&body, tables, range, "percent (logarithmic)")?;
    for strategy in TABLE_1_STRATEGIES {
        let (cells, colour) = (cells(tables, strategy), colour(strategy));
        let line = LineSeries::new(cells.iter().map(point), colour.stroke_width(2));
        chart.draw_series(line)?;
        marks(&mut chart, &cells, colour, TESTS_RANGE)?;
    }
    Ok(())
}
