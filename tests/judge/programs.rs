//! Programs under judgement: what each ill behaviour is called, that none is waited for, and that the next case is run.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use sdop::judge::answer::Trouble;
use sdop::judge::process::Program;
use sdop::judge::wire::Wire;
use sdop::judge::{Claim, Options, Outcome, Verdict, examine};

/// A program that reads frames and answers each with what `answer` says; $n is the frame's number.
fn answering(answer: &str) -> String {
    format!("read -r header; n=0; while read -r frame; do {answer}; n=$((n + 1)); done")
}

const RIGHT: &str = r#"echo "{\"frame\":$n,\"pairs\":[]}""#;

fn run(command: &str, wire: Wire, timeout: f64, case: &str) -> Verdict {
    let program = Program {
        command: command.to_owned(),
        wire,
        timeout: Duration::from_secs_f64(timeout),
    };
    let options = Options {
        claim: Claim::Aabb,
        pattern: case.to_owned(),
        ..Options::default()
    };
    examine(&program, &options, |_, _| {}).unwrap()
}

/// What a program's only case ends with. Generous: the machine may be busy.
fn trouble(command: &str) -> Trouble {
    let verdict = run(command, Wire::Ndjson, 20.0, "churn/swap/0001");
    assert!(!verdict.passed());
    match verdict.cases[0].outcome.clone() {
        Outcome::Error { trouble } => trouble,
        other => panic!("{command}: {other:?}"),
    }
}

#[test]
fn a_program_that_answers_nothing_in_time_is_stopped_with_all_that_it_started() {
    let start = Instant::now();
    for command in [
        "sleep 1000",
        "sleep 1000 & wait",
        "cat > /dev/null; sleep 1000",
        "while :; do :; done",
    ] {
        let verdict = run(command, Wire::Ndjson, 0.3, "churn/swap/0001");
        let outcome = &verdict.cases[0].outcome;
        assert!(
            matches!(
                outcome,
                Outcome::Error {
                    trouble: Trouble::Timeout { frame: 0, .. }
                }
            ),
            "{command}: {outcome:?}"
        );
    }
    assert!(start.elapsed() < Duration::from_secs(60));
}

#[test]
fn a_program_that_goes_on_after_its_input_has_ended_is_no_pass() {
    let command = format!("{}; exec sleep 1000", answering(RIGHT));
    let verdict = run(&command, Wire::Ndjson, 4.0, "churn/swap/0001");
    let outcome = &verdict.cases[0].outcome;
    assert!(
        matches!(
            outcome,
            Outcome::Error {
                trouble: Trouble::Hanging { .. }
            }
        ),
        "{outcome:?}"
    );
}

#[test]
fn crashes_floods_and_early_ends_have_names() {
    let found = trouble("read -r header; read -r frame; echo out of memory >&2; exit 3");
    assert!(
        matches!(&found, Trouble::Crashed { how, answered: 0, said } if how == "exit code 3" && said.contains("out of memory")),
        "{found}"
    );
    let found = trouble("kill -SEGV $$");
    assert!(
        matches!(&found, Trouble::Crashed { how, .. } if how == "signal 11"),
        "{found}"
    );
    assert!(matches!(
        trouble("true"),
        Trouble::Early {
            answered: 0,
            frames: 6,
            ..
        }
    ));
    assert!(
        matches!(trouble("no-such-program-here"), Trouble::Crashed { how, .. } if how == "exit code 127")
    );
    // On one line, on lines of their own, and in answers that are right but for their size.
    for command in [
        "tr '\\0' x < /dev/zero",
        "read -r h; printf '{\"frame\":0,\"pairs\":['; while :; do printf '[0,1],'; done",
    ] {
        assert!(
            matches!(trouble(command), Trouble::Flood { .. }),
            "{command}"
        );
    }
    // All answers are right, and then it fails.
    let found = trouble(&format!("{}; exit 1", answering(RIGHT)));
    assert!(
        matches!(found, Trouble::Crashed { answered: 6, .. }),
        "{found}"
    );
}

#[test]
fn lines_that_are_no_answers_have_names() {
    for (line, why) in [
        ("hello", "no JSON"),
        ("", "6 frames"),
        (r#"{"frame":0}"#, "missing field `pairs`"),
        (r#"{"frame":0,"pairs":[[0,NaN]]}"#, "NaN"),
        (r#"{"frame":0,"pairs":[[0,-1]]}"#, "-1"),
        (r#"{"frame":0,"pairs":[[0,1.5]]}"#, "1.5"),
        (r#"{"frame":0,"pairs":[[0,1,2]]}"#, "trailing"),
        (r#"{"frame":0,"pairs":[[0,99999999999]]}"#, "99999999999"),
        (r#"{"frame":0,"pairs":[[0,4"#, "no JSON"),
    ] {
        let said = trouble(&answering(&format!("echo '{line}'"))).to_string();
        assert!(said.contains(why), "{line}: {said}");
    }
    let answer = |pairs: &str| {
        trouble(&answering(&format!(
            r#"echo "{{\"frame\":$n,\"pairs\":[{pairs}]}}""#
        )))
    };
    assert_eq!(answer("[3,3]"), Trouble::SelfPair { frame: 0, body: 3 });
    assert_eq!(
        answer("[4,1]"),
        Trouble::Reversed {
            frame: 0,
            pair: [4, 1]
        }
    );
    assert_eq!(
        answer("[0,1],[0,1]"),
        Trouble::Twice {
            frame: 0,
            pair: [0, 1]
        }
    );
    assert_eq!(
        answer("[0,40]"),
        Trouble::NoBody {
            frame: 0,
            pair: [0, 40],
            bodies: 40
        }
    );
    // Every frame twice, and the last one twice.
    assert_eq!(
        trouble(&answering(&format!("{RIGHT}; {RIGHT}"))),
        Trouble::OutOfTurn {
            expected: 1,
            found: 0
        }
    );
    let found = trouble(&format!("{}; echo more", answering(RIGHT)));
    assert_eq!(
        found,
        Trouble::TooMany {
            frames: 6,
            line: "more".to_owned()
        }
    );
}

#[test]
fn a_program_may_skip_a_case_and_a_run_of_skipped_cases_is_no_pass() {
    let skips = |wire, line: &str| {
        let verdict = run(
            &answering(&format!("echo '{line}'; exit 0")),
            wire,
            20.0,
            "churn/swap/000[0-9]".replace("[0-9]", "?").as_str(),
        );
        assert!(!verdict.passed());
        assert!(
            verdict.cases.len() == 4
                && verdict.cases.iter().all(
                    |case| matches!(&case.outcome, Outcome::Skipped { why } if why == "no swaps")
                ),
            "{verdict}"
        );
    };
    skips(Wire::Ndjson, r#"{"frame":0,"skipped":"no swaps"}"#);
    skips(Wire::Text, "skip no swaps");
}

#[test]
fn a_failing_case_does_not_end_the_run() {
    // Fails on every second case or so, by its name.
    let command = format!(
        "read -r header; case $header in *0001*) exit 9;; esac; {}",
        answering(RIGHT).replacen("read -r header;", "", 1)
    );
    let verdict = run(&command, Wire::Ndjson, 20.0, "churn/teleport/*");
    let crashed = verdict
        .cases
        .iter()
        .filter(|case| matches!(case.outcome, Outcome::Error { .. }))
        .count();
    assert_eq!(
        (verdict.cases.len(), crashed, verdict.not_run),
        (4, 1, 0),
        "{verdict}"
    );
}

/// The command line, in a directory of its own.
fn sdop(directory: &Path, arguments: &[&str]) -> (Output, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_sdop"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (output, text)
}

fn example(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "examples", "judge", name]
        .iter()
        .collect();
    path.display().to_string()
}

#[test]
fn the_python_example_passes_and_its_full_buffer_is_found_with_a_small_scene_that_replays() {
    if Command::new("python3").arg("--version").output().is_err() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let right = format!("python3 {}", example("boxes.py"));
    let cases = [
        "--claims",
        "aabb",
        "--case",
        "b*",
        "--timeout",
        "60",
        "--no-fresh",
    ];
    let run = |command: &str, more: &[&str]| {
        sdop(
            directory.path(),
            &[&["verify", "--exec", command], &cases[..], more].concat(),
        )
    };
    let (output, text) = run(&right, &[]);
    assert!(output.status.success() && text.contains("PASS"), "{text}");
    let (output, text) = run(&format!("{right} --full-buffer"), &[]);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("buffer/growth") && text.contains("exactly"),
        "{text}"
    );
    let scene = std::fs::read_to_string(directory.path().join("missed-pair.toml")).unwrap();
    assert!(scene.matches("[[bodies]]").count() < 96, "{scene}");
    // The counter-example fails again by the command that was printed.
    let command = format!("{right} --full-buffer");
    let again = [
        "verify",
        "--exec",
        &command,
        "--claims",
        "aabb",
        "--timeout",
        "60",
        "--replay",
        "missed-pair.ndjson",
    ];
    assert_eq!(sdop(directory.path(), &again).0.status.code(), Some(1));
    // And the right program passes it.
    let again = [
        "verify",
        "--exec",
        &right,
        "--claims",
        "aabb",
        "--timeout",
        "60",
        "--replay",
        "missed-pair.ndjson",
    ];
    assert!(sdop(directory.path(), &again).0.status.success());
    // The scene is runnable.
    let (output, _) = sdop(directory.path(), &["run", "missed-pair.toml"]);
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn a_list_of_known_failures_cannot_go_stale() {
    let directory = tempfile::tempdir().unwrap();
    let silent = answering(RIGHT);
    let run = |known: &str, format: &str| {
        std::fs::write(directory.path().join("known"), known).unwrap();
        let case = [
            "--claims",
            "aabb",
            "--case",
            "box/grid/000?",
            "--timeout",
            "60",
            "--no-fresh",
            "--known",
            "known",
            "--format",
            format,
        ];
        sdop(
            directory.path(),
            &[&["verify", "--exec", &silent], &case[..]].concat(),
        )
    };
    let all: String = (0..8)
        .map(|n| format!("box/grid/000{n} # says nothing\n"))
        .collect();
    // Known failures alone: nothing was shown to be right.
    assert_eq!(run(&all, "table").0.status.code(), Some(1));
    let (output, text) = run(&format!("{all}box/grid/0009\n"), "json");
    assert!(
        output.status.code() == Some(1)
            && text.contains("\"stale\": [\n    \"box/grid/0009\"\n  ]"),
        "{text}"
    );
    let (output, text) = run("", "junit");
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text.starts_with("<?xml")
            && text.matches("<failure").count() == 8
            && text.contains("tests=\"8\""),
        "{text}"
    );
}

#[test]
fn cases_are_written_answered_elsewhere_and_checked() {
    let directory = tempfile::tempdir().unwrap();
    let (output, _) = sdop(
        directory.path(),
        &[
            "cases",
            "--out",
            "c",
            "--claims",
            "aabb",
            "--case",
            "box/flat/*",
        ],
    );
    assert!(output.status.success());
    let case = "c/box/flat/0000.ndjson";
    assert_eq!(
        std::fs::read_dir(directory.path().join("c/box/flat"))
            .unwrap()
            .count(),
        8
    );
    let answer = |pairs: &str| {
        std::fs::write(
            directory.path().join("answers"),
            format!("{{\"frame\":0,\"pairs\":[{pairs}]}}\n"),
        )
        .unwrap()
    };
    let every: Vec<String> = (0..48)
        .flat_map(|j| (0..j).map(move |i| format!("[{i},{j}]")))
        .collect();
    for (pairs, code) in [
        (every.join(","), 0),
        (String::new(), 1),
        ("[0,0]".to_owned(), 1),
    ] {
        answer(&pairs);
        let (output, text) = sdop(directory.path(), &["check", case, "--pairs", "answers"]);
        assert_eq!(output.status.code(), Some(code), "{text}");
    }
    // Without answers there is nothing to judge.
    let (output, _) = sdop(directory.path(), &["check", case]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        sdop(
            directory.path(),
            &["cases", "--out", "c", "--case", "no/such"]
        )
        .0
        .status
        .code(),
        Some(2)
    );
}

#[test]
fn a_programs_own_time_counts_once_it_has_passed_and_is_called_self_reported() {
    let directory = tempfile::tempdir().unwrap();
    let scene = "name = \"three\"\nframes = 4\n[[bodies]]\nshape = \"box\"\nposes = [[0,0,0,1,0,0,0],[0,0,0,1,0.5,0,0],[0,0,0,1,0,0.5,0]]\n";
    std::fs::write(directory.path().join("three.toml"), scene).unwrap();
    let bench = |pairs: &str| {
        let program = answering(&format!(
            r#"echo "{{\"frame\":$n,\"pairs\":[{pairs}],\"ns\":77}}""#
        ));
        let arguments = [
            "bench",
            "three.toml",
            "--exec",
            &program,
            "--frames",
            "4",
            "--format",
            "json",
        ];
        let (output, text) = sdop(directory.path(), &arguments);
        let rows: serde_json::Value = serde_json::from_str(&text).unwrap();
        (output.status.code(), rows)
    };
    let (code, rows) = bench("[0,1],[0,2],[1,2]");
    assert_eq!(code, Some(0), "{rows}");
    let theirs = &rows[1];
    assert_eq!(
        (&theirs["median_ns"], &theirs["clock"], &theirs["outcome"]),
        (&77.into(), &"self-reported".into(), &"pass".into())
    );
    assert!(rows[0]["median_ns"].as_u64().is_some_and(|ns| ns > 0) && rows[0]["outcome"] == "pass");
    let (code, rows) = bench("[0,1]");
    assert_eq!(code, Some(1));
    assert!(
        rows[1]["median_ns"].is_null() && rows[1]["outcome"] == "fail",
        "{rows}"
    );
}

#[test]
fn broadmarks_recordings_are_cases_of_boxes() {
    let directory = tempfile::tempdir().unwrap();
    let written = ["cases", "--out", "c", "--aabbs", "--case", "box/grid/0000"];
    assert!(sdop(directory.path(), &written).0.status.success());
    let bytes = std::fs::read(directory.path().join("c/box/grid/0000.aabbs")).unwrap();
    assert_eq!(bytes.len(), 304 + 48 * 32);
    let every: Vec<String> = (0..48)
        .flat_map(|j| (0..j).map(move |i| format!("[{i},{j}]")))
        .collect();
    for (pairs, code) in [(every.join(","), 0), (String::new(), 1)] {
        let answer = format!("{{\"frame\":0,\"pairs\":[{pairs}]}}\n");
        std::fs::write(directory.path().join("answers"), answer).unwrap();
        let check = ["check", "c/box/grid/0000.aabbs", "--pairs", "answers"];
        let (output, text) = sdop(directory.path(), &check);
        assert_eq!(output.status.code(), Some(code), "{text}");
    }
    std::fs::write(
        directory.path().join("short.aabbs"),
        &bytes[..bytes.len() - 1],
    )
    .unwrap();
    assert_eq!(
        sdop(directory.path(), &["check", "short.aabbs"])
            .0
            .status
            .code(),
        Some(2)
    );
}
