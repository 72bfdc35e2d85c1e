//! The figures, as SVG: precision against time, break-even against density, precision against
//! budget.

use std::ops::Range;

use plotters::prelude::*;
use sdop_bench::tradeoff::pays::Standing;
use sdop_bench::tradeoff::{Tradeoff, VariantResult};

use crate::commands::style::{
    BY_K, Chart, Curves, GREY, LIGHT, Stroke, draw_curves, page, plain, quiet, text,
};

const SIZE: (u32, u32) = (960, 600);

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
    page(SIZE, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(format!("{}: what accuracy costs", result.scene), text(17))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(56)
            .build_cartesian_2d((times.start / 1.5..times.end * 3.0).log_scale(), 0.0..1.0)?;
        quiet(&mut chart.configure_mesh())
            .x_desc("time per warm frame, µs (log)")
            .x_label_formatter(&plain)
            .y_desc("precision: true pairs / reported pairs")
            .y_label_formatter(&plain)
            .draw()?;
        for (standing, colour) in [(Standing::Beaten, LIGHT), (Standing::Tied, GREY)] {
            let rows = result.rows.iter().filter(|row| is_drawn_as(row, standing));
            let dots = rows.map(|row| Circle::new(at(row), 4, colour.filled()));
            chart
                .draw_series(dots)?
                .label(standing.name())
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        }
        let steps = front.iter().map(|row| at(row));
        let line = BLACK.stroke_width(2);
        chart
            .draw_series(LineSeries::new(steps, line))?
            .label("front")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], line));
        let pixel = |row: &VariantResult| chart.backend_coord(&at(row));
        let dots: Vec<(i32, i32)> = result.rows.iter().map(pixel).collect();
        let names: Vec<(&str, (i32, i32))> =
            labelled.iter().map(|row| (row.name.as_str(), pixel(row))).collect();
        let offsets = label_offsets(&names, &dots);
        for (place, (row, offset)) in labelled.iter().zip(offsets).enumerate() {
            let colour = if place < front.len() { BLACK } else { GREY };
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
                + PathElement::new([(0, 0), (offset.0 - 3, offset.1 + 6)], GREY)
                + Text::new(row.name.clone(), offset, text(13));
            chart.draw_series([mark])?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .border_style(LIGHT)
            .background_style(WHITE)
            .label_font(text(13))
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
    let mut front: Vec<&VariantResult> =
        rows.filter(|row| row.standing == Standing::Front && !is_beaten(row)).collect();
    front.sort_by(|a, b| at(a).0.total_cmp(&at(b).0));
    front
}

/// Where the names of points go, in pixels from each: to the right, as near as they can be without
/// hiding a dot or another name. Dots are in pixels, down the page.
fn label_offsets(names: &[(&str, (i32, i32))], dots: &[(i32, i32)]) -> Vec<(i32, i32)> {
    const HEIGHT: i32 = 15;
    /// Steps down and up, the nearest first; then further to the right.
    const PLACES: [i32; 13] = [3, -17, 18, -32, 33, -47, 48, -62, 63, -77, 78, -92, 93];
    let mut taken: Vec<[i32; 4]> =
        dots.iter().map(|&(x, y)| [x - 6, y - 6, x + 6, y + 6]).collect();
    let mut offsets = Vec::new();
    for &(name, (x, y)) in names {
        let width = 7 * name.chars().count() as i32;
        let of =
            |(right, down): (i32, i32)| [x + right, y + down, x + right + width, y + down + HEIGHT];
        let is_free = |offset: &(i32, i32)| {
            let own = of(*offset);
            taken.iter().all(|other| {
                own[2] <= other[0] || other[2] <= own[0] || own[3] <= other[1] || other[3] <= own[1]
            })
        };
        let further = [14, 40, 70, 110].into_iter();
        let mut places = further.flat_map(|right| PLACES.map(|down| (right, down)));
        let offset = places.find(is_free).unwrap_or((14, PLACES[0]));
        taken.push(of(offset));
        offsets.push(offset);
    }
    offsets
}

/// For each S-DOP with a two-sided test, the Cp above which it is cheaper than spheres alone,
/// against density.
pub fn break_even(result: &Tradeoff) -> miette::Result<String> {
    let mut curves = Curves::new();
    for density in &result.densities {
        for even in density.break_even.iter().filter(|b| b.cp > 0.0 && by_k(&b.name).is_some()) {
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
    let stroke = |place, name: &str| by_k(name).unwrap_or(Stroke::plain(place));
    let legend_room = 6.0;
    let chart = Chart {
        caption: &format!("{}: when an or-DOP pays", result.scene),
        titles: ["sphere overlaps per body (log)", "Cp, ns per surviving pair (log)"],
        x: (densities.start..densities.end * legend_room).log_scale(),
        y: (prices.start / 1.5..prices.end * 1.5).log_scale(),
        ticks: &plain,
        legend: SeriesLabelPosition::UpperRight,
    };
    page(SIZE, |area| draw_curves(area, &curves, stroke, chart))
}

/// The curve of an S-DOP with a two-sided test, coloured by its k.
fn by_k(name: &str) -> Option<Stroke> {
    let (k, _) = name.strip_prefix("s-dop ")?.split_once(", ")?;
    let known = ["6", "14", "18", "26"].iter().position(|own| *own == k)?;
    let stroke = Stroke { colour: BY_K[known], is_dashed: false, has_rings: false };
    name.ends_with("two-sided").then_some(stroke)
}

/// Precision against the budget of tests, a curve per order.
pub fn budget(result: &Tradeoff) -> miette::Result<String> {
    let mut curves = Curves::new();
    for row in &result.budgets {
        let point = (row.tests as f64, row.precision);
        curves.entry(row.order.to_string()).or_default().push(point);
    }
    let most = result.budgets.iter().map(|row| row.tests).max();
    let chart = Chart {
        caption: &format!("{}: time-critical culling", result.scene),
        titles: ["or-DOP tests per frame", "precision: true pairs / reported pairs"],
        x: 0.0..1.4 * most.unwrap_or(1).max(1) as f64,
        y: 0.0..1.0_f64,
        ticks: &plain,
        legend: SeriesLabelPosition::UpperRight,
    };
    let stroke = |place, _: &str| Stroke::plain(place);
    page(SIZE, |area| draw_curves(area, &curves, stroke, chart))
}

/// From the least to the greatest positive value; one decade about 1 when there is none.
fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let positive = values.filter(|value| *value > 0.0 && value.is_finite());
    let (lo, hi) = positive.fold((f64::INFINITY, 0.0_f64), |(lo, hi), v| (lo.min(v), hi.max(v)));
    if lo < hi { lo..hi } else { 0.3..3.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use sdop::Tier;
    use sdop_bench::measure::conditions::Conditions;
    use sdop_bench::measure::machine::Machine;

    use super::*;

    /// A comparison of variants with these names, microseconds, precisions and standings.
    fn compared(rows: &[(&str, f64, f64, Standing)]) -> Tradeoff {
        let estimate = |mean: f64| serde_json::json!({"mean": mean, "half_width": 0.0, "seeds": 1});
        let rows: Vec<_> = rows
            .iter()
            .map(|(name, microseconds, precision, standing)| {
                serde_json::json!({
                    "name": name, "reported": estimate(1.0), "precision": estimate(*precision),
                    "precisions": [precision], "per_true": estimate(1.0), "recall": 1.0,
                    "volume_over_hull": null, "times": [1e-6 * microseconds],
                    "standing": standing, "pairs_sha256": [],
                })
            })
            .collect();
        serde_json::from_value(serde_json::json!({
            "command": "", "machine": Machine::here(Tier::SCALAR), "scene": "s", "bodies": 2,
            "frames": 1, "samples": 1, "seeds": [1], "truth": estimate(1.0), "partners": 1.0,
            "narrow_phase": {"miss": 1e-6, "hit": 1e-6}, "rows": rows, "cheapest": [], "densities": [], "budgets": [],
            "clock": [], "interest": [], "conditions": Conditions::default(),
        }))
        .unwrap()
    }

    #[test]
    fn only_the_front_is_named() {
        let rows = [
            ("fast", 10.0, 0.3, Standing::Front),
            ("middle", 30.0, 0.6, Standing::Front),
            // A slower one of the same precision, which its interval has kept on the front.
            ("level", 40.0, 0.6, Standing::Front),
            ("tight", 2000.0, 0.9, Standing::Front),
            ("aabb", 400.0, 0.4, Standing::Beaten),
            ("other", 500.0, 0.35, Standing::Beaten),
        ];
        let result = compared(&rows);
        let names: Vec<&str> = front(&result).iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["fast", "middle", "tight"]);
        let drawn = precision(&result).unwrap();
        let words: Vec<&str> = drawn.lines().map(str::trim).collect();
        for name in ["fast", "middle", "tight", "aabb", "10", "100", "1000", "0.5", "1"] {
            assert!(words.contains(&name), "{name}: {drawn}");
        }
        for name in ["level", "other", "100.0", "1000.0", "1.0"] {
            assert!(!words.contains(&name), "{name}: {drawn}");
        }
        let black = drawn.lines().filter(|it| it.starts_with("<circle") && it.contains("#000000"));
        assert_eq!(black.count(), 3, "a dot for each on the front");
    }

    /// Names hide no dot and no other name.
    #[test]
    fn names_hide_nothing() {
        let dots = [(100, 300), (110, 298), (105, 297), (130, 305), (600, 300)];
        let names = dots.map(|dot| ("s-dop 18, one-sided", dot));
        let offsets = label_offsets(&names, &dots);
        let mut boxes: Vec<[i32; 4]> = names
            .iter()
            .zip(offsets)
            .map(|((name, (x, y)), (right, down))| {
                let width = 7 * name.len() as i32;
                [x + right, y + down, x + right + width, y + down + 15]
            })
            .collect();
        boxes.extend(dots.map(|(x, y)| [x - 4, y - 4, x + 4, y + 4]));
        for (at, own) in boxes.iter().enumerate() {
            for other in &boxes[at + 1..] {
                let apart = own[2] <= other[0] || other[2] <= own[0];
                let apart = apart || own[3] <= other[1] || other[3] <= own[1];
                // Dots may lie on one another.
                assert!(apart || own[2] - own[0] == 8, "{own:?} {other:?}");
            }
        }
    }
}
