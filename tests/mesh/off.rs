//! OFF files: what is read, and where an invalid file is wrong.

use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn off(text: &str) -> Result<TriangleMesh, MeshError> {
    read_bytes("a.off", MeshFormat::Off, text.as_bytes(), &ReadOptions::default())
}

#[track_caller]
fn assert_square(text: &str) {
    let mesh = off(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "{text}");
    let expected = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    assert_eq!(mesh.vertices, expected, "{text}");
}

#[test]
fn headers_say_what_vertices_have() {
    for (header, weight, extra) in [
        ("OFF", "", ""),
        ("off", "", ""),
        ("OFF # made by hand", "", ""),
        ("", "", ""),
        ("COFF", "", " 255 0 0 255"),
        ("COFF", "", " 1 0 0"),
        ("NOFF", "", " 0 0 1"),
        ("STOFF", "", " 0.5 nan"),
        ("STCNOFF", "", " 0 0 255 0 0 0 0 1"),
        ("4OFF", " 1", ""),
        ("OFF", "", " 12 13"),
    ] {
        let vertices = ["0 0 0", "2 0 0", "2 2 0", "0 2 0"];
        let vertices = vertices.map(|v| format!("{v}{weight}{extra}\n")).concat();
        assert_square(&format!("{header}\n\n4 1 4\n{vertices}4 0 1 2 3\n"));
        assert_square(&format!("{header}\n4 1\n# faces\n{vertices}4 0 1 2 3 255 0 0\n"));
    }
}

#[test]
fn weights_divide() {
    assert_square("4OFF\n4 1 0\n0 0 0 1\n4 0 0 2\n1 1 0 .5\n0 -2 0 -1\n4 0 1 2 3\n");
}

#[test]
fn lines_may_be_broken_anywhere() {
    assert_square("OFF 4 1 4\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n");
    assert_square("OFF\n4 1 4\n0 0 0 2 0 0\n2 2 0 0 2 0\n4 0 1\n2 3\n");
    assert_square("NOFF\n4 1 4\n0 0 0 0 0 1 2 0 0 0 0 1\n2 2 0 0 0 1 0 2 0 0 0 1\n4 0 1 2 3\n");
}

/// Bad off is refused with its line.
#[test]
fn invalid_off_is_rejected() {
    let square = "OFF\n4 1 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n";
    let with = |from: &str, to: &str| square.replacen(from, to, 1);
    for (text, expected) in [
        (String::new(), "a.off: the mesh has no vertices"),
        ("solid\n".into(), "a.off:1: this is not OFF: found \"solid\""),
        ("OFF BINARY\n".into(), "a.off:1: this is a binary OFF file"),
        (with("OFF", "nOFF 4"), "a.off:1: vertices of nOFF have another number of dimensions"),
        (with("4 1 0", "4 0 0").replace("4 0 1 2 3\n", ""), "a.off: the mesh has no triangles"),
        (with("4 1", "0 1"), "a.off:2: the mesh has no vertices"),
        (with("4 1", "-4 1"), "a.off:2: a count should not be negative, found -4"),
        (with("4 1", "5 1"), "a.off:7: the file ends where face 0 of 1 should be"),
        (with("4 1", "4 2"), "a.off:7: the file ends where face 1 of 2 should be"),
        (with("2 2 0", "2 x 0"), "a.off:5: a coordinate should be a number, found \"x\""),
        (with("1 2 3", "1 2 4"), "a.off:7: triangle 1 names vertex 4, but the vertices are 0 to 3"),
        (with("4 0 1 2 3", "0"), "a.off: the mesh has no triangles"),
    ] {
        assert_eq!(off(&text).unwrap_err().problem(), expected, "{text}");
    }
}
