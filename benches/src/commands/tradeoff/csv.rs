//! The comparison as CSV: one number per line, and one line per variant and seed.

use sdop_bench::tradeoff::{Estimate, Tradeoff, VariantResult};
use serde::Serialize;

use crate::commands::cost::lines::{Line, of_cost, of_price};

/// Every number of every variant: what it reports, how precise and how tight it is, its time by the
/// formula's terms, and the prices. The strategy of a line is the variant's name, which says all of
/// its settings.
pub fn lines(result: &Tradeoff) -> Vec<Line<'_>> {
    let mut lines = Vec::new();
    for row in &result.rows {
        lines.extend(quality(&result.scene, row));
        let costs = [&row.warm, &row.cold].into_iter().flatten();
        lines.extend(costs.flat_map(of_cost));
    }
    let prices = result.prices.iter();
    lines.extend(prices.flat_map(|price| of_price(&result.scene, price)));
    lines
}

fn quality<'a>(scene: &'a str, row: &'a VariantResult) -> Vec<Line<'a>> {
    let line = |term, unit, value, half_width| Line {
        scene,
        strategy: &row.name,
        regime: None,
        volume: "",
        term,
        unit,
        value,
        half_width,
    };
    let of = |term, unit, estimate: &Estimate| line(term, unit, estimate.mean, estimate.half_width);
    let mut lines = vec![
        of("reported", "pairs per frame", &row.reported),
        of("precision", "1", &row.precision),
        of("reported / true", "1", &row.per_true),
        line("recall", "1", row.recall, 0.0),
        of("time", "s per warm frame", &row.seconds()),
    ];
    if let Some(ratio) = row.volume_over_hull {
        lines.push(line("volume / hull", "1", ratio, 0.0));
    }
    lines
}

/// What a variant reported with one seed.
#[derive(Serialize)]
pub struct SeedLine<'a> {
    variant: &'a str,
    seed: u64,
    precision: f64,
    pairs_sha256: &'a str,
}

/// What every variant reported, seed by seed: equal on every machine.
pub fn seeds(result: &Tradeoff) -> Vec<SeedLine<'_>> {
    fn of<'a>(result: &Tradeoff, row: &'a VariantResult) -> Vec<SeedLine<'a>> {
        let found = result.seeds.iter().zip(&row.precisions).zip(&row.pairs_sha256);
        let line = |((&seed, &precision), pairs_sha256): ((&u64, &f64), &'a String)| SeedLine {
            variant: &row.name,
            seed,
            precision,
            pairs_sha256,
        };
        found.map(line).collect()
    }
    let rows = result.rows.iter();
    rows.flat_map(|row| of(result, row)).collect()
}
