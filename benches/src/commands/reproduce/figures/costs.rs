//! T per strategy and N: the predicted terms stacked, the measured time as a mark.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop_bench::cost::table::Cost;
use sdop_bench::reproduce::paper_name;

use super::style::{PARTS, anchored, ends, label, legend, quiet, text, titled};
use super::{Area, Drawn};
use crate::commands::reproduce::rows::Tables;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// One panel a strategy, each with its own scale.
pub fn draw(area: &Area<'_>, tables: &Tables) -> Drawn {
    let body = titled(
        area,
        "T without construction, warm, µs per frame: terms predicted from other scenes' prices, and measured (•, 95 %)",
    )?;
    let body = keys(&body)?;
    let panels = body.split_evenly((2, 3));
    for (area, strategy) in panels.iter().zip(tables.strategies()) {
        let of = |cost: &&Cost| cost.strategy == strategy;
        let costs: Vec<&Cost> = tables.costs.iter().filter(of).collect();
        panel(area, paper_name(strategy), &costs, scene_name)?;
    }
    Ok(())
}

/// One panel with a column a strategy: what `sdop cost` draws of one scene.
pub fn draw_strategies(area: &Area<'_>, scene: &str, costs: &[&Cost]) -> Drawn {
    let title = format!(
        "{scene}: where a warm frame's time goes, µs: predicted terms, and measured (•, 95 %)"
    );
    let body = keys(&titled(area, &title)?)?;
    panel(&body, "", costs, |cost| cost.variant.replace("s-dop-", ""))
}

/// The legend; returns what is left of the area.
fn keys<'a>(area: &Area<'a>) -> Result<Area<'a>, super::Failure> {
    let (keys, body) = area.split_vertically(30);
    let parts: Vec<_> = PARTS
        .iter()
        .map(|part| (part.name, part.colour, false))
        .collect();
    legend(&keys, (14, 12), &parts)?;
    Ok(body)
}

fn scene_name(cost: &Cost) -> String {
    let name = cost.scene.replace("paper-", "");
    name.replace("crowded-500", "crowded")
}

fn panel(area: &Area<'_>, title: &str, costs: &[&Cost], name: fn(&Cost) -> String) -> Drawn {
    let highest = |cost: &&Cost| 1e6 * cost.frame.measured.mean.max(cost.frame.predicted.mean);
    let top = costs.iter().map(highest).fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(title, text(15))
        .margin(10)
        .x_label_area_size(26)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..costs.len() as f64, 0.0..1.2 * top)?;
    quiet(&mut chart.configure_mesh())
        .disable_x_mesh()
        .disable_x_axis()
        .y_labels(5)
        .y_label_formatter(&|microseconds| format!("{microseconds}"))
        .draw()?;
    for (i, cost) in costs.iter().enumerate() {
        column(&mut chart, i as f64, cost, name(cost))?;
    }
    Ok(())
}

/// One scene's stack with its mark, its value above and its name below.
fn column(chart: &mut Chart<'_, '_>, x: f64, cost: &Cost, name: String) -> Drawn {
    let mut base = 0.0;
    for part in &PARTS {
        let height = 1e6 * (part.of)(&cost.terms);
        let corners = [(x + 0.15, base), (x + 0.85, base + height)];
        chart.draw_series([Rectangle::new(corners, part.colour.filled())])?;
        base += height;
    }
    let (middle, mean) = (x + 0.5, 1e6 * cost.frame.measured.mean);
    let [lo, hi] = ends(&cost.frame.measured).map(|seconds| 1e6 * seconds);
    let whisker = vec![(middle, lo), (middle, hi)];
    chart.draw_series([PathElement::new(whisker, BLACK.stroke_width(2))])?;
    chart.draw_series([Circle::new((middle, mean), 4, BLACK.filled())])?;
    let digits = usize::from(mean < 10.0);
    let value = format!("{mean:.digits$}");
    let (top, above) = (
        (middle, hi.max(base)),
        anchored(11, HPos::Center, VPos::Bottom),
    );
    label(chart.plotting_area(), &top, (0, -8), value, above)?;
    let (foot, below) = ((middle, 0.0), anchored(12, HPos::Center, VPos::Top));
    label(chart.plotting_area(), &foot, (0, 8), name, below)
}
