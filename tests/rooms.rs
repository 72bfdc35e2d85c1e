//! Rooms import downward only, and no files import each other in a circle: read from the paths in
//! the sources. Which crate may name which is in their manifests; within a crate no two rooms
//! import each other, since all are in one order.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Every room of a crate, the lowest first: each imports rooms before it, never one after it.
/// ARCHITECTURE.md draws the same order.
const LIBRARY: &[&str] = &[
    "problem",
    "simd",
    "rounding",
    "choice",
    "files",
    "pairs",
    "threads",
    "settings",
    "counters",
    "bodies",
    "cull_error",
    "mesh",
    "volume",
    "update",
    "broad_phase",
    "overlap",
    "listing",
    "strategy",
    "culler",
    "living",
    "boxes",
    "posed",
    "query",
    "periodic",
    "world",
    "compound",
    "c",
    "wasm",
];
const JUDGE: &[&str] = &[
    "claim",
    "contestant",
    "json",
    "record",
    "case",
    "truth",
    "configuration",
    "draw",
    "history",
    REST,
    "verify",
];
const BENCH: &[&str] = &[
    "number",
    "percentiles",
    "remedy",
    "decimate",
    "posed_ordops",
    "random",
    "hash",
    "mpi",
    "network",
    "sweep",
    "tightness",
    "effects",
    "roster",
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
    "live",
];
/// All files of a crate that have no room of their own.
const REST: &str = "(the rest)";

/// Where the crates are.
const CRATES: [(&str, &[&str]); 3] =
    [("src", LIBRARY), ("reference/judge/src", JUDGE), ("benches/src", BENCH)];

/// A path's names.
type Names = Vec<String>;

/// The paths that a text begins with: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn paths(text: &str) -> Vec<Names> {
    let text = text.trim_start();
    let Some(list) = text.strip_prefix('{') else {
        let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        let (name, rest) = text.split_at(end.unwrap_or(text.len()));
        let longer = |path: Names| [vec![name.to_owned()], path].concat();
        return match rest.strip_prefix("::") {
            Some(rest) => paths(rest).into_iter().map(longer).collect(),
            None => vec![vec![name.to_owned()]],
        };
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
    named.flat_map(paths).collect()
}

/// A source without comments. What a macro names by `$crate::` is another room's when it is used.
fn code(source: &str) -> String {
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let code: Vec<&str> = source.lines().filter(is_code).collect();
    code.join("\n").replace("$crate::", "")
}

/// The rooms that a source names by `crate::`.
fn imports(source: &str) -> Vec<String> {
    let code = code(source);
    let named = code.split("crate::").skip(1).flat_map(paths);
    named.filter_map(|path| path.into_iter().next()).collect()
}

/// What a module names in its crate, from the crate's root on; its unit tests left out.
fn names(module: &[String], source: &str) -> Vec<Names> {
    let code = code(source);
    let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let mut found: Vec<Names> = code.split("crate::").skip(1).flat_map(paths).collect();
    for start in ["self::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let path = code[at..].trim_start_matches("super::");
            let up = (code.len() - at - path.len()) / "super::".len();
            if code[..at].ends_with("super::") || up > module.len() {
                continue;
            }
            let path = path.strip_prefix("self::").unwrap_or(path);
            let from = &module[..module.len() - up];
            found.extend(paths(path).into_iter().map(|path| [from, &path].concat()));
        }
    }
    found
}

/// The modules that import each other in a circle, or are imported by such ones. What a module
/// takes from those that it is in doesn't count.
fn circle(sources: &BTreeMap<Names, String>) -> Vec<&Names> {
    let imported = |(module, source): (&'_ Names, &String)| {
        let file = |path: Names| {
            let above = (0..=path.len()).rev().map(|length| path[..length].to_vec());
            above.into_iter().find(|path| sources.contains_key(path))
        };
        let others = names(module, source).into_iter().filter_map(file);
        let others = others.filter(|other| !module.starts_with(other));
        others.collect::<BTreeSet<Names>>()
    };
    let imports: BTreeMap<&Names, _> = sources.iter().map(|one| (one.0, imported(one))).collect();
    let mut left: Vec<&Names> = sources.keys().collect();
    loop {
        // Who imports nothing that is left is in no circle.
        let is_held = |module: &&Names| left.iter().any(|other| imports[*module].contains(*other));
        let held: Vec<&Names> = left.iter().copied().filter(is_held).collect();
        if held.len() == left.len() {
            return held;
        }
        left = held;
    }
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

/// The module of a source: its path below the crate's sources.
fn module(path: &Path) -> Names {
    let whole = path.with_extension("");
    let names = whole.iter().map(|name| name.to_str().unwrap().to_owned());
    let is_own = |name: &String| !["mod", "lib", "main"].contains(&name.as_str());
    names.filter(is_own).collect()
}

/// No files import each other in a circle.
#[test]
fn files_form_no_circle() {
    let folders = CRATES.map(|(folder, _)| folder);
    for folder in folders.into_iter().chain(["reference/src"]) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let mut files = Vec::new();
        sources(&root, &mut files);
        let module = |file: &PathBuf| module(file.strip_prefix(&root).unwrap());
        let read = |file: &PathBuf| (module(file), fs::read_to_string(file).unwrap());
        let all = files.iter().map(read);
        let all: BTreeMap<Names, String> =
            all.filter(|(module, _)| !module.contains(&"tests".to_owned())).collect();
        assert!(all.len() > 20, "{folder}: {}", all.len());
        let circle = circle(&all);
        assert!(circle.is_empty(), "{folder}: {circle:?}");
    }
}

/// A circle is found however its imports are written.
#[test]
fn circles_are_found() {
    let modules = |sources: &[(&str, &str)]| -> BTreeMap<Names, String> {
        let one = |&(path, source): &(&str, &str)| (module(Path::new(path)), source.to_owned());
        sources.iter().map(one).collect()
    };
    for sources in [
        &[("a.rs", "use super::b::B;"), ("b.rs", "use crate::a;")][..],
        &[
            ("a/c.rs", "use super::super::b;"),
            ("b.rs", "use crate::{d, a::{x, c::C}};"),
            ("d.rs", ""),
        ],
        &[
            ("a/mod.rs", "use self::c::C;"),
            ("a/c.rs", "fn f() { super::e::g(); }"),
            ("a/e.rs", "use super::c;"),
        ],
        &[
            ("a.rs", "use super::b;"),
            ("b.rs", "use super::c;"),
            ("c.rs", "fn f() { crate::a::g() }"),
        ],
    ] {
        assert!(circle(&modules(sources)).len() >= 2, "{sources:?}");
    }
    let line = [
        ("a/mod.rs", "mod c;\nuse c::C;\nuse self::e::E;"),
        (
            "a/c.rs",
            "use super::A;\nuse super::e::E;\n#[cfg(test)]\nmod tests { use super::super::b; }",
        ),
        ("a/e.rs", "// crate::a::c"),
        ("b.rs", "use crate::a::{A, c::C};"),
    ];
    assert!(circle(&modules(&line)).is_empty());
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
    assert!(!wrong(JUDGE, "truth", "use crate::draw::Contact;").is_empty());
    assert!(wrong(JUDGE, "score", "use crate::{truth::Shapes, claim::Claim};").is_empty());
    let below = "// see crate::world\nuse crate::threads::Threads;";
    assert!(wrong(LIBRARY, "bodies", below).is_empty());
    assert_eq!(wrong(LIBRARY, "update", "use crate::tools::trick;").len(), 1);
    assert_eq!(wrong(LIBRARY, "update", "use crate::Culler;").len(), 1, "the face is above all");
    assert_eq!(wrong(LIBRARY, "helpers", "").len(), 1);
}
