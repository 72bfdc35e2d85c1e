//! Scenes far from the origin: translations of `poses` are f64, and pairs are those of their exact
//! values.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;

use miette::Diagnostic;
use sdop::settings::{Interest, Strategy, ViewCone};
use sdop::simd::Tier;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::simulate::{Simulation, SimulationError, Summary, run};
use sdop_bench::tradeoff::truth::ExactJudge;
use sdop_judge::record::{FrameLine, Reader, Recorder};
use sdop_judge::report::pose_in_text;
use tempfile::TempDir;

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A scene of tetrahedra with corners at these places along x, at 0.25 along y.
fn scene_file(places: &[&str], more: &str) -> (TempDir, SceneFile) {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("t.obj"), TETRAHEDRON).unwrap();
    let mut text = "name = \"far\"\nframes = 2\ndt = 0.5\n".to_owned();
    for (body, x) in places.iter().enumerate() {
        let _ = write!(
            text,
            "[[bodies]] # {body}\nmesh = \"t.obj\"\nposes = [[0, 0, 0, 1, {x}, 0.25, 0]]\n"
        );
    }
    text.push_str(more);
    let file = SceneFile::parse(&text, "far.toml", directory.path()).unwrap();
    (directory, file)
}

fn tetrahedra(places: &[&str], more: &str) -> Scene {
    scene_file(places, more).1.build_exact().unwrap()
}

fn summary(scene: &Scene) -> Summary {
    run::<SimulationError>(scene, Tier::detect(), |_| Ok(())).unwrap()
}

/// The first frame's pairs.
fn pairs(scene: &Scene) -> Vec<[u32; 2]> {
    let mut simulation = Simulation::new(scene, Tier::detect()).unwrap();
    let frame = simulation.next_frame().unwrap().unwrap();
    frame.pairs.sorted()
}

/// They overlap by 0.3, and the third is 0.1 apart from the second.
const FAR: [&str; 3] = ["1000000031.5", "1000000032.2", "1000000033.3"];

#[test]
fn far_overlaps_are_reported() {
    for strategy in [
        Strategy::Sphere,
        Strategy::Aabb,
        Strategy::KDop,
        Strategy::Obb,
        Strategy::OrDop,
        Strategy::SDopSequential,
        Strategy::SDopBatch,
    ] {
        for still in ["", "static = true\n"] {
            let mut scene = tetrahedra(&FAR, still);
            assert!(!scene.fine.is_empty());
            scene.cull.strategy = strategy;
            let found = pairs(&scene);
            assert!(found.contains(&[0, 1]), "{strategy}");
            if strategy != Strategy::Sphere {
                assert_eq!(found, [[0, 1]], "{strategy}");
            }
            let Summary { counters, .. } = summary(&scene);
            assert_eq!(counters.reported, 2 * found.len() as u64, "{strategy}");
        }
    }
}

#[test]
fn bodies_of_interest_keep_their_numbers() {
    let mut far = tetrahedra(&FAR, "");
    let mut near = tetrahedra(&["31.5", "32.25", "33.375"], "");
    for body in 0..3 {
        for scene in [&mut far, &mut near] {
            scene.cull.strategy = Strategy::SDopObjectOfInterest;
            scene.cull.interest = Some(Interest::Bodies(vec![body]));
        }
        assert_eq!(pairs(&far), pairs(&near), "body {body}");
    }
}

/// Looking along x, the first body sees the centre of the second, 1.135 away, and not its own.
/// Rounded to f32, the two would be 64 apart. Pairs with a body of interest are refined.
#[test]
fn cones_see_exact_places() {
    let near = ["31.5", "32.2", "33.3"];
    for (range, expected) in [(1.0, &[[0, 1], [1, 2]][..]), (1.2, &[[0, 1]])] {
        for places in [FAR, near] {
            let mut scene = tetrahedra(&places, "");
            scene.cull.strategy = Strategy::SDopObjectOfInterest;
            scene.cull.interest = Some(Interest::Cone(ViewCone {
                body: Some(0),
                apex: None,
                direction: [1.0, 0.0, 0.0],
                half_angle: 30.0,
                range: Some(range),
            }));
            assert_eq!(pairs(&scene), expected, "{places:?} to {range}");
        }
    }
}

/// The exact reference decides at the f64 places: rounded to f32, the last two would meet instead.
#[test]
fn truth_is_of_exact_places() {
    let scene = tetrahedra(&FAR, "");
    let judge = ExactJudge::new(&scene.shapes).unwrap();
    let translations = scene.fine.of(&scene.bodies);
    let meets =
        |translations: Option<&[[f64; 3]]>| judge.meetings(&scene.bodies, translations).unwrap();
    assert_eq!(meets(translations.as_deref()), [[0, 1]]);
    assert_eq!(meets(None), [[1, 2]]);
    // The nearest translations at which they touch, and at which they don't.
    for (x, pairs) in [(1_000_000_032.5, &[[0, 1]][..]), (1_000_000_032.5_f64.next_up(), &[])] {
        let mut places = translations.clone().unwrap();
        (places[1][0], places[2][0]) = (x, 0.0);
        assert_eq!(meets(Some(&places)), pairs, "{x}");
    }
}

#[test]
fn exact_translations_take_the_same_path() {
    let near = ["0.5", "1.25", "1000000000"];
    let (_directory, file) = scene_file(&near, "");
    let [exact, rounded] = [file.build_exact().unwrap(), file.build().unwrap()];
    assert!(exact.fine.is_empty());
    assert_eq!(exact.bodies, rounded.bodies);
    let (exact, rounded) = (summary(&exact), summary(&rounded));
    assert_eq!(exact.counters, rounded.counters);
    assert_eq!(exact.pairs_sha256, rounded.pairs_sha256);
    // 16777217 is halfway between two f32.
    assert!(!tetrahedra(&["16777217"], "").fine.is_empty());
}

#[test]
fn studies_in_f32_refuse_coarse_rounding() {
    let (_directory, file) = scene_file(&FAR, "");
    let error = file.build().unwrap_err();
    assert!(
        error.to_string().starts_with("far.toml:6:10: body 0: rounding its translation"),
        "{error}"
    );
    let help = error.help().unwrap().to_string();
    assert!(help.contains("`sdop run`"), "{help}");
    let (_directory, file) = scene_file(&["0.1", "1000.7"], "");
    let scene = file.build().unwrap();
    assert!(scene.fine.is_empty());
    assert_eq!(scene.bodies.translation[1][0], 1000.7);
    assert!(!file.build_exact().unwrap().fine.is_empty());
}

#[test]
fn translations_beyond_the_limit_are_refused() {
    // 2^60 + 256, which f32 rounds to 2^60.
    let (_directory, file) = scene_file(&["0", "1152921504606847232"], "");
    let error = file.build_exact().unwrap_err().to_string();
    assert!(error.starts_with("far.toml:9:10: body 1: translation"), "{error}");
}

/// The second body moves by a half per frame, which f32 doesn't notice there, and the third by 64,
/// which it does.
#[test]
fn moved_bodies_are_where_f32_says() {
    let more = "velocities = [[128, 0, 0]]\n[effects]\nmotion = true\n";
    let scene = tetrahedra(&FAR, more);
    let mut simulation = Simulation::new(&scene, Tier::detect()).unwrap();
    let first = simulation.next_frame().unwrap().unwrap();
    let translations = first.fine.of(first.bodies).unwrap();
    assert_eq!(translations[2], [1_000_000_033.3, 0.25, 0.0]);
    let second = simulation.next_frame().unwrap().unwrap();
    let translations = second.fine.of(second.bodies).unwrap();
    assert_eq!(translations[1], [1_000_000_032.2, 0.25, 0.0]);
    assert_eq!(translations[2], [1_000_000_064.0 + 64.0, 0.25, 0.0]);
    assert_eq!(second.pairs.sorted(), [[0, 1]]);
}

#[test]
fn records_hold_exact_translations() {
    let scene = tetrahedra(&FAR, "");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("far.ndjson");
    let mut recorder = Recorder::create(&path, &sdop_bench::record::header(&scene)).unwrap();
    run(&scene, Tier::detect(), |frame| {
        let line = sdop_bench::record::frame_line(frame, scene.cull.strategy);
        recorder.frame(&line).unwrap();
        Ok::<(), SimulationError>(())
    })
    .unwrap();
    recorder.finish().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("\"translations\":[[1000000031.5,0.25,0.0],[1000000032.2,"), "{text}");
    let frame = Reader::open(&path).unwrap().next_frame().unwrap().unwrap();
    assert_eq!(frame.translations, scene.fine.of(&scene.bodies));
    assert_eq!(frame.poses, FrameLine::poses(&scene.bodies));
    assert_eq!(frame.pairs, [[0, 1]]);

    for (from, to, problem) in [
        ("[1000000031.5,0.25,0.0],", "", "2 translations for 3 bodies"),
        ("[1000000032.2,", "[1000000132.2,", "body 1 has the translation"),
        ("[1000000033.3,", "[1e300,", "body 2: translation"),
    ] {
        std::fs::write(&path, text.replace(from, to)).unwrap();
        let error = Reader::open(&path).unwrap().next_frame().unwrap_err();
        assert!(error.to_string().contains(problem), "{error}");
    }
}

/// A pose of f32 numbers, written into a scene file, reads back to them exactly, and to no other
/// f64.
#[test]
fn written_poses_are_exact() {
    let translation = [0.1_f32, -3.0e-39, 1.0e9 / 3.0];
    let pose = pose_in_text([0.1, 0.2, 0.3, 0.4], translation);
    let text =
        format!("name = \"w\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[{pose}]]\n");
    let file = SceneFile::parse(&text, "w.toml", std::path::Path::new("")).unwrap();
    let scene = file.build_exact().unwrap();
    assert!(scene.fine.is_empty());
    assert_eq!(scene.bodies.translation, [translation]);
    assert_eq!(scene.bodies.rotation, [[0.1, 0.2, 0.3, 0.4]]);
}
