//! T per strategy and N: the predicted terms stacked, the measured time as a mark.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop::reproduce::paper_name;
use sdop::reproduce::terms::Cost;

use super::style::{GREY, PALE, PARTS, anchored, ends, label, legend, text, titled};
use super::{Area, Drawn};
use crate::cli::reproduce::rows::Tables;

/// One panel a strategy, each with its own scale.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let body = titled(
        area,
        "T without construction, µs a frame: terms predicted from other scenes' prices, and measured (•, 95 % over seeds)",
    )?;
    let (keys, body) = body.split_vertically(30);
    let parts: Vec<_> = PARTS
        .iter()
        .map(|part| (part.name, part.colour, false))
        .collect();
    legend(&keys, (14, 12), &parts)?;
    let mut strategies = Vec::new();
    for cost in &tables.costs {
        if !strategies.contains(&cost.strategy) {
            strategies.push(cost.strategy);
        }
    }
    let panels = body.split_evenly((2, 3));
    for (panel, strategy) in panels.iter().zip(strategies) {
        let costs: Vec<&Cost> = tables
            .costs
            .iter()
            .filter(|cost| cost.strategy == strategy)
            .collect();
        stack(panel, paper_name(strategy), &costs)?;
    }
    Ok(())
}

fn stack(panel: &Area<'_>, title: &str, costs: &[&Cost]) -> Drawn {
    let top = costs
        .iter()
        .map(|cost| 1e6 * cost.measured.mean.max(cost.predicted))
        .fold(0.0, f64::max);
    let columns = costs.len() as f64;
    let mut chart = ChartBuilder::on(panel)
        .caption(title, text(15))
        .margin(10)
        .x_label_area_size(26)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..columns, 0.0..1.2 * top)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .disable_x_axis()
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .y_labels(5)
        .y_label_formatter(&|microseconds| format!("{microseconds}"))
        .label_style(text(12))
        .draw()?;
    for (i, cost) in costs.iter().enumerate() {
        let x = i as f64;
        let mut base = 0.0;
        for part in &PARTS {
            let height = 1e6 * (part.of)(&cost.terms);
            chart.draw_series([Rectangle::new(
                [(x + 0.15, base), (x + 0.85, base + height)],
                part.colour.filled(),
            )])?;
            base += height;
        }
        let [lo, hi] = ends(&cost.measured).map(|seconds| 1e6 * seconds);
        let middle = x + 0.5;
        chart.draw_series([PathElement::new(
            vec![(middle, lo), (middle, hi)],
            BLACK.stroke_width(2),
        )])?;
        chart.draw_series([Circle::new(
            (middle, 1e6 * cost.measured.mean),
            4,
            BLACK.filled(),
        )])?;
        let value = match 1e6 * cost.measured.mean {
            microseconds if microseconds < 10.0 => format!("{microseconds:.1}"),
            microseconds => format!("{microseconds:.0}"),
        };
        let top = hi.max(base);
        label(
            chart.plotting_area(),
            &(middle, top),
            (0, -8),
            value,
            anchored(11, HPos::Center, VPos::Bottom),
        )?;
        let name = cost
            .scene
            .replace("paper-", "")
            .replace("crowded-500", "crowded");
        label(
            chart.plotting_area(),
            &(middle, 0.0),
            (0, 8),
            name,
            anchored(12, HPos::Center, VPos::Top),
        )?;
    }
    Ok(())
}
