//! Figures as SVG, one file each.

mod costs;
mod frame_rates;
mod percent;
mod residuals;
mod sphere;
mod style;
mod useful_tests;

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use sdop_bench::cost::table::Cost;

use super::rows::Tables;

/// Where a figure is drawn.
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Why nothing could be drawn.
type DrawError = Box<dyn std::error::Error + Send + Sync>;
/// How drawing ends.
type DrawResult = Result<(), DrawError>;

/// A figure's file name, size, and what draws it.
type Figure = (
    &'static str,
    (u32, u32),
    fn(&Area<'_>, &Tables) -> DrawResult,
);

const FIGURES: [Figure; 5] = [
    ("frame_rates", (1000, 620), frame_rates::draw),
    ("useful_tests", (860, 560), useful_tests::draw),
    ("costs", (1060, 640), costs::draw),
    ("residuals", (900, 420), residuals::draw),
    ("sphere", (760, 430), sphere::draw),
];

/// Draws every figure into the directory.
///
/// # Errors
/// A file that can't be written.
pub fn draw_all(directory: &Path, tables: &Tables) -> miette::Result<()> {
    for (name, size, draw) in FIGURES {
        let svg = svg(size, |area| draw(area, tables))
            .map_err(|error| miette::miette!("cannot draw {name}: {error}"))?;
        super::write(&directory.join(name).with_extension("svg"), &svg)?;
    }
    Ok(())
}

/// Where the time of one scene's frames goes, strategy by strategy.
///
/// # Errors
/// What can't be drawn.
pub fn draw_costs(scene: &str, costs: &[&Cost]) -> miette::Result<String> {
    svg((1060, 480), |area| {
        costs::draw_strategies(area, scene, costs)
    })
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
