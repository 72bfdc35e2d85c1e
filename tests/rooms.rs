//! Rooms import downward only: read from the `crate::` paths of the sources. Which crate may name
//! which is in their manifests; within a crate no two rooms import each other, since all stand in
//! one order.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

/// Every room of a crate, the lowest first: each imports rooms before it, never one after it.
/// ARCHITECTURE.md draws the same order.
const LIBRARY: &[&str] = &[
    "simd",
    "rounding",
    "choice",
    "files",
    "pairs",
    "threads",
    "mesh",
    "volume",
    "settings",
    "counters",
    "bodies",
    "update",
    "broad_phase",
    "overlap",
    "strategy",
    "culler",
    "world",
    "boxes",
    "query",
    "compound",
    "c",
];
const JUDGE: &[&str] = &["contestant", "json", "record", "ours", REST, "every_way"];
const BENCH: &[&str] = &[
    "number",
    "percentiles",
    "remedy",
    "random",
    "hash",
    "mpi",
    "network",
    "sweep",
    "tightness",
    "effects",
    "scene",
    "simulate",
    "domain",
    "hull_test",
    "measure",
    "record",
    "cost",
    "verify",
    "outsiders",
    "reproduce",
    "tradeoff",
    "view",
    "report",
    "board",
    // The program.
    "commands",
    "main",
];
/// All files of a crate that have no room of their own.
const REST: &str = "(the rest)";

/// Where the crates are.
const CRATES: [(&str, &[&str]); 3] = [
    ("src", LIBRARY),
    ("reference/judge/src", JUDGE),
    ("benches/src", BENCH),
];

/// The names that a list such as `{a, b::{c, d}}` or a path such as `a::b` begins with.
fn heads(path: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let is_name = |c: &char| c.is_alphanumeric() || *c == '_';
        text.trim_start().chars().take_while(is_name).collect()
    };
    let Some(list) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                parts.push(&list[start..at]);
                break;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    let named = parts.into_iter().filter(|part| !part.trim().is_empty());
    named.map(name).collect()
}

/// The rooms that a source names by `crate::`. What a macro names by `$crate::` is another room's
/// when it is used.
fn imports(source: &str) -> Vec<String> {
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let code: Vec<&str> = source.lines().filter(is_code).collect();
    let code = code.join("\n").replace("$crate::", "");
    code.split("crate::").skip(1).flat_map(heads).collect()
}

/// What is wrong with a room's imports.
fn wrong(rooms: &[&str], room: &str, source: &str) -> Vec<String> {
    let place = |name: &str| {
        let own = rooms.iter().position(|room| *room == name);
        own.or_else(|| rooms.iter().position(|room| *room == REST))
    };
    let Some(own) = place(room) else {
        return vec![format!("{room} is not in the list of rooms")];
    };
    let mut found = Vec::new();
    for import in imports(source) {
        match place(&import) {
            Some(other) if other <= own => {}
            Some(_) => found.push(format!("{room} imports {import}, which stands above it")),
            None => found.push(format!("{room} imports {import}, which is no room")),
        }
    }
    found
}

/// The room of a source: its folder below the crate's, or its own name.
fn room(path: &Path) -> String {
    let first = path.iter().next().unwrap().to_str().unwrap();
    first.trim_end_matches(".rs").to_owned()
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_room_imports_upward() {
    let (mut found, mut read) = (Vec::new(), 0);
    for (folder, rooms) in CRATES {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let mut files = Vec::new();
        sources(&root, &mut files);
        read += files.len();
        for file in files {
            let path = file.strip_prefix(&root).unwrap();
            if path == Path::new("lib.rs") {
                continue; // it only hands names on
            }
            let source = fs::read_to_string(&file).unwrap();
            let upward = wrong(rooms, &room(path), &source).into_iter();
            found.extend(upward.map(|what| format!("{folder}/{}: {what}", path.display())));
        }
    }
    assert!(read > 300, "{read}");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// An upward import is seen however it is written.
#[test]
fn upward_imports_are_found() {
    for source in [
        "use crate::world::World;",
        "use crate::{simd::Tier, world::{Body, World}};",
        "use crate::scene::Scene;",
        "fn f() { crate::culler::Culler::builder(); }",
        "use crate::{number, scene};",
    ] {
        assert!(!wrong(LIBRARY, "bodies", source).is_empty(), "{source}");
    }
    assert!(!wrong(BENCH, "sweep", "use crate::{number, scene};").is_empty());
    assert!(wrong(BENCH, "commands", "use crate::{number, scene};").is_empty());
    assert!(!wrong(JUDGE, "ours", "use crate::case::Case;").is_empty());
    assert!(wrong(JUDGE, "case", "use crate::{ours::Shapes, claim::Claim};").is_empty());
    let below = "// see crate::world\nuse crate::volume::Shape;";
    assert!(wrong(LIBRARY, "bodies", below).is_empty());
    assert_eq!(
        wrong(LIBRARY, "update", "use crate::tools::trick;").len(),
        1
    );
    assert_eq!(
        wrong(LIBRARY, "update", "use crate::Culler;").len(),
        1,
        "the face is above all"
    );
    assert_eq!(wrong(LIBRARY, "helpers", "").len(), 1);
}
