//! The sphere percentage over N, compared with the closed form for its one box, and with the
//! paper's row.

use plotters::prelude::*;
use sdop::settings::Strategy;

use super::percent::{cells, chart, marks, right};
use super::style::{colour, legend, titled};
use super::{Area, DrawResult};
use crate::commands::palette::GREY;
use crate::commands::reproduce::rows::Drawings;

/// The percentages shown.
const RANGE: [f64; 2] = [0.7, 1.3];

/// Percent over N.
pub fn draw(area: &Area<'_>, tables: &Drawings) -> DrawResult {
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
    let mut chart = chart(&body, tables, RANGE[0]..RANGE[1], "percent")?;
    let of_box = |scene: &str| tables.boxes.iter().find(|row| row.scene == scene);
    if let Some(row) = cells.first().and_then(|cell| of_box(&cell.scene)) {
        let line = vec![(0.0, row.percent), (right(tables), row.percent)];
        chart.draw_series([PathElement::new(line, GREY.stroke_width(2))])?;
    }
    marks(&mut chart, &cells, own, RANGE)
}
