//! The result as tables for a terminal.

use sdop_bench::measure::turns::Regime;
use sdop_bench::report::digits::interval;
use sdop_bench::tradeoff::pays::{CHECKS, Choice, Standing, advice, choose};
use sdop_bench::tradeoff::{Tradeoff, VariantResult};

use crate::commands::output::{Column, Listing, counted, paragraphs, pivot, rows};

/// A title, and the quantities of the variants below it.
type Part = (&'static str, &'static [Column<'static>]);

/// The tables of `--all`, after the recommended variants. A line has those of its quantities that a
/// variant has.
const PARTS: [Part; 4] = [
    (
        "Every variant",
        &[
            ("reported", "reported", 1.0),
            ("precision", "precision", 1.0),
            ("reported / true", "reported / true", 1.0),
            ("recall", "recall", 1.0),
            ("volume / hull", "volume / hull", 1.0),
            ("warm µs", "time", 1e6),
            ("Co, ms", "Co", 1e3),
        ],
    ),
    (
        "Time-critical: precision against the budget of tests",
        &[
            ("refined", "refined", 1.0),
            ("precision", "precision", 1.0),
            ("recall", "recall", 1.0),
            ("mean age", "mean age", 1.0),
            ("oldest", "oldest", 1.0),
        ],
    ),
    (
        "Time-critical: the overrun of the clock, µs",
        &[("refined", "refined", 1.0), ("p50", "overrun p50", 1e6), ("p99", "overrun p99", 1e6)],
    ),
    (
        "Object of interest",
        &[
            ("or-DOP tests", "or-DOP tests", 1.0),
            ("reported", "reported", 1.0),
            ("precision", "precision", 1.0),
            ("warm µs", "time", 1e6),
            ("lazy, warm µs", "time, lazy", 1e6),
        ],
    ),
];

/// For people: the recommendation, the variants that aren't beaten, and on request all tables.
pub fn text(result: &Tradeoff, is_whole: bool) -> String {
    let mut parts = vec![advice(&result.cheapest, &result.narrow_phase)];
    parts.extend(result.conditions.warning());
    parts.extend([heading(result), unbeaten(result).to_string()]);
    if is_whole {
        let title = "The cheapest variant, by density and price of a check; * not alone";
        parts.push(format!("{title}\n{}", decisions(result)));
        let title = "The ns per check from which each is cheaper than spheres, by density";
        parts.push(format!("{title}\n{}", break_even(result)));
        let all = result.rows();
        for (title, columns) in PARTS {
            // The quantity that only the variants of this table have comes last.
            let own = columns[columns.len() - 1].1;
            let is_of =
                |variant: &str| all.iter().any(|row| row.variant == variant && row.metric == own);
            let rows: Vec<_> = all.iter().filter(|row| is_of(&row.variant)).cloned().collect();
            if !rows.is_empty() {
                parts.push(format!("{title}\n{}", pivot(&rows, Regime::Warm, false, columns)));
            }
        }
    } else {
        parts.push("--all prints the rest.".to_owned());
    }
    paragraphs(&parts.join("\n\n"))
}

/// The variants that no other one beats, the fastest first.
fn unbeaten(result: &Tradeoff) -> Listing {
    let mut shown: Vec<&VariantResult> =
        result.rows.iter().filter(|row| row.standing != Standing::Beaten).collect();
    shown.sort_by(|a, b| a.seconds().mean.total_cmp(&b.seconds().mean));
    let header = ["variant", "standing", "precision", "µs per warm frame", "false pairs"];
    rows(&header, &shown, |row| {
        vec![
            row.name.clone(),
            row.standing.to_string(),
            interval(&row.precision),
            interval(&row.seconds().scaled(1e6)),
            format!("{:.1}", row.reported.mean * (1.0 - row.precision.mean)),
        ]
    })
}

/// What was run.
fn heading(result: &Tradeoff) -> String {
    let Tradeoff { scene, bodies, samples, frames, seeds, partners, .. } = result;
    let simd = &result.machine.simd;
    format!(
        "{scene}: {bodies} bodies, {}, {samples} of {frames} frames of each judged, {simd}; {} true pairs per frame, \
         {partners:.2} sphere overlaps per body",
        counted(seeds.len(), "seed"),
        interval(&result.truth),
    )
}

/// One row per density, one column per price of a check: what to use.
fn decisions(result: &Tradeoff) -> Listing {
    let checks = CHECKS.map(|seconds| format!("{:.0} ns", 1e9 * seconds));
    let header = [&["overlaps per body"][..], &checks.each_ref().map(String::as_str)].concat();
    rows(&header, &result.densities, |density| {
        let name = |Choice { best, tied, .. }: Choice| match tied.is_empty() {
            true => best,
            false => format!("{best} *"),
        };
        let cell = |check| choose(&density.lines, check).map_or("–".to_owned(), name);
        std::iter::once(format!("{:.2}", density.partners)).chain(CHECKS.map(cell)).collect()
    })
}

/// One row per S-DOP, one column per density, which is in sphere overlaps per body.
fn break_even(result: &Tradeoff) -> Listing {
    let names: Vec<[String; 2]> = result
        .densities
        .iter()
        .map(|density| [format!("{:.2}", density.partners), density.metric("break-even")])
        .collect();
    let columns: Vec<Column<'_>> = names.iter().map(|[title, of]| (&**title, &**of, 1e9)).collect();
    pivot(&result.rows(), Regime::Warm, false, &columns)
}
