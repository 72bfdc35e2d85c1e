//! Binary STL and PLY files: what is read, and what is wrong with an invalid one.

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
        let found = read(bytes.clone()).unwrap_err().to_string();
        assert_eq!(&found, expected, "{}", String::from_utf8_lossy(bytes));
    }
}

/// Two triangles that share the edge from x to y.
fn two_triangles() -> TriangleMesh {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    TriangleMesh::new("a", vertices, vec![[0, 1, 2], [1, 3, 2]]).unwrap()
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

/// Many exporters start the header of a binary file with the word that marks a text file.
#[test]
fn length_identifies_binary_stl() {
    for header in ["", "solid plane", "solid plane\n", "exported \u{7}"] {
        assert_eq!(stl(binary_stl(header.as_bytes(), &[FIRST, SECOND])).unwrap(), two_triangles());
    }
}

#[test]
fn invalid_binary_stl_is_rejected() {
    let long = [binary_stl(b"", &[FIRST]), vec![0]].concat();
    let short = binary_stl(b"", &[FIRST])[..133].to_vec();
    let nan = binary_stl(b"", &[FIRST, [[0.0; 3], [0.0, f32::NAN, 0.0], [0.0; 3]]]);
    let marked = [&binary_stl(b"solid", &[FIRST, SECOND])[..84], &[7, 7]].concat();
    assert_refused(
        &[
            (binary_stl(b"", &[]), "a.stl: the mesh has no vertices"),
            (long, "a.stl: a binary STL file of 1 triangles has 134 bytes, this one has 135"),
            (short, "a.stl: a binary STL file of 1 triangles has 134 bytes, this one has 133"),
            (marked, "a.stl: a binary STL file of 2 triangles has 184 bytes, this one has 86"),
            (nan, "a.stl: vertex 4 has the coordinate NaN: not a finite f32"),
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
    assert_eq!(ply(binary_ply("binary_little_endian", little_endian)).unwrap(), two_triangles());
    assert_eq!(ply(binary_ply("binary_big_endian", big_endian)).unwrap(), two_triangles());
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

#[test]
fn invalid_binary_ply_is_rejected() {
    let binary = binary_ply("binary_little_endian", little_endian);
    let cut = binary[..binary.len() - 1].to_vec();
    let long = [binary, vec![7, 7]].concat();
    assert_refused(
        &[
            (cut, "a.ply: the file ends in face 1 of 2"),
            (long, "a.ply: 2 bytes too many after the last element"),
        ],
        ply,
    );
}
