//! Every shipped scene builds, and its first steps keep the contract.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use sdop_bench::scene::SceneFile;

fn shipped() -> Vec<PathBuf> {
    let directory =
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes")).unwrap();
    let mut files: Vec<PathBuf> = directory.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "toml")
    });
    files.sort();
    files
}

#[test]
fn every_shipped_scene_builds_and_steps() {
    let files = shipped();
    assert!(files.len() >= 19);
    for path in files {
        let scene = SceneFile::read(&path).unwrap().build().unwrap();
        assert_eq!(
            Some(scene.name.as_str()),
            path.file_stem().and_then(|stem| stem.to_str())
        );
        let mut effects = scene.start_effects().unwrap();
        let mut bodies = scene.bodies.clone();
        for _ in 0..2 {
            effects.step(&mut bodies).unwrap();
        }
    }
}
