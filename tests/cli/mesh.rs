//! `sdop mesh`: counts, sizes of volumes, conversion, and errors with file and line.

use serde_json::Value;

use crate::cli::{json, refusal, stdout, text};

/// Spot is closed and every volume is larger than its hull.
#[test]
fn spot_volumes_exceed_its_hull() {
    let report = json(&["mesh", "data/meshes/spot.tri"]);
    assert_eq!(report["vertices"], 2930);
    assert_eq!(report["triangles"], 5856);
    assert_eq!(report["closed_components"], report["components"]);
    let volumes = report["volumes"].as_array().unwrap();
    let names: Vec<&str> = volumes.iter().map(|v| v["name"].as_str().unwrap()).collect();
    #[rustfmt::skip]
    assert_eq!(names, [
        "sphere", "aabb", "k-dop-14", "k-dop-18", "k-dop-26", "obb",
        "or-dop-6-principal", "or-dop-14-principal", "or-dop-18-principal", "or-dop-26-principal",
        "or-dop-6-model", "or-dop-14-model", "or-dop-18-model", "or-dop-26-model",
    ]);
    let over_hull = |name: &str| {
        let found = volumes.iter().find(|v| v["name"] == name);
        found.unwrap()["over_hull"].as_f64().unwrap()
    };
    assert!(names.iter().all(|name| over_hull(name) > 1.0), "{volumes:?}");
    for finer in ["14", "18", "26"] {
        assert!(over_hull(&format!("or-dop-{finer}-model")) < over_hull("or-dop-6-model"));
    }
    assert_eq!(over_hull("obb"), over_hull("or-dop-6-principal"));
    let shown = stdout(&["mesh", "data/meshes/spot.tri"]);
    assert!(shown.contains("components: 1, closed"), "{shown}");
    let words = ["means over 64 rotations", "not the smallest box"];
    assert!(words.iter().all(|words| shown.contains(words)), "{shown}");
}

/// A flat mesh has no size over hull.
#[test]
fn flat_mesh_has_no_hull_ratio() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("flat.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let report = json(&["mesh", text(&path)]);
    assert_eq!(report["hull_volume"], 0.0);
    assert_eq!(report["volumes"][0]["over_hull"], Value::Null);
    assert!(stdout(&["mesh", text(&path)]).contains("open"));
}

/// Conversion keeps every vertex to the bit.
#[test]
fn conversion_keeps_every_bit() {
    let directory = tempfile::tempdir().unwrap();
    let obj = directory.path().join("spot.obj");
    let back = directory.path().join("back.tri");
    let shown = stdout(&["mesh", "data/meshes/spot.tri", "--to", text(&obj)]);
    assert!(shown.contains("written to"), "{shown}");
    let report = json(&["mesh", text(&obj), "--to", text(&back)]);
    assert_eq!(report["written"], text(&back));
    let spot = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/meshes/spot.tri");
    let [before, after] = [spot, text(&back)]
        .map(|path| sdop::mesh::read(path, &sdop::mesh::ReadOptions::default()).unwrap());
    assert_eq!(before.vertices, after.vertices);
    assert_eq!(before.triangles, after.triangles);
}

#[test]
fn fewer_triangles_are_written_and_described() {
    let directory = tempfile::tempdir().unwrap();
    let small = directory.path().join("small.ply");
    let flags = ["--triangles", "500", "--to", text(&small)];
    let report = json(&[&["mesh", "data/meshes/spot.tri"], &flags[..]].concat());
    let triangles = report["triangles"].as_u64().unwrap();
    assert!((400..=500).contains(&triangles), "{triangles}");
    assert_eq!(report["closed_components"], 1);
    assert_eq!(json(&["mesh", text(&small)])["triangles"], triangles);
    assert_eq!(report["warnings"], serde_json::json!([]));
    let coarse = stdout(&["mesh", "data/meshes/teapot.tri", "--triangles", "50"]);
    assert!(coarse.contains(" triangles are left instead of 50: "), "{coarse}");
}

/// What readers warn about is shown, and so is what counts as one vertex.
#[test]
fn warnings_and_merged_vertices_are_shown() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("bow.off");
    let bow = "OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n-0 0 0\n4 0 1 2 3\n3 4 2 3\n";
    std::fs::write(&path, format!("{bow}1 2 3\n")).unwrap();
    let report = json(&["mesh", text(&path)]);
    assert_eq!(report["warnings"].as_array().unwrap().len(), 2);
    assert_eq!(report["merged_vertices"], 1);
    let shown = stdout(&["mesh", text(&path)]);
    assert!(shown.contains("bow.off:10: ignored 3 words after the last face"), "{shown}");
    assert!(shown.contains("bow.off:8: 1 of 1 faces"), "{shown}");
    assert!(shown.contains("1 vertices have the position of another one"), "{shown}");
}

/// Bad meshes are refused with file line and help.
#[test]
fn invalid_meshes_are_rejected() {
    let directory = tempfile::tempdir().unwrap();
    let bad = directory.path().join("bad.obj");
    std::fs::write(&bad, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n").unwrap();
    let message = refusal(&["mesh", text(&bad)]);
    assert!(message.contains("bad.obj:4"), "{message}");
    assert!(message.contains("names vertex 4"), "{message}");
    let ambiguous = directory.path().join("two.tri");
    // Three indices from 0 or from 1: both fit when no index is 0 or 4.
    let vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";
    std::fs::write(&ambiguous, format!("5 2\n{vertices}1 2 3\n2 3 4\n")).unwrap();
    let message = refusal(&["mesh", text(&ambiguous)]);
    assert!(message.contains("--tri-format indexed"), "{message}");
    assert!(message.contains("--tri-format cart3d"), "{message}");
    let chosen = json(&["mesh", text(&ambiguous), "--tri-format", "cart3d"]);
    assert_eq!(chosen["unused_vertices"], 1);
    assert!(refusal(&["mesh", "data/meshes/README.md"]).contains("names no mesh format"));
}

/// Of a flat square with a vertex in its middle, four vertices span it, and nothing is wider for a
/// vertex that no triangle uses.
#[test]
fn facts_are_of_the_used_vertices() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("square.obj");
    let square = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 0\n";
    let faces = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    std::fs::write(&path, format!("{square}v 9 9 9\nv 0 0 0\n{faces}f 1 5 3\nf 1 2 7\n")).unwrap();
    let report = json(&["mesh", text(&path)]);
    assert_eq!(report["hull_vertices"], 4);
    assert_eq!(report["hull_volume"].to_string(), "0.0");
    assert_eq!(report["unused_vertices"], 1);
    assert_eq!(report["degenerate_triangles"], 2);
    let radius = report["ball"][3].as_f64().unwrap();
    assert!((radius - 2_f64.sqrt()).abs() < 1e-6, "{radius}");
    let shown = stdout(&["mesh", text(&path)]);
    assert!(shown.contains("culled shapes contain all vertices"), "{shown}");
}
