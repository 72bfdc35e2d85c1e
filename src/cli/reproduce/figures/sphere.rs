//! The sphere percentage over N beside the closed form for its one box, and the paper's row.

use plotters::prelude::*;
use sdop::reproduce::readings::{Cell, Reading};
use sdop::scene::settings::Strategy;

use super::style::{GREY, PALE, colour, ends, legend, text, titled};
use super::{Area, Drawn};
use crate::cli::reproduce::rows::Tables;

/// Percent over N.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let body = titled(
        area,
        "Share of sphere tests that hit: a fixed box has one, whatever N",
    )?;
    let (keys, body) = body.split_vertically(30);
    let blue = colour(Strategy::Sphere);
    legend(
        &keys,
        (14, 12),
        &[
            ("measured, 95 % over seeds", blue, false),
            ("the paper's Table 1", blue, true),
            ("closed form P(2r/L)", GREY, false),
        ],
    )?;
    let of = |cell: &&Cell| {
        cell.strategy == Strategy::Sphere
            && cell.reading == Reading::OwnTests
            && cell.scene.starts_with("paper")
    };
    let cells: Vec<&Cell> = tables.table_1.iter().filter(of).collect();
    let most = cells.iter().map(|cell| cell.bodies).max().unwrap_or(1) as f64;
    let right = 1.06 * most;
    let mut chart = ChartBuilder::on(&body)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..right, 0.7..1.3)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .x_desc("objects")
        .y_desc("percent")
        .y_label_formatter(&|percent| format!("{percent:.1}"))
        .x_label_formatter(&|n| format!("{n:.0}"))
        .label_style(text(12))
        .axis_desc_style(text(13))
        .draw()?;
    if let Some(geometry) = cells
        .first()
        .and_then(|cell| tables.boxes.iter().find(|b| b.scene == cell.scene))
    {
        let percent = geometry.percent;
        chart.draw_series([PathElement::new(
            vec![(0.0, percent), (right, percent)],
            GREY.stroke_width(2),
        )])?;
    }
    chart.draw_series(cells.iter().map(|cell| {
        let (x, [lo, hi]) = (cell.bodies as f64, ends(&cell.measured));
        PathElement::new(
            vec![(x, lo.max(0.7)), (x, hi.min(1.3))],
            blue.stroke_width(2),
        )
    }))?;
    chart.draw_series(
        cells
            .iter()
            .map(|cell| Circle::new((cell.bodies as f64, cell.measured.mean), 5, blue.filled())),
    )?;
    let paper: Vec<_> = cells
        .iter()
        .filter_map(|cell| Some((cell.bodies as f64, cell.paper?)))
        .collect();
    chart.draw_series(DashedLineSeries::new(
        paper.clone(),
        5,
        4,
        blue.stroke_width(1),
    ))?;
    chart.draw_series(
        paper
            .into_iter()
            .map(|at| Circle::new(at, 5, blue.stroke_width(2))),
    )?;
    Ok(())
}
