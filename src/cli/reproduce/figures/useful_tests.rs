//! The paper's Fig. 14, the percentages of Table 1, with the paper's own as hollow marks.

use plotters::prelude::*;
use sdop::reproduce::paper_name;
use sdop::reproduce::readings::{Cell, Reading, TABLE_1_STRATEGIES};
use sdop::scene::settings::Strategy;

use super::style::{GREY, PALE, colour, ends, legend, text, titled};
use super::{Area, Drawn};
use crate::cli::reproduce::rows::Tables;

/// Percent over N, logarithmic, a line a strategy.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let body = titled(
        area,
        "Collisions detected in percent of tests (ALL S-DOP: list entries count as tests)",
    )?;
    let (keys, body) = body.split_vertically(52);
    let filled: Vec<_> = TABLE_1_STRATEGIES
        .iter()
        .map(|&s| (paper_name(s), colour(s), false))
        .collect();
    legend(&keys, (14, 12), &filled)?;
    legend(
        &keys,
        (14, 36),
        &[
            ("measured, mean and 95 % interval over seeds", GREY, false),
            ("the paper's Table 1", GREY, true),
        ],
    )?;
    let most = tables
        .table_1
        .iter()
        .map(|cell| cell.bodies)
        .max()
        .unwrap_or(1) as f64;
    let mut chart = ChartBuilder::on(&body)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..1.06 * most, (0.3..100.0).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .x_desc("objects")
        .y_desc("percent (logarithmic)")
        .y_label_formatter(&|percent| format!("{percent}"))
        .x_label_formatter(&|n| format!("{n:.0}"))
        .label_style(text(12))
        .axis_desc_style(text(13))
        .draw()?;
    for strategy in TABLE_1_STRATEGIES {
        let reading = if strategy == Strategy::SDopBatch {
            Reading::TestsAndList
        } else {
            Reading::OwnTests
        };
        let of = |cell: &&Cell| {
            cell.strategy == strategy && cell.reading == reading && cell.scene.starts_with("paper")
        };
        let cells: Vec<&Cell> = tables.table_1.iter().filter(of).collect();
        let colour = colour(strategy);
        let point = |cell: &&Cell| (cell.bodies as f64, cell.measured.mean);
        chart.draw_series(LineSeries::new(
            cells.iter().map(point),
            colour.stroke_width(2),
        ))?;
        chart.draw_series(
            cells
                .iter()
                .map(|cell| Circle::new(point(cell), 4, colour.filled())),
        )?;
        chart.draw_series(cells.iter().map(|cell| {
            let (x, [lo, hi]) = (cell.bodies as f64, ends(&cell.measured));
            PathElement::new(vec![(x, lo.max(0.3)), (x, hi)], colour.stroke_width(2))
        }))?;
        let paper: Vec<_> = cells
            .iter()
            .filter_map(|cell| Some((cell.bodies as f64, cell.paper?)))
            .collect();
        chart.draw_series(DashedLineSeries::new(
            paper.clone(),
            5,
            4,
            colour.stroke_width(1),
        ))?;
        chart.draw_series(
            paper
                .into_iter()
                .map(|at| Circle::new(at, 5, colour.stroke_width(2))),
        )?;
    }
    Ok(())
}
