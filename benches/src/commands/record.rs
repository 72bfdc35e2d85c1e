//! `sdop record`: runs an experiment and stores its measurements with their provenance.

mod estimates;
mod flow;
mod identifier;

use std::path::{Path, PathBuf};
use std::time::Duration;

use miette::{IntoDiagnostic as _, miette};
use sdop_bench::report::{CodeVersion, Experiment, FILE, Manifest, experiments};

use super::Outcome;
use super::files::write;
use super::output::{paragraphs, print, rows};
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
                experiment.name.clone(),
                experiment.about.clone(),
                duration(&args.out, experiment),
                experiment.needs.clone(),
            ]
        });
        print(&paragraphs(&format!(
            "{list}\nAll need a checkout of the repository and run in its root. \"takes\" is from the latest record that says so."
        )))?;
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
    for experiment in chosen(args)? {
        let directory = place(args, &experiment.name);
        if flow::record(args, experiment, &directory)? {
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
        flow::further(args, experiment)?;
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
        let manifest = Manifest::read(&machine.path().join(&experiment.name)).ok()?;
        let seconds = manifest.seconds?;
        Some((manifest.date, seconds))
    });
    let latest = measured.max_by(|a, b| a.0.cmp(&b.0));
    latest.map_or(experiment.takes.clone(), |(_, seconds)| {
        let whole = Duration::from_secs(seconds.ceil() as u64);
        humantime::format_duration(whole).to_string()
    })
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
        let names: Vec<&str> = experiments().map(|experiment| &*experiment.name).collect();
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

/// Describes files that were measured before records had manifests.
fn adopt(
    args: &Args,
    name: &str,
    known: Option<&Experiment>,
    directory: &Path,
) -> miette::Result<()> {
    let deterministic = known.map_or(&[][..], |experiment| &experiment.deterministic);
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
            known.map_or_else(String::new, |experiment| flow::command_line(experiment, args));
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
