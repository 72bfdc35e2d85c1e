//! `sdop record`: runs an experiment and stores its measurements with their provenance.

mod identifier;
mod shared;
mod steps;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::measure::machine::Machine;
use sdop_bench::mpi;
use sdop_bench::report::{
    CodeVersion, Experiment, ExperimentStep, FILE, Load, Manifest, experiments,
};

use super::Outcome;
use super::files::{COMMAND, SHARING, write};
use super::output::{print, rows};
use super::scene_args::MachineArgs;
use super::sweep::SweepArgs;

/// Run an experiment and store its measurements under data/record
///
/// Writes the experiment's tables and record.json, which has the command, commit, date, machine,
/// compiler, load before and after, and the digest of every file and input. Without an experiment,
/// lists all of them. With the first digits of a record's identifier, prints its record.json, from
/// the git history if the tree no longer has it. Sweeps (reproduce, tradeoff, verify) can be shared
/// by ranks of mpirun or split into shards; other experiments are measured in one process.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop record\n          sdop record a6d7f33e907e\n          sdop record reproduce kernels --name my-laptop\n          sdop record reproduce --name my-laptop -- --quick\n          \
    mpirun -n 64 sdop record verify --name my-cluster\n          sdop record verify --name my-cluster --shard 3/64, then once --merge"
)]
pub struct Args {
    /// The experiments (kernels and peers mean all experiments in their group), or an identifier
    experiments: Vec<String>,
    /// The machine's name in data/record
    #[arg(long, value_name = "NAME", default_value = "here")]
    name: String,
    /// Output directory for records
    #[arg(long, value_name = "DIR", default_value = "data/record")]
    out: PathBuf,
    /// Describe existing files instead of measuring; they keep the commit that last changed them
    #[arg(long)]
    adopt: bool,
    /// A note for readers of the record
    #[arg(long, value_name = "TEXT")]
    note: Option<String>,
    /// Make the record from the shards that --shard wrote
    #[arg(long, conflicts_with_all = ["adopt", "shard", "share_cores"])]
    merge: bool,
    #[command(flatten)]
    sweep: SweepArgs,
    #[command(flatten)]
    machine: MachineArgs,
    /// Further arguments for the experiment, after --
    #[arg(last = true)]
    more: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// An unknown experiment; a measurement that fails; files that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    if args.experiments.is_empty() {
        let all: Vec<_> = experiments().collect();
        let header = ["experiment", "measures", "takes", "needs"];
        let list = rows(&header, &all, |experiment| {
            vec![
                experiment.name.to_owned(),
                experiment.about.to_owned(),
                duration(&args.out, experiment),
                experiment.needs(),
            ]
        });
        print(&format!(
            "{list}\nAll need a checkout of the repository and run in its root. \"takes\" is from the latest record that says so."
        ))?;
        return Ok(Outcome::Passed);
    }
    if let [digits] = &args.experiments[..]
        && !args.adopt
        && identifier::is_identifier(digits)
    {
        identifier::show(&args.out, digits)?;
        return Ok(Outcome::Passed);
    }
    if args.adopt {
        for name in &args.experiments {
            adopt(args, name, Experiment::named(name), &place(args, name))?;
            say(&place(args, name))?;
        }
        return Ok(Outcome::Passed);
    }
    // All names and arguments are looked at before anything is measured.
    let chosen = chosen(args)?;
    for experiment in chosen {
        let directory = place(args, experiment.name);
        if mpi::rank() > 0 {
            shared::serve(args, experiment, &directory)?;
        } else if args.sweep.shard().is_some() {
            shared::shard(args, experiment, &directory)?;
        } else {
            if args.merge {
                shared::merge(args, experiment, &directory)?;
            } else {
                measure(args, experiment, &directory)?;
            }
            say(&directory)?;
        }
    }
    Ok(Outcome::Passed)
}

/// The experiments that are named, with arguments that they take.
fn chosen(args: &Args) -> miette::Result<Vec<&'static Experiment>> {
    let mut chosen: Vec<&Experiment> = Vec::new();
    for name in &args.experiments {
        chosen.extend(named(name)?);
    }
    for experiment in &chosen {
        further(args, experiment)?;
        if let Some(file) = experiment.missing(Path::new(".")) {
            return Err(miette!(
                help = "run it in the root of a checkout of the repository",
                "{} needs {}, and there is no such file here",
                experiment.name,
                file.display()
            ));
        }
    }
    Ok(chosen)
}

/// How long an experiment took, by the latest of its records that says so.
fn duration(records: &Path, experiment: &Experiment) -> String {
    let machines = std::fs::read_dir(records).into_iter().flatten().flatten();
    let measured = machines.filter_map(|machine| {
        let manifest = Manifest::read(&machine.path().join(experiment.name)).ok()?;
        let seconds = manifest.seconds?;
        Some((manifest.date, machine.file_name(), seconds))
    });
    match measured.max_by(|a, b| a.0.cmp(&b.0)) {
        None => experiment.roughly().to_owned(),
        Some((_, machine, seconds)) => {
            let time = humantime::format_duration(Duration::from_secs(seconds.ceil() as u64));
            format!("{time} ({})", machine.to_string_lossy())
        }
    }
}

fn place(args: &Args, experiment: &str) -> PathBuf {
    args.out.join(&args.name).join(experiment)
}

/// The experiment of that name, or all experiments of that group.
fn named(name: &str) -> miette::Result<Vec<&'static Experiment>> {
    let belongs = |experiment: &&Experiment| {
        let rest = experiment.name.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    let found: Vec<_> = experiments().filter(belongs).collect();
    if found.is_empty() {
        let names: Vec<&str> = experiments().map(|experiment| experiment.name).collect();
        return Err(miette!(
            help = format!("one of: {}", names.join(", ")),
            "unknown experiment `{name}`"
        ));
    }
    Ok(found)
}

fn say(directory: &Path) -> miette::Result<()> {
    let manifest = Manifest::read(directory)?;
    print(&format!(
        "{}: record {}, {} files",
        directory.display(),
        manifest.id(),
        manifest.files.len()
    ))
}

/// Measures into a temporary directory next to the record's, and renames it when the record is
/// complete.
fn measure(args: &Args, experiment: &Experiment, directory: &Path) -> miette::Result<()> {
    let part = prepare(directory)?;
    let (before, start) = (Load::now(), Instant::now());
    execute(args, experiment, &part)?;
    let seconds = start.elapsed().as_secs_f64();
    let command = command_line(experiment, args);
    let mut manifest =
        Manifest::describe(&part, experiment.name, command, experiment.deterministic)?;
    manifest.machine = Some(Machine::here(args.machine.tier()));
    manifest.load = before.zip(Load::now()).map(|(before, after)| [before, after]);
    manifest.seconds = Some(seconds);
    finish(args, experiment, manifest, directory)
}

/// A directory whose name goes on beyond another's.
fn beside(directory: &Path, ending: &str) -> PathBuf {
    let mut beside = directory.as_os_str().to_owned();
    beside.push(ending);
    beside.into()
}

/// The directory for a record that isn't whole, without what an earlier run left there.
fn prepare(directory: &Path) -> miette::Result<PathBuf> {
    let part = beside(directory, ".part");
    let prepare = || {
        if part.exists() {
            std::fs::remove_dir_all(&part)?;
        }
        std::fs::create_dir_all(&part)
    };
    prepare().into_diagnostic().wrap_err_with(|| format!("cannot write {}", part.display()))?;
    Ok(part)
}

/// Writes the manifest of a record that is whole, and puts it in its place.
fn finish(
    args: &Args,
    experiment: &Experiment,
    mut manifest: Manifest,
    directory: &Path,
) -> miette::Result<()> {
    manifest.note.clone_from(&args.note);
    manifest.add_inputs(Path::new("."), experiment.scenes)?;
    let part = beside(directory, ".part");
    write(&part.join(FILE), manifest.text())?;
    let replace = || {
        if directory.exists() {
            std::fs::remove_dir_all(directory)?;
        }
        std::fs::rename(&part, directory)
    };
    replace().into_diagnostic().wrap_err_with(|| format!("cannot write {}", directory.display()))
}

/// What a step's command gets beyond its own arguments: the SIMD level too, which the record names,
/// so that it is what ran.
fn further(args: &Args, experiment: &Experiment) -> miette::Result<Vec<String>> {
    let behind = |flag: &&&str| args.more.iter().any(|argument| argument.starts_with(**flag));
    if let Some(flag) = SHARING.iter().chain(&["--simd"]).find(behind) {
        return Err(miette!(
            help = "put it before the --: it decides what is recorded",
            "{flag} after the --"
        ));
    }
    let mut more = args.more.clone();
    if let Some(tier) = args.machine.asked() {
        let ours = |step: &ExperimentStep| {
            matches!(step, ExperimentStep::Sdop(_) | ExperimentStep::SdopPrints(..))
        };
        if !experiment.steps.iter().all(ours) {
            return Err(miette!(
                help = "leave the level out: only experiments that sdop runs itself can be limited to one",
                "{} chooses its SIMD levels",
                experiment.name
            ));
        }
        more.extend(["--simd".to_owned(), tier.name().to_owned()]);
    }
    Ok(more)
}

/// Runs the experiment's steps.
fn execute(args: &Args, experiment: &Experiment, out: &Path) -> miette::Result<()> {
    for (index, step) in experiment.steps.iter().enumerate() {
        let (mut command, file) = complete(args, experiment, step, out)?;
        let words = command.get_args().map(|word| word.to_string_lossy());
        let line = words.collect::<Vec<_>>().join(" ");
        let (name, of) = (experiment.name, experiment.steps.len());
        eprintln!("{name} {}/{of}: {line}", index + 1);
        let said = steps::output(experiment, step, &mut command)?;
        if let Some(file) = file {
            write(&out.join(file), said)?;
        }
    }
    Ok(())
}

/// A step's command with the arguments that this run adds, and the file for its output.
fn complete(
    args: &Args,
    experiment: &Experiment,
    step: &ExperimentStep,
    out: &Path,
) -> miette::Result<(Command, Option<&'static str>)> {
    let (mut command, file) = steps::command(step, out)?;
    if shared::sweep(experiment) {
        command.args(args.sweep.arguments());
        if file.is_some() {
            // Its shard.
            command.arg("--out").arg(out);
        }
    }
    command.args(further(args, experiment)?).env(COMMAND, command_line(experiment, args));
    Ok((command, file))
}

/// The command as a reader types it.
fn command_line(experiment: &Experiment, args: &Args) -> String {
    let mut command = format!("sdop record {}", experiment.name);
    if let Some(tier) = args.machine.asked() {
        command.push_str(&format!(" --simd {tier}"));
    }
    if !args.more.is_empty() {
        command.push_str(" -- ");
        command.push_str(&args.more.join(" "));
    }
    command
}

/// Describes files that were measured before records had manifests.
fn adopt(
    args: &Args,
    name: &str,
    known: Option<&Experiment>,
    directory: &Path,
) -> miette::Result<()> {
    let deterministic = known.map_or(&[][..], |experiment| experiment.deterministic);
    let mut manifest = Manifest::describe(directory, name, String::new(), deterministic)?;
    for file in manifest.files.keys().filter(|file| file.ends_with(".json")) {
        let text = std::fs::read_to_string(directory.join(file)).into_diagnostic()?;
        let value: serde_json::Value = serde_json::from_str(&text).into_diagnostic()?;
        if let Some(command) = value["command"].as_str() {
            command.clone_into(&mut manifest.command);
        }
        manifest.machine =
            serde_json::from_value(value["machine"].clone()).ok().or(manifest.machine);
    }
    if manifest.command.is_empty() {
        manifest.command =
            known.map_or_else(String::new, |experiment| command_line(experiment, args));
    }
    manifest.caches.clear();
    let touched = CodeVersion::last_touching(Path::new("."), directory);
    if let Some((commit, day)) = touched {
        manifest.code = CodeVersion::at(Path::new("."), &commit);
        manifest.date = day;
    }
    manifest.note.clone_from(&args.note);
    write(&directory.join(FILE), manifest.text())
}
