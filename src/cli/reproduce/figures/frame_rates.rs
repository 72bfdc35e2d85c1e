//! The paper's Figs 12 and 13: frame rates of 500 objects in the crowded and in the usual box, for each F.

use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop::reproduce::paper_name;
use sdop::reproduce::rates::{ELSEWHERE, Rate};

use super::style::{GREY, PALE, anchored, colour, ends, label, text, titled};
use super::{Area, Drawn};
use crate::cli::reproduce::rows::Tables;

/// One panel a scene and F.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let most = tables
        .rates
        .iter()
        .map(|rate| rate.bodies)
        .max()
        .unwrap_or(0);
    let of_most = || tables.rates.iter().filter(|rate| rate.bodies == most);
    let mut scenes: Vec<&str> = Vec::new();
    for rate in of_most() {
        if !scenes.contains(&rate.scene.as_str()) {
            scenes.push(&rate.scene);
        }
    }
    scenes.sort_unstable();
    let title = format!("Frame rate of {most} objects, fps = 1/(F + t); whiskers: 95 % over seeds");
    let panels = titled(area, &title)?.split_evenly((ELSEWHERE.len(), scenes.len().max(1)));
    for (row, elsewhere) in ELSEWHERE.into_iter().enumerate() {
        for (column, scene) in scenes.iter().enumerate() {
            let rates: Vec<&Rate> = of_most()
                .filter(|rate| rate.scene == *scene && rate.elsewhere == elsewhere)
                .collect();
            let panel = &panels[row * scenes.len() + column];
            let fps = || rates.iter().map(|rate| rate.fps.mean);
            let (slowest, fastest) = (
                fps().fold(f64::INFINITY, f64::min),
                fps().fold(0.0, f64::max),
            );
            let title = format!("{scene}, F = {} ms", 1e3 * elsewhere);
            if elsewhere == 0.0 {
                let range = (0.5 * slowest..30.0 * fastest).log_scale();
                bars(
                    panel,
                    &title,
                    &rates,
                    range,
                    0.5 * slowest,
                    "frames a second (logarithmic)",
                )?;
            } else {
                bars(
                    panel,
                    &title,
                    &rates,
                    0.0..1.22 * fastest,
                    0.0,
                    "frames a second",
                )?;
            }
        }
    }
    Ok(())
}

/// Horizontal bars, the first strategy on top.
fn bars<X>(
    panel: &Area<'_>,
    title: &str,
    rates: &[&Rate],
    range: X,
    floor: f64,
    unit: &str,
) -> Drawn
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
    let ticks = |fps: &f64| match *fps {
        fps if fps >= 1e6 => format!("{}M", fps / 1e6),
        fps if fps >= 1e3 => format!("{}k", fps / 1e3),
        fps => format!("{fps}"),
    };
    chart
        .configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .x_labels(6)
        .x_desc(unit)
        .x_label_formatter(&ticks)
        .label_style(text(12))
        .axis_desc_style(text(13))
        .draw()?;
    for (i, rate) in rates.iter().enumerate() {
        let y = rows - 0.5 - i as f64;
        let fps = rate.fps.mean;
        let [lo, hi] = ends(&rate.fps);
        let (left, right, colour) = ((floor, y), (fps, y), colour(rate.strategy));
        if floor == 0.0 {
            chart.draw_series([Rectangle::new(
                [(floor, y - 0.33), (fps, y + 0.33)],
                colour.filled(),
            )])?;
        } else {
            // A logarithmic axis has no zero for a bar to stand on.
            chart.draw_series([PathElement::new(vec![left, right], colour.stroke_width(2))])?;
            chart.draw_series([Circle::new(right, 6, colour.filled())])?;
        }
        chart.draw_series([PathElement::new(
            vec![(lo.max(floor), y), (hi, y)],
            BLACK.stroke_width(2),
        )])?;
        let value = match fps {
            fps if fps >= 1e6 => format!("{:.1}M", fps / 1e6),
            fps if fps >= 1e3 => format!("{:.1}k", fps / 1e3),
            fps => format!("{fps:.1}"),
        };
        let area = chart.plotting_area();
        label(
            area,
            &(hi.max(fps), y),
            (7, 0),
            value,
            anchored(12, HPos::Left, VPos::Center),
        )?;
        let name = paper_name(rate.strategy).to_owned();
        label(
            area,
            &(floor, y),
            (-8, 0),
            name,
            anchored(13, HPos::Right, VPos::Center),
        )?;
    }
    Ok(())
}
