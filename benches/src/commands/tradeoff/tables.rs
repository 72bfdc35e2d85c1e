//! The result as tables for a terminal.

use comfy_table::Table;
use sdop_bench::cost::table::CheckedPrediction;
use sdop_bench::cost::terms::Terms;
use sdop_bench::tradeoff::pays::{CHECKS, Standing, choose};
use sdop_bench::tradeoff::{Estimate, Tradeoff, VariantResult};

use crate::commands::output::{rows, table};

/// For people: the recommendation, then a short table.
pub fn brief(result: &Tradeoff) -> String {
    let front: Vec<VariantResult> = {
        let shown = result.rows.iter().filter(|row| row.standing != Standing::Beaten);
        let mut shown: Vec<VariantResult> = shown.cloned().collect();
        shown.sort_by(|a, b| a.seconds().mean.total_cmp(&b.seconds().mean));
        shown
    };
    let header = ["variant", "standing", "precision", "µs per warm frame", "false pairs"];
    let short = rows(&header, &front, |row| {
        vec![
            row.name.clone(),
            row.standing.to_string(),
            plus_minus(&row.precision, 1.0, 3),
            plus_minus(&row.seconds(), 1e6, 1),
            format!("{:.1}", row.reported.mean * (1.0 - row.precision.mean)),
        ]
    });
    let mut parts = vec![result.advice.clone()];
    parts.extend(result.conditions.warning());
    parts.extend([heading(result), short.to_string()]);
    parts.extend(in_worlds(result));
    parts.push("--all prints the rest.".to_owned());
    parts.join("\n\n")
}

/// Everything, for people.
pub fn text(result: &Tradeoff) -> String {
    let mut parts = vec![result.advice.clone()];
    parts.extend(result.conditions.warning());
    parts.extend([
        heading(result),
        "Which variant, by density and price of a narrow-phase check".into(),
        decisions(result).to_string(),
        variants(result).to_string(),
    ]);
    parts.extend(in_worlds(result));
    parts.extend([
        "Time-critical: precision against the budget of tests".into(),
        budgets(result).to_string(),
        "Time-critical: the clock overrun, microseconds".into(),
        clock(result).to_string(),
        "Object of interest".into(),
        interest(result).to_string(),
        "Cp (ns) above which each pays, spheres alone before it, by density".into(),
        break_even(result).to_string(),
    ]);
    parts.join("\n\n")
}

/// For a scene in which bodies fall asleep: each variant in a culler and in a world, the fastest
/// world first.
fn in_worlds(result: &Tradeoff) -> Option<String> {
    let mut fastest = result.worlds.clone();
    fastest.sort_by(|a, b| a.world.mean.total_cmp(&b.world.mean));
    let header = ["variant", "reported", "culler, warm µs", "world, warm µs"];
    let times = rows(&header, &fastest, |row| {
        vec![
            row.variant.clone(),
            format!("{:.1}", row.reported),
            plus_minus(&row.culler, 1e6, 1),
            plus_minus(&row.world, 1e6, 1),
        ]
    });
    let title = "Bodies fall asleep: a culler is given every pose, a world keeps the pairs of those that stay";
    (!fastest.is_empty()).then(|| format!("{title}\n\n{times}"))
}

/// One row per density, one column per price of a check: what to use, and what is tied with it.
pub fn decisions(result: &Tradeoff) -> Table {
    let checks = CHECKS.map(nanoseconds);
    let header =
        [&["sphere overlaps per body"][..], &checks.each_ref().map(String::as_str)].concat();
    rows(&header, &result.densities, |density| {
        let choice = |check: f64| choose(&density.lines, check);
        let cell = |check| choice(check).map_or("–".into(), |c| with_ties(&c.best, &c.tied));
        let best = CHECKS.map(cell);
        std::iter::once(format!("{:.2}", density.partners)).chain(best).collect()
    })
}

fn with_ties(best: &str, tied: &[String]) -> String {
    match tied {
        [] => best.to_owned(),
        [one] => format!("{best} (tied: {one})"),
        [one, rest @ ..] => format!("{best} (tied: {one} and {} more)", rest.len()),
    }
}

fn nanoseconds(seconds: f64) -> String {
    format!("{:.0} ns a check", 1e9 * seconds)
}

/// What was run.
pub fn heading(result: &Tradeoff) -> String {
    format!(
        "{}: {} bodies, {} of {} frames judged, seeds {:?}, {}; {} true pairs a frame, {:.2} sphere overlaps a body",
        result.scene,
        result.bodies,
        result.samples,
        result.frames,
        result.seeds,
        result.simd,
        plus_minus(&result.truth, 1.0, 1),
        result.partners,
    )
}

/// The mean and its interval, scaled.
pub fn plus_minus(estimate: &Estimate, scale: f64, digits: usize) -> String {
    let (mean, half) = (scale * estimate.mean, scale * estimate.half_width);
    if half.is_finite() {
        format!("{mean:.digits$} ± {half:.digits$}")
    } else {
        format!("{mean:.digits$}")
    }
}

/// One row per variant, with its relation to the Pareto front.
pub fn variants(result: &Tradeoff) -> Table {
    let header = [
        "variant",
        "standing",
        "precision",
        "reported / true",
        "recall",
        "volume / hull",
        "Nu",
        "Nv",
        "Nu·Cu µs",
        "F µs",
        "Nv·Cv µs",
        "sum µs",
        "warm µs",
        "residual %",
        "cold µs",
        "residual %",
        "Co ms",
        "residual %",
    ];
    rows(&header, &result.rows, variant)
}

fn variant(row: &VariantResult) -> Vec<String> {
    let terms = row.warm.as_ref().map_or(&[][..], |cost| &cost.terms);
    let joined = |term: fn(&Terms) -> f64| {
        let terms: Vec<String> = terms.iter().map(|t| format!("{:.0}", term(t))).collect();
        terms.join(" + ")
    };
    let sum = |term: fn(&Terms) -> f64| format!("{:.1}", 1e6 * terms.iter().map(term).sum::<f64>());
    let compared = |cost: Option<&CheckedPrediction>, scale: f64| {
        let cells = cost.map(|cost| {
            let residual = format!("{:+.1}", 100.0 * cost.residual.mean);
            [plus_minus(&cost.measured, scale, 1), residual]
        });
        cells.unwrap_or_default()
    };
    let mut cells = vec![
        row.name.clone(),
        row.standing.to_string(),
        plus_minus(&row.precision, 1.0, 3),
        plus_minus(&row.per_true, 1.0, 2),
        if row.recall == 1.0 { "1".into() } else { format!("{:.6}", row.recall) },
        row.volume_over_hull.map_or("–".into(), |ratio| format!("{ratio:.2}")),
        joined(|t| t.updates),
        joined(|t| t.tests),
        sum(|t| t.update),
        sum(|t| t.finding),
        sum(|t| t.test),
        sum(Terms::recurring),
    ];
    cells.extend(compared(row.warm.as_ref().map(|cost| &cost.frame), 1e6));
    cells.extend(compared(row.cold.as_ref().map(|cost| &cost.frame), 1e6));
    cells.extend(compared(row.warm.as_ref().map(|cost| &cost.construct), 1e3));
    cells
}

/// A line an order and budget.
pub fn budgets(result: &Tradeoff) -> Table {
    let header = ["order", "tests / frame", "refined", "precision", "recall", "mean age", "oldest"];
    rows(&header, &result.budgets, |row| {
        vec![
            row.order.to_string(),
            row.tests.to_string(),
            format!("{:.3}", row.refined),
            format!("{:.3}", row.precision),
            format!("{}", row.recall),
            format!("{:.1}", row.mean_age),
            row.oldest.to_string(),
        ]
    })
}

/// A line a clock budget.
pub fn clock(result: &Tradeoff) -> Table {
    let header = ["budget µs", "refined", "overrun p50", "overrun p99"];
    rows(&header, &result.clock, |row| {
        vec![
            row.microseconds.to_string(),
            format!("{:.3}", row.refined),
            format!("{:+.1}", row.p50),
            format!("{:+.1}", row.p99),
        ]
    })
}

/// A line an interest set.
pub fn interest(result: &Tradeoff) -> Table {
    let header = [
        "of interest",
        "or-DOP tests",
        "reported",
        "precision",
        "recall",
        "warm µs",
        "lazy, warm µs",
    ];
    rows(&header, &result.interest, |row| {
        vec![
            row.bodies.to_string(),
            format!("{:.1}", row.tests),
            format!("{:.1}", row.reported),
            format!("{:.3}", row.quality.precision),
            format!("{}", row.quality.recall),
            plus_minus(&row.seconds, 1e6, 1),
            plus_minus(&row.lazy_seconds, 1e6, 1),
        ]
    })
}

/// One line per density, one column per S-DOP.
pub fn break_even(result: &Tradeoff) -> Table {
    let names = result
        .densities
        .first()
        .map_or(Vec::new(), |density| density.break_even.iter().map(|b| b.name.as_str()).collect());
    let mut header = vec!["partners", "sphere hits"];
    header.extend(&names);
    let mut rows = table(&header);
    for density in &result.densities {
        let hits = density.lines.first().map_or(0.0, |line| line.pairs);
        let mut cells = vec![format!("{:.3}", density.partners), format!("{hits:.1}")];
        cells.extend(names.iter().map(|name| {
            let found = density.break_even.iter().find(|b| b.name == *name);
            found.map_or("–".into(), |b| format!("{:.0}", 1e9 * b.cp))
        }));
        rows.add_row(cells);
    }
    rows
}
