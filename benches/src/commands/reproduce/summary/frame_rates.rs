//! Figs 12 and 13: frame rates, their ratio to the control, and culling as a share of a 60 Hz frame.

use std::fmt::{Result, Write as _};

use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::rates::ELSEWHERE;

use super::text::{header, interval};
use crate::commands::reproduce::rows::Tables;

pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## Figs 12 and 13: frame rates\n")?;
    writeln!(out, "![frame rates](figures/frame_rates.svg)\n")?;
    writeln!(
        out,
        "t is the median culling time of a warm frame; fps = 1/(F + t), with F all else that a frame costs. The control's t is the"
    )?;
    writeln!(
        out,
        "price of calling and timing a culler that does nothing, so that its rate at F = 0 is that of the clock.\n"
    )?;
    let fps = ELSEWHERE
        .map(|f| [format!("fps, F = {} ms", 1e3 * f), "to control".to_owned()])
        .concat();
    let columns = ["scene", "strategy", "t, µs", "share of a 60 Hz frame, %"];
    let fps: Vec<&str> = fps.iter().map(String::as_str).collect();
    header(out, &[&columns[..], &fps[..]].concat())?;
    for rate in tables
        .rates
        .iter()
        .filter(|rate| rate.elsewhere == ELSEWHERE[0])
    {
        let (t, share) = (interval(&rate.culling.scaled(1e6)), interval(&rate.share));
        write!(
            out,
            "| {} | {} | {t} | {share} |",
            rate.scene,
            paper_name(rate.strategy)
        )?;
        for other in tables
            .rates
            .iter()
            .filter(|r| r.scene == rate.scene && r.strategy == rate.strategy)
        {
            write!(
                out,
                " {} | {:.4} |",
                interval(&other.fps),
                other.to_control.mean
            )?;
        }
        writeln!(out)?;
    }
    writeln!(out)?;
    hidden(out, tables)
}

/// From which F on everything else hides the difference between two strategies.
fn hidden(out: &mut String, tables: &Tables) -> Result {
    writeln!(
        out,
        "\"Almost\" and \"similar\" are read as within five percent. Whether the frame rates of two strategies are so depends on F\n\
         alone; the verdict turns at these F, in µs:\n"
    )?;
    header(out, &["scene", "frame rates", "within 5 % from F on, µs"])?;
    for row in &tables.hidden {
        let [one, other] = row.of.map(paper_name);
        let from = row.from.as_ref();
        let from = from.map_or("0".to_owned(), |from| interval(&from.scaled(1e6)));
        writeln!(out, "| {} | {one} / {other} | {from} |", row.scene)?;
    }
    writeln!(out)
}
