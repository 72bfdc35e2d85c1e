//! `sdop record`: runs an experiment and keeps what it measured, with where it comes from.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::lab::measure::machine::Machine;
use sdop::lab::report::{Code, EXPERIMENTS, Experiment, FILE, Load, Manifest, Program};

use super::Outcome;
use super::files::write;
use super::output::{print, rows};
use super::scene_args::MachineArgs;

/// Run an experiment and keep its measurements under data/record
///
/// Writes the experiment's tables and record.json: command, commit, date, machine, compiler, load before and after, and the digest of
/// every file and input. Without an experiment, lists them.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop record\n          sdop record reproduce --name my-laptop\n          sdop record reproduce --name my-laptop -- --quick"
)]
pub struct Args {
    /// The experiment
    experiment: Option<String>,
    /// What the machine is called in data/record
    #[arg(long, value_name = "NAME", default_value = "here")]
    name: String,
    /// Where records go
    #[arg(long, value_name = "DIR", default_value = "data/record")]
    out: PathBuf,
    /// Describe the files that are there already instead of measuring; they keep the commit that last touched them
    #[arg(long)]
    adopt: bool,
    /// A note for readers of the record
    #[arg(long, value_name = "TEXT")]
    note: Option<String>,
    #[command(flatten)]
    machine: MachineArgs,
    /// Further arguments of the experiment, behind --
    #[arg(last = true)]
    more: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// An unknown experiment; a measurement that fails; files that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let Some(name) = &args.experiment else {
        let list = rows(&["experiment", "measures"], EXPERIMENTS, |experiment| {
            vec![experiment.name.to_owned(), experiment.about.to_owned()]
        });
        print(&list.to_string())?;
        return Ok(Outcome::Passed);
    };
    let directory = args.out.join(&args.name).join(name);
    let known = EXPERIMENTS
        .iter()
        .find(|experiment| experiment.name == name);
    if args.adopt {
        adopt(args, name, known, &directory)?;
    } else {
        let experiment = known.ok_or_else(|| {
            let names: Vec<&str> = EXPERIMENTS
                .iter()
                .map(|experiment| experiment.name)
                .collect();
            miette!(
                help = format!("one of: {}", names.join(", ")),
                "unknown experiment `{name}`"
            )
        })?;
        measure(args, experiment, &directory)?;
    }
    let manifest = Manifest::read(&directory)?;
    print(&format!(
        "{}: record {}, {} files",
        directory.display(),
        manifest.id(),
        manifest.files.len()
    ))?;
    Ok(Outcome::Passed)
}

/// Measures into a directory beside, and puts it in its place when it is whole.
fn measure(args: &Args, experiment: &Experiment, directory: &Path) -> miette::Result<()> {
    let beside = directory.with_extension("part");
    let cannot = || format!("cannot write {}", beside.display());
    if beside.exists() {
        std::fs::remove_dir_all(&beside)
            .into_diagnostic()
            .wrap_err_with(cannot)?;
    }
    std::fs::create_dir_all(&beside)
        .into_diagnostic()
        .wrap_err_with(cannot)?;
    let before = Load::now();
    execute(experiment, &args.more, &beside)?;
    let command = command_line(experiment, &args.more);
    let mut manifest =
        Manifest::describe(&beside, experiment.name, command, experiment.deterministic)?;
    manifest.machine = Some(Machine::here(args.machine.tier()));
    manifest.load = before
        .zip(Load::now())
        .map(|(before, after)| [before, after]);
    manifest.note.clone_from(&args.note);
    manifest.add_inputs(Path::new("."), experiment.scenes)?;
    write(&beside.join(FILE), manifest.text())?;
    if directory.exists() {
        std::fs::remove_dir_all(directory)
            .into_diagnostic()
            .wrap_err_with(cannot)?;
    }
    std::fs::rename(&beside, directory)
        .into_diagnostic()
        .wrap_err_with(cannot)
}

/// Runs the experiment's program; what it prints becomes the record's table where it writes no files itself.
fn execute(experiment: &Experiment, more: &[String], out: &Path) -> miette::Result<()> {
    let mut command = program(experiment)?;
    command.args(experiment.arguments).args(more);
    let takes_out = !matches!(experiment.program, Program::Bench { .. });
    if takes_out {
        command.arg("--out").arg(out).stdout(Stdio::null());
    }
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot run {}", experiment.name))?;
    if !output.status.success() {
        return Err(miette!("{} failed: {}", experiment.name, output.status));
    }
    match experiment.program {
        Program::Bench { file } => write(
            &out.join(file),
            String::from_utf8_lossy(&output.stdout).as_bytes(),
        ),
        Program::Sdop | Program::Peers => Ok(()),
    }
}

fn program(experiment: &Experiment) -> miette::Result<Command> {
    Ok(match experiment.program {
        Program::Sdop => Command::new(std::env::current_exe().into_diagnostic()?),
        Program::Peers => {
            let mut cargo = Command::new("cargo");
            cargo.args(["run", "--release", "--quiet", "-p", "sdop-peers", "--"]);
            cargo
        }
        Program::Bench { .. } => {
            let mut cargo = Command::new("cargo");
            cargo.args(["bench", "--quiet", "--bench"]);
            cargo
        }
    })
}

/// The command as a reader types it.
fn command_line(experiment: &Experiment, more: &[String]) -> String {
    let mut command = format!("sdop record {}", experiment.name);
    if !more.is_empty() {
        command.push_str(" -- ");
        command.push_str(&more.join(" "));
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
        manifest.machine = serde_json::from_value(value["machine"].clone())
            .ok()
            .or(manifest.machine);
    }
    if manifest.command.is_empty() {
        manifest.command =
            known.map_or_else(String::new, |experiment| command_line(experiment, &[]));
    }
    manifest.caches.clear();
    let touched = Code::last_touching(Path::new("."), directory);
    if let Some((commit, day)) = touched {
        manifest.code = Code::at(Path::new("."), &commit);
        manifest.date = day;
    }
    manifest.note.clone_from(&args.note);
    write(&directory.join(FILE), manifest.text())
}
