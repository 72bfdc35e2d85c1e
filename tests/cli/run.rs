//! `sdop run`: the object that it prints, which depends only on scene and flags, and the input that
//! it rejects.

use sdop::simd::Tier;
use serde_json::Value;

use crate::cli::{json, refusal, scene_file, sdop, stdout, text};

const SCENE: &str = "data/scenes/paper-50.toml";
const FAST: [&str; 4] = ["run", SCENE, "--frames", "20"];

fn run(flags: &[&str]) -> Value {
    json(&[&FAST, flags].concat())
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn json_is_the_documented_object() {
    let report = run(&[]);
    #[rustfmt::skip]
    assert_eq!(keys(&report), [
        "scene", "seed", "bodies", "frames", "strategy", "pairs", "finder", "k", "axes", "overlap", "updates", "interest", "budget",
        "simd", "threads", "counters", "seconds", "frame_seconds", "conditions", "effects", "volumes_sha256", "pairs_sha256",
        "pairs_digest",
    ]);
    #[rustfmt::skip]
    assert_eq!(keys(&report["counters"]), [
        "sphere_updates", "ordop_updates", "sphere_tests", "sphere_hits", "ordop_tests", "ordop_hits", "untested",
        "reported",
    ]);
    let stages = ["construct", "effects", "update", "pair_finding", "ordop", "total"];
    assert_eq!(keys(&report["seconds"]), stages);
    assert_eq!(keys(&report["frame_seconds"]), ["p50", "p99", "most"]);
    assert_eq!(keys(&report["effects"][0]), ["name", "steps", "seconds"]);
    // What else the machine did, as `cost` says it: no interval, no count of wide ones.
    assert_eq!(keys(&report["conditions"]), ["others", "wide", "of"]);
    assert_eq!(report["conditions"]["of"], 0);
    assert_eq!(report["scene"], "paper-50");
    assert_eq!(report["frames"], 20);
    assert_eq!(report["pairs_sha256"].as_str().unwrap().len(), 64);
    assert_eq!(report["pairs_digest"].as_str().unwrap().len(), 32);
}

/// Counters and hashes are the same twice and in every simd level.
#[test]
fn runs_repeat_in_every_tier() {
    let expected = run(&["--simd", "scalar"]);
    for tier in Tier::available() {
        let report = run(&["--simd", tier.name()]);
        assert_eq!(report["simd"], tier.name());
        for key in ["counters", "volumes_sha256", "pairs_sha256"] {
            assert_eq!(report[key], expected[key], "{key} in {tier}");
        }
    }
    let other_seed = run(&["--seed", "2"]);
    assert_ne!(other_seed["pairs_sha256"], expected["pairs_sha256"]);
}

/// Threads and finders leave the pairs as they are.
#[test]
fn threads_and_finders_keep_pairs() {
    let expected = run(&["--strategy", "sphere"]);
    for finder in ["all-pairs", "grid", "sweep", "neighbours", "auto"] {
        let one = run(&["--pairs", finder]);
        for strategy in ["sphere", "s-dop-batch"] {
            let flags = ["--pairs", finder, "--threads", "3", "--strategy", strategy];
            let report = run(&flags);
            assert_eq!(report["threads"], 3);
            assert_eq!(report["pairs"], finder);
            let picked = if finder == "auto" { "all-pairs" } else { finder };
            assert_eq!(report["finder"], picked);
            let same = if strategy == "sphere" { &expected } else { &one };
            assert_eq!(report["pairs_sha256"], same["pairs_sha256"], "{flags:?}");
            for count in ["sphere_hits", "reported"] {
                let (seen, expected) = (&report["counters"][count], &same["counters"][count]);
                assert_eq!(seen, expected, "{count} {flags:?}");
            }
        }
    }
}

/// Counters follow from bodies frames and strategy.
#[test]
fn counters_follow_from_the_scene() {
    let count = |report: &Value, name: &str| report["counters"][name].as_u64().unwrap();
    let sequential = run(&[]);
    // 50 bodies, 10 of them static: 50·49/2 − 10·9/2 pairs and 40 updates a frame.
    assert_eq!(count(&sequential, "sphere_tests"), 20 * (1225 - 45));
    assert_eq!(count(&sequential, "sphere_updates"), 20 * 40);
    assert_eq!(count(&sequential, "ordop_tests"), count(&sequential, "sphere_hits"));
    assert_eq!(count(&sequential, "reported"), count(&sequential, "ordop_hits"));
    let batch = run(&["--strategy", "s-dop-batch"]);
    assert_eq!(batch["counters"], sequential["counters"]);
    assert_eq!(batch["pairs_sha256"], sequential["pairs_sha256"]);

    let none = run(&["--strategy", "none"]);
    assert_eq!(none["pairs_sha256"], Value::Null);
    assert_eq!(none["pairs_digest"], Value::Null);
    let counts = none["counters"].as_object().unwrap();
    assert!(counts.values().all(|count| *count == 0), "{counts:?}");
}

/// Homogeneous volumes have counters of their own.
#[test]
fn single_volumes_have_own_counters() {
    for (strategy, volume) in [("aabb", "aabb"), ("obb", "obb"), ("k-dop", "kdop")] {
        let counters = &run(&["--strategy", strategy])["counters"];
        for (what, expected) in [("updates", 20 * 40), ("tests", 20 * (1225 - 45))] {
            assert_eq!(counters[format!("{volume}_{what}")], expected, "{strategy}");
        }
        assert_eq!(counters[format!("{volume}_hits")], counters["reported"], "{strategy}");
        assert_eq!(counters["sphere_tests"], 0, "{strategy}");
    }
}

/// A frame less is stepped and unlisted effects are not simulated.
#[test]
fn unlisted_effects_are_not_simulated() {
    let report = run(&[]);
    let steps = |name: &str| {
        let effects = report["effects"].as_array().unwrap();
        let effect = effects.iter().find(|effect| effect["name"] == name);
        effect.unwrap()["steps"].as_u64().unwrap()
    };
    for listed in ["motion", "walls", "spin"] {
        assert_eq!(steps(listed), 19, "{listed}");
    }
    for unlisted in ["gravity", "brownian", "response"] {
        assert_eq!(steps(unlisted), 0, "{unlisted}");
    }
    let table = stdout(&FAST);
    let line = |name: &str| table.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
    assert!(line("gravity").contains("not simulated"), "{table}");
    assert!(line("motion").contains("19"), "{table}");
}

#[test]
fn flags_override_the_scene() {
    let report = run(&[
        "--strategy",
        "s-dop-time-critical",
        "--budget-tests",
        "0",
        "--k",
        "26",
        "--axes",
        "model",
        "--overlap",
        "full",
        "--updates",
        "lazy",
        "--interest",
        "3,4",
        "--order",
        "interest-first",
    ]);
    assert_eq!(report["strategy"], "s-dop-time-critical");
    assert_eq!(report["k"], 26);
    assert_eq!(report["axes"], "model");
    assert_eq!(report["overlap"], "full");
    assert_eq!(report["updates"], "lazy");
    assert_eq!(report["interest"], serde_json::json!([3, 4]));
    assert_eq!(report["budget"], serde_json::json!({"tests": 0}));
    let counters = &report["counters"];
    assert_eq!(counters["ordop_tests"], 0);
    assert_eq!(counters["untested"], counters["sphere_hits"]);
}

/// Csv is a header and a line of the same values.
#[test]
fn csv_has_the_same_values() {
    let csv = stdout(&[&FAST[..], &["--format", "csv"]].concat());
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let header = reader.headers().unwrap().clone();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 1);
    let cell = |name: &str| {
        let column = header.iter().position(|column| column == name);
        rows[0][column.unwrap_or_else(|| panic!("{name} in {csv}"))].to_owned()
    };
    let report = run(&[]);
    assert_eq!(cell("scene"), "paper-50");
    assert_eq!(cell("pairs_sha256"), report["pairs_sha256"]);
    assert_eq!(cell("counters.sphere_hits"), report["counters"]["sphere_hits"].to_string());
    assert_eq!(cell("effects.motion.steps"), "19");
    assert_eq!(cell("budget"), "");
}

/// Bad flags are refused with what would do.
#[test]
fn invalid_flags_name_valid_ones() {
    for (flags, messages) in [
        (&["--simd", "sse9"][..], &["unknown SIMD level `sse9`", "avx512, neon"][..]),
        (&["--strategy", "s-dop-batsh"], &["invalid value 's-dop-batsh'", "'s-dop-batch'"]),
        (&["--strategy", "s-dop-time-critical"], &["needs `budget`", "tests = 1000"]),
        (&["--interest", "50"], &["body 50 of a scene of 50", "counted from 0"]),
        (&["--interest", "1,x"], &["body indices as in 0,5,7"]),
        (&["--threads", "0"], &["0 is not in 1..=1024"]),
        (&["--threads", "100000"], &["100000 is not in 1..=1024"]),
        (&["--k", "8"], &["invalid value '8'", "6, 14, 18, 26"]),
        (&["--budget-tests", "5", "--budget-us", "5"], &["cannot be used with"]),
        (&["--seed", "-1"], &["'-1'"]),
    ] {
        let message = refusal(&[&FAST, flags].concat());
        for part in messages {
            assert!(message.contains(part), "{flags:?}: {message}");
        }
    }
}

/// A level that this cpu lacks is refused with those it has.
#[test]
fn missing_tier_lists_available_ones() {
    let available: Vec<_> = Tier::available().iter().map(|tier| tier.name()).collect();
    let lacking = Tier::NAMES.iter().find(|name| !available.contains(name));
    // No CPU has both AVX and NEON.
    let lacking = lacking.unwrap();
    let message = refusal(&[&FAST[..], &["--simd", lacking]].concat());
    let expected = format!("this CPU or build has no {lacking}; it has {}", available.join(", "));
    assert!(message.contains(&expected), "{message}");
}

/// Scene errors say where and how to mend.
#[test]
fn scene_errors_name_place_and_remedy() {
    let head = "name = \"bad\"\nframes = 2\n";
    for (body, messages) in [
        (
            "[[bodies]]\nshape = \"box\"\ncuont = 3\n",
            &["scene.toml:5:1:", "unknown field `cuont`", "did you mean `count`?"][..],
        ),
        (
            "[[bodies]]\nmesh = \"nowhere.tri\"\ncount = 1\n",
            &["scene.toml:4:8", "nowhere.tri", "relative to the scene file"],
        ),
        (
            "[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 0, 1, 2, 3]]\n",
            &["scene.toml:5:10", "quaternion"],
        ),
    ] {
        let (_directory, path) = scene_file(&format!("{head}{body}"));
        let message = refusal(&["run", text(&path)]);
        for part in messages {
            assert!(message.contains(part), "{body}: {message}");
        }
    }
    let message = refusal(&["run", "no-such-scene.toml"]);
    assert!(message.contains("no-such-scene.toml"), "{message}");
    assert!(message.contains("paper-500.toml"), "{message}");
}

/// A body that leaves the contract is named with its frame.
#[test]
fn leaving_body_is_named_with_frame() {
    let (_directory, path) = scene_file(
        "name = \"escape\"\nframes = 9\ndt = 1.0\n[effects]\nmotion = true\n[[bodies]]\nshape = \"box\"\n\
         poses = [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 1.0e18, 0, 0]]\nvelocities = [[0, 0, 0], [1.0e17, 0, 0]]\n",
    );
    let message = refusal(&["run", text(&path)]);
    // 10¹⁸ + 2·10¹⁷ is beyond 2⁶⁰ ≈ 1.15·10¹⁸.
    assert!(message.contains("frame 2: body 1: translation"), "{message}");
    assert!(message.contains("at most 2^60"), "{message}");
}

/// Unit boxes that overlap by 0.3 where f32 steps by 64, and one that is 0.1 apart from them.
#[test]
fn far_poses_are_culled_exactly() {
    let group = |x: &str| {
        format!(
            "[[bodies]]\nshape = \"box\"\nsizes = {{ x = 1, y = 1, z = 1 }}\nposes = [[0, 0, 0, 1, {x}, 0, 0]]\n"
        )
    };
    let groups = ["1000000031.5", "1000000032.2", "1000000033.3"].map(group);
    let (directory, path) = scene_file(&format!("name = \"far\"\nframes = 1\n{}", groups.concat()));
    let record = directory.path().join("far.ndjson");
    let report = json(&["run", text(&path), "--record", text(&record), "--truth"]);
    assert_eq!(report["counters"]["reported"], 1);
    let frame = std::fs::read_to_string(&record).unwrap();
    assert!(frame.contains("\"translations\":[[1000000031.5,0.0,0.0],"), "{frame}");
    assert!(frame.contains("\"meets\":[[0,1]]"), "{frame}");
    let study = refusal(&["cost", text(&path)]);
    assert!(study.contains("`sdop run` culls f64 translations"), "{study}");
}

/// A recording that cannot be written is refused.
#[test]
fn unwritable_recording_is_an_error() {
    let output = sdop(&[&FAST[..], &["--record", "no/such/directory/x.ndjson"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("cannot write no/such/directory/x.ndjson"), "{message}");
}
