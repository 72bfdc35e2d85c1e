//! `sdop view` of scenes and records: the content of pages, and messages about broken, old or
//! unknown records. `benches/src/view/web/test/` tests pages in a browser.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::cli::{refusal, scene_file, sdop, stdout, text};

const SCENE: &str = r#"
name = "seen </script>"
seed = 18446744073709551615
frames = 5
dt = 0.1
[box]
side = 4.0
[[bodies]]
shape = "gear"
count = 12
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[[bodies]]
shape = "torus"
count = 4
radius = 0.9
static = true
[effects]
motion = true
walls = "specular"
"#;

/// The header of a page.
pub fn header(page: &Path) -> Value {
    let page = std::fs::read_to_string(page).unwrap();
    assert_eq!(page.matches("id=\"sdop-header\"").count(), 1);
    let (_, rest) = page.split_once("id=\"sdop-header\">").unwrap();
    let (header, _) = rest.split_once("</script>").unwrap();
    serde_json::from_str(header).unwrap()
}

/// The numbers of a block as the header counts them, and the bytes of its text.
fn block(page: &Path, name: &str) -> (u64, usize) {
    let listed = header(page)["blocks"].as_array().unwrap().clone();
    let listed = listed.iter().find(|block| block["name"] == name).unwrap();
    let page = std::fs::read_to_string(page).unwrap();
    let (_, rest) = page.split_once(&format!("id=\"block-{name}\">")).unwrap();
    let (coded, _) = rest.split_once("</script>").unwrap();
    (listed["length"].as_u64().unwrap(), coded.len() / 4 * 3 - coded.matches('=').count())
}

/// Writes the scene's record, with `--truth` or without.
fn record(directory: &Path, scene: &Path, name: &str, flags: &[&str]) -> PathBuf {
    let path = directory.join(name);
    stdout(&[&["run", text(scene), "--record", text(&path)], flags].concat());
    path
}

pub fn view(flags: &[&str]) {
    stdout(&[&["view", "--no-prices"], flags].concat());
}

/// A page of a scene holds its run.
#[test]
fn scene_page_contains_its_run() {
    let (directory, scene) = scene_file(SCENE);
    let page = directory.path().join("page.html");
    view(&[text(&scene), "--out", text(&page)]);
    let header = header(&page);
    assert_eq!(header["scene"], "seen </script>");
    assert_eq!(header["seed"], "18446744073709551615");
    assert_eq!(header["source"], "scene.toml");
    assert_eq!(
        (&header["bodies"], &header["moving"], &header["frames"]),
        (&16.into(), &12.into(), &5.into())
    );
    assert_eq!((&header["truth"], &header["side"]), (&true.into(), &4.0.into()));
    let runs = header["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 1);
    assert_eq!(runs[0]["name"], "s-dop-sequential");
    assert_eq!(runs[0]["volumes"], serde_json::json!(["sphere", "or-dop"]));
    assert_eq!(runs[0]["construct"], Value::Null);
    let on = |name: &str| {
        header["effects"].as_array().unwrap().iter().any(|e| e["name"] == name && e["on"] == true)
    };
    assert!(on("motion") && on("walls") && !on("gravity"));
    let pairs = header["pairs"].as_u64().unwrap();
    assert!(pairs > 20, "{pairs}");
    for (name, length, bytes) in [
        ("poses", 7 * 12 * 5, 4),
        ("first", 7 * 16, 4),
        ("flags", pairs, 1),
        ("pairs", 2 * pairs, 2),
        ("counters-0", 3 * 2 * 5, 8),
    ] {
        assert_eq!(block(&page, name), (length, length as usize * bytes), "{name}");
    }
}

/// A record shows the same as its scene.
#[test]
fn record_page_equals_scene_page() {
    let (directory, scene) = scene_file(SCENE);
    let pages = ["scene.html", "record.html"].map(|name| directory.path().join(name));
    let record = record(directory.path(), &scene, "run.ndjson", &[]);
    view(&[text(&scene), "--out", text(&pages[0])]);
    view(&[text(&record), "--out", text(&pages[1])]);
    let [of_scene, of_record] = pages.each_ref().map(|page| std::fs::read_to_string(page).unwrap());
    assert!(
        of_scene == of_record.replace("\"source\":\"run.ndjson\"", "\"source\":\"scene.toml\"")
    );
}

/// Recorded truth is used without computing it again.
#[test]
fn recorded_truth_is_used() {
    let (directory, scene) = scene_file(SCENE);
    let record = record(directory.path(), &scene, "run.ndjson", &["--truth"]);
    let pages = ["as-is.html", "changed.html"].map(|name| directory.path().join(name));
    view(&[text(&record), "--no-truth", "--out", text(&pages[0])]);
    assert_eq!(header(&pages[0])["truth"], true);
    // A pair that meets is taken from the report: it is shown as missed, not decided anew.
    let lines = std::fs::read_to_string(&record).unwrap();
    let mut lines: Vec<String> = lines.lines().map(str::to_owned).collect();
    let mut frame: Value = serde_json::from_str(&lines[2]).unwrap();
    let met = frame["meets"][0].clone();
    assert!(met.is_array(), "nothing meets in frame 1");
    frame["pairs"].as_array_mut().unwrap().retain(|pair| *pair != met);
    lines[2] = frame.to_string();
    std::fs::write(&record, lines.join("\n") + "\n").unwrap();
    view(&[text(&record), "--no-truth", "--out", text(&pages[1])]);
    assert_eq!(header(&pages[0])["pairs"], header(&pages[1])["pairs"]);
    assert_ne!(std::fs::read(&pages[0]).unwrap(), std::fs::read(&pages[1]).unwrap());
}

/// Two strategies or two records stand side by side.
#[test]
fn two_runs_are_shown_together() {
    let (directory, scene) = scene_file(SCENE);
    let page = directory.path().join("page.html");
    let first = record(directory.path(), &scene, "first.ndjson", &[]);
    let spheres = record(directory.path(), &scene, "spheres.ndjson", &["--strategy", "sphere"]);
    let mut sizes = Vec::new();
    for beside in ["sphere", text(&spheres)] {
        view(&[text(&first), "--beside", beside, "--out", text(&page)]);
        let header = header(&page);
        let names: Vec<_> =
            header["runs"].as_array().unwrap().iter().map(|run| run["name"].clone()).collect();
        assert_eq!(names, ["s-dop-sequential", "sphere"]);
        sizes.push(std::fs::read(&page).unwrap());
    }
    assert!(sizes[0] == sizes[1], "a strategy's pairs and its record's differ");
    let other = record(directory.path(), &scene, "other.ndjson", &["--seed", "2"]);
    let message = refusal(&["view", text(&first), "--beside", text(&other)]);
    assert!(message.contains("not the frames of"), "{message}");
    let message = refusal(&["view", text(&first), "--beside", "shpere"]);
    assert!(
        message.contains("neither a strategy nor a record")
            && message.contains("did you mean `sphere`?"),
        "{message}"
    );
}

/// Runs a view that must fail, and returns what it says and the header of the page that it wrote
/// all the same.
fn broken(path: &Path) -> (String, Value) {
    let page = path.with_extension("html");
    let output = sdop(&["view", text(path), "--no-prices", "--out", text(&page)]);
    assert_eq!(output.status.code(), Some(2));
    let words = String::from_utf8_lossy(&output.stderr)
        .split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ");
    (words, header(&page))
}

/// A broken record makes a page that says so.
#[test]
fn broken_record_makes_a_page() {
    let (directory, scene) = scene_file(SCENE);
    let record = record(directory.path(), &scene, "run.ndjson", &[]);
    let whole = std::fs::read_to_string(&record).unwrap();
    let cut = directory.path().join("cut.ndjson");
    std::fs::write(&cut, &whole[..whole.len() - 40]).unwrap();
    let (message, header) = broken(&cut);
    assert!(message.contains("cut.ndjson:6: the file ends inside this line"), "{message}");
    assert_eq!(header["frames"], 4);
    let shown = header["messages"][0].as_str().unwrap();
    assert!(
        shown.contains("cut.ndjson:6: the file ends inside this line")
            && shown.contains("The 4 frames before"),
        "{shown}"
    );

    let newer = directory.path().join("newer.ndjson");
    std::fs::write(&newer, whole.replacen("\"version\":1", "\"version\":3", 1)).unwrap();
    let (message, header) = broken(&newer);
    assert!(
        message.contains("the record has version 3; this program reads version 1"),
        "{message}"
    );
    assert_eq!((&header["frames"], &header["source"]), (&0.into(), &"newer.ndjson".into()));
    assert!(header["messages"][0].as_str().unwrap().contains("write it again"));

    let other = directory.path().join("other.ndjson");
    std::fs::write(&other, "{\"format\":\"glTF\",\"version\":2}\n").unwrap();
    assert!(broken(&other).0.contains("not a record"));
}

/// An older record lacks counters and shows the rest.
#[test]
fn older_record_lacks_only_counters() {
    let (directory, scene) = scene_file(SCENE);
    let record = record(directory.path(), &scene, "run.ndjson", &[]);
    let old = directory.path().join("old.ndjson");
    let mut lines = Vec::new();
    for line in std::fs::read_to_string(&record).unwrap().lines() {
        let mut line: Value = serde_json::from_str(line).unwrap();
        let known =
            ["format", "version", "scene", "seed", "shapes", "bodies", "frame", "poses", "pairs"];
        line.as_object_mut().unwrap().retain(|key, _| known.contains(&key.as_str()));
        lines.push(line.to_string());
    }
    std::fs::write(&old, lines.join("\n") + "\n").unwrap();
    let page = directory.path().join("old.html");
    view(&[text(&old), "--out", text(&page)]);
    let header = header(&page);
    assert_eq!((&header["frames"], &header["truth"]), (&5.into(), &true.into()));
    assert_eq!((&header["effects"], &header["runs"][0]["volumes"]), (&Value::Null, &Value::Null));
    let message = refusal(&["view", text(&old), "--strategy", "sphere"]);
    assert!(message.contains("--beside STRATEGY"), "{message}");
}
