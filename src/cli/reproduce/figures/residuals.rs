//! How well the formula predicts: measured over predicted, less one.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop::reproduce::paper_name;
use sdop::reproduce::terms::Cost;
use sdop::scene::settings::Strategy;

use super::style::{GREY, PALE, anchored, colour, ends, label, legend, text, titled};
use super::{Area, Drawn};
use crate::cli::reproduce::rows::Tables;

/// One group a scene, one mark a strategy.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let body = titled(
        area,
        "Residual of T = Nu·Cu + F + Nv·Cv: measured over predicted, less one (whiskers: 95 % over seeds)",
    )?;
    let (keys, body) = body.split_vertically(30);
    let (mut scenes, mut strategies): (Vec<&str>, Vec<Strategy>) = (Vec::new(), Vec::new());
    for cost in &tables.costs {
        if !scenes.contains(&cost.scene.as_str()) {
            scenes.push(&cost.scene);
        }
        if !strategies.contains(&cost.strategy) {
            strategies.push(cost.strategy);
        }
    }
    let named: Vec<_> = strategies
        .iter()
        .map(|&s| (paper_name(s), colour(s), false))
        .collect();
    legend(&keys, (14, 12), &named)?;
    let furthest = tables
        .costs
        .iter()
        .map(|cost| cost.residual.abs())
        .fold(0.1, f64::max);
    let limit = 100.0 * 1.2 * furthest;
    let mut chart = ChartBuilder::on(&body)
        .margin(12)
        .x_label_area_size(30)
        .y_label_area_size(54)
        .build_cartesian_2d(0.0..scenes.len() as f64, -limit..limit)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .disable_x_axis()
        .light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .y_desc("residual, %")
        .y_label_formatter(&|percent| format!("{percent:+.0}"))
        .label_style(text(12))
        .axis_desc_style(text(13))
        .draw()?;
    chart.draw_series([PathElement::new(
        vec![(0.0, 0.0), (scenes.len() as f64, 0.0)],
        GREY.stroke_width(1),
    )])?;
    for cost in &tables.costs {
        let group = scenes
            .iter()
            .position(|scene| *scene == cost.scene)
            .unwrap_or(0);
        let place = strategies
            .iter()
            .position(|&strategy| strategy == cost.strategy)
            .unwrap_or(0);
        let x = group as f64 + (place as f64 + 1.0) / (strategies.len() as f64 + 1.0);
        mark(&mut chart, cost, x)?;
    }
    for (group, scene) in scenes.iter().enumerate() {
        let at = (group as f64 + 0.5, -limit);
        label(
            chart.plotting_area(),
            &at,
            (0, 8),
            (*scene).to_owned(),
            anchored(13, HPos::Center, VPos::Top),
        )?;
    }
    Ok(())
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn mark(chart: &mut Chart<'_, '_>, cost: &Cost, x: f64) -> Drawn {
    let colour = colour(cost.strategy);
    let ends = ends(&cost.measured).map(|seconds| 100.0 * (seconds / cost.predicted - 1.0));
    chart.draw_series([PathElement::new(
        vec![(x, ends[0]), (x, ends[1])],
        colour.stroke_width(2),
    )])?;
    chart.draw_series([Circle::new((x, 100.0 * cost.residual), 5, colour.filled())])?;
    Ok(())
}
