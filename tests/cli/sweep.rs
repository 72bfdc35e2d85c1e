//! Sharing work: merged shards give the result of one process.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use super::{refusal, sdop, text};

const SCENE: &str = r#"
name = "small"
frames = 9
[box]
side = 5.0
[[bodies]]
shape = "l-shape"
count = 12
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[effects]
motion = true
walls = "specular"
"#;

/// Units of a moment each: two groups of hard cases, two blocks of a scene's frames.
const VERIFY: [&str; 12] = [
    "verify",
    "--group",
    "coincident",
    "--group",
    "counts",
    "--frames",
    "7",
    "--simd",
    "scalar",
    "--format",
    "json",
    "--out",
];
/// With the units of a seed there are some of every kind, which take longer.
const ONE_SEED: [&str; 2] = ["--seeds", "1"];
const NO_SEED: [&str; 2] = ["--seeds", "0"];

struct Place {
    directory: tempfile::TempDir,
    scene: PathBuf,
}

impl Place {
    fn new() -> Self {
        let directory = tempfile::tempdir().unwrap();
        let scene = directory.path().join("small.toml");
        fs::write(&scene, SCENE).unwrap();
        Self { directory, scene }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn verify(&self, more: &[&str]) -> Output {
        let out = [text(self.directory.path()), text(&self.scene)];
        sdop(&[&VERIFY[..], &out, more].concat())
    }

    /// The file that a shard leaves.
    fn shard(&self, index: usize, of: usize, more: &[&str]) -> PathBuf {
        let output = self.verify(&[&["--shard", &format!("{index}/{of}")], more].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        self.path(&format!("verify-{index}-of-{of}.units"))
    }
}

/// The report without measured times.
fn report(output: &Output) -> Value {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let mut report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_ne!(report["seconds"].take(), Value::Null);
    assert_eq!(report["missed"], 0);
    report
}

fn merge(place: &Place, shards: &[&Path]) -> Output {
    let shards: Vec<&str> = shards.iter().map(|path| text(path)).collect();
    let out = ["-o", text(place.directory.path()), "--format", "json"];
    sdop(&[&["merge"], &shards[..], &out].concat())
}

fn merge_refused(shards: &[&Path]) -> String {
    let shards: Vec<&str> = shards.iter().map(|path| text(path)).collect();
    refusal(&[&["merge"], &shards[..]].concat())
}

fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().map(|line| format!("{line}\n")).collect()
}

#[test]
fn shards_merged_are_the_whole() {
    let place = Place::new();
    let whole = report(&place.verify(&ONE_SEED));
    assert_eq!(whole["sources"].as_array().unwrap().len(), 4);
    let shards = [1, 2, 3].map(|index| place.shard(index, 3, &ONE_SEED));
    let [one, two, three] = shards.each_ref().map(PathBuf::as_path);
    assert_eq!(report(&merge(&place, &[two, three, one])), whole);

    // One process, and two who share: no part of the work is in both or in none.
    let alone = place.shard(1, 1, &ONE_SEED);
    assert_eq!(report(&merge(&place, &[&alone])), whole);

    for (shards, told) in [
        (&[three, one][..], "1 of 3 shards are missing: 2"),
        (&[one], "2 of 3 shards are missing: 2, 3"),
        (&[one, two, two, three], "are both shard 2/3"),
        (&[one, two, alone.as_path()], "there are 3 shards here and 1 there"),
    ] {
        let message = merge_refused(shards);
        assert!(message.contains(told), "{message}");
    }
}

/// A pass is about all that was asked for.
#[test]
fn a_run_cut_short_is_incomplete() {
    let place = Place::new();
    let whole = report(&place.verify(&ONE_SEED));
    assert_eq!(whole["conclusion"], "pass");
    assert_eq!(whole["judged"], whole["asked"]);
    assert_eq!(whole["why"], Value::Null);

    let output = place.verify(&[&ONE_SEED[..], &["--time", "0"]].concat());
    assert_eq!(output.status.code(), Some(3));
    let short: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(short["conclusion"], "incomplete");
    assert_eq!(short["asked"], whole["asked"]);
    let [asked, judged] = ["asked", "judged"].map(|key| short[key].as_u64().unwrap());
    assert!(0 < judged && judged < asked, "{judged} of {asked}");
    let left = asked - judged;
    let why = format!("{judged} of {asked} units were judged: --time left no room for {left}");
    assert_eq!(short["why"], why);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.ends_with(&format!("sdop: {why}\n")), "{said}");
    let table = sdop(&[&VERIFY[..9], &ONE_SEED, &["--time", "0"]].concat());
    assert_eq!(table.status.code(), Some(3));
    let said = String::from_utf8_lossy(&table.stdout);
    assert!(said.contains("INCOMPLETE: "), "{said}");
}

/// Shards of different work are not merged.
#[test]
fn different_work_is_not_merged() {
    let place = Place::new();
    let one = place.shard(1, 2, &NO_SEED);
    let told = |other: &Path, told: &str| {
        let message = merge_refused(&[&one, other]);
        assert!(message.contains("are shards of different runs"), "{message}");
        assert!(message.contains(told), "{message}");
    };
    let other = place.shard(2, 2, &[&NO_SEED[..], &["--first-seed", "7"]].concat());
    told(&other, "the setting `first_seed` is 1 here and 7 there");
    fs::write(&place.scene, SCENE.replace("1.0", "1.1")).unwrap();
    let other = place.shard(2, 2, &NO_SEED);
    told(&other, "the input scene 1 (small, 12 bodies, 7 frames) is");

    // Another program's: as this one would write it.
    fs::write(&place.scene, SCENE).unwrap();
    let other = place.shard(2, 2, &NO_SEED);
    let mut header: Value = serde_json::from_str(&lines(&other)[0]).unwrap();
    header["code"] = Value::from("0.0.9 0123456789abcdef");
    let rest = lines(&other)[1..].concat();
    fs::write(&other, format!("{header}\n{rest}")).unwrap();
    let message = merge_refused(&[&one, &other]);
    assert!(message.contains("the digest at its end does not match its lines"), "{message}");
    reseal(&other);
    told(&other, "and 0.0.9 0123456789abcdef there");
}

/// Gives a changed file the digest that its lines have now.
fn reseal(path: &Path) {
    let mut lines = lines(path);
    let end = lines.pop().unwrap();
    let body = lines.concat();
    let seconds = end.split(' ').nth(1).unwrap();
    let digest = sha256(body.as_bytes());
    fs::write(path, format!("{body}end {seconds} {digest}\n")).unwrap();
}

fn sha256(bytes: &[u8]) -> String {
    use sha2::Digest as _;
    let digest = sha2::Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A shard without a unit is refused.
#[test]
fn empty_shard_is_rejected() {
    let place = Place::new();
    let one = place.shard(1, 1, &NO_SEED);
    let mut lines = lines(&one);
    let cut_off = place.path("cut.units");
    fs::write(&cut_off, lines[..9].concat() + &lines[9][..20]).unwrap();
    let message = merge_refused(&[&cut_off]);
    assert!(message.contains("is not a finished shard"), "{message}");
    let lost = lines.remove(5);
    fs::write(&one, lines.concat()).unwrap();
    reseal(&one);
    let message = merge_refused(&[&one]);
    assert!(lost.starts_with("done 4 "), "{lost}");
    assert!(
        message.contains("does not hold the units of shard 1/1: unit 4 is the first"),
        "{message}"
    );
}
