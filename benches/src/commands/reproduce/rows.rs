//! The result files: `counts.csv` has what is the same on every machine, seed by seed, and the
//! summary has its hash; `claims.csv` has the claims and their numbers, and `reproduce.csv` every
//! other number. `results.json` has what pages and figures are made from.

use miette::IntoDiagnostic as _;
use sdop::settings::Strategy;
use sdop_bench::cost::table::{Cost, PriceRow};
use sdop_bench::hash::hex;
use sdop_bench::measure::conditions::Conditions;
use sdop_bench::measure::machine::Machine;
use sdop_bench::measure::row::Row;
use sdop_bench::measure::turns::Regime;
use sdop_bench::reproduce::check::PaperClaim;
use sdop_bench::reproduce::rates::{self, Rate};
use sdop_bench::reproduce::readings::{self, Table1Cell};
use sdop_bench::reproduce::rows::{rows, scene_prices};
use sdop_bench::reproduce::{PaperScene, Results, StrategyRun, claims, study};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::commands::output::csv_text;

/// Everything that is written.
#[derive(Serialize)]
pub struct Tables {
    pub command: String,
    pub machine: Machine,
    pub seeds: Vec<u64>,
    pub frames: u32,
    pub volumes_sha256: String,
    pub counts_sha256: String,
    pub conditions: Conditions,
    pub prices: Vec<ScenePrice>,
    #[serde(flatten)]
    pub drawn: Drawings,
    pub claims: Vec<PaperClaim>,
    pub study: Vec<PaperClaim>,
    #[serde(skip)]
    counts: Vec<Value>,
    #[serde(skip)]
    pub rows: Vec<Row>,
}

/// What the figures are drawn from: a part of `results.json`.
#[derive(Serialize, Deserialize)]
pub struct Drawings {
    pub boxes: Vec<BoxRow>,
    pub table_1: Vec<Table1Cell>,
    pub rates: Vec<Rate>,
    /// Warm frames.
    pub costs: Vec<Cost>,
}

impl Drawings {
    /// Those of `results.json`.
    ///
    /// # Errors
    /// Another text.
    #[cfg_attr(not(feature = "maintain"), allow(dead_code, reason = "pages alone need it"))]
    pub fn read(results: &str) -> miette::Result<Self> {
        let mut read: Self = serde_json::from_str(results).into_diagnostic()?;
        for cell in &mut read.table_1 {
            let own = read.boxes.iter().find(|row| row.scene == cell.scene);
            cell.in_papers_box = own.is_some_and(|row| !row.crowded);
        }
        Ok(read)
    }

    /// The scenes with costs.
    pub fn scenes(&self) -> Vec<&str> {
        distinct(self.costs.iter().map(|cost| cost.scene.as_str()))
    }

    /// The strategies with costs.
    pub fn strategies(&self) -> Vec<Strategy> {
        distinct(self.costs.iter().map(|cost| cost.strategy))
    }
}

/// A price with the scene that it was calibrated for.
#[derive(Serialize)]
pub struct ScenePrice {
    pub scene: &'static str,
    #[serde(flatten)]
    pub price: PriceRow,
}

/// A scene's bodies and box.
#[derive(Clone, Serialize, Deserialize)]
pub struct BoxRow {
    pub scene: String,
    /// Whether it is the small box.
    pub crowded: bool,
    pub bodies: usize,
    pub statics: usize,
    pub side: f64,
    pub radius: f64,
}

impl Tables {
    /// All tables of the results.
    pub fn new(results: &Results, machine: &Machine, command: String, before: Conditions) -> Self {
        let counts: Vec<Value> = results.runs().map(count_row).collect();
        let costs = results.costs(Regime::Warm);
        let scene_prices = |&scene: &PaperScene| {
            let prices = scene_prices(results, scene).into_iter();
            prices.map(move |price| ScenePrice { scene: scene.name(), price })
        };
        Self {
            command,
            machine: machine.clone(),
            seeds: results.plan.seeds.clone(),
            frames: results.plan.frames,
            volumes_sha256: results.volumes_sha256.clone(),
            counts_sha256: hash(&counts).unwrap_or_default(),
            conditions: before.after(costs.iter().map(|cost| cost.frame.measured)),
            prices: results.plan.names.iter().flat_map(scene_prices).collect(),
            drawn: Drawings {
                boxes: results
                    .plan
                    .names
                    .iter()
                    .filter_map(|&name| box_row(results, name))
                    .collect(),
                table_1: readings::table(results),
                rates: rates::table(results),
                costs,
            },
            claims: claims::all(results),
            study: study::all(results),
            counts,
            rows: rows(results),
        }
    }

    /// The CSV files: name without extension, rows.
    pub fn files(&self) -> miette::Result<[(&'static str, Value); 3]> {
        let rows = serde_json::to_value(&self.rows).into_diagnostic()?;
        Ok([
            ("counts", self.counts.clone().into()),
            ("claims", self.checks().into()),
            ("reproduce", rows),
        ])
    }

    /// Each number that supports or contradicts a claim.
    fn checks(&self) -> Vec<Value> {
        let mut rows = Vec::new();
        for claim in self.claims.iter().chain(&self.study) {
            rows.extend(claim.checks.iter().map(|check| {
                json!({
                    "source": claim.source,
                    "claim": claim.claim,
                    "claim_verdict": claim.verdict(),
                    "quantity": check.quantity,
                    "value": check.value,
                    "half_width": check.half_width,
                    "expected": check.expected,
                    "verdict": check.verdict,
                })
            }));
        }
        rows
    }
}

/// Each item once, in the order of first sight.
pub fn distinct<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for item in items {
        if !seen.contains(&item) {
            seen.push(item);
        }
    }
    seen
}

/// SHA-256 of the counts as their CSV file has them.
fn hash(counts: &[Value]) -> miette::Result<String> {
    let text = csv_text(serde_json::to_value(counts).into_diagnostic()?)?;
    Ok(hex(&Sha256::digest(text)))
}

fn box_row(results: &Results, scene: PaperScene) -> Option<BoxRow> {
    let run = results.example(scene.name())?;
    Some(BoxRow {
        scene: run.scene.clone(),
        crowded: scene.crowded(),
        bodies: run.bodies,
        statics: run.statics,
        side: run.side,
        radius: run.radius,
    })
}

/// What one strategy did in one run.
fn count_row(run: &StrategyRun) -> Value {
    let [sphere, ordop] = [run.counters.sphere, run.counters.ordop];
    json!({
        "scene": run.scene,
        "bodies": run.bodies,
        "statics": run.statics,
        "seed": run.seed,
        "frames": run.frames,
        "strategy": run.strategy.name(),
        "sphere_updates": sphere.updates,
        "ordop_updates": ordop.updates,
        "sphere_tests": sphere.tests,
        "sphere_hits": sphere.hits,
        "ordop_tests": ordop.tests,
        "ordop_hits": ordop.hits,
        "reported": run.counters.reported,
        "pairs_sha256": run.pairs_sha256,
    })
}
