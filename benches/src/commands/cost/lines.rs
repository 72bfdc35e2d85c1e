//! The formula's numbers as CSV: one number per line, with its meaning, unit and interval.

use sdop_bench::cost::study::CostReport;
use sdop_bench::cost::table::{CheckedPrediction, Cost, PriceRow};
use sdop_bench::cost::terms::{TermWidths, Terms};
use sdop_bench::measure::turns::Regime;
use sdop_bench::reproduce::Estimate;
use serde::Serialize;

/// One number.
#[derive(Serialize)]
pub struct Line<'a> {
    pub scene: &'a str,
    pub strategy: &'a str,
    pub regime: Option<Regime>,
    /// The volume, where it is a number of one.
    pub volume: &'a str,
    pub term: &'static str,
    pub unit: &'static str,
    pub value: f64,
    /// Half the width of its 95 % interval; empty where there is none.
    pub half_width: f64,
}

/// Counts, terms, sums and prices of every strategy, warm and cold.
pub fn of_report(report: &CostReport) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = report.costs.iter().flat_map(of_cost).collect();
    for price in &report.prices {
        lines.extend(of_price(&report.scene, price));
    }
    lines
}

/// Counts, terms and sums of one strategy in one regime.
pub fn of_cost(cost: &Cost) -> Vec<Line<'_>> {
    let mut lines = Vec::new();
    let mut line = |volume, term, unit, value, half_width| {
        lines.push(Line {
            scene: &cost.scene,
            strategy: &cost.variant,
            regime: Some(cost.regime),
            volume,
            term,
            unit,
            value,
            half_width,
        });
    };
    // Earlier records have no intervals of terms.
    let widths = cost.widths.iter().map(Some).chain(std::iter::repeat(None));
    for (terms, widths) in cost.terms.iter().zip(widths) {
        for (term, value) in
            [("queried", terms.queried), ("thawed", terms.thawed), ("kept", terms.kept)]
        {
            // Cullers without a world count no such bodies.
            if value > 0.0 {
                line(terms.volume.name(), term, "per frame", value, f64::INFINITY);
            }
        }
        for (term, unit, value, width) in TERMS {
            let half_width = widths.map_or(f64::INFINITY, width);
            line(terms.volume.name(), term, unit, value(terms), half_width);
        }
    }
    for (names, unit, compared) in [
        (["sum", "measured", "residual"], "s per frame", &cost.frame),
        (["Co predicted", "Co measured", "Co residual"], "s", &cost.construct),
        (["T predicted", "T measured", "T residual"], "s", &cost.total),
    ] {
        let CheckedPrediction { predicted, measured, residual } = compared;
        line("", names[0], unit, predicted.mean, predicted.half_width);
        line("", names[1], unit, measured.mean, measured.half_width);
        line("", names[2], "1", residual.mean, residual.half_width);
    }
    lines
}

/// A term's name and unit, and where its value and its interval are.
type Term = (&'static str, &'static str, fn(&Terms) -> f64, fn(&TermWidths) -> f64);

const TERMS: [Term; 7] = [
    ("Nu", "per frame", |t| t.updates, |w| w.updates),
    ("Nv", "per frame", |t| t.tests, |w| w.tests),
    ("hits", "per frame", |t| t.hits, |w| w.hits),
    ("Nu*Cu", "s per frame", |t| t.update, |w| w.update),
    ("F", "s per frame", |t| t.finding, |w| w.finding),
    ("Nv*Cv", "s per frame", |t| t.test, |w| w.test),
    ("Co", "s", |t| t.construct, |w| w.construct),
];

/// The prices of one volume of a strategy in one regime.
pub fn of_price<'a>(scene: &'a str, price: &'a PriceRow) -> Vec<Line<'a>> {
    let line = |(term, unit, value): (&'static str, &'static str, &Estimate)| Line {
        scene,
        strategy: &price.variant,
        regime: Some(price.regime),
        volume: price.volume.name(),
        term,
        unit,
        value: value.mean,
        half_width: value.half_width,
    };
    [
        ("price Co", "s", &price.construct),
        ("price Co per body", "s", &price.construct_body),
        ("price Cu", "s per update", &price.update),
        ("price F per frame", "s per frame", &price.frame),
        ("price F per body", "s per body and frame", &price.body),
        ("price F per body with hits", "s per body", &price.row),
        ("price F per queried body", "s per body", &price.query),
        ("price F per thawed body", "s per body", &price.thaw),
        ("price F per kept body", "s per body", &price.keep),
        ("price F per listed pair", "s per pair", &price.handle),
        ("price Cv hit", "s per test", &price.hit),
        ("price Cv miss", "s per test", &price.miss),
        ("price Cv further slab", "s per slab", &price.further),
    ]
    .map(line)
    .into()
}
