//! Judged programs that misbehave: each failure has a name, the judge waits for none of them, and
//! it goes on with the next case.

use std::time::{Duration, Instant};

use sdop_judge::answer::AnswerError;
use sdop_judge::process::{Program, Service};
use sdop_judge::wire::Wire;
use sdop_judge::{Claim, Conclusion, Options, Outcome, Verdict, examine};

/// A program that reads frames and answers each with what `answer` says; $n is the frame's number.
pub fn answering(answer: &str) -> String {
    format!("read -r header; n=0; while read -r frame; do {answer}; n=$((n + 1)); done")
}

pub const RIGHT: &str = r#"echo "{\"frame\":$n,\"pairs\":[]}""#;

fn run(command: &str, wire: Wire, timeout: f64, case: &str) -> Verdict {
    let program =
        Program { command: command.to_owned(), wire, timeout: Duration::from_secs_f64(timeout) };
    let options = Options { claim: Claim::Aabb, pattern: case.to_owned(), ..Options::default() };
    examine(&program, &options, |_, _| {}).unwrap()
}

/// What a program's only case ends with. Generous: the machine may be busy.
fn trouble(command: &str) -> AnswerError {
    let verdict = run(command, Wire::Ndjson, 20.0, "churn/swap/0001");
    assert!(!verdict.passed());
    match verdict.cases[0].outcome.clone() {
        Outcome::Error { trouble } => trouble,
        other => panic!("{command}: {other:?}"),
    }
}

/// A program that answers nothing in time is stopped, with all that it started.
#[test]
fn late_programs_are_stopped() {
    let start = Instant::now();
    for (command, computes) in [
        ("sleep 1000", false),
        ("sleep 1000 & wait", false),
        ("cat > /dev/null; sleep 1000", false),
        ("while :; do :; done", true),
        ("(while :; do :; done) & wait", true),
    ] {
        let verdict = run(command, Wire::Ndjson, 0.1, "churn/swap/0001");
        let Outcome::Error { trouble } = &verdict.cases[0].outcome else {
            panic!("{command}: {verdict}");
        };
        assert!(verdict.cases[0].is_late(), "{command}: {trouble}");
        let is_limit = matches!(trouble, AnswerError::Timeout { frame: 0, .. });
        assert_eq!(is_limit || cfg!(not(target_os = "linux")), computes, "{command}: {trouble}");
    }
    assert!(start.elapsed() < Duration::from_secs(60));
}

/// A program that continues after the end of its input does not pass.
#[test]
fn programs_end_with_their_input() {
    let command = format!("{}; exec sleep 1000", answering(RIGHT));
    let verdict = run(&command, Wire::Ndjson, 0.3, "churn/swap/0001");
    let outcome = &verdict.cases[0].outcome;
    assert!(
        matches!(outcome, Outcome::Error { trouble: AnswerError::Hanging { .. } }),
        "{outcome:?}"
    );
}

#[test]
fn crashes_and_floods_are_named() {
    let found = trouble("read -r header; read -r frame; echo out of memory >&2; exit 3");
    assert!(
        matches!(&found, AnswerError::Crashed { how, answered: 0, said } if how == "exit code 3" && said.contains("out of memory")),
        "{found}"
    );
    let found = trouble("kill -SEGV $$");
    assert!(matches!(&found, AnswerError::Crashed { how, .. } if how == "signal 11"), "{found}");
    assert!(matches!(trouble("true"), AnswerError::Early { answered: 0, frames: 6, .. }));
    let found = trouble("no-such-program-here");
    assert!(
        matches!(&found, AnswerError::Start { why } if why.starts_with("exit code 127; it says: ")),
        "{found}"
    );
    assert!(
        matches!(trouble("/dev/null"), AnswerError::Start { why } if why.starts_with("exit code 126"))
    );
    // A program that has answered was there.
    let found = trouble(&format!("{}; exit 127", answering(RIGHT)));
    assert!(matches!(found, AnswerError::Crashed { .. }), "{found}");
    // On one line, on lines of their own, and in answers that are right but for their size.
    for command in [
        "tr '\\0' x < /dev/zero",
        "read -r h; printf '{\"frame\":0,\"pairs\":['; while :; do printf '[0,1],'; done",
    ] {
        assert!(matches!(trouble(command), AnswerError::Flood { .. }), "{command}");
    }
    // All answers are right, and then it fails.
    let found = trouble(&format!("{}; exit 1", answering(RIGHT)));
    assert!(matches!(found, AnswerError::Crashed { answered: 6, .. }), "{found}");
}

#[test]
fn programs_without_answers_end_runs() {
    let verdict = run("no-such-program-here", Wire::Ndjson, 20.0, "*");
    assert!(verdict.cases.len() == 3 && verdict.not_run > 100, "{verdict}");
    let why = verdict.why().unwrap();
    let first = "cases failed, first box/grid/0000 cannot be started: exit code 127";
    assert!(why.starts_with("3 of ") && why.contains(first), "{why}");
    // So is one that can, and answers nothing.
    let verdict = run("exit 1", Wire::Ndjson, 20.0, "box/flat/*");
    assert_eq!((verdict.cases.len(), verdict.not_run), (3, 5));
}

#[test]
fn malformed_lines_are_named() {
    for (line, why) in [
        ("hello", "standard output is for answers alone"),
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
        trouble(&answering(&format!(r#"echo "{{\"frame\":$n,\"pairs\":[{pairs}]}}""#)))
    };
    assert_eq!(answer("[3,3]"), AnswerError::SelfPair { frame: 0, body: 3 });
    assert_eq!(answer("[4,1]"), AnswerError::Reversed { frame: 0, pair: [4, 1] });
    assert_eq!(answer("[0,1],[0,1]"), AnswerError::Twice { frame: 0, pair: [0, 1] });
    assert_eq!(answer("[0,40]"), AnswerError::NoBody { frame: 0, pair: [0, 40], bodies: 40 });
    // Every frame twice, and the last one twice.
    assert_eq!(
        trouble(&answering(&format!("{RIGHT}; {RIGHT}"))),
        AnswerError::OutOfTurn { expected: 1, found: 0 }
    );
    let found = trouble(&format!("{}; echo more", answering(RIGHT)));
    assert_eq!(found, AnswerError::TooMany { frames: 6, line: "more".to_owned() });
}

/// A program may skip a case. A run whose cases were all skipped does not pass.
#[test]
fn skipping_programs_do_not_pass() {
    let skips = |wire, line: &str| {
        let verdict = run(
            &answering(&format!("echo '{line}'; exit 0")),
            wire,
            20.0,
            "churn/swap/000[0-9]".replace("[0-9]", "?").as_str(),
        );
        assert_eq!(verdict.conclusion(), Conclusion::Incomplete);
        assert_eq!((verdict.judged(), verdict.asked()), (0, 7));
        assert!(
            verdict.cases.len() == 7
                && verdict.cases.iter().all(
                    |case| matches!(&case.outcome, Outcome::Skipped { why } if why == "no swaps")
                ),
            "{verdict}"
        );
    };
    skips(Wire::Ndjson, r#"{"frame":0,"skipped":"no swaps"}"#);
    skips(Wire::Text, "skip no swaps");
}

/// Answers frames without pairs, and skips each case in which there is one.
#[test]
fn skipping_what_meets_is_incomplete() {
    let skip = r#"echo "{\"frame\":$n,\"skipped\":\"something meets\"}"; exit 0"#;
    let first = format!("read -r header; n=0; {RIGHT}; read -r frame; n=1; {skip}");
    let verdict = run(&first, Wire::Ndjson, 20.0, "churn/teleport/*");
    // The first frames are answered wrongly, which no later word takes back.
    assert_eq!(verdict.conclusion(), Conclusion::NotPassed, "{verdict}");
    assert!(verdict.pairs().missed > 0);
    let always = answering(skip);
    let verdict = run(&always, Wire::Ndjson, 20.0, "churn/teleport/*");
    assert_eq!(verdict.conclusion(), Conclusion::Incomplete, "{verdict}");
    let said = verdict.to_string();
    assert!(said.starts_with("claim aabb: INCOMPLETE, 0 of 7 cases judged"), "{said}");
}

#[test]
fn cases_without_time_are_incomplete() {
    let program =
        Program { command: "true".to_owned(), wire: Wire::Ndjson, timeout: Duration::from_secs(1) };
    let options = Options { claim: Claim::Aabb, time: Some(Duration::ZERO), ..Options::default() };
    let verdict = examine(&program, &options, |_, _| {}).unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Incomplete);
    assert!(verdict.cases.is_empty() && verdict.not_run > 100);
}

#[test]
fn failing_cases_do_not_end_runs() {
    // Fails on every second case or so, by its name.
    let command = format!(
        "read -r header; case $header in *0001*) exit 9;; esac; {}",
        answering(RIGHT).replacen("read -r header;", "", 1)
    );
    let verdict = run(&command, Wire::Ndjson, 20.0, "churn/teleport/*");
    let crashed =
        verdict.cases.iter().filter(|case| matches!(case.outcome, Outcome::Error { .. })).count();
    assert_eq!((verdict.cases.len(), crashed, verdict.not_run), (7, 1, 0), "{verdict}");
}

/// A program that reads one case after the other: a header starts the count anew.
const SERVING: &str = r#"n=0; while read -r line; do case $line in *'"format"'*) n=0;; *) echo "{\"frame\":$n,\"pairs\":[]}"; n=$((n + 1));; esac; done"#;

fn serve(command: String, case: &str) -> Verdict {
    let service =
        Service::new(Program { command, wire: Wire::Ndjson, timeout: Duration::from_secs(20) });
    let options = Options {
        claim: Claim::Aabb,
        pattern: case.to_owned(),
        shrink_time: Duration::ZERO,
        ..Options::default()
    };
    examine(&service, &options, |_, _| {}).unwrap()
}

/// A service judges many cases with few processes.
#[test]
fn services_judge_many_cases() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("started");
    let verdict = serve(format!("echo one >> '{}'; {SERVING}", log.display()), "churn/*");
    let alone = run(&answering(RIGHT), Wire::Ndjson, 20.0, "churn/*");
    let counts = |verdict: &Verdict| -> Vec<_> {
        verdict.cases.iter().map(|case| (case.name.clone(), case.pairs)).collect()
    };
    assert_eq!(counts(&verdict), counts(&alone));
    let started = std::fs::read_to_string(log).unwrap().lines().count();
    assert!(started < 16 && verdict.cases.len() > 25, "{started} processes");
}

/// A service is started again after a case that ends it.
#[test]
fn ended_services_start_again() {
    let ending = SERVING.replacen("n=0;;", r#"n=0; case $line in *0001\"*) exit 9;; esac;;"#, 1);
    let verdict = serve(ending, "churn/teleport/*");
    let crashed = |outcome: &Outcome| {
        matches!(outcome, Outcome::Error { trouble: AnswerError::Crashed { answered: 0, .. } })
    };
    let ended = verdict.cases.iter().filter(|case| crashed(&case.outcome));
    assert_eq!(ended.count(), 1, "{verdict}");
    assert_eq!(verdict.cases.len(), 7);
}

/// An answer too many would be the next case's first.
#[test]
fn services_may_not_answer_twice() {
    let twice = SERVING.replacen("echo", "echo; echo {}; echo", 1);
    let verdict = serve(twice, "churn/teleport/0001");
    assert!(matches!(verdict.cases[0].outcome, Outcome::Error { .. }), "{verdict}");
    let chatty =
        SERVING.replacen("n=$((n + 1))", r#"echo "{\"frame\":$n,\"pairs\":[]}"; n=$((n + 1))"#, 1);
    let verdict = serve(chatty, "churn/teleport/*");
    assert!(
        verdict.cases.iter().all(|case| matches!(case.outcome, Outcome::Error { .. })),
        "{verdict}"
    );
}
