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

fn replaced(text: &str, from: &str, to: &[u8]) -> Vec<u8> {
    let (before, after) = text.split_once(from).unwrap();
    [before.as_bytes(), to, after.as_bytes()].concat()
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

/// Numbers are those of c and fortran.
#[test]
fn c_and_fortran_numbers_parse() {
    let text = OBJ.replace("v 1 0 0", "v +1.d0 .5 5.E-1");
    let vertex = read(MeshFormat::Obj, text).unwrap().vertices[1];
    assert_eq!(vertex, [1.0, 0.5, 0.5]);
}

#[test]
fn capitals_are_letters_too() {
    assert_triangles(MeshFormat::Stl, STL.to_uppercase(), ONE);
    assert_triangles(MeshFormat::Stl, STL.replace("solid", "Solid"), ONE);
    assert_triangles(MeshFormat::Obj, OBJ.to_uppercase(), ONE);
    assert_triangles(MeshFormat::Ply, PLY.to_uppercase(), ONE);
}

/// Text stl begins and ends in many ways.
#[test]
fn tolerant_text_stl() {
    let marked = format!("\u{feff}{STL}");
    let comment = format!("# made by hand\n; and again\n\n// and {STL}");
    let end = STL.replace("endsolid", "end solid").replace("endloop", "end loop");
    let one_line = STL.replace("endfacet\n", "endfacet ");
    for text in [marked, comment, end.replace("endfacet", "end facet"), one_line] {
        assert_triangles(MeshFormat::Stl, text, ONE);
    }
}

/// Exporters write what they have for a normal; here it is not used.
#[test]
fn normals_of_stl_may_be_anything() {
    for normal in ["nan nan nan", "-nan(ind) -1.#IND 1.#QNAN", "", "1 2", "0,0 0,0 1,0"] {
        assert_triangles(MeshFormat::Stl, STL.replace("0 0 1\n", &format!("{normal}\n")), ONE);
    }
}

/// A refused stl is called what it is.
#[test]
fn rejected_stl_is_named_correctly() {
    let message = |bytes: &[u8]| read(MeshFormat::Stl, bytes).unwrap_err().problem();
    let cut = STL.to_uppercase();
    let cut = &cut[..cut.len() / 2];
    assert!(!message(cut.as_bytes()).contains("binary"), "{}", message(cut.as_bytes()));
}

/// Unused properties of ply may be anything.
#[test]
fn unused_ply_properties_are_ignored() {
    for value in ["nan", "-nan(ind)", "1.#QNAN", "inf", "?"] {
        assert_triangles(
            MeshFormat::Ply,
            replaced(PLY, "1 0 0 2", format!("1 0 0 {value}").as_bytes()),
            ONE,
        );
    }
}

/// A comment without the word, and columns that the header does not name.
#[test]
fn extra_ply_words_are_ignored() {
    let unmarked = PLY.replacen("comment NAME", "Created by NAME", 1);
    assert_triangles(MeshFormat::Ply, unmarked, ONE);
    let longer = PLY.replace("1 0 0 2\n", "1 0 0 2 7 8\n").replace("3 0 1 2\n", "3 0 1 2 9 9\n");
    assert_triangles(MeshFormat::Ply, longer, ONE);
}

/// The numbers begin after the line feed if the header's other lines end with one, whatever is
/// before it.
#[test]
fn binary_ply_begins_after_header() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                  property float z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    // The first byte of the data looks like a line end, too.
    let first = f32::from_le_bytes([b'\n', 0, 0, 0]);
    let points = [[first, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let numbers = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let data: Vec<u8> = numbers.chain([3, 0, 1, 2]).collect();
    for text in [
        header.to_owned(),
        header.replace('\n', "\r\n"),
        header.replace('\n', "\r"),
        header.replace("end_header\n", "end_header\r\n"),
    ] {
        assert_triangles(MeshFormat::Ply, [text.as_bytes(), &data].concat(), ONE);
    }
}

/// −1 ends a strip, and each strip starts with a triangle in the order of its vertices.
#[test]
fn strips_of_ply_are_unrolled() {
    let strips = PLY
        .replace("element vertex 3", "element vertex 5")
        .replace("element face 1", "element tristrips 1")
        .replace("3 0 1 2\n", "1 1 0 4\n2 1 0 5\n8 0 1 2 3 -1 1 3 4\n");
    assert_triangles(MeshFormat::Ply, strips, &[[0, 1, 2], [2, 1, 3], [1, 3, 4]]);
}

/// Lines of obj are continued and commented.
#[test]
fn obj_lines_continue_and_comment() {
    let text = "v 0 0 0 # first\nv 1 0 \\\n 0\nV 0 1 0\nf 1/1 2/x/y \\\r\n3//-7#\nf -1 -2 -3";
    assert_triangles(MeshFormat::Obj, text, &[[0, 1, 2], [2, 1, 0]]);
    let later = "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    assert_triangles(MeshFormat::Obj, later, ONE);
}
