//! The style of all figures: colours, text, legends, curves, and the page that they are drawn on.
//!
//! A colour has the same meaning in all figures and on the page of `sdop view` (its style sheet is
//! `view/web/src/style.css`): orange, blue and red are the page's pairs, bluish green is its cells.
//! Other curves are black.

use std::collections::BTreeMap;

use plotters::chart::MeshStyle;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use sdop::settings::Strategy;
use sdop_bench::cost::terms::Terms;
use sdop_bench::measure::counts::Volume;
use sdop_bench::reproduce::Estimate;

/// Where a figure is drawn.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Why nothing could be drawn.
pub type DrawError = Box<dyn std::error::Error + Send + Sync>;
/// How drawing ends.
pub type DrawResult = Result<(), DrawError>;

/// Draws on a white page and returns the SVG.
///
/// # Errors
/// Drawing fails.
pub fn page(
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> DrawResult,
) -> miette::Result<String> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let drawn = area.fill(&WHITE).map_err(Into::into).and_then(|()| draw(&area));
    drop(area);
    drawn.map_err(|error: DrawError| miette::miette!("cannot draw: {error}"))?;
    Ok(text)
}

/// The terms of the formula: updates, finding, tests. Light for spheres, middle for or-DOPs, dark
/// for boxes and k-DOPs.
pub const UPDATES: [RGBColor; 3] =
    [RGBColor(235, 199, 217), RGBColor(204, 121, 167), RGBColor(133, 62, 102)];
pub const FINDING: RGBColor = RGBColor(170, 170, 170);
pub const TESTS: [RGBColor; 3] =
    [RGBColor(197, 187, 235), RGBColor(123, 99, 207), RGBColor(64, 45, 140)];

/// The strategies of the paper, of different lightness for the colour-blind.
pub const SPHERE: RGBColor = RGBColor(86, 180, 233);
pub const INTEREST: RGBColor = RGBColor(27, 42, 107);
pub const SEQUENTIAL: RGBColor = RGBColor(27, 120, 55);
pub const BATCH: RGBColor = RGBColor(158, 150, 0);
pub const ORDOPS: RGBColor = RGBColor(115, 63, 16);

/// Sequential S-DOP by k, from few half-spaces to many.
pub const BY_K: [RGBColor; 4] =
    [RGBColor(166, 219, 160), RGBColor(90, 174, 97), SEQUENTIAL, RGBColor(0, 68, 27)];

pub const GREY: RGBColor = RGBColor(110, 110, 110);
/// Data that matter less.
pub const LIGHT: RGBColor = RGBColor(190, 190, 190);
/// Lines in the background.
pub const PALE: RGBColor = RGBColor(225, 225, 225);

/// A strategy's colour in every figure.
pub fn colour(strategy: Strategy) -> RGBColor {
    match strategy {
        Strategy::None => RGBColor(90, 90, 90),
        Strategy::Sphere => SPHERE,
        Strategy::SDopObjectOfInterest => INTEREST,
        Strategy::SDopSequential => SEQUENTIAL,
        Strategy::SDopBatch => BATCH,
        _ => ORDOPS,
    }
}

/// One part of a stacked cost: its name, its colour, and the term of which volumes it is.
pub type CostPart = (&'static str, RGBColor, fn(&Terms) -> f64, fn(Volume) -> bool);

/// The formula's terms, from the bottom of the stack to its top.
pub const PARTS: [CostPart; 7] = [
    ("Nu·Cu spheres", UPDATES[0], |t| t.update, is_sphere),
    ("Nu·Cu or-DOPs", UPDATES[1], |t| t.update, is_ordop),
    ("Nu·Cu aabb, k-dop, obb", UPDATES[2], |t| t.update, is_other),
    ("F pair finding", FINDING, |t| t.finding, |_| true),
    ("Nv·Cv spheres", TESTS[0], |t| t.test, is_sphere),
    ("Nv·Cv or-DOPs", TESTS[1], |t| t.test, is_ordop),
    ("Nv·Cv aabb, k-dop, obb", TESTS[2], |t| t.test, is_other),
];

/// The seconds of a part.
pub fn part_of(terms: &[Terms], (_, _, term, which): &CostPart) -> f64 {
    terms.iter().filter(|t| which(t.volume)).map(term).sum()
}

fn is_sphere(volume: Volume) -> bool {
    volume == Volume::Sphere
}

fn is_ordop(volume: Volume) -> bool {
    volume == Volume::OrDop
}

fn is_other(volume: Volume) -> bool {
    !is_sphere(volume) && !is_ordop(volume)
}

/// Text at a size, dark grey.
pub fn text(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&RGBColor(40, 40, 40))
}

/// Text with an anchor.
pub fn anchored(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    text(size).pos(Pos::new(horizontal, vertical))
}

/// Axes and lines in the background.
pub fn quiet<'m, 'a, 'b, X: Ranged, Y: Ranged, B: DrawingBackend>(
    mesh: &'m mut MeshStyle<'a, 'b, X, Y, B>,
) -> &'m mut MeshStyle<'a, 'b, X, Y, B> {
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .label_style(text(12))
        .axis_desc_style(text(13))
}

/// A finite interval's ends, or the mean twice for one seed alone.
pub fn ends(estimate: &Estimate) -> [f64; 2] {
    if estimate.half_width.is_finite() { estimate.interval() } else { [estimate.mean; 2] }
}

/// A title over a figure; returns what is left of the area.
pub fn titled<'a>(area: &Area<'a>, title: &str) -> Result<Area<'a>, DrawError> {
    let (head, body) = area.split_vertically(34);
    head.draw(&Text::new(title.to_owned(), (14, 10), text(17)))?;
    Ok(body)
}

/// Coloured keys in one row; `hollow` ones are outlines.
pub fn legend(area: &Area<'_>, mut at: (i32, i32), keys: &[(&str, RGBColor, bool)]) -> DrawResult {
    for (name, colour, hollow) in keys {
        let style =
            if *hollow { ShapeStyle::from(colour).stroke_width(2) } else { colour.filled() };
        area.draw(&Circle::new((at.0 + 6, at.1), 5, style))?;
        area.draw(&Text::new(
            (*name).to_owned(),
            (at.0 + 17, at.1),
            anchored(13, HPos::Left, VPos::Center),
        ))?;
        at.0 += 17 + 8 * name.chars().count() as i32 + 14;
    }
    Ok(())
}

/// Text some pixels off a point of a chart; it may stand outside of the axes.
pub fn label<CT: CoordTranslate>(
    area: &DrawingArea<SVGBackend<'_>, CT>,
    at: &CT::From,
    offset: (i32, i32),
    text: String,
    style: TextStyle<'_>,
) -> DrawResult {
    let (at, origin) = (area.map_coordinate(at), area.get_base_pixel());
    let place = (at.0 - origin.0 + offset.0, at.1 - origin.1 + offset.1);
    area.strip_coord_spec().draw(&Text::new(text, place, style))?;
    Ok(())
}

/// Points of each curve, by its name.
pub type Curves = BTreeMap<String, Vec<(f64, f64)>>;

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
pub fn draw_curves<X, Y>(
    area: &Area<'_>,
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
        .caption(chart.caption, text(17))
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(chart.x, chart.y)?;
    quiet(&mut drawn.configure_mesh())
        .x_desc(chart.titles[0])
        .y_desc(chart.titles[1])
        .x_label_formatter(chart.ticks)
        .y_label_formatter(&plain)
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
        .label_font(text(13))
        .draw()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: &str = include_str!("../view/web/src/style.css");

    /// The page's colours by name, for light ground and for dark.
    fn of_page() -> Vec<(&'static str, RGBColor)> {
        let hex = |text: &str| {
            let number = u32::from_str_radix(text.strip_prefix('#')?, 16).ok()?;
            let [_, r, g, b] = number.to_be_bytes();
            Some(RGBColor(r, g, b))
        };
        let variables = STYLE.lines().filter_map(|line| {
            let (name, value) = line.trim().strip_prefix("--")?.split_once(": ")?;
            Some((name, hex(value.trim_end_matches(';'))?))
        });
        variables.collect()
    }

    fn distance(a: RGBColor, b: RGBColor) -> f64 {
        let square = |a: u8, b: u8| (f64::from(a) - f64::from(b)).powi(2);
        (square(a.0, b.0) + square(a.1, b.1) + square(a.2, b.2)).sqrt()
    }

    #[test]
    fn terms_have_the_page_s_colours() {
        let page = of_page();
        let first = |name: &str| page.iter().find(|(own, _)| *own == name).map(|it| it.1);
        assert_eq!(first("update"), Some(UPDATES[1]));
        assert_eq!(first("find"), Some(FINDING));
        assert_eq!(first("test"), Some(TESTS[1]));
    }

    #[test]
    fn a_colour_has_one_meaning() {
        let page = of_page();
        let pairs = ["reported", "meets", "missed", "cells", "pair-0", "pair-1"];
        let mut meanings: Vec<(&str, RGBColor)> =
            page.into_iter().filter(|(name, _)| pairs.contains(name)).collect();
        assert_eq!(meanings.len(), 2 * pairs.len() - 1, "orange is one on both grounds");
        for (names, colours) in [
            (["light updates", "updates", "dark updates"], UPDATES),
            (["light tests", "tests", "dark tests"], TESTS),
        ] {
            meanings.extend(names.into_iter().zip(colours));
        }
        meanings.extend([
            ("sphere", SPHERE),
            ("of interest", INTEREST),
            ("sequential", SEQUENTIAL),
            ("batch", BATCH),
            ("or-DOPs", ORDOPS),
        ]);
        meanings.extend(BY_K.map(|colour| ("sequential", colour)));
        for (at, (name, colour)) in meanings.iter().enumerate() {
            for (other, own) in &meanings[..at] {
                assert!(name == other || distance(*colour, *own) > 40.0, "{name} is like {other}");
            }
        }
    }
}
