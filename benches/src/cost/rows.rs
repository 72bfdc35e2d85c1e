//! The formula's numbers as rows.

use super::PRICES;
use super::study::CostReport;
use super::table::{CheckedPrediction, Cost, PriceRow};
use super::terms::Terms;
use crate::measure::estimate::Estimate;
use crate::measure::row::{Row, Rows};

/// A term's name, its unit, and where it is in terms and in their half-widths.
type Term = (&'static str, &'static str, fn(&Terms) -> f64);

/// The terms of one volume.
const TERMS: [Term; 9] = [
    ("Nu", "per frame", |t| t.updates),
    ("Nv", "per frame", |t| t.tests),
    ("hits", "per frame", |t| t.hits),
    ("bodies with hits", "per frame", |t| t.rows),
    ("further slabs", "per frame", |t| t.further),
    ("Nu*Cu", "s per frame", |t| t.update),
    ("F", "s per frame", |t| t.finding),
    ("Nv*Cv", "s per frame", |t| t.test),
    ("Co", "s", |t| t.construct),
];

/// Sums over volumes.
const SUMS: [Term; 5] = [
    ("Nu*Cu", "s per frame", |t| t.update),
    ("F", "s per frame", |t| t.finding),
    ("Nv*Cv", "s per frame", |t| t.test),
    ("all terms", "s per frame", Terms::recurring),
    ("without F", "s per frame", Terms::in_paper),
];

/// The rows of `sdop cost`.
#[must_use]
pub fn of_report(report: &CostReport) -> Vec<Row> {
    let mut rows = Rows::new("cost", &report.scene);
    report.costs.iter().for_each(|cost| add_cost(&mut rows, cost));
    report.prices.iter().for_each(|price| add_price(&mut rows, price));
    rows.finish()
}

/// Adds counts, terms and sums of one variant in one regime.
pub fn add_cost(rows: &mut Rows, cost: &Cost) {
    let of = (cost.variant.as_str(), Some(cost.regime));
    let n = cost.frame.measured.seeds;
    // Earlier records have no intervals of terms.
    let widths = cost.widths.iter().map(Some).chain(std::iter::repeat(None));
    for (terms, widths) in cost.terms.iter().zip(widths) {
        for (term, unit, value) in TERMS {
            let half_width = widths.map_or(f64::INFINITY, value);
            let estimate = Estimate { mean: value(terms), half_width, seeds: n };
            if estimate.mean != 0.0 {
                rows.add(of, format!("{term} ({})", terms.volume), unit, estimate);
            }
        }
    }
    for (name, unit, term) in SUMS {
        let exact = Estimate { mean: cost.sum(term), half_width: f64::INFINITY, seeds: n };
        rows.add(of, name, unit, exact);
    }
    for (names, unit, compared) in [
        (["sum", "measured", "residual"], "s per frame", &cost.frame),
        (["Co predicted", "Co measured", "Co residual"], "s", &cost.construct),
        (["T predicted", "T measured", "T residual"], "s", &cost.total),
    ] {
        let CheckedPrediction { predicted, measured, residual } = *compared;
        rows.add(of, names[0], unit, predicted);
        rows.add(of, names[1], unit, measured);
        rows.add(of, names[2], "1", residual);
    }
}

/// Adds the prices of one volume in one regime.
pub fn add_price(rows: &mut Rows, price: &PriceRow) {
    for kind in PRICES {
        if let Some(&value) = price.prices.get(kind.key).filter(|value| value.mean != 0.0) {
            let metric = format!("price {} ({})", kind.name, price.volume);
            rows.add((&price.variant, Some(price.regime)), metric, kind.unit, value);
        }
    }
}
