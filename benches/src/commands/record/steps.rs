//! The programs of an experiment's steps.

use std::path::Path;
use std::process::{Command, Stdio};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::report::{Experiment, ExperimentStep};

/// What a step's command says, when it ends well.
pub(super) fn output(
    experiment: &Experiment,
    step: &ExperimentStep,
    command: &mut Command,
) -> miette::Result<Vec<u8>> {
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot run {}", experiment.name))?;
    // A planted bug must be seen.
    let expected = if planted(step) { Some(1) } else { Some(0) };
    if output.status.code() != expected {
        return Err(miette!("{} failed: {}", experiment.name, output.status));
    }
    Ok(output.stdout)
}

fn planted(step: &ExperimentStep) -> bool {
    matches!(step, ExperimentStep::Rapier(_, arguments) | ExperimentStep::Bullet(_, arguments) if arguments.contains("--without-margin"))
}

/// A step's command, and the file that its output becomes.
pub(super) fn command(
    step: &ExperimentStep,
    out: &Path,
) -> miette::Result<(Command, Option<&'static str>)> {
    let cargo = |arguments: &[&str]| {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments);
        cargo
    };
    let this = || Ok::<_, miette::Report>(Command::new(std::env::current_exe().into_diagnostic()?));
    let (mut command, file) = match *step {
        ExperimentStep::Sdop(arguments) => {
            let mut command = this()?;
            command.args(arguments).arg("--out").arg(out);
            (command, None)
        }
        ExperimentStep::SdopPrints(file, arguments) => {
            let mut command = this()?;
            command.args(arguments);
            (command, Some(file))
        }
        ExperimentStep::Peers(arguments) => {
            let mut command = cargo(&PEERS);
            // Engines in C++ are built as their packages are.
            command.env("CXX", "g++").args(words(arguments)).arg("--out").arg(out);
            (command, None)
        }
        ExperimentStep::Rapier(file, arguments) => {
            let mut command = cargo(&RAPIER);
            command.args(arguments.split(' '));
            let dropped = out.with_extension("dropped");
            if arguments.starts_with("check") {
                command.arg("--cases").arg(dropped);
            }
            command.arg("--out").arg(out.join(file));
            (command, None)
        }
        ExperimentStep::Bullet(file, arguments) => {
            let mut command = cargo(&BULLET);
            command.args(arguments.split(' '));
            command.arg("--out").arg(out.join(file));
            (command, None)
        }
        ExperimentStep::Bench(file, bench) => {
            (cargo(&["bench", "--quiet", "--bench", bench]), Some(file))
        }
        ExperimentStep::Estimates(file, benches) => (estimates(benches, &out.join(file))?, None),
        ExperimentStep::Script(file, arguments) => {
            let mut command = Command::new(arguments[0]);
            command.args(&arguments[1..]);
            (command, Some(file))
        }
    };
    command.stdout(if file.is_some() { Stdio::piped() } else { Stdio::null() });
    Ok((command, file))
}

/// The arguments in a line. A flag's value goes up to the next flag, whatever spaces it has.
fn words(line: &str) -> Vec<String> {
    let line = format!(" {line}");
    let (first, flags) = line.split_once(" --").unwrap_or((&line, ""));
    let mut words: Vec<String> = first.split_whitespace().map(str::to_owned).collect();
    for flag in flags.split(" --").filter(|flag| !flag.is_empty()) {
        let (name, value) = flag.split_once(' ').unwrap_or((flag, ""));
        words.push(format!("--{name}"));
        words.extend((!value.is_empty()).then(|| value.to_owned()));
    }
    words
}

const PEERS: [&str; 8] =
    ["run", "--release", "--quiet", "-p", "sdop-peers", "--features", "physx,debian,box3d", "--"];

const RAPIER: [&str; 6] = ["run", "--release", "--quiet", "-p", "sdop-rapier", "--"];

const BULLET: [&str; 8] =
    ["run", "--release", "--quiet", "-p", "sdop-bullet", "--features", "debian", "--"];

/// Runs benches into a directory of their own; the command that gathers criterion's estimates from
/// it.
fn estimates(benches: &[&str], file: &Path) -> miette::Result<Command> {
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
        if !status.success() {
            return Err(miette!("the bench {bench} failed: {status}"));
        }
    }
    let mut command = Command::new("cargo");
    command.args(["run", "--release", "--quiet", "-p", "sdop-peers", "--", "kernels"]);
    command.arg("--from").arg(home).arg("--out").arg(file);
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn values_may_have_spaces() {
        assert_eq!(words("narrow a.toml --frames 5"), ["narrow", "a.toml", "--frames", "5"]);
        let peers = "--peers sdop,parry3d refit,Embree --quick";
        assert_eq!(words(peers), ["--peers", "sdop,parry3d refit,Embree", "--quick"]);
    }
}
