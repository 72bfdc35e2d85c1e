//! Files that other programs read are read: bytes that are not UTF-8, capitals, byte-order marks,
//! comments and line ends.

use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn read(format: MeshFormat, bytes: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("a", format, bytes.as_ref(), &ReadOptions::default())
}

#[track_caller]
fn assert_triangles(format: MeshFormat, bytes: impl AsRef<[u8]>, expected: &[[u32; 3]]) {
    let bytes = bytes.as_ref();
    let mesh =
        read(format, bytes).unwrap_or_else(|error| panic!("{error}\n{}", bytes.escape_ascii()));
    assert_eq!(mesh.triangles, expected, "{}", bytes.escape_ascii());
}

const OBJ: &str = "# by NAME\no NAME\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl NAME\nf 1 2 3\n";

const STL: &str = "solid NAME\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
                   endfacet\nendsolid NAME\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment NAME\nobj_info NAME\nelement vertex 3\nproperty float x\n\
                   property float y\nproperty float z\nproperty float quality\nelement face 1\n\
                   property list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n";

const ONE: &[[u32; 3]] = &[[0, 1, 2]];

/// Latin-1, and bytes of no encoding, in names and comments.
#[test]
fn names_need_not_be_utf8() {
    for name in [&b"\xe9toile"[..], b"\xff\xfe\x80", b"", b"endsolid facet", b"v 1 2"] {
        for (format, text) in
            [(MeshFormat::Obj, OBJ), (MeshFormat::Ply, PLY), (MeshFormat::Stl, STL)]
        {
            let count = text.matches("NAME").count();
            let bytes = (0..count).fold(text.as_bytes().to_vec(), |bytes, _| {
                let at = bytes.windows(4).position(|word| word == b"NAME").unwrap();
                [&bytes[..at], name, &bytes[at + 4..]].concat()
            });
            assert_triangles(format, bytes, ONE);
        }
    }
    assert_triangles(MeshFormat::Tri, "3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n", ONE);
}

/// Old Mac, Unix and Windows; a mark of UTF-8; blanks before, between and after words.
#[test]
fn line_ends_do_not_matter() {
    let tri = "3 1\n0 0 0\n1 0 0\n0 1 0\n0 2 1\n";
    let formats = [
        (MeshFormat::Obj, OBJ, ONE),
        (MeshFormat::Ply, PLY, ONE),
        (MeshFormat::Stl, STL, ONE),
        (MeshFormat::Tri, tri, &[[0, 2, 1]]),
    ];
    for (format, text, expected) in formats {
        for end in ["\n", "\r\n", "\r", " \n", "\n\n", "\t\r\n \r\n"] {
            assert_triangles(format, text.replace('\n', end), expected);
        }
        assert_triangles(format, format!("\u{feff}{text}"), expected);
        assert_triangles(format, text.replace(' ', "\t "), expected);
        assert_triangles(format, format!(" {}", text.replace('\n', "\n  ")), expected);
    }
}

/// As some Windows programs save text.
#[test]
fn marked_utf16_is_text() {
    let off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (format, text) in [(MeshFormat::Obj, OBJ), (MeshFormat::Stl, STL), (MeshFormat::Off, off)] {
        for order in [u16::to_be_bytes, u16::to_le_bytes] {
            let units = format!("\u{feff}{text}").replace("NAME", "étoile ★");
            let bytes: Vec<u8> = units.encode_utf16().flat_map(order).collect();
            assert_triangles(format, &bytes, ONE);
            assert_triangles(format, &bytes[..bytes.len() - 1], ONE);
        }
    }
}

#[test]
fn capitals_are_letters_too() {
    assert_triangles(MeshFormat::Stl, STL.to_uppercase(), ONE);
    assert_triangles(MeshFormat::Stl, STL.replace("solid", "Solid"), ONE);
    assert_triangles(MeshFormat::Obj, OBJ.to_uppercase(), ONE);
    assert_triangles(MeshFormat::Ply, PLY.to_uppercase(), ONE);
}
