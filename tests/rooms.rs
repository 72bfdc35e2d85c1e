//! Rooms import downward only: read from the `crate::` paths of the sources. A library room knows nothing of the laboratory
//! or the command line, and no two rooms import each other, since all stand in one order.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

/// Every room, the lowest first: each imports rooms before it, never one behind. ARCHITECTURE.md draws the same order.
const ROOMS: &[&str] = &[
    // The library.
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
    // The laboratory.
    "lab/number",
    "lab/percentiles",
    "lab/random",
    "lab/hash",
    "lab/mpi",
    "lab/sweep",
    "lab/tightness",
    "lab/effects",
    "lab/scene",
    "lab/simulate",
    "lab/domain",
    "lab/hull_test",
    "lab/measure",
    "lab/record",
    "lab/cost",
    "lab/verify",
    "lab/judge",
    "lab/reproduce",
    "lab/tradeoff",
    "lab/view",
    "lab/report",
    // The command line.
    "cli",
    "main",
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

/// The rooms that a source names by `crate::`. What a macro names by `$crate::` is another room's when it is used.
fn imports(source: &str) -> Vec<String> {
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let code: Vec<&str> = source.lines().filter(is_code).collect();
    let code = code.join("\n").replace("$crate::", "");
    let mut rooms = Vec::new();
    for path in code.split("crate::").skip(1) {
        match path.strip_prefix("lab::") {
            Some(inner) => rooms.extend(heads(inner).iter().map(|name| format!("lab/{name}"))),
            None => rooms.extend(heads(path)),
        }
    }
    rooms
}

/// What is wrong with a room's imports.
fn wrong(room: &str, source: &str) -> Vec<String> {
    let place = |name: &str| ROOMS.iter().position(|room| *room == name);
    let Some(own) = place(room) else {
        return vec![format!("{room} is not in the list of rooms")];
    };
    let mut found = Vec::new();
    for import in imports(source).iter().filter(|import| *import != room) {
        match place(import) {
            Some(other) if other < own => {}
            Some(_) => found.push(format!("{room} imports {import}, which stands above it")),
            None => found.push(format!("{room} imports {import}, which is no room")),
        }
    }
    found
}

/// The room of a source: its folder below `src` or `src/lab`, or its own name.
fn room(path: &Path) -> String {
    let parts: Vec<&str> = path.iter().map(|part| part.to_str().unwrap()).collect();
    let name = |at: usize| parts[at].trim_end_matches(".rs");
    if parts[0] == "lab" {
        format!("lab/{}", name(1))
    } else {
        name(0).to_owned()
    }
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    assert!(files.len() > 100, "{}", files.len());
    let faces = ["lib.rs", "lab/mod.rs"]; // they only hand names on
    let mut found = Vec::new();
    for file in files {
        let path = file.strip_prefix(&root).unwrap();
        if !faces.contains(&path.to_str().unwrap()) {
            let source = fs::read_to_string(&file).unwrap();
            let told = wrong(&room(path), &source).into_iter();
            found.extend(told.map(|what| format!("{}: {what}", path.display())));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn an_upward_import_is_seen_however_it_is_written() {
    for source in [
        "use crate::world::World;",
        "use crate::{simd::Tier, world::{Body, World}};",
        "use crate::lab::scene::Scene;",
        "fn f() { crate::culler::Culler::builder(); }",
        "use crate::lab::{number, scene};",
    ] {
        assert!(!wrong("bodies", source).is_empty(), "{source}");
        assert!(wrong("cli", source).is_empty(), "{source}");
    }
    assert!(wrong("bodies", "// see crate::world\nuse crate::volume::Shape;").is_empty());
    assert_eq!(wrong("update", "use crate::tools::trick;").len(), 1);
    assert_eq!(
        wrong("update", "use crate::Culler;").len(),
        1,
        "the face is above all"
    );
    assert_eq!(wrong("helpers", "").len(), 1);
}
