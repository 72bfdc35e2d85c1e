//! `sdop run --record`: an independent reader gets the same bits as the library, pose by pose and
//! pair by pair.

use sdop::simd::Tier;
use sdop_bench::scene::SceneFile;
use sdop_bench::simulate::{self, SimulationError};
use serde_json::Value;

use crate::cli::{command, scene_file, text};

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

/// Numbers at any depth, in the order in which they are written, as the bits of the nearest f32.
fn bits(value: &Value) -> Vec<u32> {
    match value {
        Value::Array(items) => items.iter().flat_map(bits).collect(),
        Value::Number(_) => vec![value.to_string().parse::<f32>().unwrap().to_bits()],
        other => panic!("{other}"),
    }
}

fn bits_of(numbers: &[f32]) -> Vec<u32> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn recording_reads_back_exactly() {
    let (directory, path) = scene_file(SCENE);
    let record = directory.path().join("run.ndjson");
    let run = command(&["run", text(&path), "--record", text(&record)]).output().unwrap();
    assert!(run.status.success(), "{run:?}");
    let recorded = std::fs::read_to_string(&record).unwrap();
    let lines: Vec<Value> =
        recorded.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let scene = SceneFile::read(&path).unwrap().build().unwrap();

    let header = &lines[0];
    assert_eq!((&header["format"], &header["version"]), (&"sdop-record".into(), &1.into()));
    assert_eq!((&header["scene"], &header["seed"]), (&"recorded".into(), &7.into()));
    assert_eq!(header["shapes"].as_array().unwrap().len(), scene.shapes.len());
    for (recorded, shape) in header["shapes"].as_array().unwrap().iter().zip(&scene.shapes) {
        let [x, y, z] = shape.ball.centre;
        let ordop = &recorded["ordop"];
        assert_eq!(recorded["name"], shape.name.as_str());
        assert_eq!(bits(&recorded["vertices"]), bits_of(shape.vertices.as_flattened()));
        assert_eq!(recorded["triangles"], serde_json::json!(shape.triangles));
        assert_eq!(bits(&recorded["ball"]), bits_of(&[x, y, z, shape.ball.radius]));
        assert_eq!(ordop["k"], shape.ordop.directions.k());
        assert_eq!(bits(&ordop["basis"]), bits_of(shape.ordop.basis.columns.as_flattened()));
        assert_eq!(bits(&ordop["lo"]), bits_of(&shape.ordop.lo));
        assert_eq!(bits(&ordop["hi"]), bits_of(&shape.ordop.hi));
    }
    let mut frames = lines[1..].iter();
    simulate::run(&scene, Tier::SCALAR, |frame| -> Result<(), SimulationError> {
        let recorded = frames.next().unwrap();
        let poses = frame.bodies.rotation.iter().zip(&frame.bodies.translation);
        let poses: Vec<f32> = poses.flat_map(|(q, t)| [&q[..], &t[..]].concat()).collect();
        assert_eq!(recorded["frame"], frame.number);
        assert_eq!(bits(&recorded["poses"]), bits_of(&poses));
        assert_eq!(recorded["pairs"], serde_json::json!(frame.pairs.sorted()));
        Ok(())
    })
    .unwrap();
    assert_eq!((lines.len(), frames.next()), (7, None));
}
