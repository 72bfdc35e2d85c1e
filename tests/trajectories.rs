//! Golden trajectories: rotations and translations of every frame, hashed, are equal on every CPU and build.
//!
//! Run this test's binary under emulated CPUs to see it: `qemu-x86_64 -cpu Nehalem target/debug/deps/trajectories-…`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop::effects::Effects;
use sdop::scene::{Scene, SceneFile};
use sha2::{Digest, Sha256};

/// SHA-256 over q and t of all bodies, little endian, for the initial state and each of `steps` steps.
fn trajectory(scene: &Scene, steps: usize) -> String {
    let mut bodies = scene.bodies.clone();
    let mut effects = Effects::new(scene).unwrap();
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
    hash.finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn shipped(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/scenes")
        .join(name);
    SceneFile::read(&path)
        .and_then(|file| file.build())
        .unwrap()
}

#[test]
fn shipped_scenes_move_as_recorded() {
    let golden = [
        (
            "paper-150.toml",
            600,
            "454db76da8ca17a87b644ccff5e2a2a2477d238aed429695b598aef7fc7b5f88",
        ),
        (
            "mixed-radii-10k.toml",
            10,
            "e12f38b2af3e00e526acdbbe7f4fd7e9a3ec7083816d36f4de99805d66185e97",
        ),
        (
            "clusters-10k.toml",
            5,
            "65e8c38d54e11446f1deafd14a9cf200ac83d4b61bff9eac01dc67855ccb908b",
        ),
        (
            "plane-10k.toml",
            5,
            "6663b650c1021d4a638e3cbc6d8f6398a4487e698c7cd5bf880ce3bcce4fbb38",
        ),
        (
            "brownian-1k.toml",
            100,
            "81133f062d66be151a7ce53f18be13099bcd8e983f412548ca4dab57f2340b11",
        ),
        (
            "free-fall-1k.toml",
            100,
            "5debf03ba271b7aff873e4cb8e600e3ce4f8410401b0c2415560e1351b656ada",
        ),
        (
            "rotating-gravity-1k.toml",
            100,
            "8679169d0e9e881e2c6eae5af3c8dd2343c875992d6c44e286275f6364bd6cb3",
        ),
    ];
    let found = golden.map(|(name, steps, _)| (name, steps, trajectory(&shipped(name), steps)));
    assert_eq!(
        found
            .each_ref()
            .map(|(name, steps, hash)| (*name, *steps, hash.as_str())),
        golden
    );
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
    let scene = SceneFile::parse(text, "all.toml", &directory)
        .and_then(|file| file.build())
        .unwrap();
    assert_eq!(
        trajectory(&scene, 300),
        "f6df11fd47e2d893b796a8c78b764c3a3332007bba5b94ecc08fdabf897e4c34"
    );
}
