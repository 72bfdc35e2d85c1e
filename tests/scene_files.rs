//! Every shipped scene builds, and its first steps keep the contract.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use sdop_bench::scene::SceneFile;

fn shipped() -> Vec<PathBuf> {
    let directory =
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes")).unwrap();
    let mut files: Vec<PathBuf> = directory.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

#[test]
fn every_shipped_scene_builds_and_steps() {
    let files = shipped();
    assert!(files.len() >= 21);
    for path in files {
        let scene = SceneFile::read(&path).unwrap().build().unwrap();
        assert_eq!(Some(scene.name.as_str()), path.file_stem().and_then(|stem| stem.to_str()));
        let mut effects = scene.start_effects().unwrap();
        let mut bodies = scene.bodies.clone();
        for _ in 0..2 {
            effects.step(&mut bodies).unwrap();
        }
    }
}

/// Millimetres, mirrored: the ball is a thousandth, and a group without a scale keeps the size.
#[test]
fn groups_scale_their_meshes() {
    let text = "name = \"a\"\nframes = 1\n\
                [[bodies]]\nshape = \"l-shape\"\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n\
                [[bodies]]\nshape = \"l-shape\"\nscale = 0.5\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n\
                [[bodies]]\nshape = \"l-shape\"\nscale = [-0.5, 0.5, 0.5]\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n";
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let scene = SceneFile::read(&path).unwrap().build().unwrap();
    let [whole, half, mirrored] = &scene.shapes[..] else {
        panic!("{} shapes", scene.shapes.len())
    };
    assert_eq!(half.vertices[1], whole.vertices[1].map(|x| x * 0.5));
    assert_eq!(mirrored.vertices[1][0], -half.vertices[1][0]);
    assert_eq!(mirrored.vertices[1][1], half.vertices[1][1]);
    let [a, b, c] = half.triangles[0];
    assert_eq!(mirrored.triangles[0], [a, c, b]);
}
