//! The formula: prices, and T of each strategy and scene split into its terms, predicted against measured.

use std::fmt::{Result, Write as _};

use sdop::lab::reproduce::paper_name;
use sdop::lab::reproduce::terms::Cost;

use super::text::{header, interval, number};
use crate::cli::prices;
use crate::cli::reproduce::rows::Tables;

pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## T = Co + Nu·Cu + F + Nv·Cv\n")?;
    writeln!(out, "![costs](figures/costs.svg)\n")?;
    writeln!(
        out,
        "Prices, from calibration on other seeds, other N and other boxes. F is pair finding, a stage of its own; a hit's"
    )?;
    writeln!(
        out,
        "price is that of one more hit among the misses around it.\n"
    )?;
    header(out, &prices::COLUMNS)?;
    for price in &tables.prices.0 {
        writeln!(out, "| {} |", prices::cells(price, number).join(" | "))?;
    }
    writeln!(
        out,
        "\nPredicted / measured: Co in ms, paid once; the other terms in µs a frame; T in ms for all {} frames.\n",
        tables.frames
    )?;
    let columns = [
        "scene",
        "strategy",
        "Co",
        "Nu·Cu",
        "F",
        "Nv·Cv",
        "sum",
        "measured",
        "residual, %",
        "T",
    ];
    header(out, &columns)?;
    for cost in &tables.costs {
        writeln!(out, "| {} |", cells(cost, tables.frames).join(" | "))?;
    }
    writeln!(out, "\n![residuals](figures/residuals.svg)\n")
}

fn cells(cost: &Cost, frames: u32) -> Vec<String> {
    let both = |seconds: [f64; 2]| seconds.map(|s| number(1e3 * s)).join(" / ");
    let terms = [
        cost.sum(|t| t.update),
        cost.sum(|t| t.finding),
        cost.sum(|t| t.test),
        cost.predicted,
    ];
    let mut cells = vec![cost.scene.clone(), paper_name(cost.strategy).to_owned()];
    cells.push(both([cost.sum(|t| t.construct), cost.construct.mean]));
    cells.extend(terms.map(|seconds| number(1e6 * seconds)));
    cells.push(interval(&cost.measured.scaled(1e6)));
    cells.push(format!("{:+.1}", 100.0 * cost.residual));
    cells.push(both(cost.totals(frames)));
    cells
}
