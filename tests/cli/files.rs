//! Files: written files are complete or absent, and endless input is rejected.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::cli::{command, refusal, scene_file, text};

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

/// A run that is interrupted leaves the former record or none.
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

/// What took long to judge is kept for the user, wherever the command was given.
#[test]
fn truths_go_to_user_cache() {
    let (directory, scene) = scene_file(&LONG.replace("100000000", "40"));
    let [here, cache] = ["here", "cache"].map(|name| directory.path().join(name));
    fs::create_dir(&here).unwrap();
    let study = ["tradeoff", text(&scene), "--quick", "--seeds", "1"];
    let output = command(&study).current_dir(&here).env("XDG_CACHE_HOME", &cache).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    assert_eq!(fs::read_dir(&here).unwrap().count(), 0);
    assert!(fs::read_dir(cache.join("sdop/truth")).unwrap().count() > 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let (_directory, scene) = scene_file(LONG);
    let message = refusal(&["run", text(&scene), "--record", "/dev/full"]);
    assert!(message.contains("cannot write /dev/full"), "{message}");
}

/// A link to an endless device ends at the limit.
#[cfg(target_os = "linux")]
#[test]
fn endless_device_ends_at_limit() {
    let directory = tempfile::tempdir().unwrap();
    let link = |name: &str| {
        let path = directory.path().join(name);
        symlink("/dev/zero", &path).unwrap();
        path
    };
    let [mesh, scene] = ["mesh.obj", "scene.toml"].map(link);
    for args in [["mesh", text(&mesh)], ["run", text(&scene)], ["verify", text(&scene)]] {
        let message = refusal(&[&args[..], &["--max-file-size", "1"]].concat());
        assert!(message.contains("more than 1048576 bytes"), "{message}");
        assert!(message.contains("--max-file-size"), "{message}");
    }
    // A record's line, a recording and answers.
    let [record, boxes, answers] = ["run.ndjson", "run.aabbs", "answers"].map(link);
    let case = directory.path().join("case.ndjson");
    let (_scene, file) = scene_file(LONG);
    let run = ["run", text(&file), "--frames", "1", "--record", text(&case)];
    assert!(command(&run).status().unwrap().success());
    for args in [
        &["check", text(&record)][..],
        &["check", text(&boxes)],
        &["check", text(&case), "--pairs", text(&answers)],
        &["judge", "true", "--replay", text(&record)],
    ] {
        let message = refusal(&[args, &["--max-file-size", "1"]].concat());
        assert!(message.contains("1048576 bytes"), "{message}");
    }
    // A scene within the limit whose mesh is not.
    let (_other, scene) = scene_file(&format!(
        "name = \"endless\"\nframes = 1\n[[bodies]]\nmesh = {:?}\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n",
        text(&mesh)
    ));
    let message = refusal(&["run", text(&scene), "--max-file-size", "1"]);
    assert!(message.contains("more than 1048576 bytes"), "{message}");
    assert!(message.contains("mesh = "), "at its place: {message}");
}
