//! The formula: prices, and T of each strategy and scene split into its terms, predicted against measured.

use std::fmt::{Result, Write as _};

use sdop::cost::predict::Terms;
use sdop::reproduce::paper_name;

use super::text::{header, interval, number};
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
    header(
        out,
        &[
            "volume",
            "Co, ms",
            "Cu, ns",
            "F, ns a frame",
            "F, ns a body",
            "Cv hit, ns",
            "Cv miss, ns",
        ],
    )?;
    for price in &tables.prices.0 {
        let costs = price.costs;
        let nanoseconds =
            [costs.update, costs.frame, costs.body, costs.hit, costs.miss].map(|s| number(1e9 * s));
        writeln!(
            out,
            "| {} | {} | {} |",
            price.volume,
            number(1e3 * costs.construct),
            nanoseconds.join(" | ")
        )?;
    }
    writeln!(
        out,
        "\nPredicted / measured: Co in ms, paid once; the other terms in µs a frame; T in ms for all {} frames.\n",
        tables.frames
    )?;
    header(
        out,
        &[
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
        ],
    )?;
    for cost in &tables.costs {
        let sum = |term: fn(&Terms) -> f64| cost.terms.iter().map(term).sum::<f64>();
        let parts = [
            sum(|t| t.update),
            sum(|t| t.finding),
            sum(|t| t.test),
            cost.predicted,
        ]
        .map(|s| number(1e6 * s));
        let construct = [sum(|t| t.construct), cost.construct.mean];
        let frames = f64::from(tables.frames);
        let total = [
            construct[0] + frames * cost.predicted,
            construct[1] + frames * cost.measured.mean,
        ];
        let [construct, total] =
            [construct, total].map(|both| both.map(|s| number(1e3 * s)).join(" / "));
        let measured = interval(&cost.measured.scaled(1e6));
        let name = paper_name(cost.strategy);
        writeln!(
            out,
            "| {} | {name} | {construct} | {} | {measured} | {:+.1} | {total} |",
            cost.scene,
            parts.join(" | "),
            100.0 * cost.residual
        )?;
    }
    writeln!(out, "\n![residuals](figures/residuals.svg)\n")
}
