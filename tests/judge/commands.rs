//! The command line: examples, unit tests of counter-examples, known failures, timing, reasons.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::programs::{RIGHT, answering};

/// Runs the program in its own directory.
pub(super) fn sdop(directory: &Path, arguments: &[&str]) -> (Output, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_sdop"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (output, text)
}

fn example(name: &str) -> String {
    let path: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "examples", "judge", name].iter().collect();
    path.display().to_string()
}

/// The Python example passes. With its full buffer it is caught, with a small scene that shows the
/// miss again.
#[test]
fn python_example_and_its_flaw() {
    if Command::new("python3").arg("--version").output().is_err() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let right = format!("python3 {}", example("boxes.py"));
    let cases = ["--claims", "aabb", "--case", "b*", "--timeout", "60", "--no-fresh"];
    let run = |command: &str, more: &[&str]| {
        sdop(directory.path(), &[&["judge", command], &cases[..], more].concat())
    };
    let (output, text) = run(&right, &[]);
    assert!(output.status.success() && text.contains("PASS"), "{text}");
    let (output, text) = run(&format!("{right} --full-buffer"), &[]);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("buffer/growth") && text.contains("exactly"), "{text}");
    let case = std::fs::read_to_string(directory.path().join("missed-pair.ndjson")).unwrap();
    assert!(case.contains("\"scene\":\"missed-pair/b"), "{case}");
    assert!(case.matches("\"static\"").count() < 96, "{case}");
    // No scene can state boxes.
    assert!(!directory.path().join("missed-pair.toml").exists());
    // The counter-example fails again, by the command's former name as well.
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
    let again =
        ["judge", &right, "--claims", "aabb", "--timeout", "60", "--replay", "missed-pair.ndjson"];
    assert!(sdop(directory.path(), &again).0.status.success());
}

/// Judges a culler of boxes that reports nothing, and returns the lines that a person reads about
/// the smallest case.
fn silence(directory: &Path, more: &[&str]) -> (Output, String) {
    let silent = answering(RIGHT);
    let arguments = ["judge", &silent, "--timeout", "60", "--no-fresh"];
    sdop(directory, &[&arguments[..], more].concat())
}

/// A miss of boxes names the ends that meet.
#[test]
fn box_misses_name_meeting_ends() {
    let directory = tempfile::tempdir().unwrap();
    let cases = ["--claims", "aabb", "--case", "box/grid/*"];
    let (output, text) = silence(directory.path(), &cases);
    assert_eq!(output.status.code(), Some(1));
    for words in [
        "box/grid/0000 misses",
        "\n  case aims at: touching taken for apart: < in place of <=\n",
        "\nsmallest: 2 bodies, 1 frame, from box/grid/000",
        "\n  box 0: (",
        " ends at ",
        " starts at ",
        "\n  shared point: (",
        "(sdop view ./missed-pair.ndjson)",
    ] {
        assert!(text.contains(words), "{words:?} in {text}");
    }
    assert!(!text.contains("ulp") && !text.contains(".toml"), "{text}");
    // One line says why the exit code is 1.
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.starts_with("sdop: 8 of 8 cases failed, first box/grid/0000 misses"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    let (_, json) = silence(directory.path(), &[&cases[..], &["--format", "json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let why = json["why"].as_str().unwrap();
    assert!(said.contains(why), "{why}");
}

/// Failed groups are printed first, and passed ones together in a line.
#[test]
fn failed_groups_are_printed_first() {
    let directory = tempfile::tempdir().unwrap();
    let (_, text) = silence(directory.path(), &["--claims", "aabb", "--case", "*/0000"]);
    let table = text.split("\nclaim aabb: ").next().unwrap();
    let last = table.lines().last().unwrap();
    assert!(last.ends_with("cases") && last.contains(" groups passed all of their "), "{table}");
    assert!(table.contains("box/grid") && table.lines().count() > 5, "{table}");
}

/// A miss of meshes becomes a scene where a scene can state it.
#[test]
fn mesh_misses_become_scenes() {
    let directory = tempfile::tempdir().unwrap();
    let scene = directory.path().join("missed-pair.toml");
    let (_, text) = silence(directory.path(), &["--case", "exact/face-to-face/0000"]);
    assert!(text.contains("missed-pair.toml") && text.contains("\n  depth: "), "{text}");
    let (output, run) = sdop(directory.path(), &["run", "missed-pair.toml"]);
    assert!(output.status.success() && run.contains("reported 1 pairs"), "{run}");
    // Balls that aren't those of the meshes, and a miss that takes two frames, are in no scene.
    std::fs::remove_file(&scene).unwrap();
    let spheres = ["--claims", "sphere", "--case", "hard/touch-by-quadruples/*"];
    let (output, _) = silence(directory.path(), &spheres);
    assert_eq!(output.status.code(), Some(1));
    assert!(directory.path().join("missed-pair.ndjson").exists() && !scene.exists());
}

/// Runs a counter-example's unit test with a culler that reports all pairs, and one that reports
/// none.
fn as_test(language: &str, claim: &str, case: &str) {
    let (compiler, arguments, culler, end): (&str, &[&str], &str, &str) = match language {
        "python" => (
            "python3",
            &[],
            "def your_culler(*given):\n    n = len(given[-1][-1])\n    return [[i, j] for j in range(n) for i in range(j)][:PAIRS]\n",
            "TEST()\n",
        ),
        "rust" => ("rustc", &["--test", "-o", "tested"], "", ""),
        _ => (
            "c++",
            &["-std=c++17", "-o", "tested"],
            "#include <array>\n#include <vector>\ntemplate <class... Given> std::vector<std::array<unsigned, 2>> your_culler(const Given&...) {\n    \
             std::vector<std::array<unsigned, 2>> pairs;\n    for (unsigned j = 0; j < 2; j++) for (unsigned i = 0; i < j; i++) pairs.push_back({i, j});\n    \
             pairs.resize(PAIRS < pairs.size() ? PAIRS : pairs.size());\n    return pairs;\n}\n",
            "int main() { TEST(); }\n",
        ),
    };
    if Command::new(compiler).arg("--version").output().is_err() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (_, text) = silence(here, &["--claims", claim, "--case", case, "--as-test", language]);
    let ending = match language {
        "python" => "py",
        "rust" => "rs",
        _ => "cpp",
    };
    let test = std::fs::read_to_string(here.join(format!("missed-pair.{ending}"))).unwrap();
    assert!(text.contains(&test), "{text}");
    let name = test.split("reports_").nth(1).unwrap();
    let name = format!("reports_{}", name.split('(').next().unwrap());
    let name = if language == "python" { format!("test_{name}") } else { name };
    for (pairs, passes) in [("1", true), ("0", false)] {
        let culler = if language == "rust" {
            let given = test.split("your_culler(&").nth(1).unwrap().split(')').next().unwrap();
            let count = given.split(", ").count();
            let types = ["A", "B", "C", "D", "E", "F", "G"];
            let list: Vec<String> = types[..count].iter().map(|t| format!("_: &{t}")).collect();
            format!(
                "fn your_culler<{}>({}) -> Vec<[u32; 2]> {{ [[0, 1]][..{pairs}].to_vec() }}\n",
                types[..count].join(", "),
                list.join(", ")
            )
        } else {
            culler.replace("PAIRS", pairs)
        };
        let source = format!("{culler}{test}{}", end.replace("TEST", &name));
        let file = here.join(format!("whole.{ending}"));
        std::fs::write(&file, &source).unwrap();
        let mut command = Command::new(compiler);
        command.args(arguments).arg(&file).current_dir(here);
        let output = command.output().unwrap();
        let ran = if language == "python" {
            output
        } else {
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{said}\n{source}");
            Command::new(here.join("tested")).output().unwrap()
        };
        assert_eq!(ran.status.success(), passes, "{ran:?}\n{source}");
    }
}

#[test]
fn counter_examples_are_unit_tests() {
    for language in ["python", "rust", "cpp"] {
        as_test(language, "aabb", "box/range/0000");
        as_test(language, "mesh", "exact/tip-on-face/0000");
        as_test(language, "parts", "parts/touch/0000");
        as_test(language, "periodic", "periodic/changed/0000");
    }
    as_test("python", "sphere", "touch/ball-ball/0000");
    as_test("rust", "or-dop", "touch/face-corner/0000");
}

#[test]
fn known_failures_must_still_fail() {
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
        sdop(directory.path(), &[&["judge", &silent], &case[..]].concat())
    };
    let all: String = (0..8).map(|n| format!("box/grid/000{n} # says nothing\n")).collect();
    // Known failures alone: nothing was shown to be right.
    assert_eq!(run(&all, "table").0.status.code(), Some(1));
    let (output, _) = run(&format!("{all}box/grid/0009\n"), "json");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(2)
            && error.contains("`box/grid/0009` is no case of the claim aabb")
            && error.contains("did you mean `box/grid/000"),
        "{error}"
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

/// The only line of standard error that starts with the program's name, without it.
pub(super) fn reason(output: &Output) -> String {
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    let mut lines = error.lines().filter_map(|line| line.strip_prefix("sdop: "));
    let reason = lines.next().unwrap_or_else(|| panic!("no reason: {error}"));
    assert_eq!(lines.next(), None, "{error}");
    reason.to_owned()
}

#[test]
fn no_success_without_a_reason() {
    let directory = tempfile::tempdir().unwrap();
    let skips = answering(r#"echo '{"frame":0,"skipped":"no grids"}'; exit 0"#);
    let silent = answering(RIGHT);
    for (program, code, says) in [
        (&skips, 3, "0 of 8 cases were judged: 8 skipped, 0 not run"),
        (&silent, 1, "8 of 8 cases failed, first box/grid/0000 misses "),
        (&"false".to_owned(), 1, "8 of 8 cases failed, first box/grid/0000 crashed"),
    ] {
        let case = ["--claims", "aabb", "--case", "box/grid/*", "--no-fresh"];
        let more = ["--timeout", "60", "--format", "json"];
        let run = [&["judge", program], &case[..], &more].concat();
        let (output, text) = sdop(directory.path(), &run);
        assert_eq!(output.status.code(), Some(code), "{text}");
        let (why, found): (_, serde_json::Value) =
            (reason(&output), serde_json::from_str(&text).unwrap());
        assert!(why.starts_with(says), "{why}");
        assert_eq!(found["why"], why.as_str());
        let word = if code == 3 { "incomplete" } else { "not-passed" };
        assert_eq!((&found["conclusion"], &found["asked"]), (&word.into(), &8.into()));
    }
    // A timing's rows say it themselves.
    let scene =
        "name = \"one\"\nframes = 2\n[[bodies]]\nshape = \"box\"\nposes = [[0,0,0,1,0,0,0]]\n";
    std::fs::write(directory.path().join("one.toml"), scene).unwrap();
    let timing = ["bench", "one.toml", "--exec", &skips, "--frames", "2", "--rounds", "1"];
    let (output, _) = sdop(directory.path(), &timing);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    assert!(reason(&output).ends_with("skipped the scene: no grids"));
}

/// A program's own time counts once it has passed, and is called self-reported.
#[test]
fn self_reported_time_needs_a_pass() {
    let directory = tempfile::tempdir().unwrap();
    let scene = "name = \"three\"\nframes = 4\n[[bodies]]\nshape = \"box\"\nposes = [[0,0,0,1,0,0,0],[0,0,0,1,0.5,0,0],[0,0,0,1,0,0.5,0]]\n";
    std::fs::write(directory.path().join("three.toml"), scene).unwrap();
    let bench = |pairs: &str| {
        let program =
            answering(&format!(r#"echo "{{\"frame\":$n,\"pairs\":[{pairs}],\"ns\":77}}""#));
        let arguments =
            ["bench", "three.toml", "--exec", &program, "--frames", "4", "--format", "json"];
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
    assert!(rows[1]["median_ns"].is_null() && rows[1]["outcome"] == "fail", "{rows}");
}
