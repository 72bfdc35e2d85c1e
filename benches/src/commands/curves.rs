//! Draws curves over one quantity with a legend, for the figures of several commands.

use std::collections::BTreeMap;
use std::error::Error;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use super::palette::{GREY, LIGHT, PALE};

pub const FONT: &str = "sans-serif";

/// Points of each curve, by its name.
pub type Curves = BTreeMap<String, Vec<(f64, f64)>>;
pub type DrawResult = Result<(), Box<dyn Error>>;

/// The style of a curve: several may have one colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stroke {
    pub colour: RGBColor,
    pub is_dashed: bool,
    /// Whether its points are rings instead of dots.
    pub has_rings: bool,
}

impl Stroke {
    /// Strokes of curves without a meaning that has a colour: black, then grey, with different
    /// dashes and marks.
    pub fn plain(place: usize) -> Self {
        Self {
            colour: if place < 4 { BLACK } else { GREY },
            is_dashed: place % 2 == 1,
            has_rings: place / 2 % 2 == 1,
        }
    }

    /// The mark of a point.
    fn mark<At>(self, at: At) -> Circle<At, i32> {
        let (radius, style) = if self.has_rings {
            (6, self.colour.stroke_width(2)) // about the dots of another curve
        } else {
            (4, self.colour.filled())
        };
        Circle::new(at, radius, style)
    }
}

/// The places of a chart's title, axes and legend.
pub struct Chart<'a, X, Y> {
    pub caption: &'a str,
    pub titles: [&'a str; 2],
    pub x: X,
    pub y: Y,
    /// The text of numbers along the x axis.
    pub ticks: &'a dyn Fn(&f64) -> String,
    pub legend: SeriesLabelPosition,
}

/// A number without trailing zeros.
pub fn plain(number: &f64) -> String {
    let rounded = (1e9 * number).round() / 1e9;
    format!("{rounded}")
}

/// Draws every curve by its stroke.
///
/// # Errors
/// Drawing fails.
pub fn draw<X, Y>(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    curves: &Curves,
    stroke: impl Fn(usize, &str) -> Stroke,
    chart: Chart<'_, X, Y>,
) -> DrawResult
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut drawn = ChartBuilder::on(area)
        .caption(chart.caption, (FONT, 20))
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(chart.x, chart.y)?;
    drawn
        .configure_mesh()
        .x_desc(chart.titles[0])
        .y_desc(chart.titles[1])
        .x_label_formatter(chart.ticks)
        .y_label_formatter(&plain)
        .label_style((FONT, 14))
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .draw()?;
    for (place, (name, points)) in curves.iter().enumerate() {
        let stroke = stroke(place, name);
        let line = stroke.colour.stroke_width(2);
        let points = || points.iter().copied();
        let series = if stroke.is_dashed {
            drawn.draw_series(DashedLineSeries::new(points(), 6, 4, line))?
        } else {
            drawn.draw_series(LineSeries::new(points(), line))?
        };
        series.label(name).legend(move |at| {
            let ends = if stroke.is_dashed { [(3, 0), (13, 0)] } else { [(0, 0), (16, 0)] };
            EmptyElement::at(at) + PathElement::new(ends, line) + stroke.mark((8, 0))
        });
        drawn.draw_series(points().map(|at| stroke.mark(at)))?;
    }
    drawn
        .configure_series_labels()
        .position(chart.legend)
        .border_style(LIGHT)
        .background_style(WHITE)
        .label_font((FONT, 13))
        .draw()?;
    Ok(())
}

/// Draws on a white page and returns the SVG.
///
/// # Errors
/// Drawing fails.
pub fn page(
    size: (u32, u32),
    draw: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> DrawResult,
) -> miette::Result<String> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let drawn = area.fill(&WHITE).map_err(Into::into).and_then(|()| draw(&area));
    drop(area);
    drawn.map_err(|error: Box<dyn Error>| miette::miette!("cannot draw: {error}"))?;
    Ok(text)
}
