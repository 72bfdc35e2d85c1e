//! The paper's Fig. 14: percentages of Table 1 over N, ours and the paper's.

use plotters::prelude::*;
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::readings::{Reading, TABLE_1_STRATEGIES, Table1Cell};

use crate::commands::reproduce::rows::Drawings;
use crate::commands::style::{Area, DrawResult, GREY, colour, ends, legend, plain, quiet, titled};

/// The percentages that are shown.
const RANGE: [f64; 2] = [0.3, 100.0];

/// Percent over N, logarithmic, one line per strategy: means with whiskers, and the paper's numbers
/// as hollow marks on a dashed line.
pub fn draw(area: &Area<'_>, tables: &Drawings) -> DrawResult {
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
    let [lo, hi] = RANGE;
    let most = tables.table_1.iter().map(|cell| cell.bodies).max().unwrap_or(1) as f64;
    let mut chart = ChartBuilder::on(&body)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..1.06 * most, (lo..hi).log_scale())?;
    quiet(&mut chart.configure_mesh())
        .x_desc("objects")
        .y_desc("percent (logarithmic)")
        .y_label_formatter(&plain)
        .x_label_formatter(&|n| format!("{n:.0}"))
        .draw()?;
    for strategy in TABLE_1_STRATEGIES {
        let (reading, colour) = (Reading::shown(strategy), colour(strategy));
        let of = |cell: &&Table1Cell| {
            cell.strategy == strategy && cell.reading == reading && cell.in_papers_box
        };
        let cells: Vec<&Table1Cell> = tables.table_1.iter().filter(of).collect();
        let (thick, thin) = (colour.stroke_width(2), colour.stroke_width(1));
        let points = || cells.iter().map(|cell| (cell.bodies as f64, cell.measured.mean));
        chart.draw_series(LineSeries::new(points(), thick))?;
        chart.draw_series(cells.iter().map(|cell| {
            let ends = ends(&cell.measured).map(|end| (cell.bodies as f64, end.clamp(lo, hi)));
            PathElement::new(ends.to_vec(), thick)
        }))?;
        chart.draw_series(points().map(|at| Circle::new(at, 5, colour.filled())))?;
        let printed = |cell: &&Table1Cell| Some((cell.bodies as f64, cell.paper?));
        let paper: Vec<_> = cells.iter().filter_map(printed).collect();
        chart.draw_series(DashedLineSeries::new(paper.clone(), 5, 4, thin))?;
        chart.draw_series(paper.into_iter().map(|at| Circle::new(at, 5, thick)))?;
    }
    Ok(())
}
