//! The built binary: exit codes, standard output and messages.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod board;
mod files;
mod mesh;
mod ranks;
mod recording;
mod report;
mod reproduce;
mod run;
mod sweep;
mod sweeps;
mod terminal;
mod view;
mod view_cases;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// `sdop` with these arguments, in the root of the repository.
fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sdop"));
    command.args(args).current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    command
}

fn sdop(args: &[&str]) -> Output {
    command(args).output().unwrap()
}

/// Standard output of a command that must succeed.
fn stdout(args: &[&str]) -> String {
    let output = sdop(args);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{args:?}: {stderr}");
    String::from_utf8(output.stdout).unwrap()
}

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&stdout(&[args, &["--format", "json"]].concat())).unwrap()
}

/// The message of a command that must refuse its input: exit code 2, nothing on standard output.
/// Line breaks and frames that fit it to a screen are taken out.
fn refusal(args: &[&str]) -> String {
    let output = sdop(args);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert_eq!(output.stdout, b"", "{args:?}");
    let words = stderr.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

/// A scene file in a directory that exists as long as the test.
fn scene_file(text: &str) -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    (directory, path)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Every command has help with an example.
#[test]
fn every_command_has_an_example() {
    let commands = stdout(&["--help"]);
    let listed = commands
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help");
    let mut number = 0;
    for name in listed {
        let help = stdout(&[name, "--help"]);
        let (_, examples) = help.split_once("\nExample").unwrap_or_else(|| panic!("{help}"));
        assert!(examples.contains(&format!(": sdop {name}")), "{help}");
        number += 1;
    }
    assert!(number >= 2, "{commands}");
}

/// A reader that leaves early is no error.
#[test]
fn early_reader_is_no_error() {
    let mut child = command(&["mesh", "data/meshes/spot.tri"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(output.status.code(), Some(0));
}

/// Invalid input is reported before the long work.
#[test]
fn invalid_input_fails_early() {
    let message = refusal(&["verify", "no-such.toml", "--seeds", "1000000"]);
    assert!(message.contains("no-such.toml"), "{message}");
    let control = ["cost", "data/scenes/paper-50.toml", "--strategy", "none"];
    let message = refusal(&control);
    assert!(message.contains("the control culls nothing"), "{message}");
    let message = refusal(&["run", "data/scenes/paper-50.toml", "--frames", "0"]);
    assert!(message.contains("0 is not in 1..="), "{message}");
    let message = refusal(&["run", "README.md"]);
    assert!(message.contains("written in TOML"), "{message}");
}

#[test]
fn an_unknown_command_is_bad_input() {
    assert!(refusal(&["rnu"]).contains("unrecognized subcommand 'rnu'"));
}
