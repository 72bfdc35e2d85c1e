//! Criterion's estimates as one table: nanoseconds per element, the median with its confidence
//! interval.

use std::path::Path;
use std::process::{Command, Stdio};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use serde::Serialize;
use serde_json::Value;

use super::super::files::{read, write};

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

/// Runs benches into a directory of their own, and writes their estimates.
pub(super) fn record(benches: &[String], file: &Path) -> miette::Result<()> {
    let home = std::env::current_dir().into_diagnostic()?.join("target/criterion-record");
    if home.exists() {
        std::fs::remove_dir_all(&home).into_diagnostic()?;
    }
    for bench in benches {
        let status = Command::new("cargo")
            .args(["bench", "--quiet", "--bench", bench, "--"])
            .args("--noplot --sample-size 20 --warm-up-time 0.1 --measurement-time 0.4".split(' '))
            .env("CRITERION_HOME", &home)
            .stdout(Stdio::null())
            .status()
            .into_diagnostic()?;
        miette::ensure!(status.success(), "the bench {bench} failed: {status}");
    }
    let mut rows = Vec::new();
    gather(&home, &mut rows)?;
    rows.sort_by_cached_key(|row| {
        (row.group.clone(), row.function.clone(), row.elements, row.parameter.clone())
    });
    let mut out = csv::Writer::from_writer(Vec::new());
    for row in rows {
        out.serialize(row).into_diagnostic()?;
    }
    write(file, out.into_inner().into_diagnostic()?)
}

/// Looks for the newest estimates of every benchmark below a directory.
fn gather(directory: &Path, rows: &mut Vec<KernelTiming>) -> miette::Result<()> {
    let blame = || format!("cannot read {}", directory.display());
    for entry in std::fs::read_dir(directory).into_diagnostic().wrap_err_with(blame)? {
        let path = entry.into_diagnostic()?.path();
        if path.ends_with("new") {
            rows.push(row(&path).ok_or_else(|| miette!("{}: no estimates", path.display()))?);
        } else if path.is_dir() {
            gather(&path, rows)?;
        }
    }
    Ok(())
}

fn row(directory: &Path) -> Option<KernelTiming> {
    let json = |name: &str| -> Option<Value> {
        serde_json::from_str(&read(&directory.join(name)).ok()?).ok()
    };
    let (benchmark, estimates) = (json("benchmark.json")?, json("estimates.json")?);
    let text = |key: &str| benchmark[key].as_str().unwrap_or_default().to_owned();
    let elements = benchmark["throughput"]["Elements"].as_u64().unwrap_or(1);
    let each = |ns: &Value| Some(ns.as_f64()? / elements as f64);
    let (median, interval) = (&estimates["median"], &estimates["median"]["confidence_interval"]);
    Some(KernelTiming {
        group: text("group_id"),
        function: text("function_id"),
        parameter: text("value_str"),
        elements,
        ns: each(&median["point_estimate"])?,
        ns_low: each(&interval["lower_bound"])?,
        ns_high: each(&interval["upper_bound"])?,
    })
}
