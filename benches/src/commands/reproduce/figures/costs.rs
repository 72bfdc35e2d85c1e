//! T per strategy and N: the predicted terms stacked, the measured time as a mark.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sdop_bench::cost::table::Cost;
use sdop_bench::reproduce::paper_name;

use crate::commands::reproduce::rows::Drawings;
use crate::commands::style::{
    Area, CostPart, DrawError, DrawResult, PARTS, anchored, ends, label, legend, part_of, plain,
    quiet, text, titled,
};

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// One panel a strategy, each with its own scale.
pub fn draw(area: &Area<'_>, tables: &Drawings) -> DrawResult {
    let body = titled(
        area,
        "T without construction, warm, µs per frame: terms predicted from other scenes' prices, and measured (•, 95 %)",
    )?;
    let body = keys(&body, &tables.costs.iter().collect::<Vec<_>>())?;
    let panels = body.split_evenly((2, 3));
    for (area, strategy) in panels.iter().zip(tables.strategies()) {
        let of = |cost: &&Cost| cost.strategy == strategy;
        let costs: Vec<&Cost> = tables.costs.iter().filter(of).collect();
        panel(area, paper_name(strategy), &costs, scene_name)?;
    }
    Ok(())
}

/// A column per strategy: what `sdop cost` draws of one scene. Where some take far longer than
/// others, they have a panel of their own, so that the terms of all can be seen.
pub fn draw_strategies(area: &Area<'_>, scene: &str, costs: &[&Cost]) -> DrawResult {
    let title = format!(
        "{scene}: where a warm frame's time goes, µs: predicted terms, and measured (•, 95 %)"
    );
    let body = keys(&titled(area, &title)?, costs)?;
    let name = |cost: &Cost| cost.variant.replace("s-dop-", "");
    let (fast, slow) = apart(costs);
    if slow.is_empty() {
        return panel(&body, "", &fast, name);
    }
    let share = fast.len() as f64 / costs.len() as f64;
    let left = (f64::from(body.dim_in_pixel().0) * share.clamp(0.25, 0.75)) as i32;
    let (left, right) = body.split_horizontally(left);
    panel(&left, "", &fast, name)?;
    panel(&right, "on another scale", &slow, name)
}

/// Splits costs in two at the widest gap between neighbours by time, if the slowest takes so much
/// longer than the fastest that the terms of the fastest would be too low to see. The order within
/// each part stays.
fn apart<'a>(costs: &[&'a Cost]) -> (Vec<&'a Cost>, Vec<&'a Cost>) {
    const LEAST_TIME_RATIO: f64 = 4.0;
    let time = |cost: &Cost| cost.frame.measured.mean;
    let mut times: Vec<f64> = costs.iter().map(|&cost| time(cost)).collect();
    times.sort_by(f64::total_cmp);
    let gap = times.windows(2).max_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
    let border = match (gap, times.first(), times.last()) {
        (Some(gap), Some(first), Some(last)) if *last >= LEAST_TIME_RATIO * first => gap[0],
        _ => f64::INFINITY,
    };
    costs.iter().copied().partition(|&cost| time(cost) <= border)
}

/// The legend of the terms that there are; returns what is left of the area.
fn keys<'a>(area: &Area<'a>, costs: &[&Cost]) -> Result<Area<'a>, DrawError> {
    let there = |part: &&CostPart| costs.iter().any(|cost| part_of(&cost.terms, part) > 0.0);
    let parts: Vec<_> = PARTS.iter().filter(there).map(|part| (part.0, part.1, false)).collect();
    let rows: Vec<_> = parts.chunks(5).collect();
    let (keys, body) = area.split_vertically(10 + 20 * rows.len() as i32);
    for (row, parts) in rows.iter().enumerate() {
        legend(&keys, (14, 12 + 20 * row as i32), parts)?;
    }
    Ok(body)
}

fn scene_name(cost: &Cost) -> String {
    let name = cost.scene.replace("paper-", "");
    name.replace("crowded-500", "crowded")
}

fn panel(
    area: &Area<'_>,
    title: &str,
    costs: &[&Cost],
    name: impl Fn(&Cost) -> String,
) -> DrawResult {
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
        .y_label_formatter(&plain)
        .draw()?;
    for (i, cost) in costs.iter().enumerate() {
        column(&mut chart, i as f64, cost, name(cost))?;
    }
    Ok(())
}

/// One scene's stack with its mark, its value above and its name below.
fn column(chart: &mut Chart<'_, '_>, x: f64, cost: &Cost, name: String) -> DrawResult {
    let mut base = 0.0;
    for part in &PARTS {
        let height = 1e6 * part_of(&cost.terms, part);
        if height <= 0.0 {
            continue;
        }
        let corners = [(x + 0.15, base), (x + 0.85, base + height)];
        chart.draw_series([Rectangle::new(corners, part.1.filled())])?;
        base += height;
    }
    let (middle, mean) = (x + 0.5, 1e6 * cost.frame.measured.mean);
    let [lo, hi] = ends(&cost.frame.measured).map(|seconds| 1e6 * seconds);
    let whisker = vec![(middle, lo), (middle, hi)];
    chart.draw_series([PathElement::new(whisker, BLACK.stroke_width(2))])?;
    chart.draw_series([Circle::new((middle, mean), 4, BLACK.filled())])?;
    let digits = usize::from(mean < 10.0);
    let value = format!("{mean:.digits$}");
    let (top, above) = ((middle, hi.max(base)), anchored(11, HPos::Center, VPos::Bottom));
    label(chart.plotting_area(), &top, (0, -8), value, above)?;
    let (foot, below) = ((middle, 0.0), anchored(12, HPos::Center, VPos::Top));
    label(chart.plotting_area(), &foot, (0, 8), name, below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::style::{TESTS, UPDATES, page};
    use sdop::settings::Strategy;
    use sdop_bench::cost::table::CheckedPrediction;
    use sdop_bench::cost::terms::Terms;
    use sdop_bench::measure::counts::Volume;
    use sdop_bench::measure::turns::Regime;

    fn cost(strategy: Strategy, volume: Volume, microseconds: f64) -> Cost {
        let seconds = 1e-6 * microseconds;
        let compared = CheckedPrediction::of(&[[seconds, seconds]], &[seconds]);
        Cost {
            scene: "s".into(),
            bodies: 1,
            strategy,
            variant: strategy.name().into(),
            regime: Regime::Warm,
            level: None,
            frames: 1,
            terms: vec![Terms {
                volume,
                updates: 1.0,
                tests: 1.0,
                hits: 1.0,
                rows: 0.0,
                further: 0.0,
                construct: 0.0,
                update: 0.5 * seconds,
                finding: 0.25 * seconds,
                test: 0.25 * seconds,
            }],
            widths: Vec::new(),
            frame: compared,
            construct: compared,
            total: compared,
            fails: None,
        }
    }

    #[test]
    fn low_bars_have_a_panel() {
        let spheres =
            [19.0, 22.0, 56.0, 245.0].map(|us| cost(Strategy::Sphere, Volume::Sphere, us));
        let all: Vec<&Cost> = spheres.iter().collect();
        let times = |costs: &[&Cost]| -> Vec<f64> {
            costs.iter().map(|cost| (1e6 * cost.frame.measured.mean).round()).collect()
        };
        let (fast, slow) = apart(&all);
        assert_eq!((times(&fast), times(&slow)), (vec![19.0, 22.0, 56.0], vec![245.0]));
        // Within four times, one scale serves all.
        let (fast, slow) = apart(&all[..3]);
        assert_eq!((fast.len(), slow.len()), (3, 0));
    }

    /// The columns of a figure have their strategies' names, and each its terms' colours.
    #[test]
    fn every_bar_has_its_name() {
        let named = [
            (Strategy::Aabb, Volume::Aabb),
            (Strategy::KDop, Volume::KDop),
            (Strategy::Obb, Volume::Obb),
        ];
        let costs = named.map(|(strategy, volume)| cost(strategy, volume, 50.0));
        let drawn =
            page((1060, 480), |area| draw_strategies(area, "s", &costs.iter().collect::<Vec<_>>()));
        let drawn = drawn.unwrap_or_default();
        let lines: Vec<&str> = drawn.lines().map(str::trim).collect();
        for (strategy, _) in named {
            assert!(lines.contains(&strategy.name()), "{}: {drawn}", strategy.name());
        }
        for colour in [UPDATES[2], TESTS[2]] {
            let fill = format!("fill=\"#{:02X}{:02X}{:02X}\"", colour.0, colour.1, colour.2);
            let rectangles = lines.iter().filter(|line| line.starts_with("<rect"));
            assert_eq!(rectangles.filter(|line| line.contains(&fill)).count(), 3, "{fill}");
        }
    }

    /// Boxes have their own key and dear strategies their own panel.
    #[test]
    fn expensive_strategies_get_a_panel() {
        let sphere = cost(Strategy::Sphere, Volume::Sphere, 40.0);
        let obb = cost(Strategy::Obb, Volume::Obb, 900.0);
        let draw = |costs: &[&Cost]| {
            let drawn = page((1060, 480), |area| draw_strategies(area, "s", costs));
            drawn.unwrap_or_default()
        };
        let both = draw(&[&sphere, &obb]);
        assert!(both.contains("Nu·Cu aabb, k-dop, obb") && both.contains("on another scale"));
        // No or-DOP, no key of or-DOPs.
        assert!(!both.contains("or-DOPs"), "{both}");
        let one = draw(&[&sphere]);
        assert!(one.contains("Nu·Cu spheres") && !one.contains("obb") && !one.contains("scale"));
    }
}
