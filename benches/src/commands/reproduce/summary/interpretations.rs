//! What the paper doesn't state, swept: the likeliest interpretation, and the best that each assumption allows.

use std::fmt::{Result, Write as _};

use sdop::settings::{Axes, Overlap};
use sdop::volume::DirectionSet;
use sdop_bench::reproduce::paper::{TABLE_1, TABLE_1_BODIES};
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::sensitivity::{Bounce, Interpretation, Start};

use super::text::{header, number};
use crate::commands::reproduce::rows::Tables;

pub fn section(out: &mut String, tables: &Tables) -> Result {
    let all = &tables.interpretations;
    let Some(best) = all.first() else {
        return Ok(());
    };
    writeln!(out, "## What the paper doesn't state, swept\n")?;
    writeln!(
        out,
        "{} interpretations of Table 1: where bodies start, what a wall does, how many frames count, which or-DOP. A cell's error is \
         taken as normal in ln(ours/the paper's), with the width σ that fits best; ln L within about 2 of the best can't be told \
         from it. The likeliest: start {}, walls {}, {} frames, k = {}, {} axes, {}, σ = {:.2} (a typical cell is off by {:.0} %).\n",
        all.len(),
        best.start,
        best.bounce,
        best.frames,
        best.k,
        best.axes,
        best.overlap,
        best.sigma,
        100.0 * best.sigma.exp_m1()
    )?;
    let columns = TABLE_1_BODIES.map(|n| format!("N = {n}"));
    header(
        out,
        &[&["strategy"], &columns.each_ref().map(String::as_str)[..]].concat(),
    )?;
    for ((strategy, paper), ours) in TABLE_1.iter().zip(&best.percent) {
        let cells = ours
            .iter()
            .zip(paper)
            .map(|(ours, paper)| format!("{} ({paper:.2})", number(*ours)));
        writeln!(
            out,
            "| {} | {} |",
            paper_name(*strategy),
            cells.collect::<Vec<_>>().join(" | ")
        )?;
    }
    writeln!(
        out,
        "\nThe best that each assumption allows, whatever the others:\n"
    )?;
    header(out, &["assumption", "value", "σ", "ln L", "below the best"])?;
    let mut line = |what: &str, value: String, fits: &dyn Fn(&Interpretation) -> bool| {
        let Some(found) = all.iter().find(|found| fits(found)) else {
            return Ok(());
        };
        let below = best.likelihood - found.likelihood;
        writeln!(
            out,
            "| {what} | {value} | {:.2} | {:.1} | {below:.1} |",
            found.sigma, found.likelihood
        )
    };
    for &start in Start::ALL {
        line("start", start.to_string(), &|i| i.start == start)?;
    }
    for &bounce in Bounce::ALL {
        line("walls", bounce.to_string(), &|i| i.bounce == bounce)?;
    }
    let mut lengths: Vec<u32> = all.iter().map(|i| i.frames).collect();
    lengths.sort_unstable();
    lengths.dedup();
    for frames in lengths {
        line("frames", frames.to_string(), &|i| i.frames == frames)?;
    }
    for &k in DirectionSet::ALL {
        line("k", k.to_string(), &|i| i.k == k.k())?;
    }
    for &axes in Axes::ALL {
        line("axes", axes.to_string(), &|i| i.axes == axes)?;
    }
    for &overlap in Overlap::ALL {
        line("overlap test", overlap.to_string(), &|i| {
            i.overlap == overlap
        })?;
    }
    writeln!(out)
}
