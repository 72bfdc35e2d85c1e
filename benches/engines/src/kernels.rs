//! Criterion's estimates as one table: nanoseconds per element, the median with its confidence
//! interval.

use std::fs;
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::facts;

/// Gathers criterion's estimates into one table
#[derive(clap::Args)]
pub struct Args {
    /// Directory of criterion's estimates
    #[arg(long, default_value = "target/criterion")]
    from: PathBuf,
    /// The file to write
    #[arg(long)]
    out: PathBuf,
}

/// A line of the table.
#[derive(Serialize)]
struct KernelTiming {
    group: String,
    function: String,
    parameter: String,
    elements: u64,
    ns: f64,
    ns_low: f64,
    ns_high: f64,
}

/// `benchmark.json`.
#[derive(Deserialize)]
struct Benchmark {
    group_id: String,
    function_id: Option<String>,
    value_str: Option<String>,
    throughput: Option<Throughput>,
}

#[derive(Deserialize)]
struct Throughput {
    #[serde(rename = "Elements")]
    elements: Option<u64>,
}

/// `estimates.json`.
#[derive(Deserialize)]
struct Estimates {
    median: CriterionEstimate,
}

#[derive(Deserialize)]
struct CriterionEstimate {
    point_estimate: f64,
    confidence_interval: Interval,
}

#[derive(Deserialize)]
struct Interval {
    lower_bound: f64,
    upper_bound: f64,
}

/// Reads and writes.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut rows = Vec::new();
    gather(&args.from, &mut rows)?;
    if rows.is_empty() {
        return Err(miette!(
            help = "run the benches first: `cargo bench --bench ordop`",
            "no results of criterion in {}",
            args.from.display()
        ));
    }
    rows.sort_by(|a, b| {
        let key = |row: &KernelTiming| (row.group.clone(), row.function.clone(), row.elements);
        key(a).cmp(&key(b)).then(a.parameter.cmp(&b.parameter))
    });
    sdop::files::write(&args.out, facts::csv(&rows)?)
        .into_diagnostic()
        .wrap_err_with(|| format!("writing {}", args.out.display()))
}

/// Looks for the newest estimates of every benchmark below a directory.
fn gather(directory: &Path, rows: &mut Vec<KernelTiming>) -> miette::Result<()> {
    let blame = || format!("reading {}", directory.display());
    let entries = fs::read_dir(directory).into_diagnostic().wrap_err_with(blame)?;
    for entry in entries {
        let path = entry.into_diagnostic()?.path();
        if !path.is_dir() {
            continue;
        }
        if path.ends_with("new") {
            rows.push(row(&path)?);
        } else {
            gather(&path, rows)?;
        }
    }
    Ok(())
}

fn row(directory: &Path) -> miette::Result<KernelTiming> {
    let benchmark: Benchmark = read(&directory.join("benchmark.json"))?;
    let Estimates { median } = read(&directory.join("estimates.json"))?;
    let elements = benchmark.throughput.and_then(|each| each.elements);
    let elements = elements.unwrap_or(1);
    let each = |ns: f64| ns / elements as f64;
    Ok(KernelTiming {
        group: benchmark.group_id,
        function: benchmark.function_id.unwrap_or_default(),
        parameter: benchmark.value_str.unwrap_or_default(),
        elements,
        ns: each(median.point_estimate),
        ns_low: each(median.confidence_interval.lower_bound),
        ns_high: each(median.confidence_interval.upper_bound),
    })
}

fn read<T: DeserializeOwned>(path: &Path) -> miette::Result<T> {
    let blame = || format!("reading {}", path.display());
    let text = fs::read_to_string(path).into_diagnostic().wrap_err_with(blame)?;
    serde_json::from_str(&text).into_diagnostic().wrap_err_with(blame)
}
