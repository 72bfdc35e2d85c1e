//! A volume's prices as a row of a table.

use sdop_bench::cost::table::PriceRow;
use sdop_bench::reproduce::Estimate;

/// The columns, each with its unit.
pub const COLUMNS: [&str; 14] = [
    "strategy",
    "volume",
    "Co, ms",
    "Cu, ns",
    "F, ns per frame",
    "F, ns per body",
    "F, ns per body with hits",
    "F, ns per queried body",
    "F, ns per thawed body",
    "F, ns per kept body",
    "F, ns per listed pair",
    "Cv hit, ns",
    "Cv miss, ns",
    "Cv further slab, ns",
];

/// The cells, numbers written by `number`.
pub fn cells(price: &PriceRow, number: impl Fn(&Estimate) -> String) -> Vec<String> {
    let ns = |price: &Estimate| number(&price.scaled(1e9));
    vec![
        price.variant.clone(),
        price.volume.to_string(),
        number(&price.construct.scaled(1e3)),
        ns(&price.update),
        ns(&price.frame),
        ns(&price.body),
        ns(&price.row),
        ns(&price.query),
        ns(&price.thaw),
        ns(&price.keep),
        ns(&price.handle),
        ns(&price.hit),
        ns(&price.miss),
        ns(&price.further),
    ]
}
