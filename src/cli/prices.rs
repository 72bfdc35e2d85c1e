//! A volume's prices as a row of a table.

use sdop::lab::cost::predict::Price;

/// The columns, each with its unit.
pub const COLUMNS: [&str; 7] = [
    "volume",
    "Co, ms",
    "Cu, ns",
    "F, ns a frame",
    "F, ns a body",
    "Cv hit, ns",
    "Cv miss, ns",
];

/// The cells, numbers written by `number`.
pub fn cells(price: &Price, number: fn(f64) -> String) -> Vec<String> {
    let costs = price.costs;
    let recurring = [costs.update, costs.frame, costs.body, costs.hit, costs.miss];
    let mut cells = vec![price.volume.to_string(), number(1e3 * costs.construct)];
    cells.extend(recurring.map(|seconds| number(1e9 * seconds)));
    cells
}
