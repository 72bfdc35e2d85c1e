//! The comparison of volumes: its truth, its hulls, its counts, and the command that prints them.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot build its input has failed"
)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use sdop::rounding::sphere::inflate_radius;
use sdop::simd::Tier;
use sdop::volume::Hull;
use sdop_bench::hull_test::{HullGraph, PosedHull, may_touch};
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::sweep::Sweep as _;
use sdop_bench::tradeoff::TradeoffPlan;
use sdop_bench::tradeoff::counts::Tally;
use sdop_bench::tradeoff::safety::without_margins;
use sdop_bench::tradeoff::shapes::{Crowd, builtin};
use sdop_bench::tradeoff::truth::{ExactJudge, samples};
use sdop_bench::tradeoff::units::Comparison;
use sdop_bench::tradeoff::variant::{self, Variant};
use sdop_reference::Pose;
use sdop_reference::exact::{meeting, mesh::Mesh};

const SCENE: &str = r#"
name = "few"
seed = 3
frames = 40
[box]
side = 6.0
[[bodies]]
shape = "gear"
count = 20
radius = 1.0
speed = [1.0, 2.0]
[[bodies]]
shape = "l-shape"
count = 15
radius = [0.6, 1.2]
speed = [1.0, 2.0]
[[bodies]]
shape = "torus"
count = 15
radius = 1.0
static = true
[effects]
motion = true
walls = "specular"
spin = { rate = [0.5, 1.0] }
"#;

fn scene() -> Scene {
    SceneFile::parse(SCENE, "few.toml", Path::new(""))
        .unwrap()
        .build()
        .unwrap()
}

/// Hulls agree with the exact meeting of hull meshes.
#[test]
fn hulls_agree_with_exact_meshes() {
    let (mut meetings, mut pairs) = (0, 0);
    for shape in builtin().unwrap() {
        let hull = Hull::of(&shape.vertices);
        let mesh = Mesh::new(&shape.vertices, &hull.facets).unwrap();
        let graphs = [HullGraph::new(&shape)];
        let crowd = Crowd::new(std::slice::from_ref(&shape), 1.0, 300, 5);
        let bodies = &crowd.bodies;
        for [i, j] in crowd.pairs() {
            let pose = |b: u32| {
                Pose::new(bodies.rotation[b as usize], bodies.translation[b as usize]).unwrap()
            };
            let exact = meeting::meet((&mesh, &pose(i)), (&mesh, &pose(j))).meets;
            let posed = |b: u32| PosedHull::of(&graphs, bodies, b as usize);
            assert_eq!(may_touch(&posed(i), &posed(j)), exact, "{} {i}", shape.name);
            meetings += u32::from(exact);
            pairs += 1;
        }
    }
    assert!(meetings > pairs / 5 && meetings < 4 * pairs / 5);
}

#[test]
fn touching_hulls_are_reported() {
    // Unit cubes face to face, corner to corner, edge to edge: exact in f32, a sign in f64 could
    // fall either way.
    let cubes = [builtin().unwrap().swap_remove(0)];
    let graphs = [HullGraph::new(&cubes[0])];
    let half = 0.5_f32;
    for gap in [
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 1.0],
        [1.0, -1.0, 0.3],
        [0.0, 0.0, 0.0],
    ] {
        for (stretch, touch) in [(1.0, true), (1.0 + 1e-6, gap == [0.0; 3])] {
            let mut crowd = Crowd::new(&cubes, 1.0, 1, 0);
            crowd.bodies.rotation = vec![[0.0, 0.0, 0.0, 1.0]; 2];
            crowd.bodies.translation = vec![[0.0; 3], gap.map(|x: f32| 2.0 * half * x * stretch)];
            let posed = |b| PosedHull::of(&graphs, &crowd.bodies, b);
            assert_eq!(may_touch(&posed(0), &posed(1)), touch, "{gap:?} {stretch}");
        }
    }
}

/// The truth is every meeting and is kept.
#[test]
fn truth_is_complete_and_cached() {
    let scene = scene();
    let samples = samples(&scene, 3).unwrap();
    assert_eq!(
        samples.iter().map(|s| s.frame).collect::<Vec<_>>(),
        [0, 13, 26]
    );
    let judge = ExactJudge::new(&scene.shapes).unwrap();
    let cache = tempfile::tempdir().unwrap();
    let truth = judge.truth(&samples, Some(cache.path())).unwrap();

    let n = scene.bodies.len() as u32;
    let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
    let moving =
        |&[i, j]: &[u32; 2]| scene.bodies.dynamic[i as usize] || scene.bodies.dynamic[j as usize];
    let counted = judge.count(&samples[0].bodies, all.filter(moving)).unwrap();
    assert_eq!(truth[0].len(), counted);
    assert!(counted > 20 && truth.iter().all(|pairs| pairs.is_sorted()));

    // What was kept is read again; a file that was tampered with is not.
    let file = fs::read_dir(cache.path())
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let kept = fs::read_to_string(&file).unwrap();
    let first = format!("{} {} ", truth[0][0][0], truth[0][0][1]);
    fs::write(&file, kept.replacen(&first, "", 1)).unwrap();
    assert_eq!(judge.truth(&samples, Some(cache.path())).unwrap(), truth);
    assert_eq!(fs::read_to_string(&file).unwrap(), kept);
    // Another scene has another file.
    judge.truth(&samples[..2], Some(cache.path())).unwrap();
    assert_eq!(fs::read_dir(cache.path()).unwrap().count(), 2);
}

/// Every variant finds every true pair and finer ones report fewer.
#[test]
fn finer_variants_report_fewer() {
    let scene = scene();
    let samples = samples(&scene, 5).unwrap();
    let truth = ExactJudge::new(&scene.shapes)
        .unwrap()
        .truth(&samples, None)
        .unwrap();
    let tier = Tier::detect();
    let tally = |variant: &Variant| Tally::of(&scene, variant, tier, &samples, &truth).unwrap();
    let variants = variant::all(&scene, 30);
    let tallies: Vec<Tally> = variants.iter().map(tally).collect();
    for (variant, found) in variants.iter().zip(&tallies) {
        assert_eq!(found.quality().recall, 1.0, "{}", variant.name);
        assert_eq!(*found, tally(variant), "{}", variant.name);
        let tightness = variant::tightness(variant, &scene).unwrap();
        assert!(tightness >= 1.0 - 1e-6, "{}: {tightness}", variant.name);
    }
    let reported = |name: &str| {
        let place = variants.iter().position(|v| v.name == name).unwrap();
        tallies[place].reported
    };
    for k in [6, 14, 18, 26] {
        let of = |overlap| reported(&format!("s-dop {k}, principal, {overlap}"));
        assert!(of("one-sided") >= of("two-sided") && of("two-sided") >= of("full"));
        assert!(reported("sphere") > of("one-sided"));
        assert!(of("full") >= reported("sphere + hull"));
    }
    assert_eq!(reported("aabb"), reported("6-dop"));
    for same in ["s-dop lazy", "s-dop batch", "s-dop batch lazy"] {
        assert_eq!(reported(same), reported("s-dop 18, principal, two-sided"));
    }
}

/// Shrunk volumes are what the margins make of the true ones.
#[test]
fn margins_equal_shrunk_volumes() {
    for shape in builtin().unwrap() {
        let bare = without_margins(&shape);
        assert!(inflate_radius(bare.ball.radius) <= shape.ball.radius);
        assert!(inflate_radius(bare.ball.radius.next_up()) > shape.ball.radius);
        let shrunk = shape
            .ordop
            .hi
            .iter()
            .zip(&bare.ordop.hi)
            .all(|(hi, bare)| bare < hi);
        assert!(shrunk, "{}", shape.name);
    }
}

/// Where bodies fall asleep, each variant that a world can have is timed in one, and both report
/// the same pairs. Elsewhere nothing is.
#[test]
fn worlds_are_compared_where_bodies_rest() {
    let resting = SCENE.replace(
        "[effects]",
        "[effects]\nrest = { speed = 0.5, after = 0.1 }",
    );
    let plan = TradeoffPlan {
        seeds: 1,
        samples: 2,
        pairs: 1,
        window: 1,
        stride: 1,
        tier: Tier::detect(),
        cache: None,
    };
    for (text, worlds) in [(SCENE, 0), (&resting, 1)] {
        let file = SceneFile::parse(text, "few.toml", Path::new("")).unwrap();
        let comparison = Comparison::new(&file, &plan).unwrap();
        let units = comparison.header().unwrap().units;
        let of_worlds: Vec<usize> = (0..units)
            .filter(|&unit| comparison.name(unit) == "times of worlds")
            .collect();
        assert_eq!(of_worlds.len(), worlds);
        for unit in of_worlds {
            let found: serde_json::Value =
                serde_json::from_str(&comparison.run(unit).unwrap()).unwrap();
            let rows = found["Worlds"].as_array().unwrap();
            let names: Vec<&str> = rows
                .iter()
                .map(|row| row["variant"].as_str().unwrap())
                .collect();
            assert!(
                names.contains(&"sphere") && names.contains(&"aabb"),
                "{names:?}"
            );
            assert_eq!(names.len(), 1 + 1 + 4 + 24 + 1, "{names:?}");
            for row in rows {
                let mean = |key: &str| row[key]["mean"].as_f64().unwrap();
                assert!(mean("culler") > 0.0 && mean("world") > 0.0);
            }
        }
    }
}

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
    let mut parts = vec![
        result["truth"].clone(),
        result["budgets"].clone(),
        result["shapes"].clone(),
    ];
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

/// The variations of `lab::tradeoff::vary` are of a scene of 50 bodies.
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
        partners[2..]
            .iter()
            .all(|p| (p / partners[1] - 1.0).abs() < 0.4),
        "the density stays: {partners:?}"
    );
    let triangles = of("triangles", "triangles");
    assert!(
        triangles[0] <= 100.0 && triangles[0] < triangles[1],
        "{triangles:?}"
    );
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
        assert_eq!(
            run.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        );
        let text = String::from_utf8(run.stdout).unwrap();
        assert!(text.starts_with("Cheapest at this density"), "{text}");
        assert!(text.contains("sphere + hull") && !text.contains("The price of safety"));
    }
    assert_eq!(
        counts(&here.join("one/tradeoff.json")),
        counts(&here.join("two/tradeoff.json"))
    );

    changes_are_what_they_say(&here.join("one/tradeoff.json"));
    nothing_is_left_out(&here.join("one/tradeoff.json"));

    let again = sdop(
        &[
            "tradeoff",
            "one/tradeoff.json",
            "--out",
            "again",
            "--format",
            "csv",
        ],
        here,
    );
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
    assert!(
        figure.contains("aabb") && !figure.contains("1e"),
        "{figure}"
    );
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
    assert!(
        lines[0].starts_with("Use ") && lines[3].is_empty(),
        "{text}"
    );
    assert!(lines[2].starts_with("By the price of a check: "), "{text}");

    let run = sdop(
        &[
            "advise",
            "few.toml",
            "--narrow-ns",
            "1e6",
            "--format",
            "json",
        ],
        here,
    );
    let advice: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let candidates = advice["candidates"].as_array().unwrap();
    let total = |candidate: &serde_json::Value| candidate["total"].as_f64().unwrap();
    let least = candidates.iter().map(total).fold(f64::INFINITY, f64::min);
    assert_eq!(total(&candidates[0]), least);
    assert_eq!(candidates[0]["name"], advice["best"]);
    // Both axes and every finder are tried.
    let names = |list: &str| -> Vec<String> {
        let list = advice[list].as_array().unwrap().iter();
        list.map(|one| one["name"].as_str().unwrap().to_owned())
            .collect()
    };
    for axes in ["principal", "model"] {
        assert!(names("candidates").contains(&format!("s-dop 18, {axes}, two-sided")));
    }
    let mut finders = names("finders");
    finders.sort();
    assert_eq!(
        finders,
        ["all-pairs", "auto", "grid", "neighbours", "sweep"]
    );
    // What is printed to be pasted is a table that a scene takes, and flags that the program takes.
    let table = &text[text.find("[cull]").unwrap()..];
    let table = &table[..table.find("\n\n").unwrap()];
    fs::write(here.join("pasted.toml"), format!("{SCENE}{table}\n")).unwrap();
    assert_eq!(sdop(&["run", "pasted.toml"], here).status.code(), Some(0));
    let flags = text
        .lines()
        .find_map(|line| line.strip_prefix("As flags: "));
    let flags: Vec<&str> = flags.unwrap().split(' ').collect();
    let run = sdop(&[&["run", "few.toml"], &flags[..]].concat(), here);
    assert_eq!(run.status.code(), Some(0));
    assert!(
        text.contains("sdop::Culler::builder().strategy(sdop::Strategy::"),
        "{text}"
    );

    // A check takes a millisecond: the variant with the fewest pairs wins, which is the hulls.
    let pairs = |candidate: &serde_json::Value| candidate["pairs"].as_f64().unwrap();
    let fewest = candidates.iter().map(pairs).fold(f64::INFINITY, f64::min);
    assert_eq!(pairs(&candidates[0]), fewest);

    let run = sdop(&["advise", "few.toml", "--narrow-ns", "-1"], here);
    assert_eq!(run.status.code(), Some(2));
}
