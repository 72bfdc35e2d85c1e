//! `sdop reproduce` and `sdop cost`.

use std::path::Path;

use super::{json, refusal, scene_file, sdop, stdout, text};

const TINY: [&str; 7] = ["reproduce", "--quick", "--seeds", "2", "--frames", "3", "--out"];

/// SHA-256 of what all machines count.
const COUNTS: &str = "6a826ee5bcc855a5c769231e5e964cfffdecb0d6d4af1d5d0f6462914135ae34";

#[test]
fn reproduce_writes_tables_and_figures() {
    let directory = tempfile::tempdir().unwrap();
    let [out, paper] = ["tables", "paper"].map(|name| directory.path().join(name));
    let brief = stdout(&[&TINY[..], &[text(&out), "--paper", text(&paper)]].concat());
    assert!(brief.contains("Collisions in percent of tests, 2 seeds of 3 frames"), "{brief}");
    let read = |path: &Path| std::fs::read_to_string(path).unwrap();
    let counts = read(&out.join("counts.csv"));
    assert_eq!(counts.lines().count(), 1 + 2 * 6 * 6);
    for name in ["frame_rates", "useful_tests", "costs", "residuals", "sphere"] {
        let svg = read(&paper.join("figures").join(name).with_extension("svg"));
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{name}");
    }
    for name in ["times", "table_1", "frame_rates", "costs", "prices", "survival", "claims"] {
        assert!(read(&out.join(name).with_extension("csv")).lines().count() > 1, "{name}");
    }
    let results: serde_json::Value =
        serde_json::from_str(&read(&out.join("results.json"))).unwrap();
    assert_eq!(results["seeds"], serde_json::json!([1, 2]));
    // Equal on every machine: the counts' hash says so for all of them.
    assert_eq!(results["counts_sha256"], COUNTS);
    assert!(!results.to_string().contains(text(directory.path())), "a path of this machine");
    assert_eq!(results["claims"][0]["checks"].as_array().unwrap().len(), 20);
}

/// Reproduce in shards gives the same counts.
#[test]
fn sharded_reproduce_counts_alike() {
    let directory = tempfile::tempdir().unwrap();
    let [out, merged] = ["shards", "merged"].map(|name| directory.path().join(name));
    let mut shards = Vec::new();
    for index in ["1", "2"] {
        let shard = [text(&out), "--shard", &format!("{index}/2")];
        assert!(stdout(&[&TINY[..], &shard].concat()).ends_with("7 of 14 units\n"));
        shards.push(out.join(format!("reproduce-{index}-of-2.units")));
    }
    let shards = shards.iter().map(|path| text(path));
    let merge = ["merge"].into_iter().chain(shards).chain(["-o", text(&merged)]);
    let brief = stdout(&merge.collect::<Vec<_>>());
    assert!(brief.contains("2 seeds of 3 frames"), "{brief}");
    let results = std::fs::read_to_string(merged.join("results.json")).unwrap();
    let results: serde_json::Value = serde_json::from_str(&results).unwrap();
    assert_eq!(results["seeds"], serde_json::json!([1, 2]));
    // Equal on every machine: the counts' hash says so for all of them.
    assert_eq!(results["counts_sha256"], COUNTS);
    assert!(!results.to_string().contains(text(directory.path())), "a path of this machine");
    let command = "cargo run --release -- reproduce --quick --seeds 2 --frames 3 --out DIR";
    assert_eq!(results["command"], command);
    assert_eq!(results["counts_sha256"], COUNTS);
}

#[test]
fn reproduce_says_what_it_needs() {
    let elsewhere = refusal(&["reproduce", "--scenes", "no/such/place"]);
    assert!(
        elsewhere.contains("there is no directory no/such/place")
            && elsewhere.contains("--scenes DIR"),
        "{elsewhere}"
    );
    assert_eq!(sdop(&["reproduce", "--shard", "half"]).status.code(), Some(2));
}

/// Cost predicts every term of the strategies asked for.
#[test]
fn cost_predicts_every_term() {
    let arguments = ["cost", "data/scenes/paper-50.toml", "--frames", "3", "--seeds", "2"];
    let one = json(&[&arguments[..], &["--strategy", "s-dop-batch"]].concat());
    assert_eq!((&one["bodies"], &one["frames"]), (&50.into(), &3.into()));
    let costs = one["costs"].as_array().unwrap();
    let regimes: Vec<_> = costs.iter().map(|cost| &cost["regime"]).collect();
    assert_eq!(regimes, ["warm", "cold"]);
    let names = |list: &serde_json::Value| {
        let names = list.as_array().unwrap().iter();
        names.map(|item| item["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(&costs[0]["terms"]), ["sphere", "or-dop"]);
    assert_eq!(one["prices"].as_array().unwrap().len(), 2 * 2);
    assert!(one["conditions"]["of"].is_number(), "{one}");
    let terms = costs[0]["terms"].as_array().unwrap().iter();
    let recurring = |term: &serde_json::Value| {
        ["update", "finding", "test"].map(|key| term[key].as_f64().unwrap()).iter().sum::<f64>()
    };
    let sum: f64 = terms.map(recurring).sum();
    let predicted = costs[0]["frame"]["predicted"]["mean"].as_f64().unwrap();
    assert!((sum / predicted - 1.0).abs() < 1e-12 && predicted > 0.0);
}

/// Scenes of one kind have the same prices; others are refused.
#[test]
fn scenes_of_one_kind_share_prices() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().to_str().unwrap();
    let paper = |bodies: u32| format!("data/scenes/paper-{bodies}.toml");
    let (few, more, crowd) = (paper(50), paper(150), "data/scenes/uniform-10k.toml");
    let both = ["cost", &few, "--also", &more, "--frames", "2", "--seeds", "2"];
    let strategy = ["--strategy", "s-dop-batch", "--out", out];
    let printed = json(&[&both[..], &strategy].concat());
    let [one, other] = &printed.as_array().unwrap()[..] else {
        panic!("{printed}");
    };
    assert_eq!([&one["scene"], &other["scene"]], ["paper-50", "paper-150"]);
    assert_eq!(one["prices"], other["prices"]);
    assert_ne!(one["costs"][0]["terms"], other["costs"][0]["terms"]);
    let written = std::fs::read_to_string(directory.path().join("paper-150.json")).unwrap();
    assert_eq!(&serde_json::from_str::<serde_json::Value>(&written).unwrap(), other);
    let refused = refusal(&["cost", &few, "--also", crowd]);
    assert!(refused.contains("can't have the same prices"), "{refused}");
}

/// A run of one frame has no warm one: scenes are simulated further, and fewer frames can't be
/// asked for where there are no others.
#[test]
fn one_frame_is_not_timed_alone() {
    let (directory, scene) = scene_file(
        "name = \"still\"\nframes = 1\n[box]\nside = 9.0\n\
         [[bodies]]\nshape = \"box\"\ncount = 9\nradius = 1.0\n",
    );
    let short = ["--frames", "1", "--seeds", "1", "--format", "csv"];
    let timed = ["cost", text(&scene), "--strategy", "s-dop-batch"];
    let csv = stdout(&[&timed[..], &short].concat());
    let warm = csv.lines().filter(|line| line.contains(",warm,"));
    assert!(warm.count() > 5, "{csv}");
    let compared = ["tradeoff", text(&scene), "--quick", "--out"];
    let csv = stdout(&[&compared[..], &[text(directory.path())], &short].concat());
    assert!(csv.lines().count() > 5, "{csv}");
    let refused = refusal(&["reproduce", "--quick", "--frames", "1"]);
    assert!(refused.contains("1 is not in 2..=1000000"), "{refused}");
}

/// Cost covers every strategy that the scene has settings for.
#[test]
fn cost_covers_every_possible_strategy() {
    let csv = stdout(&[
        "cost",
        "data/scenes/paper-50.toml",
        "--frames",
        "2",
        "--seeds",
        "1",
        "--format",
        "csv",
    ]);
    let header = "scene,strategy,regime,volume,term,unit,value,half_width";
    assert_eq!(csv.lines().next(), Some(header));
    let mut rows: Vec<&str> = csv
        .lines()
        .filter(|line| line.contains(",sum,"))
        .filter_map(|line| line.split(',').nth(1))
        .collect();
    rows.dedup();
    let expected = [
        "sphere",
        "or-dop",
        "s-dop-sequential",
        "s-dop-batch",
        "s-dop-object-of-interest",
        "aabb",
        "k-dop",
        "obb",
    ];
    assert_eq!(rows, expected, "{csv}");
    // Counts, terms and prices.
    for part in [
        ",s-dop-batch,warm,or-dop,Nu,",
        ",s-dop-batch,warm,or-dop,Nv*Cv,",
        ",s-dop-batch,cold,or-dop,price Cv hit,",
        ",obb,warm,obb,price Cu,",
    ] {
        assert!(csv.contains(part), "{part} in {csv}");
    }
}

#[test]
fn cost_draws_where_the_time_goes() {
    let directory = tempfile::tempdir().unwrap();
    let plot = directory.path().join("cost.svg");
    let table = stdout(&[
        "cost",
        "data/scenes/paper-50.toml",
        "--frames",
        "9",
        "--seeds",
        "1",
        "--plot",
        text(&plot),
    ]);
    assert!(table.contains("1 passes of 9 frames") && table.contains("Cold frames"));
    assert!(table.contains("Cu, ns") && table.contains("Cv hit, ns"));
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert!(svg.starts_with("<svg ") && svg.contains("F pair finding"));
}
