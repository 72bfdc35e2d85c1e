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
