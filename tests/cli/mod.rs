//! The built binary: exit codes, standard output and messages.
//!
//! The folder `tests/cmd` has commands with what they print. Only what such a file can't hold is
//! written in Rust: runs that are interrupted, and records that are read by another program.
#![cfg(target_os = "linux")] // files use options of GNU's tools
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod files;
mod recording;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::answers;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// `sdop` with these arguments, in the root of the repository.
fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sdop"));
    command.args(args).current_dir(ROOT);
    command
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

/// Runs the commands of a file in a folder of their own, which has a link to `data`; `$ROOT` is the
/// repository. An answer is the exit code unless it is 0 (`? 2`), standard output, and the lines of
/// standard error after `! `, without empty lines and blanks at ends of lines.
pub fn check(name: &str) {
    let place = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(Path::new(ROOT).join("data"), place.path().join("data")).unwrap();
    let own = Path::new(env!("CARGO_BIN_EXE_sdop")).parent().unwrap();
    let path = format!("{}:{}", own.display(), std::env::var("PATH").unwrap());
    answers::check(&Path::new(ROOT).join(format!("tests/cmd/{name}.console")), |input| {
        let mut shell = Command::new("sh");
        shell.args(["-c", input]).current_dir(&place).stdin(Stdio::null());
        shell
            .env("PATH", &path)
            .env("ROOT", ROOT)
            .env("LC_ALL", "C")
            .env("XDG_CACHE_HOME", place.path().join(".cache"));
        let output = shell.output().unwrap();
        let code = output.status.code().unwrap();
        let mut answer = if code == 0 { String::new() } else { format!("? {code}\n") };
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            answer += &format!("{}\n", line.trim_end());
        }
        let errors = String::from_utf8_lossy(&output.stderr);
        for line in errors.lines().filter(|line| !line.trim().is_empty()) {
            answer += &format!("! {}\n", line.trim_end());
        }
        answer
    });
}

/// A test for each file, so that they run side by side; none is left out.
macro_rules! files {
    ($($name:ident),+) => {
        $(#[test]
        fn $name() {
            check(stringify!($name));
        })+

        #[test]
        fn every_file_is_checked() {
            let listed = [$(stringify!($name)),+, "judge"]; // checked in that room
            for file in std::fs::read_dir(Path::new(ROOT).join("tests/cmd")).unwrap() {
                let path = file.unwrap().path();
                let name = path.file_stem().unwrap().to_str().unwrap();
                assert!(path.extension() == Some("awk".as_ref()) || listed.contains(&name), "{name}");
            }
        }
    };
}
files!(board, cost, mesh, program, records, report, reproduce, run, shards, tradeoff, view);
