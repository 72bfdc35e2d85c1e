//! How a record is made: its directory is prepared, the experiment's steps run, and it is put in
//! its place when it is whole.
//!
//! Ranks of `mpirun` run the experiment's command as ranks; only the output of the first is kept. A
//! shard is stored next to the future record until all shards are merged.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use clap::Parser as _;
use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::measure::conditions::Load;
use sdop_bench::measure::machine::Machine;
use sdop_bench::mpi;
use sdop_bench::report::{Experiment, ExperimentStep, FILE, Manifest};
use sdop_bench::sweep::{Units, code};

use super::super::Cli;
use super::super::files::{COMMAND, SHARING, write};
use super::{Args, chosen, estimates};

/// The endings of the directories next to a record's: of one that isn't whole, and of its shards.
const PART: &str = ".part";
const SHARDS: &str = ".shards";

/// Makes the record of an experiment; whether this process has put it in its place, which ranks but
/// the first and shards don't.
///
/// # Errors
/// A step that fails; shards that are missing or don't fit; files that can't be written.
pub(super) fn record(
    args: &Args,
    experiment: &Experiment,
    directory: &Path,
) -> miette::Result<bool> {
    if mpi::rank() > 0 {
        run(args, experiment, &beside(directory, PART), false)?;
        return Ok(false);
    }
    if args.sweep.shard.is_some() {
        run(args, experiment, &beside(directory, SHARDS), false)?;
        return Ok(false);
    }
    let part = prepare(directory)?;
    let line = command_line(experiment, args);
    if args.merge {
        let machine = merge(experiment, directory, &line)?;
        let mut manifest =
            Manifest::describe(&part, &experiment.name, line, &experiment.deterministic)?;
        manifest.machine = machine;
        manifest.caches.clear();
        finish(args, experiment, manifest, directory)?;
    } else {
        let (before, start) = (Load::now(), Instant::now());
        run(args, experiment, &part, true)?;
        let seconds = start.elapsed().as_secs_f64();
        let mut manifest =
            Manifest::describe(&part, &experiment.name, line, &experiment.deterministic)?;
        manifest.machine = Some(Machine::here(args.machine.tier()));
        manifest.load = before.zip(Load::now()).map(|(before, after)| [before, after]);
        manifest.seconds = Some(seconds);
        finish(args, experiment, manifest, directory)?;
    }
    Ok(true)
}

/// A directory whose name goes on beyond another's.
fn beside(directory: &Path, ending: &str) -> PathBuf {
    let mut beside = directory.as_os_str().to_owned();
    beside.push(ending);
    beside.into()
}

/// The directory for a record that isn't whole, without what an earlier run left there.
fn prepare(directory: &Path) -> miette::Result<PathBuf> {
    let part = beside(directory, PART);
    let prepare = || {
        if part.exists() {
            std::fs::remove_dir_all(&part)?;
        }
        std::fs::create_dir_all(&part)
    };
    prepare().into_diagnostic().wrap_err_with(|| format!("cannot write {}", part.display()))?;
    Ok(part)
}

/// Runs the experiment's steps, whose files go to `out`; output of programs becomes files only if
/// it `is_kept`.
fn run(args: &Args, experiment: &Experiment, out: &Path, is_kept: bool) -> miette::Result<()> {
    let (name, of) = (&experiment.name, experiment.steps.len());
    for (index, step) in experiment.steps.iter().enumerate() {
        if let ("estimates", Some(file)) = (&*step.program, &step.file) {
            eprintln!("{name} {}/{of}: {}", index + 1, step.arguments.join(" "));
            estimates::record(&step.arguments, &out.join(file))?;
            continue;
        }
        let mut command = command(step, out)?;
        if is_sweep(experiment) {
            command.args(args.sweep.arguments());
            if step.file.is_some() {
                command.arg("--out").arg(out); // of its shard
            }
        }
        command.args(further(args, experiment)?).env(COMMAND, command_line(experiment, args));
        if is_kept {
            let words = command.get_args().map(|word| word.to_string_lossy());
            eprintln!("{name} {}/{of}: {}", index + 1, words.collect::<Vec<_>>().join(" "));
        } else if args.sweep.shard.is_some() {
            command.stdout(Stdio::inherit());
        }
        let said = output(name, &mut command)?;
        if let Some(file) = step.file.as_ref().filter(|_| is_kept) {
            write(&out.join(file), said)?;
        }
    }
    Ok(())
}

/// Writes the manifest of a record that is whole, and puts it in its place.
fn finish(
    args: &Args,
    experiment: &Experiment,
    mut manifest: Manifest,
    directory: &Path,
) -> miette::Result<()> {
    manifest.note.clone_from(&args.note);
    manifest.add_inputs(Path::new("."), &experiment.scenes)?;
    let part = beside(directory, PART);
    write(&part.join(FILE), manifest.text())?;
    let replace = || {
        if directory.exists() {
            std::fs::remove_dir_all(directory)?;
        }
        std::fs::rename(&part, directory)
    };
    replace().into_diagnostic().wrap_err_with(|| format!("cannot write {}", directory.display()))
}

/// Joins the shards of a record into the directory of its parts; the machine that they name.
fn merge(experiment: &Experiment, directory: &Path, line: &str) -> miette::Result<Option<Machine>> {
    let shards = shards(&beside(directory, SHARDS), line)?;
    let mut machine = None;
    for path in &shards {
        let header = Units::read(path)?.header;
        for (what, there, here) in
            [("command", &*header.line, line), ("code", &*header.code, &*code())]
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
    let part = beside(directory, PART);
    let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
    command.arg("merge").args(&shards).arg("--out").arg(&part).args(["--format", "json"]);
    for step in &experiment.steps {
        let said = output(&experiment.name, &mut command)?;
        if let Some(file) = &step.file {
            write(&part.join(file), said)?;
        }
    }
    machine.map(serde_json::from_value).transpose().into_diagnostic()
}

/// The files of shards, by name.
fn shards(place: &Path, line: &str) -> miette::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(place).into_iter().flatten().flatten();
    let is_shard = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "units");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_shard).collect();
    files.sort();
    miette::ensure!(
        !files.is_empty(),
        help = format!("make them: {line} --shard 1/n, 2/n, …"),
        "there are no shards in {}",
        place.display()
    );
    Ok(files)
}

impl Args {
    /// Whether its work is cut into units, which many can share.
    pub fn is_sweep(&self) -> bool {
        let one = chosen(self).is_ok_and(|chosen| matches!(chosen[..], [one] if is_sweep(one)));
        one && !self.adopt && !self.merge
    }

    /// Refuses to share what has no units.
    ///
    /// # Errors
    /// An experiment that isn't known, or can't be shared.
    pub fn refuse(&self) -> miette::Result<()> {
        let shares = mpi::launched() > 1 || self.merge || !self.sweep.arguments().is_empty();
        if !shares || self.experiments.is_empty() {
            return Ok(());
        }
        let chosen = chosen(self)?;
        if let Some(whole) = chosen.iter().find(|experiment| !is_sweep(experiment)) {
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

/// Whether all that an experiment does is cut into units, by what its one command says of itself.
fn is_sweep(experiment: &Experiment) -> bool {
    let [step] = &experiment.steps[..] else {
        return false;
    };
    let line = ["sdop"].into_iter().chain(step.arguments.iter().map(String::as_str));
    step.is_sdop() && Cli::try_parse_from(line).is_ok_and(|cli| cli.command.is_sweep())
}

/// What a step's command gets beyond its own arguments: the SIMD level too, which the record names,
/// so that it is what ran.
pub(super) fn further(args: &Args, experiment: &Experiment) -> miette::Result<Vec<String>> {
    let behind = |flag: &&&str| args.more.iter().any(|argument| argument.starts_with(**flag));
    if let Some(flag) = SHARING.iter().chain(&["--simd"]).find(behind) {
        return Err(miette!(
            help = "put it before the --: it decides what is recorded",
            "{flag} after the --"
        ));
    }
    let mut more = args.more.clone();
    if let Some(tier) = args.machine.simd {
        miette::ensure!(
            experiment.steps.iter().all(ExperimentStep::is_sdop),
            help =
                "leave the level out: only experiments that sdop runs itself can be limited to one",
            "{} chooses its SIMD levels",
            experiment.name
        );
        more.extend(["--simd".to_owned(), tier.name().to_owned()]);
    }
    Ok(more)
}

/// The command as a reader types it.
pub(super) fn command_line(experiment: &Experiment, args: &Args) -> String {
    let mut command = format!("sdop record {}", experiment.name);
    if let Some(tier) = args.machine.simd {
        command.push_str(&format!(" --simd {tier}"));
    }
    if !args.more.is_empty() {
        command.push_str(" -- ");
        command.push_str(&args.more.join(" "));
    }
    command
}

/// What a step's command prints, if it ends well.
fn output(name: &str, command: &mut Command) -> miette::Result<Vec<u8>> {
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot run {name}"))?;
    if !output.status.success() {
        return Err(miette!("{name} failed: {}", output.status));
    }
    Ok(output.stdout)
}

/// A step's command. Programs that write files themselves have `--out` with a directory.
fn command(step: &ExperimentStep, out: &Path) -> miette::Result<Command> {
    let mut command = match step.program.as_str() {
        "sdop" => {
            let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
            command.args(&step.arguments);
            if step.file.is_none() {
                command.arg("--out").arg(out);
            }
            command
        }
        "field" => {
            let mut cargo = Command::new("cargo");
            // Engines in C++ are built as their packages are.
            cargo.env("CXX", "g++").args([
                "run",
                "--profile",
                "optimised",
                "--quiet",
                "-p",
                "sdop-field",
            ]);
            cargo.args(["--features", "physx,debian,box3d", "--"]).args(&step.arguments);
            cargo.arg("--out").arg(out);
            cargo
        }
        "bench" => {
            let mut cargo = Command::new("cargo");
            cargo.args(["bench", "--quiet", "--bench"]).args(&step.arguments);
            cargo
        }
        script => {
            let mut command = Command::new(script);
            command.args(&step.arguments);
            command
        }
    };
    command.stdout(if step.file.is_some() { Stdio::piped() } else { Stdio::null() });
    Ok(command)
}
