//! An interrupted run leaves the former record or none.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::cli::{command, scene_file, text};

const LONG: &str = r#"
name = "long"
frames = 100000000
dt = 0.01
[box]
side = 20.0
[[bodies]]
shape = "box"
count = 50
radius = 1.0
speed = 1.0
[effects]
motion = true
walls = "specular"
"#;

/// The bytes of the unfinished file next to `path`.
fn unfinished(path: &Path) -> u64 {
    let entries = fs::read_dir(path.parent().unwrap()).unwrap();
    let parts = entries.map(|entry| entry.unwrap().path());
    let part = parts.filter(|path| path.extension() == Some("part".as_ref()));
    part.map(|path| fs::metadata(path).unwrap().len()).sum()
}

#[test]
fn interrupted_run_keeps_former_record() {
    for signal in ["INT", "TERM", "KILL"] {
        for former in [Some("the former record"), None] {
            let (directory, scene) = scene_file(LONG);
            let record = directory.path().join("run.ndjson");
            if let Some(former) = former {
                fs::write(&record, former).unwrap();
            }
            let mut child = command(&["run", text(&scene), "--record", text(&record)])
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            let start = Instant::now();
            while unfinished(&record) < 100_000 {
                assert!(child.try_wait().unwrap().is_none(), "it runs for days");
                assert!(start.elapsed() < Duration::from_secs(120), "no record is begun");
                std::thread::sleep(Duration::from_millis(5));
            }
            let pid = child.id().to_string();
            let killed = Command::new("kill").args(["-s", signal, &pid]).status();
            assert!(killed.unwrap().success());
            assert!(!ended(child, signal).success());
            let left = fs::read_to_string(&record).ok();
            assert_eq!(left.as_deref(), former, "{signal}");
        }
    }
}

/// Waits for the end, 20 s at most: a shell may start tests in the background with signals ignored,
/// which children inherit.
fn ended(mut child: Child, signal: &str) -> ExitStatus {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        if start.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            panic!("{signal} doesn't end it: is it ignored where these tests were started?");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}
