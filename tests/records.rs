//! Records: what is written reads back, and every error names its line and a remedy.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::simd::Tier;
use sdop_bench::scene::SceneFile;
use sdop_bench::simulate::Simulation;
use sdop_judge::json;
use sdop_judge::record::{FrameLine, Reader, RecordError, Recorder};

const SCENE: &str = r#"
name = "small"
frames = 3
dt = 0.1
[box]
side = 4.0
[[bodies]]
shape = "box"
count = 5
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[[bodies]]
shape = "needle"
count = 2
static = true
[effects]
motion = true
walls = "specular"
"#;

/// A small run's record as text.
fn record() -> String {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.toml");
    std::fs::write(&path, SCENE).unwrap();
    let scene = SceneFile::read(&path).unwrap().build().unwrap();
    let file = directory.path().join("run.ndjson");
    let mut recorder = Recorder::create(&file, &sdop_bench::record::header(&scene)).unwrap();
    let mut simulation = Simulation::new(&scene, Tier::SCALAR).unwrap();
    while let Some(frame) = simulation.next_frame().unwrap() {
        let line = sdop_bench::record::frame_line(&frame, scene.cull.strategy);
        recorder.frame(&line).unwrap();
    }
    assert!(!file.exists(), "under its name before it is whole");
    recorder.finish().unwrap();
    std::fs::read_to_string(&file).unwrap()
}

/// Reads all frames.
fn read(text: &[u8]) -> Result<Vec<FrameLine>, RecordError> {
    let mut reader = Reader::new(text, "r.ndjson")?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}

/// The error of a record, and its remedy.
fn refusal(text: &str) -> (String, String) {
    let error = read(text.as_bytes()).unwrap_err();
    let help = error.help().expect("a remedy").to_string();
    (error.to_string(), help)
}

/// The record with one piece of text exchanged.
fn altered(from: &str, to: &str) -> String {
    let record = record();
    assert!(record.contains(from), "{from} in {record}");
    record.replacen(from, to, 1)
}

#[test]
fn a_written_record_reads_back() {
    let text = record();
    let reader = Reader::new(text.as_bytes(), "r.ndjson").unwrap();
    let header = reader.header();
    assert_eq!((header.scene.as_str(), header.side), ("small", Some(4.0)));
    let lists =
        |name: &str| header.effects.as_ref().unwrap().iter().any(|e| e.name == name && e.on);
    assert!(lists("motion") && lists("walls") && !lists("gravity"));
    let written = json::to_string(header).unwrap();
    assert_eq!(text.lines().next(), Some(written.as_str()));
    let frames = read(text.as_bytes()).unwrap();
    assert_eq!(frames.len(), 3);
    let lines = text.lines().skip(1);
    for (frame, line) in frames.iter().zip(lines) {
        assert_eq!(json::to_string(frame).unwrap(), line);
    }
}

/// Shapes and poses are those of the scene.
#[test]
fn record_has_scene_shapes() {
    let text = record();
    let mut reader = Reader::new(text.as_bytes(), "r.ndjson").unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.toml");
    std::fs::write(&path, SCENE).unwrap();
    let scene = SceneFile::read(&path).unwrap().build().unwrap();
    // A record has the vertices as culled, and not how the scene has scaled and moved them.
    let mut shapes = scene.shapes.clone();
    for shape in &mut shapes {
        (shape.offset, shape.scale) = ([0.0; 3], 1.0);
    }
    assert_eq!(reader.shapes(), shapes);
    let mut simulation = Simulation::new(&scene, Tier::SCALAR).unwrap();
    while let Some(frame) = simulation.next_frame().unwrap() {
        let pairs = frame.pairs.sorted();
        assert_eq!(reader.next_frame().unwrap().unwrap().pairs, pairs);
        let read = reader.bodies();
        assert_eq!(read.rotation, frame.bodies.rotation);
        assert_eq!(read.translation, frame.bodies.translation);
        assert_eq!(read.dynamic, frame.bodies.dynamic);
    }
    assert_eq!(reader.next_frame().unwrap(), None);
}

/// A record of minor 0 and unknown keys are read.
#[test]
fn older_records_are_read() {
    let text = r#"{"format":"sdop-record","version":1,"scene":"s","seed":1,"shapes":[{"name":"p","vertices":[[0,0,0]],"triangles":[],"ball":[0,0,0,0],"ordop":{"k":6,"basis":[1,0,0,0,1,0,0,0,1],"lo":[0,0,0],"hi":[0,0,0]}}],"bodies":[{"shape":0,"static":false,"colour":"red"}],"mood":"fine"}
{"frame":4,"poses":[[0,0,0,1,1,2,3]],"pairs":[],"ns":12}

{"frame":9,"poses":[[0,0,0,1,1,2,3]],"pairs":[]}"#;
    let mut reader = Reader::new(text.as_bytes(), "r.ndjson").unwrap();
    assert_eq!((reader.header().minor, &reader.header().cull), (0, &None));
    assert_eq!(reader.next_frame().unwrap().unwrap().frame, 4);
    assert_eq!(reader.bodies().translation, [[1.0, 2.0, 3.0]]);
    assert_eq!(reader.next_frame().unwrap().unwrap().frame, 9);
    assert_eq!(reader.next_frame().unwrap(), None);
}

/// A first line that contradicts itself is refused.
#[test]
fn contradictory_header_is_rejected() {
    let record = record();
    let body = record.find("{\"shape\":0").unwrap();
    let seven =
        format!("{}{}", &record[..body], record[body..].replacen("\"shape\":0", "\"shape\":7", 1));
    let needle = record.find("\"triangles\":[[").unwrap() + "\"triangles\":[[".len();
    let outside =
        format!("{}99,{}", &record[..needle], record[needle..].split_once(',').unwrap().1);
    for (text, problem) in [
        (seven, "r.ndjson:1: body 0: shape 7 of"),
        (outside, "shape box: triangle 0 is [99, "),
        (altered("\"ordop\":{\"k\":18", "\"ordop\":{\"k\":17"), "no or-DOP has k = 17"),
        (
            altered("\"ordop\":{\"k\":18", "\"ordop\":{\"k\":26"),
            "k = 26 takes 13 slabs; it has 9 lower and 9 upper ends",
        ),
        (altered("\"ball\":[0.0,", "\"ball\":[1e39,"), "r.ndjson:1: column "),
        (altered("\"bodies\":", "\"bOdies\":"), "r.ndjson:1: column "),
    ] {
        let (message, help) = refusal(&text);
        assert!(message.contains(problem), "{message}");
        assert!(!help.is_empty());
    }
}

/// A bad frame is refused with its line.
#[test]
fn invalid_frame_names_its_line() {
    let record = record();
    let lines: Vec<&str> = record.lines().collect();
    let third = serde_json::from_str::<FrameLine>(lines[3]).unwrap();
    let with = |change: &dyn Fn(&mut FrameLine)| {
        let mut frame = third.clone();
        change(&mut frame);
        serde_json::to_string(&frame).unwrap()
    };
    for (line, problem) in [
        (with(&|f| f.frame = 1), "r.ndjson:4: frame 1 follows frame 1"),
        (with(&|f| f.poses.truncate(6)), "r.ndjson:4: frame 2 has 6 poses for 7 bodies"),
        (with(&|f| f.poses[3][..4].fill(0.0)), "r.ndjson:4: frame 2: body 3: rotation"),
        (with(&|f| f.poses[3][5] = 1e30), "r.ndjson:4: frame 2: body 3: translation"),
        (with(&|f| f.pairs = vec![[1, 1]]), "frame 2, pairs: [1,1] doesn't have the smaller"),
        (with(&|f| f.pairs = vec![[1, 7]]), "frame 2, pairs: [1,7] of 7 bodies"),
        (with(&|f| f.pairs = vec![[5, 6]]), "frame 2, pairs: [5,6] are both static"),
        (with(&|f| f.pairs = vec![[0, 1], [0, 1]]), "frame 2, pairs: [0,1] follows [0,1]"),
        (with(&|f| f.meets = Some(vec![[0, 3], [0, 2]])), "frame 2, meets: [0,2] follows [0,3]"),
        ("{\"frame\":2}".to_owned(), "r.ndjson:4: column 11: missing field `poses`"),
        (lines[3].replacen("[[", "[[null,", 1), "r.ndjson:4: column "),
        (lines[3].replacen("[[", "[[1e39,", 1), "r.ndjson:4: column "),
        ("\u{fffd}".to_owned(), "r.ndjson:4: column 1: expected value"),
    ] {
        let text = [&lines[..3], &[line.as_str()]].concat().join("\n");
        let (message, help) = refusal(&text);
        assert!(message.contains(problem), "{message}");
        assert!(!help.is_empty());
    }
}

/// A record cut off anywhere keeps its whole frames.
#[test]
fn truncated_record_keeps_whole_frames() {
    let text = record();
    let header = text.find('\n').unwrap();
    for end in (header + 1..text.len()).step_by(97) {
        let cut = &text.as_bytes()[..end];
        let whole = cut.iter().filter(|&&byte| byte == b'\n').count() - 1;
        let mut reader = Reader::new(cut, "r.ndjson").unwrap();
        for _ in 0..whole {
            assert!(reader.next_frame().unwrap().is_some());
        }
        if cut.ends_with(b"\n") {
            assert_eq!(reader.next_frame().unwrap(), None);
        } else {
            let error = reader.next_frame().unwrap_err();
            let message = format!("r.ndjson:{}: the file ends inside this line", whole + 2);
            assert_eq!(error.to_string(), message);
            assert!(error.help().unwrap().to_string().contains("cut the line off"));
        }
    }
    for end in (0..header).step_by(997) {
        assert!(Reader::new(&text.as_bytes()[..end], "r.ndjson").is_err());
    }
}
