//! The paper's Figs 12 and 13: frame rates of 500 objects in the crowded and in the usual box, for
//! each F.

use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::rates::{OTHER_FRAME_SECONDS, Rate};

use crate::commands::reproduce::rows::{Drawings, distinct};
use crate::commands::style::{
    Area, DrawResult, anchored, colour, ends, label, quiet, text, titled,
};

/// One panel a scene and F.
pub fn draw(area: &Area<'_>, tables: &Drawings) -> DrawResult {
    let bodies = tables.rates.iter().map(|rate| rate.bodies);
    let most = bodies.max().unwrap_or(0);
    let of_most = || tables.rates.iter().filter(|rate| rate.bodies == most);
    let mut scenes = distinct(of_most().map(|rate| rate.scene.as_str()));
    scenes.sort_unstable();
    let title = format!("Frame rate of {most} objects, fps = 1/(F + t); whiskers: 95 % over seeds");
    let panels =
        titled(area, &title)?.split_evenly((OTHER_FRAME_SECONDS.len(), scenes.len().max(1)));
    for (row, elsewhere) in OTHER_FRAME_SECONDS.into_iter().enumerate() {
        for (column, scene) in scenes.iter().enumerate() {
            let of = |rate: &&Rate| rate.scene == *scene && rate.elsewhere == elsewhere;
            // Where all the time went to other processes, there is no rate.
            let has_rate = |rate: &&Rate| rate.fps.mean.is_finite();
            let rates: Vec<&Rate> = of_most().filter(of).filter(has_rate).collect();
            if rates.is_empty() {
                continue;
            }
            let panel = &panels[row * scenes.len() + column];
            let fps = || rates.iter().map(|rate| rate.fps.mean);
            let fastest = fps().fold(0.0, f64::max);
            let title = format!("{scene}, F = {} ms", 1e3 * elsewhere);
            if elsewhere == 0.0 {
                let floor = 0.5 * fps().fold(f64::INFINITY, f64::min);
                let range = (floor..30.0 * fastest).log_scale();
                let unit = "frames a second (logarithmic)";
                bars(panel, &title, &rates, range, floor, unit)?;
            } else {
                let range = 0.0..1.22 * fastest;
                bars(panel, &title, &rates, range, 0.0, "frames a second")?;
            }
        }
    }
    Ok(())
}

type Chart<'a, 'b, X> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, RangedCoordf64>>;

/// Horizontal bars, the first strategy on top.
fn bars<X>(
    panel: &Area<'_>,
    title: &str,
    rates: &[&Rate],
    range: X,
    floor: f64,
    unit: &str,
) -> DrawResult
where
    X: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
{
    let rows = rates.len() as f64;
    let mut chart = ChartBuilder::on(panel)
        .caption(title, text(15))
        .margin(10)
        .margin_right(18)
        .x_label_area_size(38)
        .y_label_area_size(92)
        .build_cartesian_2d(range, 0.0..rows)?;
    quiet(&mut chart.configure_mesh())
        .disable_y_mesh()
        .disable_y_axis()
        .x_labels(6)
        .x_desc(unit)
        .x_label_formatter(&|fps| short(*fps, 0))
        .draw()?;
    for (i, rate) in rates.iter().enumerate() {
        bar(&mut chart, rate, rows - 0.5 - i as f64, floor)?;
    }
    Ok(())
}

/// One strategy's rate, with its value to the right and its name to the left.
fn bar<X>(chart: &mut Chart<'_, '_, X>, rate: &Rate, y: f64, floor: f64) -> DrawResult
where
    X: Ranged<ValueType = f64>,
{
    let fps = rate.fps.mean;
    let [lo, hi] = ends(&rate.fps);
    let colour = colour(rate.strategy);
    if floor == 0.0 {
        let corners = [(floor, y - 0.33), (fps, y + 0.33)];
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
    } else {
        // A logarithmic axis has no zero for a bar to stand on.
        let stem = vec![(floor, y), (fps, y)];
        chart.draw_series([PathElement::new(stem, colour.stroke_width(2))])?;
        chart.draw_series([Circle::new((fps, y), 6, colour.filled())])?;
    }
    let whisker = vec![(lo.max(floor), y), (hi, y)];
    chart.draw_series([PathElement::new(whisker, BLACK.stroke_width(2))])?;
    let area = chart.plotting_area();
    let (end, right) = ((hi.max(fps), y), anchored(12, HPos::Left, VPos::Center));
    label(area, &end, (7, 0), short(fps, 1), right)?;
    let (start, left) = ((floor, y), anchored(13, HPos::Right, VPos::Center));
    let name = paper_name(rate.strategy).to_owned();
    label(area, &start, (-8, 0), name, left)
}

/// A rate in thousands or millions.
fn short(fps: f64, digits: usize) -> String {
    match fps {
        fps if fps >= 1e6 => format!("{:.digits$}M", fps / 1e6),
        fps if fps >= 1e3 => format!("{:.digits$}k", fps / 1e3),
        fps => format!("{fps:.digits$}"),
    }
}
