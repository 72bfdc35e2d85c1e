//! The guide names every key that a scene may have, and no other.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::Path;

use sdop::lab::scene::SceneFile;

/// The keys in the first column of the table under a heading.
fn described(heading: &str) -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("paper/guide.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let (_, section) = guide.split_once(&format!("### {heading}\n")).unwrap();
    let section = section.split("\n#").next().unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    rows.map(|row| row.split('`').next().unwrap().to_owned())
        .collect()
}

/// The keys that a scene with one wrong key is told to use instead.
fn accepted(scene: &str) -> BTreeSet<String> {
    let error = SceneFile::parse(scene, "scene.toml", Path::new("."));
    let said = error.unwrap_err().to_string();
    let (_, list) = said.split_once(", expected ").unwrap();
    list.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

const WRONG: &str = "zzzzzzzzzzzz = 1\n";

#[test]
fn the_guide_has_every_key_of_a_scene() {
    let head = "name = \"a\"\nframes = 1\n";
    let bodies = "[[bodies]]\nshape = \"box\"\ncount = 1\n";
    for (heading, scene) in [
        ("Top level", format!("{WRONG}{head}{bodies}")),
        ("`[box]`", format!("{head}[box]\n{WRONG}{bodies}")),
        ("`[[bodies]]`", format!("{head}{bodies}{WRONG}")),
        ("`[effects]`", format!("{head}{bodies}[effects]\n{WRONG}")),
        ("`[cull]`", format!("{head}{bodies}[cull]\n{WRONG}")),
    ] {
        assert_eq!(described(heading), accepted(&scene), "{heading}");
    }
}
