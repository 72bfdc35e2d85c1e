//! How well the formula predicts: measured / predicted − 1.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop_bench::cost::table::Cost;
use sdop_bench::reproduce::paper_name;

use crate::commands::reproduce::rows::Drawings;
use crate::commands::style::{
    Area, DrawResult, GREY, anchored, colour, ends, label, legend, quiet, titled,
};

/// One group a scene, one mark a strategy.
pub fn draw(area: &Area<'_>, tables: &Drawings) -> DrawResult {
    let body = titled(
        area,
        "Residual of T = Nu·Cu + F + Nv·Cv: measured over predicted, less one, warm frames (whiskers: 95 %)",
    )?;
    let (keys, body) = body.split_vertically(30);
    let (scenes, strategies) = (tables.scenes(), tables.strategies());
    let named: Vec<_> = strategies.iter().map(|&s| (paper_name(s), colour(s), false)).collect();
    legend(&keys, (14, 12), &named)?;
    let sizes = tables.costs.iter().map(|cost| cost.frame.residual.mean.abs());
    let limit = 120.0 * sizes.fold(0.1, f64::max);
    let mut chart = ChartBuilder::on(&body)
        .margin(12)
        .x_label_area_size(30)
        .y_label_area_size(54)
        .build_cartesian_2d(0.0..scenes.len() as f64, -limit..limit)?;
    quiet(&mut chart.configure_mesh())
        .disable_x_mesh()
        .disable_x_axis()
        .y_desc("residual, %")
        .y_label_formatter(&|percent| format!("{percent:+.0}"))
        .draw()?;
    let zero = vec![(0.0, 0.0), (scenes.len() as f64, 0.0)];
    chart.draw_series([PathElement::new(zero, GREY.stroke_width(1))])?;
    for (group, scene) in scenes.iter().enumerate() {
        for (place, strategy) in strategies.iter().enumerate() {
            let x = group as f64 + (place as f64 + 1.0) / (strategies.len() as f64 + 1.0);
            let of = |cost: &&Cost| cost.scene == *scene && cost.strategy == *strategy;
            for cost in tables.costs.iter().filter(of) {
                mark(&mut chart, cost, x)?;
            }
        }
        let (at, style) = ((group as f64 + 0.5, -limit), anchored(13, HPos::Center, VPos::Top));
        let name = (*scene).to_owned();
        label(chart.plotting_area(), &at, (0, 8), name, style)?;
    }
    Ok(())
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn mark(chart: &mut Chart<'_, '_>, cost: &Cost, x: f64) -> DrawResult {
    let colour = colour(cost.strategy);
    let ends = ends(&cost.frame.residual).map(|share| 100.0 * share);
    chart.draw_series([PathElement::new(
        vec![(x, ends[0]), (x, ends[1])],
        colour.stroke_width(2),
    )])?;
    chart.draw_series([Circle::new((x, 100.0 * cost.frame.residual.mean), 5, colour.filled())])?;
    Ok(())
}
