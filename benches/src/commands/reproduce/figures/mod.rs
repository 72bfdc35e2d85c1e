//! Figures as SVG, one file each.

mod costs;
mod frame_rates;
mod percent;
mod residuals;
mod sphere;
mod style;
mod useful_tests;

use plotters::coord::Shift;
use plotters::prelude::*;
use sdop_bench::cost::table::Cost;

use super::rows::Drawings;

/// Where a figure is drawn.
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Why nothing could be drawn.
type DrawError = Box<dyn std::error::Error + Send + Sync>;
/// How drawing ends.
type DrawResult = Result<(), DrawError>;

/// A figure's file name, size, and what draws it.
type Figure = (&'static str, (u32, u32), fn(&Area<'_>, &Drawings) -> DrawResult);

const FIGURES: [Figure; 5] = [
    ("frame_rates", (1000, 620), frame_rates::draw),
    ("useful_tests", (860, 560), useful_tests::draw),
    ("costs", (1060, 640), costs::draw),
    ("residuals", (900, 420), residuals::draw),
    ("sphere", (760, 430), sphere::draw),
];

/// Every figure, with its file's name.
///
/// # Errors
/// What can't be drawn.
pub fn draw_all(drawings: &Drawings) -> miette::Result<Vec<(String, String)>> {
    let drawn = FIGURES.into_iter().map(|(name, size, draw)| {
        let svg = svg(size, |area| draw(area, drawings))
            .map_err(|error| miette::miette!("cannot draw {name}: {error}"))?;
        Ok((format!("{name}.svg"), svg))
    });
    drawn.collect()
}

/// Where the time of one scene's frames goes, strategy by strategy.
///
/// # Errors
/// What can't be drawn.
pub fn draw_costs(scene: &str, costs: &[&Cost]) -> miette::Result<String> {
    svg((1060, 480), |area| costs::draw_strategies(area, scene, costs))
        .map_err(|error| miette::miette!("cannot draw the costs: {error}"))
}

fn svg(size: (u32, u32), draw: impl FnOnce(&Area<'_>) -> DrawResult) -> Result<String, DrawError> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    Ok(svg)
}
