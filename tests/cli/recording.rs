//! `sdop run --record`: an independent reader gets the same bits as the library, and the reference
//! judges the recorded numbers.

use sdop::simd::Tier;
use sdop_bench::scene::SceneFile;
use sdop_bench::simulate::{self, SimulationError};
use sdop_reference as reference;
use serde::Deserialize;

use crate::cli::{scene_file, stdout, text};

const SCENE: &str = r#"
name = "recorded"
seed = 7
frames = 6
dt = 0.1
[box]
side = 6.0
[[bodies]]
shape = "l-shape"
count = 20
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[[bodies]]
shape = "torus"
count = 10
radius = 0.9
static = true
[[bodies]]
shape = "gear"
poses = [[0.1, 0.2, 0.3, 0.4, 0.5, -0.25, 0.125]]
[effects]
motion = true
walls = "specular"
spin = { rate = [0.1, 1.0] }
"#;

#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
    scene: String,
    seed: u64,
    shapes: Vec<Shape>,
    bodies: Vec<Body>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Shape {
    name: String,
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    ball: [f32; 4],
    ordop: OrDop,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OrDop {
    k: usize,
    basis: [f32; 9],
    lo: Vec<f32>,
    hi: Vec<f32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Body {
    shape: usize,
    r#static: bool,
}

#[derive(Deserialize)]
struct Frame {
    frame: u32,
    poses: Vec<[f32; 7]>,
    pairs: Vec<(u32, u32)>,
    counters: Vec<Volume>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Volume {
    volume: String,
    updates: u64,
    tests: u64,
    hits: u64,
}

/// Writes the scene's recording with the built binary and reads it back.
fn record(flags: &[&str]) -> (Header, Vec<Frame>) {
    let (directory, scene) = scene_file(SCENE);
    let path = directory.path().join("run.ndjson");
    let args = [&["run", text(&scene), "--record", text(&path)], flags].concat();
    stdout(&args);
    let recorded = std::fs::read_to_string(&path).unwrap();
    let (header, frames) = recorded.split_once('\n').unwrap();
    let frames = frames.lines().map(|line| serde_json::from_str(line).unwrap());
    (serde_json::from_str(header).unwrap(), frames.collect())
}

fn bits<const N: usize>(rows: &[[f32; N]]) -> Vec<[u32; N]> {
    rows.iter().map(|row| row.map(f32::to_bits)).collect()
}

/// A recording reads back to the same bits.
#[test]
fn recording_reads_back_exactly() {
    let (header, frames) = record(&[]);
    let (_directory, path) = scene_file(SCENE);
    let scene = SceneFile::read(&path).unwrap().build().unwrap();
    assert_eq!((header.format.as_str(), header.version), ("sdop-record", 1));
    assert_eq!((header.scene.as_str(), header.seed), ("recorded", 7));
    assert_eq!(header.shapes.len(), scene.shapes.len());
    for (recorded, shape) in header.shapes.iter().zip(&scene.shapes) {
        let basis = shape.ordop.basis.columns;
        let [x, y, z] = shape.ball.centre;
        assert_eq!(recorded.name, shape.name);
        assert_eq!(bits(&recorded.vertices), bits(&shape.vertices));
        assert_eq!(recorded.triangles, shape.triangles);
        assert_eq!(bits(&[recorded.ball]), bits(&[[x, y, z, shape.ball.radius]]));
        assert_eq!(recorded.ordop.k, shape.ordop.directions.k());
        assert_eq!(recorded.ordop.basis.map(f32::to_bits).as_slice(), bits(&basis).as_flattened());
        assert_eq!(recorded.ordop.lo, shape.ordop.lo);
        assert_eq!(recorded.ordop.hi, shape.ordop.hi);
    }
    let mut next = 0;
    simulate::run(&scene, Tier::SCALAR, |frame| -> Result<(), SimulationError> {
        let recorded = &frames[next];
        let poses = frame.bodies.rotation.iter().zip(&frame.bodies.translation);
        let poses: Vec<[f32; 7]> =
            poses.map(|(q, t)| [q[0], q[1], q[2], q[3], t[0], t[1], t[2]]).collect();
        let pairs: Vec<_> = frame.pairs.sorted().iter().map(|&[i, j]| (i, j)).collect();
        assert_eq!(recorded.frame, frame.number);
        assert_eq!(bits(&recorded.poses), bits(&poses));
        assert_eq!(recorded.pairs, pairs);
        next += 1;
        Ok(())
    })
    .unwrap();
    assert_eq!(next, frames.len());
    assert_eq!(frames.len(), 6);
}

/// Counters of the frames add up to those of the run.
#[test]
fn frame_counters_add_up() {
    let (directory, scene) = scene_file(SCENE);
    let path = directory.path().join("run.ndjson");
    let run = crate::cli::json(&["run", text(&scene), "--record", text(&path)]);
    let (_, frames) = record(&[]);
    let sum = |volume: &str, get: fn(&Volume) -> u64| -> u64 {
        let volumes = frames.iter().flat_map(|frame| &frame.counters);
        volumes.filter(|v| v.volume == volume).map(get).sum()
    };
    for (volume, key) in [("sphere", "sphere"), ("or-dop", "ordop")] {
        let counters = [
            ("updates", sum(volume, |v| v.updates)),
            ("tests", sum(volume, |v| v.tests)),
            ("hits", sum(volume, |v| v.hits)),
        ];
        for (name, counted) in counters {
            assert_eq!(run["counters"][format!("{key}_{name}")], counted, "{volume}, {name}");
            assert!(counted > 0, "{volume}, {name}");
        }
    }
    let order = |frame: &Frame| frame.counters.iter().map(|v| v.volume.clone()).collect::<Vec<_>>();
    assert!(frames.iter().all(|frame| order(frame) == ["sphere", "or-dop"]));
}

/// A record that was not finished leaves no file.
#[test]
fn unfinished_record_leaves_no_file() {
    let far = SCENE.replace("dt = 0.1", "dt = 1e18").replace("walls = \"specular\"\n", "");
    let (directory, scene) = scene_file(&far);
    let path = directory.path().join("run.ndjson");
    let message = crate::cli::refusal(&["run", text(&scene), "--record", text(&path)]);
    assert!(message.contains("frame 1"), "{message}");
    let entries = std::fs::read_dir(directory.path()).unwrap();
    let left: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, [scene.file_name().unwrap()]);
}

/// The reference finds no pair that the recording lacks.
#[test]
fn recording_has_every_exact_pair() {
    for (strategy, judged) in [
        ("s-dop-sequential", reference::Strategy::Sequential),
        ("or-dop", reference::Strategy::OrDop),
        ("sphere", reference::Strategy::Sphere),
    ] {
        let (header, frames) = record(&["--strategy", strategy]);
        let shapes: Vec<_> = header.shapes.iter().map(judged_shape).collect();
        let mut found = 0;
        for frame in &frames {
            let bodies: Vec<_> = header
                .bodies
                .iter()
                .zip(&frame.poses)
                .map(|(body, &[qx, qy, qz, qw, tx, ty, tz])| reference::Body {
                    shape: &shapes[body.shape],
                    pose: reference::Pose::new([qx, qy, qz, qw], [tx, ty, tz]).unwrap(),
                    dynamic: !body.r#static,
                })
                .collect();
            assert!(frame.pairs.is_sorted());
            for pair in reference::pairs(&bodies, judged, reference::Overlap::TwoSided) {
                assert!(
                    frame.pairs.binary_search(&pair).is_ok(),
                    "{strategy}: {pair:?} of frame {}",
                    frame.frame
                );
                found += 1;
            }
            for &(i, j) in &frame.pairs {
                assert!(i < j, "{i} {j}");
                assert!(bodies[i as usize].dynamic || bodies[j as usize].dynamic);
            }
        }
        assert!(found > 100, "{strategy}: {found} pairs");
    }
}

fn judged_shape(shape: &Shape) -> reference::Shape {
    let [x, y, z, radius] = shape.ball;
    let ball = reference::Ball { centre: [x, y, z], radius };
    let column = |i: usize| [0, 1, 2].map(|axis| shape.ordop.basis[3 * i + axis]);
    let directions = match shape.ordop.k {
        6 => reference::DirectionSet::K6,
        14 => reference::DirectionSet::K14,
        18 => reference::DirectionSet::K18,
        26 => reference::DirectionSet::K26,
        k => panic!("k = {k}"),
    };
    let slabs = reference::Slabs {
        directions,
        basis: [column(0), column(1), column(2)],
        lo: shape.ordop.lo.clone(),
        hi: shape.ordop.hi.clone(),
    };
    reference::Shape::new(ball, slabs, shape.vertices.clone(), shape.triangles.clone()).unwrap()
}
