//! The written summary, Markdown: every number and every verdict in it is computed.

mod brief;
mod claims;
mod costs;
mod digest;
mod frame_rates;
mod interpretations;
mod table_1;
mod text;
mod words;

use std::fmt::{Result, Write as _};

use super::rows::{BoxRow, Tables};
pub use brief::brief;
use text::{header, interval};

/// The summary that is kept.
pub fn write(tables: &Tables) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = sections(&mut out, tables);
    out
}

fn sections(out: &mut String, tables: &Tables) -> Result {
    head(out, tables)?;
    words::section(out, tables)?;
    digest::section(out, tables)?;
    table_1::section(out, tables)?;
    frame_rates::section(out, tables)?;
    costs::section(out, tables)?;
    claims::section(out, "Claims of the paper", &tables.claims)?;
    claims::section(out, "Our reading of Table 1, checked", &tables.study)?;
    survival(out, tables)?;
    interpretations::section(out, tables)?;
    table_1::appendix(out, tables)?;
    hashes(out, tables)?;
    words::references(out)
}

fn head(out: &mut String, tables: &Tables) -> Result {
    let Tables {
        machine,
        seeds,
        frames,
        ..
    } = tables;
    writeln!(out, "# The paper's experiments, run again\n")?;
    writeln!(
        out,
        "Made by `{}`; nothing here is written by hand.\n",
        tables.command
    )?;
    let (first, last) = (seeds.first().unwrap_or(&0), seeds.last().unwrap_or(&0));
    writeln!(
        out,
        "- {} seeds, {first} to {last}, {frames} frames each, the same trajectories for every strategy",
        seeds.len()
    )?;
    writeln!(
        out,
        "- {}, {} cores, {}, culling on one thread with {}",
        machine.cpu, machine.cores, machine.os, machine.simd
    )?;
    let build = if machine.optimised {
        ""
    } else {
        ", **not optimised: its times mean nothing**"
    };
    writeln!(out, "- sdop {}, {}{build}", machine.version, machine.rustc)?;
    writeln!(
        out,
        "- {}; the object of interest is body 0, which moves",
        boxes(tables)
    )?;
    writeln!(
        out,
        "- times are medians over *warm* frames: a culler's frames follow one another, as in a simulation; *cold* ones, before which other cullers ran, stand in `times.csv` and `costs.csv`\n- ± is half of a 95 % interval over seeds, each run at another time: frames of one run are correlated, so a run is one observation, and neighbours in time count for less where they are alike"
    )?;
    if let Some(warning) = tables.conditions.warning() {
        writeln!(out, "- **{warning}**")?;
    }
    writeln!(out)
}

fn boxes(tables: &Tables) -> String {
    let describe = |name: &str, row: &BoxRow| {
        let statics = (100.0 * row.statics as f64 / row.bodies as f64).round();
        format!(
            "{name} has side {:.1} for spheres of radius {:.0}, {statics} % of the objects static",
            row.side, row.radius
        )
    };
    let of = |crowded: bool| tables.boxes.iter().rfind(|row| row.crowded == crowded);
    let both = [("the box", of(false)), ("the crowded box", of(true))];
    let described = both
        .into_iter()
        .filter_map(|(name, row)| Some(describe(name, row?)));
    described.collect::<Vec<_>>().join("; ")
}

fn survival(out: &mut String, tables: &Tables) -> Result {
    writeln!(
        out,
        "## or-DOP hits in percent of sphere hits, by or-DOP and test\n"
    )?;
    writeln!(out, "In the first frames of paper-500.\n")?;
    let overlaps = ["one-sided", "two-sided", "full"];
    header(out, &[&["k"], &overlaps[..]].concat())?;
    for rows in tables.survival.chunk_by(|one, other| one.k == other.k) {
        let cell = |overlap: &&str| {
            let row = rows.iter().find(|row| row.overlap == *overlap);
            row.map_or(String::new(), |row| interval(&row.percent))
        };
        let cells: Vec<String> = overlaps.iter().map(cell).collect();
        writeln!(out, "| {} | {} |", rows[0].k, cells.join(" | "))?;
    }
    writeln!(out)
}

fn hashes(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## Hashes\n")?;
    writeln!(
        out,
        "Equal on every CPU and SIMD level, for these seeds and frames:\n"
    )?;
    writeln!(
        out,
        "- counts and pairs of every run (`counts.csv`): `{}`",
        tables.counts_sha256
    )?;
    writeln!(out, "- volumes: `{}`", tables.volumes_sha256)
}
