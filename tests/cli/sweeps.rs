//! All commands whose work can be shared: merged shards give the result of one process. `.ci/mpi`
//! shows the same for ranks.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::{refusal, scene_file, stdout, text};

/// A command whose work can be shared.
struct Sweep {
    name: &'static str,
    /// Arguments of a run that takes a moment; they end before the output directory. A scene's path
    /// goes where `SCENE` is.
    arguments: &'static [&'static str],
    /// Further ones, after all others.
    last: &'static [&'static str],
    /// Where its shards are and its result, in the output directory.
    shards: &'static str,
    result: &'static str,
    /// How shards become its result, where `sdop merge` doesn't do it.
    merge: Option<&'static str>,
    /// Files that don't depend on who did the work, but for the keys of [`CLOCK`]; of none, what it
    /// prints.
    facts: &'static [&'static str],
}

const REPRODUCED: &[&str] = &["counts.csv", "table_1.csv", "survival.csv"];

/// Each has a separate test below, so that they run side by side.
static SWEEPS: [Sweep; 4] = [
    Sweep {
        name: "verify",
        arguments: &[
            "SCENE", "--group", "counts", "--seeds", "1", "--frames", "2", "--simd", "scalar",
            "--format", "json", "--out",
        ],
        last: &[],
        shards: "",
        result: "",
        merge: None,
        facts: &[],
    },
    Sweep {
        name: "reproduce",
        arguments: &["--quick", "--seeds", "2", "--frames", "3", "--out"],
        last: &[],
        shards: "",
        result: "",
        merge: None,
        facts: REPRODUCED,
    },
    Sweep {
        name: "tradeoff",
        arguments: &[
            "SCENE", "--quick", "--frames", "2", "--format", "json", "--cache", "CACHE", "--out",
        ],
        last: &[],
        shards: "",
        result: "",
        merge: None,
        facts: &["tradeoff.json"],
    },
    Sweep {
        name: "record",
        arguments: &["reproduce", "--name", "box", "--out"],
        last: &["--", "--quick", "--seeds", "1", "--frames", "3"],
        shards: "box/reproduce.shards",
        result: "box/reproduce",
        merge: Some("--merge"),
        facts: &["counts.csv", "table_1.csv", "survival.csv", "record.json"],
    },
];

/// Keys below which a clock, the machine's load or the day has a say, and digests of what they are
/// in.
const CLOCK: &[&str] = &[
    "seconds",
    "lazy_seconds",
    "times",
    "warm",
    "cold",
    "construct",
    "narrow_phase",
    "standing",
    "cheapest",
    "break_even",
    "best",
    "prices",
    "decisions",
    "conditions",
    "advice",
    "clock",
    "load",
    "caches",
    "date",
    "digest",
];

const SCENE: &str = r#"
name = "small"
frames = 5
[box]
side = 5.0
[[bodies]]
shape = "l-shape"
count = 12
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[effects]
motion = true
"#;

impl Sweep {
    fn arguments(&self, scene: &Path, out: &Path, more: &[&str]) -> Vec<String> {
        let place = |argument: &&str| match *argument {
            "SCENE" => text(scene).to_owned(),
            "CACHE" => text(&out.with_extension("cache")).to_owned(),
            other => other.to_owned(),
        };
        let own = self.arguments.iter().map(place);
        let out = [text(out)];
        let rest = out.iter().chain(more).chain(self.last);
        [self.name.to_owned()]
            .into_iter()
            .chain(own)
            .chain(rest.map(|&argument| argument.to_owned()))
            .collect()
    }

    /// What a run prints, and what it leaves that doesn't depend on who did it.
    fn run(&self, scene: &Path, out: &Path, more: &[&str]) -> String {
        let arguments = self.arguments(scene, out, more);
        stdout(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    }

    fn facts(&self, printed: &str, out: &Path) -> Vec<Value> {
        let fact = |name: &&str| {
            let file = fs::read_to_string(out.join(self.result).join(name)).unwrap();
            if Path::new(name).extension().is_some_and(|e| e == "json") {
                untimed(serde_json::from_str(&file).unwrap())
            } else {
                Value::from(file)
            }
        };
        if self.facts.is_empty() {
            return vec![untimed(serde_json::from_str(printed).unwrap())];
        }
        self.facts.iter().map(fact).collect()
    }

    fn merged(&self, scene: &Path, out: &Path, shards: &[PathBuf]) -> Vec<Value> {
        let printed = if let Some(flag) = self.merge {
            self.run(scene, out, &[flag])
        } else {
            let shards = shards.iter().map(|path| text(path));
            let arguments = ["merge", "--format", "json", "--out", text(out)].into_iter();
            stdout(&arguments.chain(shards).collect::<Vec<_>>())
        };
        self.facts(&printed, out)
    }
}

/// A result without measured times, and without digests of files that have such times.
fn untimed(value: Value) -> Value {
    match value {
        Value::Object(map) => {
            let stays = |(key, _): &(String, Value)| {
                let timed = key.ends_with(".json") || key.ends_with(".svg") || key.ends_with(".md");
                let csv = key.ends_with(".csv") && !REPRODUCED.contains(&key.as_str());
                !(CLOCK.contains(&key.as_str()) || timed || csv)
            };
            let kept = map.into_iter().filter(stays);
            let kept = kept.map(|(key, value)| (key, untimed(value)));
            Value::Object(kept.collect::<Map<_, _>>())
        }
        Value::Array(items) => Value::Array(items.into_iter().map(untimed).collect()),
        other => other,
    }
}

/// Every command that can be shared is judged.
#[test]
fn every_sharable_command_is_tested() {
    let commands = stdout(&["--help"]);
    let listed = commands
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help");
    let shared = listed.filter(|name| stdout(&[name, "--help"]).contains("--shard <"));
    let mut shared: Vec<&str> = shared.collect();
    shared.sort_unstable();
    let mut judged: Vec<&str> = SWEEPS.iter().map(|sweep| sweep.name).collect();
    judged.sort_unstable();
    assert_eq!(judged, shared);
    assert_eq!(judged, TESTED, "sorted as these are");
}

/// Shards of a sweep are the work of one process.
fn shards_equal_one_process(sweep: &Sweep) {
    let (directory, scene) = scene_file(SCENE);
    let [alone, out] = ["alone", "out"].map(|name| directory.path().join(name));
    let whole = sweep.facts(&sweep.run(&scene, &alone, &[]), &alone);
    assert!(whole.iter().all(|fact| fact.to_string().len() > 100), "{whole:?}");
    let mut shards = Vec::new();
    for part in ["2/3", "1/3", "3/3"] {
        let said = sweep.run(&scene, &out, &["--shard", part]);
        let (path, units) = said.trim_end().rsplit_once(": ").unwrap();
        assert!(units.ends_with(" units"), "{said}");
        shards.push(PathBuf::from(path));
    }
    let place = out.join(sweep.shards);
    assert!(shards.iter().all(|path| path.starts_with(&place)), "{shards:?}");
    assert_eq!(sweep.merged(&scene, &out, &shards), whole, "{}", sweep.name);
}

/// A test for each sweep, so that they run side by side.
macro_rules! shards_equal_one_process {
    ($($name:ident),+) => {
        const TESTED: &[&str] = &[$(stringify!($name)),+];
        mod shards_equal_one_process {
            $(#[test]
            fn $name() {
                super::shards_equal_one_process(super::sweep(stringify!($name)));
            })+
        }
    };
}
shards_equal_one_process!(record, reproduce, tradeoff, verify);

fn sweep(name: &str) -> &'static Sweep {
    SWEEPS.iter().find(|sweep| sweep.name == name).unwrap()
}

/// Shards of another scene are no part of a work.
#[test]
fn shards_of_other_scenes_are_rejected() {
    let (directory, scene) = scene_file(SCENE);
    let of_scenes = |sweep: &&Sweep| sweep.arguments.contains(&"SCENE");
    for sweep in SWEEPS.iter().filter(of_scenes) {
        let out = directory.path().join(sweep.name);
        let mut shards = Vec::new();
        for (index, radius) in [(1, "1.0]"), (2, "1.1]")] {
            fs::write(&scene, SCENE.replace("1.0]", radius)).unwrap();
            sweep.run(&scene, &out, &["--shard", &format!("{index}/30")]);
            let name = format!("{}-{index}-of-30.units", sweep.name);
            shards.push(out.join(name));
        }
        let shards = shards.iter().map(|path| text(path));
        let message = refusal(&["merge"].into_iter().chain(shards).collect::<Vec<_>>());
        assert!(message.contains("are shards of different runs: the input scene"), "{message}");
    }
}

/// A record is made only from the shards of one plan.
#[test]
fn record_uses_only_its_shards() {
    let sweep = sweep("record");
    let (directory, scene) = scene_file(SCENE);
    let out = directory.path().join("out");
    let refused = |last: &[&str]| {
        let record = ["record", "reproduce", "--name", "box", "--merge", "--out"];
        refusal(&[&record[..], &[text(&out)], last].concat())
    };
    let none = refused(&[]);
    assert!(none.contains("there are no shards in"), "{none}");
    assert!(none.contains("sdop record reproduce --shard 1/n"), "{none}");
    sweep.run(&scene, &out, &["--shard", "2/2"]);
    let other = refused(&["--", "--quick"]);
    assert!(other.contains("its command is sdop record reproduce -- --quick --seeds 1"), "{other}");
    let missing = refused(sweep.last);
    assert!(missing.contains("1 of 2 shards are missing: 1"), "{missing}");
    assert!(!out.join("box/reproduce").exists());
    let file = out.join("box/reproduce.shards/reproduce-2-of-2.units");
    let lines = fs::read_to_string(&file).unwrap();
    let (header, rest) = lines.split_once('\n').unwrap();
    let mut header: Value = serde_json::from_str(header).unwrap();
    header["code"] = Value::from("0.0.9 0123");
    // Without its end it is no shard; what it is of is looked at first.
    let rest = rest.rsplit_once("end ").unwrap().0;
    fs::write(&file, format!("{header}\n{rest}")).unwrap();
    let other = refused(sweep.last);
    assert!(other.contains("its code is 0.0.9 0123, and this one's"), "{other}");
}

#[test]
fn an_interrupted_record_is_made_anew() {
    let sweep = sweep("record");
    let (directory, scene) = scene_file(SCENE);
    let out = directory.path().join("out");
    let part = out.join("box/reproduce.part");
    fs::create_dir_all(&part).unwrap();
    fs::write(part.join("left.csv"), "an,earlier,run\n").unwrap();
    sweep.run(&scene, &out, &[]);
    assert!(!out.join(sweep.result).join("left.csv").exists());
}

/// What has no units is not shared.
#[test]
fn work_without_units_is_rejected() {
    for (arguments, told) in [
        (&["record", "effects", "--shard", "1/2"][..], "effects is measured in one process"),
        (&["record", "cost", "--merge"], "cost/quiet is measured in one process"),
        (
            &["record", "verify", "reproduce", "--share-cores"],
            "several experiments can't be shared at once",
        ),
        (&["record", "verify", "--", "--shard", "1/2"], "--shard after the --"),
        (&["tradeoff", "earlier.json", "--shard", "1/2"], "an earlier run has no work to share"),
    ] {
        let message = refusal(arguments);
        assert!(message.contains(told), "{message}");
    }
}
