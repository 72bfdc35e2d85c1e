//! `sdop board`: rows, cells and the page, from adapters of a few lines of shell.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::cli::{sdop, stdout, text};

/// The path of a table of claims for an adapter with one answer to every frame.
fn claims(folder: &Path, answer: &str, more: &str) -> PathBuf {
    let adapter = format!(
        r#"[ "$1" = --version ] && echo 1.0 && exit
n=0
while read -r line; do
  case $line in *'"format"'*) n=0;; *) echo "{{\"frame\":$n,{answer}}}"; n=$((n + 1));; esac
done
"#
    );
    fs::write(folder.join("adapter.sh"), adapter).unwrap();
    let claims = format!(
        r#"
[run]
shell = "sh '{}/{{folder}}.sh'"

[[adapter]]
name = "none"
folder = "adapter"
language = "shell"
package = "nothing"
version = "1.0"
claim = "aabb"
says = "nothing"
settings = "none"
verdict = "fail"
{more}

[[not_run]]
name = "other"
why = "no reason"
"#,
        folder.display()
    );
    let path = folder.join("claims.toml");
    fs::write(&path, claims).unwrap();
    path
}

/// The record and the page of such an adapter.
fn board(folder: &Path, answer: &str, more: &str) -> (Value, String) {
    let (claims, out) = (claims(folder, answer, more), folder.join("out"));
    let arguments = ["board", "--case", "box/grid/0000", "--check", "--claims"];
    let run = sdop(&[&arguments[..], &[text(&claims), "--out", text(&out)]].concat());
    let json = serde_json::from_str(&fs::read_to_string(out.join("board.json")).unwrap()).unwrap();
    let page = fs::read_to_string(out.join("board.html")).unwrap();
    assert!(page.contains("Who misses pairs"), "{run:?}");
    (json, page)
}

/// A miss has its smallest case on the page.
#[test]
fn miss_has_smallest_case() {
    let folder = tempfile::tempdir().unwrap();
    let (json, page) = board(folder.path(), r#"\"pairs\":[]"#, "");
    let cell = &json["adapters"][0]["cells"][0];
    assert_eq!((&cell["family"], &cell["outcome"]), (&"box".into(), &"fail".into()));
    assert_eq!(cell["total"]["pairs"]["missed"], cell["total"]["pairs"]["required"]);
    let case = cell["smallest"]["case"].as_str().unwrap();
    assert!(case.lines().count() == 2 && case.contains("\"claims\":[\"aabb\""), "{case}");
    assert!(page.contains("id=\"picture-none-box\"") && page.contains("sdop-header"), "no picture");
}

#[test]
fn skipped_cases_are_no_pass() {
    let folder = tempfile::tempdir().unwrap();
    let (json, _) = board(folder.path(), r#"\"skipped\":\"too small\""#, "");
    let row = &json["adapters"][0];
    assert_eq!(row["outcome"], "does-not-claim");
    assert_eq!(row["cells"][0]["reasons"]["too small"], 1);
}

/// Misses outside of a claim are no failure.
#[test]
fn unclaimed_misses_are_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    let unclaimed = "unclaimed = [{ cases = \"box/*\", why = \"its page says so\" }]";
    let (json, _) = board(folder.path(), r#"\"pairs\":[]"#, unclaimed);
    assert_eq!(json["adapters"][0]["outcome"], "does-not-claim");
    assert_eq!(json["adapters"][0]["cells"][0]["reasons"]["its page says so"], 1);
}

/// The page shows the times of an adapter and ours, each with its recall.
#[test]
fn times_are_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let claims = claims(folder.path(), r#"\"pairs\":[],\"ns\":5000"#, "");
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let same = ["board", "--claims", text(&claims), "--out", text(&out)];
        stdout(&[&same[..], more].concat())
    };
    run(&["--timed", "data/scenes/crowded-500.toml"]);
    let file = out.join("times.json");
    let times: Vec<Value> = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    let recalls: Vec<(&str, f64)> = times
        .iter()
        .map(|time| (time["name"].as_str().unwrap(), time["recall"].as_f64().unwrap()))
        .collect();
    assert_eq!(recalls, [("sdop BoxCuller", 1.0), ("none", 0.0)]);
    run(&["--case", "box/grid/0000", "--times", text(&file)]);
    let page = fs::read_to_string(out.join("board.html")).unwrap();
    assert!(page.contains("Recall against time") && page.contains("0.005 ms"));
}
