//! The figures, as SVG: precision against time, break-even against density, precision against
//! budget.

use std::collections::BTreeMap;
use std::error::Error;
use std::ops::Range;

use miette::miette;
use plotters::coord::Shift;
use plotters::prelude::*;
use sdop_bench::tradeoff::pays::Standing;
use sdop_bench::tradeoff::{Tradeoff, VariantResult};

use crate::commands::palette::{BLUE, GREEN, GREY, ORANGE, PALE, PURPLE, SKY, VERMILION};

const SIZE: (u32, u32) = (960, 600);
const FONT: &str = "sans-serif";
/// A colour a curve, in this order.
const COLOURS: [RGBColor; 7] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK];

type Points = Vec<(f64, f64)>;

/// Precision against time per frame: the Pareto front with error bars, and world-aligned boxes,
/// labelled at their points; what is tied is grey.
pub fn precision(result: &Tradeoff) -> miette::Result<String> {
    let front = front(result);
    let is_drawn_as = |row: &VariantResult, standing| match row.standing {
        Standing::Front => {
            standing == Standing::Tied && !front.iter().any(|other| other.name == row.name)
        }
        own => own == standing,
    };
    let boxes = result.rows.iter().find(|row| row.name == "aabb");
    let labelled: Vec<&VariantResult> = match boxes {
        Some(boxes) if !front.iter().any(|row| row.name == boxes.name) => {
            front.iter().copied().chain([boxes]).collect()
        }
        _ => front.clone(),
    };
    let times = span(result.rows.iter().map(|row| at(row).0));
    figure(|area| {
        let mut chart = ChartBuilder::on(&area)
            .caption(format!("{}: what accuracy costs", result.scene), (FONT, 20))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(56)
            .build_cartesian_2d((times.start / 1.5..times.end * 3.0).log_scale(), 0.0..1.0)?;
        chart
            .configure_mesh()
            .x_desc("time per warm frame, µs (log)")
            .x_label_formatter(&|microseconds| format!("{microseconds}"))
            .y_desc("precision: true pairs / reported pairs")
            .label_style((FONT, 14))
            .light_line_style(TRANSPARENT)
            .bold_line_style(PALE)
            .draw()?;
        for (standing, colour) in [
            (Standing::Beaten, RGBColor(190, 190, 190)),
            (Standing::Tied, GREY),
        ] {
            let rows = result.rows.iter().filter(|row| is_drawn_as(row, standing));
            let dots = rows.map(|row| Circle::new(at(row), 4, colour.filled()));
            chart
                .draw_series(dots)?
                .label(standing.name())
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        }
        let steps = front.iter().map(|row| at(row));
        chart.draw_series(LineSeries::new(steps, BLUE.stroke_width(2)))?;
        let points: Vec<(i32, i32)> = labelled
            .iter()
            .map(|row| chart.backend_coord(&at(row)))
            .collect();
        for (place, (row, offset)) in labelled.iter().zip(label_offsets(&points)).enumerate() {
            let colour = if place < front.len() { BLUE } else { GREY };
            let (time, precision) = at(row);
            let seconds = row.seconds();
            if seconds.half_width.is_finite() {
                let [lo, hi] = seconds.interval().map(|s| (1e6 * s).max(times.start / 1.5));
                let whisker =
                    PathElement::new([(lo, precision), (hi, precision)], colour.stroke_width(2));
                chart.draw_series([whisker])?;
            }
            let mark = EmptyElement::at((time, precision))
                + Circle::new((0, 0), 5, colour.filled())
                + PathElement::new([(6, 0), (offset.0 - 3, offset.1 + 6)], GREY)
                + Text::new(row.name.clone(), offset, (FONT, 13));
            chart.draw_series([mark])?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .border_style(RGBColor(200, 200, 200))
            .background_style(WHITE)
            .label_font((FONT, 14))
            .draw()?;
        Ok(())
    })
}

/// A variant's place: µs per warm frame, precision.
fn at(row: &VariantResult) -> (f64, f64) {
    (1e6 * row.seconds().mean, row.precision.mean)
}

/// The Pareto front as it is drawn, fastest first: without what another is drawn above and to the
/// left of.
fn front(result: &Tradeoff) -> Vec<&VariantResult> {
    let is_beaten = |row: &VariantResult| {
        let (time, precision) = at(row);
        let mut others = result.rows.iter().map(at);
        others.any(|other| other.0 <= time && other.1 >= precision && other != (time, precision))
    };
    let rows = result.rows.iter();
    let mut front: Vec<&VariantResult> = rows
        .filter(|row| row.standing == Standing::Front && !is_beaten(row))
        .collect();
    front.sort_by(|a, b| at(a).0.total_cmp(&at(b).0));
    front
}

/// Where the names of points go, in pixels from each: to the right, the lowest point's first, each
/// above the one below it where they would hide one another. Points are in pixels, down the page.
fn label_offsets(points: &[(i32, i32)]) -> Vec<(i32, i32)> {
    const HEIGHT: i32 = 15;
    const WIDTH: i32 = 200;
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|&at| -points[at].1);
    let mut tops = vec![0; points.len()];
    for (rank, &own) in order.iter().enumerate() {
        let mut top = points[own].1 + 3; // below the line, which rises
        // Names further down first: one that is moved up may come to lie over the next.
        for &other in &order[..rank] {
            let near = (points[own].0 - points[other].0).abs() < WIDTH;
            if near && (top - tops[other]).abs() < HEIGHT {
                top = tops[other] - HEIGHT;
            }
        }
        tops[own] = top;
    }
    let offset = |(point, top): (&(i32, i32), &i32)| (24, top - point.1);
    points.iter().zip(&tops).map(offset).collect()
}

/// For each S-DOP, the Cp above which it is cheaper than spheres alone, against density.
pub fn break_even(result: &Tradeoff) -> miette::Result<String> {
    let mut curves: BTreeMap<String, Points> = BTreeMap::new();
    for density in &result.densities {
        for even in density.break_even.iter().filter(|b| b.cp > 0.0) {
            let point = (density.partners, 1e9 * even.cp);
            curves.entry(even.name.clone()).or_default().push(point);
        }
    }
    let reference = 1e9 * result.narrow_phase.miss;
    let densities = span(curves.values().flatten().map(|p| p.0));
    let prices = span(curves.values().flatten().map(|p| p.1).chain([reference]));
    curves.insert(
        "exact narrow phase".into(),
        vec![(densities.start, reference), (densities.end, reference)],
    );
    let legend_room = 6.0;
    lines(
        &curves,
        &format!("{}: when an or-DOP pays", result.scene),
        [
            "sphere overlaps a body (log)",
            "Cp, ns a surviving pair (log)",
        ],
        (densities.start..densities.end * legend_room).log_scale(),
        (prices.start / 1.5..prices.end * 1.5).log_scale(),
    )
}

/// Precision against the budget of tests, a curve an order.
pub fn budget(result: &Tradeoff) -> miette::Result<String> {
    let mut curves: BTreeMap<String, Points> = BTreeMap::new();
    for row in &result.budgets {
        let point = (row.tests as f64, row.precision);
        curves.entry(row.order.to_string()).or_default().push(point);
    }
    let most = result
        .budgets
        .iter()
        .map(|row| row.tests)
        .max()
        .unwrap_or(1);
    lines(
        &curves,
        &format!("{}: time-critical culling", result.scene),
        [
            "or-DOP tests a frame",
            "precision: true pairs / reported pairs",
        ],
        0.0..1.4 * most.max(1) as f64,
        0.0..1.0_f64,
    )
}

/// Named curves with a legend on the right.
fn lines<X, Y>(
    curves: &BTreeMap<String, Points>,
    caption: &str,
    axes: [&str; 2],
    x: X,
    y: Y,
) -> miette::Result<String>
where
    X: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
    Y: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
    X::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
    Y::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
{
    figure(|area| {
        let mut chart = ChartBuilder::on(&area)
            .caption(caption, (FONT, 20))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(64)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(axes[0])
            .y_desc(axes[1])
            .label_style((FONT, 14))
            .light_line_style(TRANSPARENT)
            .bold_line_style(PALE)
            .draw()?;
        for (place, (name, points)) in curves.iter().enumerate() {
            let colour = COLOURS[place % COLOURS.len()];
            // Beyond the palette, thinner lines.
            let style = colour.stroke_width(if place < COLOURS.len() { 3 } else { 1 });
            let line = LineSeries::new(points.iter().copied(), style).point_size(3);
            chart
                .draw_series(line)?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .border_style(RGBColor(200, 200, 200))
            .background_style(WHITE)
            .label_font((FONT, 12))
            .draw()?;
        Ok(())
    })
}

/// Draws on a white page and returns the SVG.
fn figure(
    draw: impl FnOnce(DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Box<dyn Error>>,
) -> miette::Result<String> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    area.fill(&WHITE)
        .map_err(Into::into)
        .and_then(|()| draw(area))
        .map_err(|error: Box<dyn Error>| miette!("cannot draw: {error}"))?;
    Ok(text)
}

/// From the least to the greatest positive value; one decade about 1 when there is none.
fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let positive = values.filter(|value| *value > 0.0 && value.is_finite());
    let (lo, hi) = positive.fold((f64::INFINITY, 0.0_f64), |(lo, hi), v| {
        (lo.min(v), hi.max(v))
    });
    if lo < hi { lo..hi } else { 0.3..3.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of near points lie above one another and far ones stay.
    #[test]
    fn near_labels_are_stacked() {
        let points = [(100, 300), (110, 298), (105, 297), (600, 300)];
        let tops: Vec<i32> = label_offsets(&points)
            .iter()
            .zip(points)
            .map(|(offset, point)| offset.1 + point.1)
            .collect();
        assert_eq!(tops, [303, 288, 273, 303]);
    }
}
