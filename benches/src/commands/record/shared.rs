//! Records of work in units: measured by the ranks of `mpirun`, or put together from shards.
//!
//! Each rank runs the experiment's command as a rank; only the output of the first is kept. A shard
//! is stored next to the future record until all shards are merged.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Parser as _;
use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::measure::machine::Machine;
use sdop_bench::mpi;
use sdop_bench::report::{Experiment, ExperimentStep, Manifest};
use sdop_bench::sweep::{Units, code};

use super::super::Cli;
use super::{Args, beside, chosen, command_line, complete, finish, prepare, steps};

/// The directory of a record's shards, next to the record's.
const SHARDS: &str = ".shards";

impl Args {
    /// Whether its work is cut into units, which many can share.
    pub fn is_sweep(&self) -> bool {
        let one = chosen(self).is_ok_and(|chosen| matches!(chosen[..], [one] if sweep(one)));
        one && !self.adopt && !self.merge
    }

    /// Refuses to share what has no units.
    ///
    /// # Errors
    /// An experiment that isn't known, or is none to be shared.
    pub fn refuse(&self) -> miette::Result<()> {
        let shares = mpi::launched() > 1 || self.merge || !self.sweep.arguments().is_empty();
        if !shares || self.experiments.is_empty() {
            return Ok(());
        }
        let chosen = chosen(self)?;
        if let Some(whole) = chosen.iter().find(|experiment| !sweep(experiment)) {
            return Err(miette!(
                help = "start it once, without mpirun, --shard and --merge",
                "{} is measured in one process",
                whole.name
            ));
        }
        miette::ensure!(
            chosen.len() == 1,
            help = "name one of them at a time",
            "several experiments can't be shared at once"
        );
        Ok(())
    }
}

/// The command of an experiment that is one sweep.
fn only_step(experiment: &Experiment) -> Option<&'static ExperimentStep> {
    match experiment.steps {
        [step @ (ExperimentStep::Sdop(_) | ExperimentStep::SdopPrints(..))] => Some(step),
        _ => None,
    }
}

/// Whether all that an experiment does is cut into units, by what its command says of itself.
pub(super) fn sweep(experiment: &Experiment) -> bool {
    let Some(ExperimentStep::Sdop(arguments) | ExperimentStep::SdopPrints(_, arguments)) =
        only_step(experiment)
    else {
        return false;
    };
    let line = ["sdop"].iter().chain(*arguments);
    Cli::try_parse_from(line).is_ok_and(|cli| cli.command.is_sweep())
}

/// A rank but the first: has a part in the work, and keeps nothing of it.
pub(super) fn serve(args: &Args, experiment: &Experiment, directory: &Path) -> miette::Result<()> {
    for step in experiment.steps {
        let (mut command, _) = complete(args, experiment, step, &beside(directory, ".part"))?;
        steps::output(experiment, step, &mut command)?;
    }
    Ok(())
}

/// Measures a shard, and stores it next to the future record.
pub(super) fn shard(args: &Args, experiment: &Experiment, directory: &Path) -> miette::Result<()> {
    for step in experiment.steps {
        let (mut command, _) = complete(args, experiment, step, &beside(directory, SHARDS))?;
        steps::output(experiment, step, command.stdout(Stdio::inherit()))?;
    }
    Ok(())
}

/// Makes the record of all shards: that of one process, of the machine that the shards name, if
/// they do.
pub(super) fn merge(args: &Args, experiment: &Experiment, directory: &Path) -> miette::Result<()> {
    let line = command_line(experiment, args);
    let shards = shards(&beside(directory, SHARDS), &line)?;
    let mut machine = None;
    for path in &shards {
        let header = Units::read(path)?.header;
        for (what, there, here) in
            [("command", &header.line, &line), ("code", &header.code, &code())]
        {
            miette::ensure!(
                there == here,
                help = "merge with the arguments and the program that made the shards, or make them anew",
                "{}: its {what} is {there}, and this one's {here}",
                path.display()
            );
        }
        machine = header.settings.get("machine").cloned();
    }
    let machine: Option<Machine> =
        machine.map(serde_json::from_value).transpose().into_diagnostic()?;
    let part = prepare(directory)?;
    let program = std::env::current_exe().into_diagnostic()?;
    let mut command = Command::new(program);
    command.arg("merge").args(&shards).arg("--out").arg(&part).args(["--format", "json"]);
    for step in experiment.steps {
        let said = steps::output(experiment, step, &mut command)?;
        if let ExperimentStep::SdopPrints(file, _) = step {
            super::write(&part.join(file), said)?;
        }
    }
    let mut manifest = Manifest::describe(&part, experiment.name, line, experiment.deterministic)?;
    manifest.machine = machine;
    manifest.caches.clear();
    finish(args, experiment, manifest, directory)
}

/// The files of shards, by name.
fn shards(place: &Path, line: &str) -> miette::Result<Vec<PathBuf>> {
    let none = || {
        miette!(
            help = format!("make them: {line} --shard 1/n, 2/n, …"),
            "there are no shards in {}",
            place.display()
        )
    };
    if !place.is_dir() {
        return Err(none());
    }
    let entries = std::fs::read_dir(place).into_diagnostic();
    let mut files = Vec::new();
    for entry in entries.wrap_err_with(|| format!("cannot read {}", place.display()))? {
        let path = entry.into_diagnostic()?.path();
        if path.extension().is_some_and(|ending| ending == "units") {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(none());
    }
    Ok(files)
}
