//! The guide names every key that a scene may have, and no other; another page, every column.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::Path;

use sdop::mesh::ProceduralShape;
use sdop::mesh::shapes::ShapeError;
use sdop_bench::scene::SceneFile;

/// The keys in the first column of the table under a heading.
fn described(heading: &str) -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("paper/guide.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let (_, section) = guide.split_once(&format!("### {heading}\n")).unwrap();
    let section = section.split("\n#").next().unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    rows.map(|row| row.split('`').next().unwrap().to_owned()).collect()
}

/// The keys that the error for a wrong key lists.
fn accepted(scene: &str) -> BTreeSet<String> {
    let error = SceneFile::parse(scene, "scene.toml", Path::new("."));
    let said = error.unwrap_err().to_string();
    let (_, list) = said.split_once(", expected ").unwrap();
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

const WRONG: &str = "zzzzzzzzzzzz = 1\n";

/// The guide has every key of a scene.
#[test]
fn guide_lists_every_scene_key() {
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

/// The guide has every size of every procedural shape.
#[test]
fn guide_lists_shape_sizes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("paper/guide.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let (_, section) = guide.split_once("**Sizes of shapes.** ").unwrap();
    let (section, _) = section.split_once("\n\n").unwrap();
    let sentences = section.replace('\n', " ");
    for shape in ProceduralShape::NAMES {
        let error = ProceduralShape::from_name(shape, &[("zzzzzzzzzzzz", 1.0)]).unwrap_err();
        let ShapeError::UnknownSize { known, .. } = error else {
            panic!("{shape}: {error}");
        };
        let listed = sentences
            .split(". ")
            .find_map(|sentence| {
                let (shapes, sizes) = sentence.split_once(": ")?;
                shapes.contains(&format!("`{shape}`")).then_some(sizes)
            })
            .unwrap();
        let listed: Vec<&str> = listed.split('`').skip(1).step_by(2).collect();
        assert_eq!(listed, known, "{shape}");
    }
}

/// A scene is shown whole before its keys are listed, and it is one.
#[test]
fn guide_scene_builds() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("paper/guide.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let (_, section) = guide.split_once("## Scene files\n").unwrap();
    let (before, _) = section.split_once("| key |").unwrap();
    let (_, scene) = before.split_once("```toml\n").unwrap();
    let (scene, _) = scene.split_once("```").unwrap();
    let file = SceneFile::parse(scene, "boxes.toml", Path::new(".")).unwrap();
    assert_eq!(file.build().unwrap().bodies.len(), 201);
}

/// The columns that the page explains for a file of a measurement record.
fn explained(page: &str, file: &str) -> BTreeSet<String> {
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let named = |row: &&str| {
        let first = row.split('|').next().unwrap();
        format!("`{first}").contains(&format!("`{file}`"))
    };
    let texts = rows.filter(named).filter_map(|row| row.split_once('|'));
    let cells = texts.flat_map(|(_, text)| text.split('`').skip(1).step_by(2));
    cells.map(str::to_owned).collect()
}

/// Every table below a directory.
fn tables(directory: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            tables(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "csv") {
            found.push(path);
        }
    }
}

/// A page explains every column of every recorded table.
#[test]
fn every_column_is_explained() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("paper/columns.md")).unwrap();
    let mut found = Vec::new();
    tables(&root.join("data/record"), &mut found);
    assert!(found.len() > 10);
    for path in found {
        let file = path.file_name().unwrap().to_str().unwrap();
        let explained = explained(&page, file);
        let table = std::fs::read_to_string(&path).unwrap();
        for column in table.lines().next().unwrap().split(',') {
            let first = column.split('.').next().unwrap();
            let stem = first.trim_end_matches("_low").trim_end_matches("_high");
            let known = [column, first, stem].iter().any(|name| explained.contains(*name));
            assert!(known, "{}: paper/columns.md doesn't explain {column}", path.display());
        }
    }
}
