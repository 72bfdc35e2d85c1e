//! Claims, each with its verdict and the numbers that decide it.

use std::fmt::{Result, Write as _};

use sdop_bench::reproduce::Estimate;
use sdop_bench::reproduce::check::{Check, Claim, Verdict};

use super::text::{header, interval};

/// Numbers shown of each kind; `claims.csv` has all.
const SHOWN: usize = 4;

pub fn section(out: &mut String, title: &str, claims: &[Claim]) -> Result {
    writeln!(out, "## {title}\n")?;
    writeln!(
        out,
        "A number is followed by where the claim puts it; at most {SHOWN} of a kind are shown, `claims.csv` has all.\n"
    )?;
    header(
        out,
        &[
            "from",
            "claim",
            "verdict",
            "for it",
            "against it",
            "undecided",
        ],
    )?;
    for claim in claims {
        let columns = [
            Verdict::Supported,
            Verdict::Contradicted,
            Verdict::Undecided,
        ]
        .map(|verdict| numbers(claim, verdict));
        writeln!(
            out,
            "| {} | {} | **{}** | {} |",
            claim.source,
            claim.claim,
            claim.verdict(),
            columns.join(" | ")
        )?;
    }
    writeln!(out)
}

fn numbers(claim: &Claim, verdict: Verdict) -> String {
    let of = claim.checks.iter().filter(|check| check.verdict == verdict);
    let mut lines: Vec<String> = of.take(SHOWN).map(line).collect();
    let more = claim.count(verdict) - lines.len();
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines.join("<br>")
}

fn line(check: &Check) -> String {
    let value = Estimate {
        mean: check.value,
        half_width: check.half_width,
        seeds: 0,
    };
    format!(
        "{}: {} ({})",
        check.quantity,
        interval(&value),
        check.expected
    )
}
