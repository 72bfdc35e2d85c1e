//! Figures as SVG, one file each.

mod costs;
mod frame_rates;
mod percent;
mod residuals;

use miette::WrapErr as _;
use sdop_bench::cost::table::Cost;

use super::rows::Drawings;
use crate::commands::style::{Area, DrawResult, page};

/// A figure's file name, size, and what draws it.
type Figure = (&'static str, (u32, u32), fn(&Area<'_>, &Drawings) -> DrawResult);

const FIGURES: [Figure; 4] = [
    ("frame_rates", (1000, 620), frame_rates::draw),
    ("useful_tests", (860, 560), percent::draw),
    ("costs", (1060, 640), costs::draw),
    ("residuals", (900, 420), residuals::draw),
];

/// Every figure, with its file's name.
///
/// # Errors
/// What can't be drawn.
pub fn draw_all(drawings: &Drawings) -> miette::Result<Vec<(String, String)>> {
    let drawn = FIGURES.into_iter().map(|(name, size, draw)| {
        let svg = page(size, |area| draw(area, drawings)).wrap_err(name)?;
        Ok((format!("{name}.svg"), svg))
    });
    drawn.collect()
}

/// Where the time of one scene's frames goes, strategy by strategy.
///
/// # Errors
/// What can't be drawn.
pub fn draw_costs(scene: &str, costs: &[&Cost]) -> miette::Result<String> {
    page((1060, 480), |area| costs::draw_strategies(area, scene, costs))
}
