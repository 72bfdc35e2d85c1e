//! Errors in scene files name file, line, column and a way to mend them; nothing panics.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod contract;
mod damaged;

use std::path::Path;

use miette::Diagnostic;
use sdop_bench::scene::{Scene, SceneError, SceneFile};

use crate::answers;
use crate::changed::changed;

const HERE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scene_errors");
const SOUND: &str = include_str!("sound.toml");

fn build(text: &str) -> Result<Scene, SceneError> {
    SceneFile::parse(text, "a.toml", Path::new(HERE))?.build()
}

/// The error of a scene with its remedy, or what the scene has.
fn answer(text: &str) -> String {
    match build(text) {
        Ok(scene) => format!("{} bodies, side {:?}", scene.bodies.len(), scene.side),
        Err(error) => {
            let help = error.help().map(|help| format!("\nhelp: {help}"));
            format!("{error}{}", help.unwrap_or_default()).replace(HERE, ".")
        }
    }
}

#[test]
fn scenes_are_rejected_with_a_remedy() {
    assert_eq!(answer(SOUND), "3 bodies, side Some(20.0)");
    let mut scene = SOUND.to_owned();
    answers::check(&Path::new(HERE).join("errors.txt"), |input| {
        if let Some(changed) = changed(input, &scene) {
            return answer(&changed);
        }
        scene = format!("{input}\n");
        answer(&scene)
    });
}

#[test]
fn an_unreadable_file_is_named() {
    let error = SceneFile::read(Path::new("data/scenes/no-such-scene.toml")).unwrap_err();
    assert!(error.to_string().starts_with("data/scenes/no-such-scene.toml: "), "{error}");
}

#[test]
fn text_of_no_kind_is_located() {
    assert!(answer("").starts_with("a.toml:1:1: missing field"));
    assert!(answer("\u{feff}\0ö = [").starts_with("a.toml:1:"));
}

/// Floats read as the nearest f32 of their text.
#[test]
fn floats_round_once() {
    // Just above the midpoint of 1 and the next f32: as f64 it is the midpoint itself, and ties to
    // even give 1.
    let text = "1.00000005960464477539062500000000000000001";
    assert_eq!(text.parse::<f64>().unwrap() as f32, 1.0);
    let scene = format!(
        "name = \"p\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, {text}, 16777217, 0.1, 0, 0]]\n"
    );
    let scene = build(&scene).unwrap();
    assert_eq!(scene.bodies.rotation[0], [0.0, 0.0, 1.0_f32.next_up(), 16_777_216.0]);
    assert_eq!(scene.bodies.translation[0][0], 0.1);
}
