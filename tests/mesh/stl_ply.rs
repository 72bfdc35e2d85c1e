//! STL and PLY files, text and binary: what is read, and where an invalid file is wrong.

use glam::Vec3;
use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn stl(bytes: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("a.stl", MeshFormat::Stl, bytes.as_ref(), &ReadOptions::default())
}

fn ply(bytes: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("a.ply", MeshFormat::Ply, bytes.as_ref(), &ReadOptions::default())
}

fn assert_refused(cases: &[(Vec<u8>, &str)], read: fn(Vec<u8>) -> Result<TriangleMesh, MeshError>) {
    for (bytes, expected) in cases {
        let found = read(bytes.clone()).unwrap_err().problem();
        assert_eq!(&found, expected, "{}", String::from_utf8_lossy(bytes));
    }
}

/// Two triangles that share the edge from x to y.
fn two_triangles() -> TriangleMesh {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    TriangleMesh::new("a", vertices, vec![[0, 1, 2], [1, 3, 2]]).unwrap()
}

fn facet(corners: [&str; 3]) -> String {
    let [a, b, c] = corners;
    format!(
        "  facet normal 0 0 1\n    outer loop\n      vertex {a}\n      vertex {b}\n      vertex {c}\n    \
         endloop\n  endfacet\n"
    )
}

fn first() -> String {
    facet(["0 0 0", "1 0 0", "0 1 0"])
}

fn second() -> String {
    facet(["1 0 0", "1 1 0", "-0 1e0 0"])
}

fn binary_stl(header: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0.0_f32; 3].iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

const FIRST: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const SECOND: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]];

/// Text stl is welded over all its solids.
#[test]
fn text_stl_welds_all_solids() {
    let one = format!("solid a b\n{}{}endsolid a b\n", first(), second());
    let nameless = format!("\nsolid\n\n{}{}endsolid", first(), second());
    let two = format!("solid a\n{}endsolid a\n\nsolid b\r\n{}endsolid b\n", first(), second());
    for text in [one, nameless, two] {
        assert_eq!(stl(&text).unwrap(), two_triangles(), "{text}");
    }
}

/// Many exporters start the header of a binary file with the word that marks a text file.
#[test]
fn length_identifies_binary_stl() {
    for header in ["", "solid plane", "solid plane\n", "exported \u{7}"] {
        assert_eq!(stl(binary_stl(header.as_bytes(), &[FIRST, SECOND])).unwrap(), two_triangles());
    }
}

/// Bad stl is refused with its line.
#[test]
fn invalid_stl_is_rejected() {
    let short = binary_stl(b"", &[FIRST])[..133].to_vec();
    let nan = binary_stl(b"", &[FIRST, [[0.0; 3], [0.0, f32::NAN, 0.0], [0.0; 3]]]);
    let text = |body: String| format!("solid a\n{body}").into_bytes();
    assert_refused(
        &[
            (vec![], "a.stl: the mesh has no vertices"),
            (b"solid a\nendsolid a\n".to_vec(), "a.stl: the mesh has no vertices"),
            (binary_stl(b"", &[]), "a.stl: the mesh has no vertices"),
            (
                b"STL?".to_vec(),
                "a.stl: this is neither text STL (no `solid`) nor binary STL (under 84 bytes)",
            ),
            (short, "a.stl: a binary STL file of 1 triangles has 134 bytes, this one has 133"),
            (nan, "a.stl: vertex 4 has the coordinate NaN: not a finite f32"),
            (
                text(first() + &second().replace("outer loop", "outer")),
                "a.stl:10: `outer loop` should stand here, found \"outer\"",
            ),
            (text(first()), "a.stl:8: the file ends before `endsolid`"),
            (
                text(first() + &second().replace("1e0", "inf")),
                "a.stl:13: vertex 5 has the coordinate inf: not a finite f32",
            ),
            (
                text(format!("\n{}endsolid", second().replace("1e0", "2e18"))),
                "a.stl:7: vertex 2 has the coordinate 2e18: beyond 2^60",
            ),
            (
                text(format!("{}endsolid\n\nhello\nfacet\n", first())),
                "a.stl:11: `facet` should stand here, found \"hello\"",
            ),
            (text("\u{0}\n".into()), "a.stl:2: `facet` should stand here, found \"\\0\""),
            (b"solid \xff".to_vec(), "a.stl:1: the file ends before `endsolid`"),
        ],
        stl,
    );
}

const HEADER: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n\
                      property float y\nproperty double z\nproperty uchar red\nelement face 2\n\
                      property list uchar int vertex_indices\nend_header\n";
const BODY: &str = "0 0 0 9\n1 0 0 9\n0 1 0 9\n1 1 0 9\n3 0 1 2\n3 1 3 2\n";

fn binary_ply(format: &str, bytes: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut file = HEADER.replace("ascii", format).into_bytes();
    for [x, y, z] in two_triangles().vertices {
        file.extend(bytes(&x.to_le_bytes()));
        file.extend(bytes(&y.to_le_bytes()));
        file.extend(bytes(&f64::from(z).to_le_bytes()));
        file.push(9);
    }
    for triangle in two_triangles().triangles {
        file.push(3);
        file.extend(triangle.iter().flat_map(|index| bytes(&index.to_le_bytes())));
    }
    file
}

fn little_endian(bytes: &[u8]) -> Vec<u8> {
    bytes.to_vec()
}

fn big_endian(bytes: &[u8]) -> Vec<u8> {
    bytes.iter().rev().copied().collect()
}

/// Text and both binary plys read alike.
#[test]
fn ply_encodings_read_alike() {
    let text = format!("{HEADER}{BODY}");
    assert_eq!(ply(&text).unwrap(), two_triangles());
    assert_eq!(ply(text.replace('\n', "\r\n")).unwrap(), two_triangles());
    assert_eq!(ply(text.replace("vertex_indices", "vertex_index")).unwrap(), two_triangles());
    assert_eq!(ply(binary_ply("binary_little_endian", little_endian)).unwrap(), two_triangles());
    assert_eq!(ply(binary_ply("binary_big_endian", big_endian)).unwrap(), two_triangles());
}

/// What follows the last element, faces without corners, and 64-bit integers are read with a
/// warning, as other programs read them.
#[test]
fn harmless_faults_are_warned_of() {
    let text = |from: &str, to: &str| format!("{HEADER}{BODY}").replacen(from, to, 1).into_bytes();
    let binary = binary_ply("binary_little_endian", little_endian);
    let header = binary.len() - 2 * 13;
    let mut wide = String::from_utf8_lossy(&binary[..header]).replace("uchar int ", "uchar int64 ");
    wide.truncate(wide.find("end_header\n").unwrap() + 11);
    let points = HEADER.replace("ascii", "binary_little_endian").len();
    let indices = two_triangles().triangles.into_iter().flat_map(|triangle| {
        [vec![3], triangle.iter().flat_map(|&i| u64::from(i).to_le_bytes()).collect()].concat()
    });
    let wide: Vec<u8> =
        wide.bytes().chain(binary[points..header].iter().copied()).chain(indices).collect();
    let of_solid = format!("solid a\n{}{}endsolid\n\nend of file\n", first(), second());
    let cases = [
        (MeshFormat::Ply, [binary, vec![7, 7]].concat(), "ignored 2 bytes after the last element"),
        (
            MeshFormat::Ply,
            text("1 3 2\n", "1 3 2\n3 0 1 2\n"),
            ":18: ignored 4 words after the last element",
        ),
        (
            MeshFormat::Ply,
            text("face 2", "face 3").into_iter().chain(*b"0\n").collect(),
            ":18: ignored 1 faces without corners",
        ),
        (MeshFormat::Ply, wide, "the header has 64-bit integers, which PLY does not define"),
        (
            MeshFormat::Stl,
            [binary_stl(b"", &[FIRST, SECOND]), vec![0]].concat(),
            "ignored 1 bytes after the last triangle",
        ),
        (MeshFormat::Stl, of_solid.into_bytes(), ":18: ignored 3 words after the last facet"),
        (
            MeshFormat::Obj,
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf\nf 1 2 3\nf 2 4 3".to_vec(),
            ":5: ignored 1 faces without corners",
        ),
        (
            MeshFormat::Off,
            b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n3 0 1 2".to_vec(),
            ":9: ignored 4 words after the last face",
        ),
    ];
    for (format, bytes, warning) in cases {
        let mesh = read_bytes("a", format, &bytes, &ReadOptions::default()).unwrap();
        let place = if warning.starts_with(':') { "a" } else { "a: " };
        assert_eq!(mesh.warnings, [format!("{place}{warning}")]);
        assert_eq!(TriangleMesh { warnings: Vec::new(), ..mesh }, two_triangles());
    }
}

/// Ply polygons become triangles and other elements are passed over.
#[test]
fn ply_polygons_become_triangles() {
    let header = HEADER.replace(
        "element face 2",
        "element edge 1\nproperty int a\nproperty list uint float b\nelement face 4",
    );
    let body = BODY.replace("3 0 1 2\n3 1 3 2\n", "7 2 0.5 1e-3\n4 0 1 3 2\n2 1 3\n1 2\n3 0 1 2");
    let mesh = ply(header + &body).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 3], [0, 3, 2], [1, 3, 3], [2, 2, 2], [0, 1, 2]]);
}

/// Bad ply is refused with its line.
#[test]
fn invalid_ply_is_rejected() {
    let text = |from: &str, to: &str| format!("{HEADER}{BODY}").replacen(from, to, 1).into_bytes();
    let binary = binary_ply("binary_little_endian", little_endian);
    let cut = binary[..binary.len() - 1].to_vec();
    assert_refused(
        &[
            (vec![], "a.ply: the mesh has no vertices"),
            (b"obj\n".to_vec(), "a.ply:1: this does not fit a PLY header: \"obj\""),
            (
                text("property double z\n", "property double\n"),
                "a.ply:7: this does not fit a PLY header: \"property double\"",
            ),
            (
                HEADER.as_bytes()[..100].to_vec(),
                "a.ply:7: this does not fit a PLY header: \"propert\"",
            ),
            (
                HEADER.as_bytes()[..HEADER.len() - 11].to_vec(),
                "a.ply:10: the file ends in a PLY header",
            ),
            (
                text("property double z\n", ""),
                "a.ply: the header lacks an element vertex with the properties x, y and z",
            ),
            (
                text("vertex_indices", "corners"),
                "a.ply: the header lacks an element face with a list property vertex_indices",
            ),
            (
                text("vertex 4", "vertex 4000000000"),
                "a.ply: the file ends in vertex 6 of 4000000000",
            ),
            (text("vertex 4", "vertex 0"), "a.ply: the mesh has no vertices"),
            (text("face 2", "face 3"), "a.ply: the file ends in face 2 of 3"),
            (text("1 0 0 9", "1 x 0 9"), "a.ply:13: a value should be a number, found \"x\""),
            (
                text("1 0 0 9", "1 1e39 0 9"),
                "a.ply:13: vertex 1 has the coordinate inf: not a finite f32",
            ),
            (
                text("3 1 3 2", "3 1 4 2"),
                "a.ply:17: triangle 1 names vertex 4, but the vertices are 0 to 3",
            ),
            (
                text("3 1 3 2", "3 1 -3 2"),
                "a.ply:17: triangle 1 names vertex -3, but the vertices are 0 to 3",
            ),
            (cut, "a.ply: the file ends in face 1 of 2"),
        ],
        ply,
    );
}

/// Elements without properties take no bytes: their count must cost neither time nor memory.
#[test]
fn a_count_without_data_costs_nothing() {
    let file = binary_ply("binary_little_endian", little_endian);
    let start = file.windows(12).position(|window| window == b"element face").unwrap();
    let empty = b"element nothing 18446744073709551615\n".to_vec();
    let file = [&file[..start], &empty, &file[start..]].concat();
    assert_eq!(ply(file).unwrap(), two_triangles());
}
