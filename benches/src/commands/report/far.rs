//! The figure of the record `kernels/far`: wrong pairs and time against distance from the origin.

use std::ops::Range;

use miette::miette;
use plotters::prelude::*;
use sdop_bench::report::Table;
use serde_json::{Map, Value};

use crate::commands::style::{Area, Chart, Curves, DrawResult, Stroke, draw_curves, page};

/// Where the axis of distances, which is logarithmic, has the origin.
const ORIGIN: f64 = 100.0;

/// The figure, as SVG.
///
/// # Errors
/// A table without these columns.
pub fn draw(table: &Table) -> miette::Result<String> {
    let (mut wrong, mut time) = (Curves::new(), Curves::new());
    for row in &table.rows {
        let (name, distance, [share, nanoseconds]) = point(row).ok_or_else(|| {
            miette!("`kernels/far` has not the columns of `cargo bench --bench far`")
        })?;
        let add = |curves: &mut Curves, y| {
            let points = curves.entry(name.to_owned()).or_default();
            points.push((distance.max(ORIGIN), y));
        };
        add(&mut wrong, 100.0 * share);
        add(&mut time, nanoseconds);
    }
    let most = |curves: &Curves| {
        let all = curves.values().flatten();
        1.1 * all.map(|point| point.1).fold(f64::MIN_POSITIVE, f64::max)
    };
    page((960, 720), |area| {
        let (upper, lower) = area.split_vertically(360);
        let y = "pairs lost or gained, % (log)";
        // A share of nothing at all is drawn at the lower end.
        let shares = 1e-3..most(&wrong).max(1.0);
        panel(&upper, &wrong, y, shares.log_scale())?;
        panel(&lower, &time, "ns per body and frame", 0.0..most(&time))
    })
}

/// A row's series, its distance, and the share of wrong pairs and nanoseconds per body.
fn point(row: &Map<String, Value>) -> Option<(&str, f64, [f64; 2])> {
    let number = |column: &str| row.get(column)?.as_f64();
    let [pairs, lost, extra] = ["pairs", "lost", "extra"].map(number);
    let (pairs, lost, extra) = (pairs?, lost?, extra?);
    let wanted = pairs - extra + lost;
    let share = (lost + extra) / wanted.max(1.0);
    let series = row.get("series")?.as_str()?;
    Some((series, number("distance")?, [share, number("ns_per_body")?]))
}

/// One quantity against distance, one curve per series.
fn panel<Y>(area: &Area<'_>, curves: &Curves, title: &str, values: Y) -> DrawResult
where
    Y: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
    Y::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
{
    let points = curves.values().flatten();
    let farthest = points.map(|point| point.0).fold(10.0 * ORIGIN, f64::max);
    let distances: Range<f64> = ORIGIN..farthest;
    let distance = |x: &f64| match x {
        x if *x <= ORIGIN => "0".to_owned(),
        x => format!("{x:e}"),
    };
    let chart = Chart {
        caption: "",
        titles: ["distance along each axis, radii (log)", title],
        x: distances.log_scale(),
        y: values,
        ticks: &distance,
        legend: SeriesLabelPosition::UpperLeft,
    };
    draw_curves(area, curves, |place, _| Stroke::plain(place), chart)
}
