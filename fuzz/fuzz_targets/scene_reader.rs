//! No text makes the scene reader panic, and the scenes that it builds keep the bodies' contract.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use sdop::volume::check_bodies;
use sdop_bench::scene::SceneFile;

fuzz_target!(|text: &str| {
    let Ok(file) = SceneFile::parse(text, "fuzz.toml", Path::new("/nonexistent")) else {
        return;
    };
    // A big scene is no bug; it would only be slow.
    let bodies: u64 = file
        .spec
        .bodies
        .iter()
        .filter_map(|group| group.get_ref().count.as_ref())
        .map(|count| u64::from(count.get_ref().get()))
        .sum();
    if bodies > 1000 {
        return;
    }
    if let Ok(scene) = file.build() {
        assert!(check_bodies(&scene.bodies, &scene.shapes).is_ok());
    }
});
