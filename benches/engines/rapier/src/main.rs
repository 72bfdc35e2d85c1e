//! Checks and times the filter: `sdop-rapier check` and `measure`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use miette::{IntoDiagnostic, Result};
use sdop::Tier;
use sdop_bench::measure::machine::Machine;
use sdop_rapier::forms::forms;
use sdop_rapier::plan::{Detail, Kind, Mode, Plan, Real, Scene};
use sdop_rapier::record::{Record, RecordedFinding};
use sdop_rapier::{double, single, whole};

/// S-DOP culling in rapier: contacts compared, steps timed.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Takes every step with and without the filter from the same state. A dropped pair is a
    /// failure (exit code 1).
    Check {
        #[command(flatten)]
        run: Run,
        /// How it is filtered.
        #[arg(long, default_value = "dispatcher")]
        mode: Mode,
        /// Plants a bug that the check must see: margins are left out.
        #[arg(long)]
        without_margin: bool,
        /// Where a dropped pair is saved as a scene.
        #[arg(long, default_value = "dropped")]
        cases: PathBuf,
    },
    /// Steps the scene in several modes, in turns, and times them by rapier's counters.
    Measure {
        #[command(flatten)]
        run: Run,
        /// The modes.
        #[arg(long, value_delimiter = ',', default_value = "plain,full,hook,dispatcher")]
        modes: Vec<Mode>,
        /// Steps of the run that prices are taken from; it has another seed.
        #[arg(long, default_value_t = 200)]
        calibrate: usize,
    },
}

#[derive(Args)]
struct Run {
    /// What happens.
    #[arg(long)]
    scene: Scene,
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
    /// Rapier's numbers.
    #[arg(long, default_value = "f32")]
    real: Real,
    /// The repository's folder of meshes.
    #[arg(long, default_value = "data/meshes")]
    meshes: PathBuf,
    /// The record that is written, as JSON.
    #[arg(long)]
    out: Option<PathBuf>,
}

impl Run {
    fn plan(&self) -> Plan {
        let Self { scene, kind, bodies, seed, .. } = *self;
        Plan { scene, kind, bodies, seed }
    }

    /// Prints the record and writes it where it was asked for.
    fn finish(&self, found: RecordedFinding) -> Result<()> {
        let record = Record {
            command: std::env::args().skip(1).collect::<Vec<_>>().join(" "),
            machine: Machine::here(Tier::detect()),
            scene: self.scene.to_string(),
            kind: self.kind.to_string(),
            detail: self.detail.to_string(),
            bodies: self.bodies,
            steps: self.steps,
            seed: self.seed,
            real: self.real.to_string(),
            found,
        };
        let text = serde_json::to_string_pretty(&record).into_diagnostic()? + "\n";
        print!("{text}");
        self.out.as_ref().map_or(Ok(()), |path| whole::write(path, &text))
    }
}

fn main() -> Result<ExitCode> {
    match Cli::parse().command {
        Command::Check { run, mode, without_margin, cases } => {
            let check =
                if run.real == Real::F32 { single::proof::check } else { double::proof::check };
            let forms = forms(&run.meshes, run.detail)?;
            let check = check(run.plan(), &forms, mode, run.steps, without_margin, &cases)?;
            let fine = check.dropped == 0;
            run.finish(RecordedFinding::Checked { mode: mode.to_string(), without_margin, check })?;
            Ok(if fine { ExitCode::SUCCESS } else { ExitCode::FAILURE })
        }
        Command::Measure { run, modes, calibrate } => {
            let measure =
                if run.real == Real::F32 { single::proof::measure } else { double::proof::measure };
            let forms = forms(&run.meshes, run.detail)?;
            let (shares, prices) = measure(run.plan(), &forms, &modes, run.steps, calibrate);
            run.finish(RecordedFinding::Measured { shares, prices })?;
            Ok(ExitCode::SUCCESS)
        }
    }
}
