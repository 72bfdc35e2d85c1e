//! Errors in scene files name file, line, column and a way to mend them; nothing panics.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod contract;
mod damaged;
mod scenes;
mod values;

use std::path::Path;

use miette::Diagnostic;
use sdop_bench::scene::{Scene, SceneError, SceneFile};

fn build(text: &str) -> Result<Scene, SceneError> {
    SceneFile::parse(text, "a.toml", Path::new("data/scenes"))?.build()
}

/// The error of a scene as "message | hint".
fn refusal(text: &str) -> String {
    let error = build(text).expect_err(text);
    let hint = error.help().map(|hint| format!(" | {hint}")).unwrap_or_default();
    format!("{error}{hint}")
}

const SOUND: &str = r#"name = "s"
frames = 2
[box]
side = 20
[[bodies]]
shape = "box"
count = 3
radius = 1
speed = [0.5, 2]
[effects]
motion = true
walls = "specular"
[cull]
strategy = "sphere"
"#;

/// The sound scene with one piece of text replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(SOUND.contains(from), "{from}");
    refusal(&SOUND.replacen(from, to, 1))
}

/// A scene of two boxes, the second one as posed.
fn posed(pose: &str) -> String {
    format!(
        "name = \"p\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0, 0, 0],\n {pose}]\n"
    )
}

#[test]
fn the_sound_scene_builds() {
    let scene = build(SOUND).unwrap();
    assert_eq!((scene.bodies.len(), scene.shapes.len(), scene.side), (3, 1, Some(20.0)));
}

#[test]
fn an_unreadable_file_is_named() {
    let error = SceneFile::read(Path::new("data/scenes/no-such-scene.toml")).unwrap_err();
    assert!(error.to_string().starts_with("data/scenes/no-such-scene.toml: "), "{error}");
}
