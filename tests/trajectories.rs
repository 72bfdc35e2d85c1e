//! Golden trajectories: rotations and translations of every frame, hashed, are equal on every CPU
//! and build.
//!
//! Run this test's binary under emulated CPUs to see it: `qemu-x86_64 -cpu Nehalem
//! target/debug/deps/trajectories-…`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop_bench::scene::{Scene, SceneFile};
use sha2::{Digest, Sha256};

/// SHA-256 over q and t of all bodies, little endian, for the initial state and each of `steps`
/// steps.
fn trajectory(scene: &Scene, steps: usize) -> String {
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    let mut hash = Sha256::new();
    for step in 0..=steps {
        if step > 0 {
            effects.step(&mut bodies).unwrap();
        }
        for (q, t) in bodies.rotation.iter().zip(&bodies.translation) {
            for x in q.iter().chain(t) {
                hash.update(x.to_le_bytes());
            }
        }
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn shipped(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes").join(name);
    SceneFile::read(&path).and_then(|file| file.build()).unwrap()
}

#[test]
fn shipped_scenes_move_as_recorded() {
    let golden = [
        ("paper-150.toml", 600, "454db76da8ca17a87b644ccff5e2a2a2477d238aed429695b598aef7fc7b5f88"),
        (
            "mixed-radii-10k.toml",
            10,
            "e12f38b2af3e00e526acdbbe7f4fd7e9a3ec7083816d36f4de99805d66185e97",
        ),
        (
            "clusters-10k.toml",
            5,
            "e9db574301c1f2319f050260c02ccf5ec0bf6325cdbde70789434344c7fdf0ca",
        ),
        ("plane-10k.toml", 5, "6663b650c1021d4a638e3cbc6d8f6398a4487e698c7cd5bf880ce3bcce4fbb38"),
        (
            "brownian-1k.toml",
            100,
            "6a8dfe07759f603ea2cf063ad370b81ad7fa07cb5f788852630835f8b08c1043",
        ),
        (
            "free-fall-1k.toml",
            100,
            "75c408d7abda3c08269833ebac0595a175915bb2079c28088f521d8728f964ff",
        ),
        (
            "rotating-gravity-1k.toml",
            100,
            "0fe4718d762e27401017829b759822bde95a6361b84ddf263f2f184e3ec63018",
        ),
        ("sleep-10k.toml", 20, "7925fff5bfeddd1c78ee4b5aab5a372faa4fded82f892429453db89e74be387c"),
        (
            "scenery-10k.toml",
            20,
            "d1040222af277e30e314b30390ee267bd931cad8a9c78c1b1b9972f442505d5a",
        ),
    ];
    let found = golden.map(|(name, steps, _)| (name, steps, trajectory(&shipped(name), steps)));
    assert_eq!(found.each_ref().map(|(name, steps, hash)| (*name, *steps, hash.as_str())), golden);
}

#[test]
fn every_effect_together_moves_as_recorded() {
    let text = r#"
name = "all"
frames = 300
[box]
partners = 0.8
[[bodies]]
shape = "torus"
count = 60
radius = [0.3, 3]
speed = [0, 5]
[[bodies]]
mesh = "../meshes/spot.tri"
origin = "file"
count = 20
speed = 2
[[bodies]]
shape = "gear"
count = 20
static = true
[effects]
motion = true
walls = "reverse"
spin = { rate = [0.1, 20] }
gravity = { acceleration = [1, -3, 9.81], period = 0.7, axis = [1, 2, 3] }
brownian = { share = 0.05, speed = [1, 8] }
response = "elastic"
"#;
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let scene =
        SceneFile::parse(text, "all.toml", &directory).and_then(|file| file.build()).unwrap();
    assert_eq!(
        trajectory(&scene, 300),
        "f6df11fd47e2d893b796a8c78b764c3a3332007bba5b94ecc08fdabf897e4c34"
    );
}
