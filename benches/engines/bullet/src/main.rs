//! Checks and times the filter: `sdop-bullet --scene pile --kind hull --bodies 500`. A dropped pair
//! is a failure (exit code 1).

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use miette::{IntoDiagnostic, Result};
use sdop::Tier;
use sdop_bench::measure::machine::Machine;
use sdop_bullet::forms::forms;
use sdop_bullet::plan::{Detail, Kind, Plan, SceneKind};
use sdop_bullet::study::{Study, study};
use sdop_bullet::whole;
use serde::Serialize;

/// S-DOP culling in Bullet: every pair's verdict compared with Bullet's contacts, steps timed in
/// turns.
#[derive(Parser)]
struct Cli {
    /// What happens.
    #[arg(long)]
    scene: SceneKind,
    /// What bodies are made of.
    #[arg(long, default_value = "hull")]
    kind: Kind,
    /// How finely bodies are cut.
    #[arg(long, default_value = "coarse")]
    detail: Detail,
    /// How many.
    #[arg(long, default_value_t = 100)]
    bodies: usize,
    /// Steps of a sixtieth of a second.
    #[arg(long, default_value_t = 1000)]
    steps: usize,
    /// Where random draws start.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Plants a bug that the check must see: margins are left out, and nothing is timed.
    #[arg(long)]
    without_margin: bool,
    /// The repository's folder of meshes.
    #[arg(long, default_value = "data/meshes")]
    meshes: PathBuf,
    /// The record that is written, as JSON.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// One file of a record.
#[derive(Serialize)]
struct Record {
    command: String,
    machine: Machine,
    scene: SceneKind,
    kind: Kind,
    detail: Detail,
    bodies: usize,
    steps: usize,
    seed: u64,
    without_margin: bool,
    #[serde(flatten)]
    found: Study,
}

fn main() -> Result<ExitCode> {
    let cli = Cli::parse();
    let plan = Plan { scene: cli.scene, kind: cli.kind, bodies: cli.bodies, seed: cli.seed };
    let forms = forms(&cli.meshes, cli.detail)?;
    let found = study(plan, &forms, cli.steps, cli.without_margin);
    let record = Record {
        command: std::env::args().skip(1).collect::<Vec<_>>().join(" "),
        machine: Machine::here(Tier::detect()),
        scene: cli.scene,
        kind: cli.kind,
        detail: cli.detail,
        bodies: cli.bodies,
        steps: cli.steps,
        seed: cli.seed,
        without_margin: cli.without_margin,
        found,
    };
    let text = serde_json::to_string_pretty(&record).into_diagnostic()? + "\n";
    print!("{text}");
    if let Some(path) = &cli.out {
        whole::write(path, &text)?;
    }
    Ok(if found.judged.dropped == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
