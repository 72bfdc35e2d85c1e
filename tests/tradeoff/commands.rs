//! `sdop tradeoff` and `sdop advise`: what they write, print and reject.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::SCENE;

fn sdop(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sdop"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

/// The counts of a result: everything but seconds and what follows from them.
fn counts(path: &Path) -> Vec<serde_json::Value> {
    let result: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let mut parts =
        vec![result["truth"].clone(), result["budgets"].clone(), result["shapes"].clone()];
    for row in result["rows"].as_array().unwrap() {
        let keys = [
            "name",
            "reported",
            "precision",
            "per_true",
            "recall",
            "volume_over_hull",
            "pairs_sha256",
        ];
        parts.extend(keys.map(|key| row[key].clone()));
        for volume in row["warm"]["terms"].as_array().unwrap() {
            parts.extend(["updates", "tests", "hits"].map(|key| volume[key].clone()));
        }
    }
    for row in result["interest"].as_array().unwrap() {
        parts.extend(["bodies", "tests", "reported", "precision"].map(|key| row[key].clone()));
    }
    for varied in result["variations"].as_array().unwrap() {
        let keys = ["aspect", "mix", "bodies", "triangles", "motion", "partners"];
        parts.extend(keys.map(|key| varied[key].clone()));
        let lines = varied["lines"].as_array().unwrap();
        parts.extend(lines.iter().map(|line| line["pairs"].clone()));
    }
    parts
}

/// The variations of `tradeoff::vary` are of a scene of 50 bodies.
fn changes_are_what_they_say(path: &Path) {
    let result: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let of = |aspect: &str, key: &str| -> Vec<f64> {
        let all = result["variations"].as_array().unwrap().iter();
        let own = all.filter(|varied| varied["aspect"] == aspect);
        own.map(|varied| varied[key].as_f64().unwrap()).collect()
    };
    // Three groups of 20, 15 and 15, each rounded.
    assert_eq!(of("bodies", "bodies"), [6.0, 50.0, 500.0, 2000.0]);
    let partners = of("bodies", "partners");
    assert!(
        partners[2..].iter().all(|p| (p / partners[1] - 1.0).abs() < 0.4),
        "the density stays: {partners:?}"
    );
    let triangles = of("triangles", "triangles");
    assert!(triangles[0] <= 100.0 && triangles[0] < triangles[1], "{triangles:?}");
    let motion = of("motion", "motion");
    for (way, factor) in motion.iter().zip([0.1, 1.0, 10.0, 40.0]) {
        let expected = factor * motion[1];
        assert!((way / expected - 1.0).abs() < 0.2, "{motion:?}"); // walls turn some back
    }
    // Balls hit as their spheres do, needles hardly ever.
    let narrow = |mix: &str| {
        let all = result["variations"].as_array().unwrap().iter();
        let varied = all.clone().find(|varied| varied["mix"] == mix).unwrap();
        let pairs = |line: usize| varied["lines"][line]["pairs"].as_f64().unwrap();
        pairs(varied["lines"].as_array().unwrap().len() - 1) / pairs(0)
    };
    assert!(narrow("needles") < 0.2 && narrow("balls") > 0.9);
}

/// The parts that units come to: of two seeds and three passes, three shapes and nine of known
/// form, seven densities, changes of four kinds.
fn nothing_is_left_out(path: &Path) {
    let result: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    for (part, number) in [
        ("seeds", 2),
        ("rows", 41),
        ("densities", 7),
        ("variations", 4 + 3 + 4 + 5),
        ("budgets", 4 * 7),
        ("clock", 7),
        ("interest", 7),
        ("shapes", 3 + 9),
    ] {
        assert_eq!(result[part].as_array().unwrap().len(), number, "{part}");
    }
    let row = &result["rows"][0];
    assert_eq!(row["times"].as_array().unwrap().len(), 3);
    assert_eq!(row["pairs_sha256"].as_array().unwrap().len(), 2);
    assert!(!result["safety"].as_array().unwrap().is_empty());
    assert!(result["narrow_phase"]["miss"].as_f64().unwrap() > 0.0);
}

/// The command counts alike twice redraws a record and fails on a miss.
#[test]
fn tradeoff_repeats_and_redraws() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    fs::write(here.join("few.toml"), SCENE).unwrap();
    for out in ["one", "two"] {
        let run = sdop(&["tradeoff", "few.toml", "--quick", "--out", out], here);
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        let text = String::from_utf8(run.stdout).unwrap();
        assert!(text.starts_with("Cheapest at this density"), "{text}");
        assert!(text.contains("sphere + hull") && !text.contains("The price of safety"));
    }
    assert_eq!(counts(&here.join("one/tradeoff.json")), counts(&here.join("two/tradeoff.json")));

    changes_are_what_they_say(&here.join("one/tradeoff.json"));
    nothing_is_left_out(&here.join("one/tradeoff.json"));

    let again = sdop(&["tradeoff", "one/tradeoff.json", "--out", "again", "--format", "csv"], here);
    assert_eq!(again.status.code(), Some(0));
    for file in [
        "figures/tradeoff.svg",
        "figures/tradeoff-pays.svg",
        "figures/tradeoff-budget.svg",
        "tradeoff.csv",
        "tradeoff-seeds.csv",
        "tradeoff.json",
    ] {
        let [one, two] = ["one", "again"].map(|out| fs::read(here.join(out).join(file)).unwrap());
        assert_eq!(one, two, "{file}");
    }
    let figure = fs::read_to_string(here.join("one/figures/tradeoff.svg")).unwrap();
    // Ticks are plain numbers, whatever the machine's times.
    assert!(figure.contains("aabb") && !figure.contains("1e"), "{figure}");
    let all = sdop(&["tradeoff", "one/tradeoff.json", "--all"], here);
    assert!(String::from_utf8_lossy(&all.stdout).contains("The price of safety"));
    let lines = String::from_utf8(again.stdout).unwrap();
    let head = "scene,strategy,regime,volume,term,unit,value,half_width";
    assert_eq!(lines.lines().next(), Some(head));
    let of = |term: &str| lines.lines().filter(|line| line.contains(term)).count();
    assert_eq!(of(",precision,"), 41);
    assert!(of(",warm,sphere,Nu,per frame,") > 0 && of(",cold,sphere,price Cu,") > 0);
    let seeds = fs::read_to_string(here.join("one/tradeoff-seeds.csv")).unwrap();
    assert_eq!(seeds.lines().count(), 1 + 41 * 2);

    let record = fs::read_to_string(here.join("one/tradeoff.json")).unwrap();
    let missed = record.replacen("\"recall\": 1.0", "\"recall\": 0.5", 1);
    fs::write(here.join("missed.json"), missed).unwrap();
    let run = sdop(&["tradeoff", "missed.json"], here);
    assert_eq!(run.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&run.stderr).contains("missed by: sphere"));

    let run = sdop(&["tradeoff", "few.json"], here);
    assert_eq!(run.status.code(), Some(2));
}

/// Advice has three lines and names the cheapest candidate.
#[test]
fn advice_names_the_cheapest() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    fs::write(here.join("few.toml"), SCENE).unwrap();
    let run = sdop(&["advise", "few.toml", "--narrow-ns", "1e6"], here);
    let text = String::from_utf8(run.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("Use ") && lines[3].is_empty(), "{text}");
    assert!(lines[2].starts_with("By the price of a check: "), "{text}");

    let run = sdop(&["advise", "few.toml", "--narrow-ns", "1e6", "--format", "json"], here);
    let advice: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let candidates = advice["candidates"].as_array().unwrap();
    let total = |candidate: &serde_json::Value| candidate["total"].as_f64().unwrap();
    let least = candidates.iter().map(total).fold(f64::INFINITY, f64::min);
    assert_eq!(total(&candidates[0]), least);
    assert_eq!(candidates[0]["name"], advice["best"]);
    // Both axes and every finder are tried.
    let names = |list: &str| -> Vec<String> {
        let list = advice[list].as_array().unwrap().iter();
        list.map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    for axes in ["principal", "model"] {
        assert!(names("candidates").contains(&format!("s-dop 18, {axes}, two-sided")));
    }
    let mut finders = names("finders");
    finders.sort();
    assert_eq!(finders, ["all-pairs", "auto", "grid", "neighbours", "sweep"]);
    // What is printed to be pasted is a table that a scene takes, and flags that the program takes.
    let table = &text[text.find("[cull]").unwrap()..];
    let table = &table[..table.find("\n\n").unwrap()];
    fs::write(here.join("pasted.toml"), format!("{SCENE}{table}\n")).unwrap();
    assert_eq!(sdop(&["run", "pasted.toml"], here).status.code(), Some(0));
    let flags = text.lines().find_map(|line| line.strip_prefix("As flags: "));
    let flags: Vec<&str> = flags.unwrap().split(' ').collect();
    let run = sdop(&[&["run", "few.toml"], &flags[..]].concat(), here);
    assert_eq!(run.status.code(), Some(0));
    assert!(text.contains("sdop::Culler::builder().strategy(sdop::Strategy::"), "{text}");

    // A check takes a millisecond: the variant with the fewest pairs wins, which is the hulls.
    let pairs = |candidate: &serde_json::Value| candidate["pairs"].as_f64().unwrap();
    let fewest = candidates.iter().map(pairs).fold(f64::INFINITY, f64::min);
    assert_eq!(pairs(&candidates[0]), fewest);

    let run = sdop(&["advise", "few.toml", "--narrow-ns", "-1"], here);
    assert_eq!(run.status.code(), Some(2));
}
