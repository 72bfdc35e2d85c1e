//! The formula: prices, and T of each strategy and scene split into its terms, predicted against measured.

use std::fmt::{Result, Write as _};

use sdop_bench::cost::predict::Terms;
use sdop_bench::cost::table::{Compared, Cost};
use sdop_bench::measure::turns::Regime;
use sdop_bench::reproduce::paper_name;

use super::text::{header, interval, number};
use crate::commands::prices;
use crate::commands::reproduce::rows::{ScenePrice, Tables};

pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## T = Co + Nu·Cu + F + Nv·Cv\n")?;
    writeln!(out, "![costs](figures/costs.svg)\n")?;
    writeln!(
        out,
        "The paper's equation is T = Nu·Cu + Nv·Cv + Co. F, pair finding, is ours: a stage that the paper doesn't name. The column\n\
         \"paper\" is what its terms alone would predict. Prices come from other seeds, other N and other boxes, none within a\n\
         tenth of the scene that they predict; their frames took turns with that scene's. All frames here are warm.\n"
    )?;
    for scene in tables.scenes() {
        writeln!(out, "Prices for {scene}:\n")?;
        header(out, &prices::COLUMNS)?;
        let of = |row: &&ScenePrice| row.scene == scene && row.price.regime == Regime::Warm;
        for row in tables.prices.iter().filter(of) {
            writeln!(
                out,
                "| {} |",
                prices::cells(&row.price, interval).join(" | ")
            )?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "Predicted / measured: Co in ms, paid once; the other terms in µs per frame; T in ms for all {} frames.\n",
        tables.frames
    )?;
    let columns = [
        "scene",
        "strategy",
        "Co",
        "residual, %",
        "Nu·Cu",
        "F",
        "Nv·Cv",
        "sum",
        "measured",
        "residual, %",
        "paper",
        "T",
        "residual, %",
    ];
    header(out, &columns)?;
    for cost in &tables.costs {
        writeln!(out, "| {} |", cells(cost).join(" | "))?;
    }
    writeln!(out, "\nThe same of cold frames, µs per frame:\n")?;
    header(
        out,
        &["scene", "strategy", "sum", "measured", "residual, %"],
    )?;
    for cost in &tables.cold_costs {
        let mut cells = vec![cost.scene.clone(), paper_name(cost.strategy).to_owned()];
        cells.push(number(1e6 * cost.frame.predicted.mean));
        cells.push(interval(&cost.frame.measured.scaled(1e6)));
        cells.push(residual(&cost.frame));
        writeln!(out, "| {} |", cells.join(" | "))?;
    }
    writeln!(out, "\n![residuals](figures/residuals.svg)\n")
}

fn cells(cost: &Cost) -> Vec<String> {
    let both = |compared: &Compared| {
        let both = [compared.predicted.mean, compared.measured.mean];
        both.map(|seconds| number(1e3 * seconds)).join(" / ")
    };
    let us = |seconds: f64| number(1e6 * seconds);
    vec![
        cost.scene.clone(),
        paper_name(cost.strategy).to_owned(),
        both(&cost.construct),
        residual(&cost.construct),
        us(cost.sum(|t| t.update)),
        us(cost.sum(|t| t.finding)),
        us(cost.sum(|t| t.test)),
        us(cost.frame.predicted.mean),
        interval(&cost.frame.measured.scaled(1e6)),
        residual(&cost.frame),
        us(cost.sum(Terms::in_paper)),
        both(&cost.total),
        residual(&cost.total),
    ]
}

fn residual(compared: &Compared) -> String {
    let percent = compared.residual.scaled(100.0);
    if percent.half_width.is_finite() {
        format!("{:+.1} ± {:.1}", percent.mean, percent.half_width)
    } else {
        format!("{:+.1}", percent.mean)
    }
}
