//! What came out, in a few lines.

use std::fmt::{Result, Write as _};

use sdop_bench::cost::table::Cost;
use sdop_bench::reproduce::check::{Claim, Verdict};
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::rates::{ELSEWHERE, Rate};

use super::table_1;
use super::text::number;
use crate::commands::reproduce::rows::Tables;

pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## In short\n")?;
    let (yes, no): (Vec<_>, Vec<_>) =
        table_1::rows(tables).partition(table_1::StrategyMatch::reproduces);
    let names = |rows: &[table_1::StrategyMatch]| {
        let names: Vec<&str> = rows.iter().map(|row| paper_name(row.strategy)).collect();
        if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        }
    };
    writeln!(
        out,
        "- Rows of Table 1 that reproduce: {}; that don't: {}. Why they can't stands under our reading of it.",
        names(&yes),
        names(&no)
    )?;
    for row in tables
        .boxes
        .iter()
        .filter(|row| Some(row.bodies) == most(tables))
    {
        writeln!(
            out,
            "- {}, fastest first, µs a frame: {}.",
            row.scene,
            order(tables, &row.scene)
        )?;
    }
    writeln!(
        out,
        "- The formula misses the measured time by {} (in the crowded box {}).",
        residual(tables, false),
        residual(tables, true)
    )?;
    writeln!(
        out,
        "- Culling takes these shares of a 60 Hz frame at most: {}.",
        shares(tables)
    )?;
    for (whose, claims) in [
        ("The paper's claims", &tables.claims),
        ("Our reading's", &tables.study),
    ] {
        writeln!(out, "- {whose}: {}.", verdicts(claims))?;
    }
    writeln!(out)
}

fn most(tables: &Tables) -> Option<usize> {
    tables.boxes.iter().map(|row| row.bodies).max()
}

fn order(tables: &Tables, scene: &str) -> String {
    let of = |rate: &&Rate| rate.scene == scene && rate.elsewhere == ELSEWHERE[0];
    let mut rates: Vec<&Rate> = tables.rates.iter().filter(of).collect();
    rates.sort_by(|one, other| one.culling.mean.total_cmp(&other.culling.mean));
    let name = |rate: &&Rate| {
        format!(
            "{} {}",
            paper_name(rate.strategy),
            number(1e6 * rate.culling.mean)
        )
    };
    rates.iter().map(name).collect::<Vec<_>>().join(" < ")
}

/// How far the formula is off in the crowded scenes, or in the others.
fn residual(tables: &Tables, crowded: bool) -> String {
    let scenes = tables.boxes.iter().filter(|row| row.crowded == crowded);
    let scenes: Vec<&str> = scenes.map(|row| row.scene.as_str()).collect();
    let of = |cost: &&Cost| scenes.contains(&cost.scene.as_str());
    let costs = tables.costs.iter().filter(of);
    let mut sizes: Vec<f64> = costs
        .map(|cost| 100.0 * cost.frame.residual.mean.abs())
        .collect();
    sizes.sort_by(f64::total_cmp);
    let worst = sizes.last().copied().unwrap_or(0.0);
    let median = sizes.get(sizes.len().saturating_sub(1) / 2);
    let median = median.copied().unwrap_or(0.0);
    let beyond = sizes.iter().filter(|size| **size > 5.0).count();
    format!(
        "{median:.1} % in the median, {worst:.1} % at worst, {beyond} of {} by more than 5 %",
        sizes.len()
    )
}

/// The largest share over scenes of each strategy.
fn shares(tables: &Tables) -> String {
    let mut shares: Vec<(&'static str, f64)> = Vec::new();
    for rate in &tables.rates {
        let name = paper_name(rate.strategy);
        match shares.iter_mut().find(|(known, _)| *known == name) {
            Some((_, share)) => *share = share.max(rate.share.mean),
            None => shares.push((name, rate.share.mean)),
        }
    }
    let share = |(name, share): &(&str, f64)| format!("{name} {} %", number(*share));
    shares
        .iter()
        .skip(1)
        .map(share)
        .collect::<Vec<_>>()
        .join(", ")
}

fn verdicts(claims: &[Claim]) -> String {
    let count = |verdict: &Verdict| {
        let number = claims
            .iter()
            .filter(|claim| claim.verdict() == *verdict)
            .count();
        format!("{number} {verdict}")
    };
    Verdict::ALL
        .iter()
        .map(count)
        .collect::<Vec<_>>()
        .join(", ")
}
