//! STL and PLY files, text and binary: what is read, and where an invalid file is wrong.

use glam::Vec3;
use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn stl(bytes: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("a.stl", MeshFormat::Stl, bytes.as_ref(), &ReadOptions::default())
}

fn ply(bytes: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("a.ply", MeshFormat::Ply, bytes.as_ref(), &ReadOptions::default())
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

/// A binary file that is cut or has a coordinate that is no number.
#[test]
fn invalid_binary_stl_is_rejected() {
    let message = |bytes: &[u8]| stl(bytes).unwrap_err().problem();
    assert_eq!(message(&binary_stl(b"", &[])), "a.stl: the mesh has no vertices");
    assert_eq!(
        message(&binary_stl(b"solid", &[FIRST])[..133]),
        "a.stl: a binary STL file of 1 triangles has 134 bytes, this one has 133"
    );
    let nan = binary_stl(b"", &[FIRST, [[0.0; 3], [0.0, f32::NAN, 0.0], [0.0; 3]]]);
    assert_eq!(message(&nan), "a.stl: vertex 4 has the coordinate NaN: not a finite f32");
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
    let binary = binary_ply("binary_big_endian", big_endian);
    assert_eq!(ply(&binary).unwrap(), two_triangles());
    let cut = ply(&binary[..binary.len() - 1]).unwrap_err();
    assert_eq!(cut.problem(), "a.ply: the file ends in face 1 of 2");
}

/// What follows the last element, and 64-bit integers, are read with a warning, as other programs
/// read them.
#[test]
fn harmless_faults_are_warned_of() {
    let binary = binary_ply("binary_little_endian", little_endian);
    let (points, indices) = binary.split_at(binary.len() - 2 * 13);
    let header = HEADER.replace("ascii", "binary_little_endian");
    let wide_indices = indices.chunks(13).flat_map(|face| {
        let index = |i: &[u8]| [i, &[0; 4]].concat();
        [vec![3], face[1..].chunks(4).flat_map(index).collect()].concat()
    });
    let wide_header = header.replace("uchar int ", "uchar int64 ");
    let wide =
        [wide_header.as_bytes(), &points[header.len()..], &wide_indices.collect::<Vec<u8>>()];
    let long_stl = [binary_stl(b"", &[FIRST, SECOND]), vec![0]].concat();
    let (long_ply, wide) = ([&binary[..], &[7, 7]].concat(), wide.concat());
    for (format, bytes, warning) in [
        (MeshFormat::Ply, long_ply, "ignored 2 bytes after the last element"),
        (MeshFormat::Ply, wide, "the header has 64-bit integers, which PLY does not define"),
        (MeshFormat::Stl, long_stl, "ignored 1 bytes after the last triangle"),
    ] {
        let mesh = read_bytes("a", format, &bytes, &ReadOptions::default()).unwrap();
        assert_eq!(mesh.warnings, [format!("a: {warning}")]);
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

/// Elements without properties take no bytes: their count must cost neither time nor memory.
#[test]
fn a_count_without_data_costs_nothing() {
    let file = binary_ply("binary_little_endian", little_endian);
    let start = file.windows(12).position(|window| window == b"element face").unwrap();
    let empty = b"element nothing 18446744073709551615\n".to_vec();
    let file = [&file[..start], &empty, &file[start..]].concat();
    assert_eq!(ply(file).unwrap(), two_triangles());
}
