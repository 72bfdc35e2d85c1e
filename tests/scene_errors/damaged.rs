//! No text causes a panic.

use std::path::Path;

use proptest::prelude::*;
use sdop::volume::check_bodies;
use sdop_bench::scene::SceneFile;

use super::SOUND;

/// The sound scene with a few bytes changed, dropped or doubled, as text.
fn damaged() -> impl Strategy<Value = String> {
    let edit = (0..SOUND.len(), "[ -~\n\u{0}-\u{ff}]{0,3}", 0..4_usize);
    proptest::collection::vec(edit, 1..4).prop_map(|edits| {
        let mut text: Vec<char> = SOUND.chars().collect();
        for (at, insert, drop) in edits {
            let at = at.min(text.len());
            let end = (at + drop).min(text.len());
            text.splice(at..end, insert.chars());
        }
        text.into_iter().collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_text_panics(text in damaged()) {
        match SceneFile::parse(&text, "a.toml", Path::new("data/scenes")) {
            Err(error) => prop_assert!(error.to_string().starts_with("a.toml:"), "{error}"),
            // A digit more can ask for a million bodies: build small scenes alone.
            Ok(file) if text.contains("count = 3\n") => {
                if let Ok(scene) = file.build() {
                    prop_assert!(check_bodies(&scene.bodies, &scene.shapes).is_ok());
                }
            }
            Ok(_) => {}
        }
    }
}
