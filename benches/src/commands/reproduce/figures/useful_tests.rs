//! The paper's Fig. 14: the percentages of Table 1, with the paper's numbers as hollow marks.

use plotters::prelude::*;
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::readings::TABLE_1_STRATEGIES;

use super::percent::{cells, chart, marks, point};
use super::style::{colour, legend, titled};
use super::{Area, DrawResult};
use crate::commands::palette::GREY;
use crate::commands::reproduce::rows::Drawings;

/// The percentages shown.
const RANGE: [f64; 2] = [0.3, 100.0];

/// Percent over N, logarithmic, one line per strategy.
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
    let range = (RANGE[0]..RANGE[1]).log_scale();
    let mut chart = chart(&body, tables, range, "percent (logarithmic)")?;
    for strategy in TABLE_1_STRATEGIES {
        let (cells, colour) = (cells(tables, strategy), colour(strategy));
        let line = LineSeries::new(cells.iter().map(point), colour.stroke_width(2));
        chart.draw_series(line)?;
        marks(&mut chart, &cells, colour, RANGE)?;
    }
    Ok(())
}
