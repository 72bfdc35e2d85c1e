//! The mesh room: readers, writers, validation, topology, shapes and decimation.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod decimate;
mod far;
mod obj;
mod off;
mod prop;
mod scale;
mod shapes;
mod stl_ply;
mod tolerant;
mod topology;
mod tri;

use std::path::Path;

use crate::changed::changed;
use crate::{answers, forms};
use sdop::mesh::{MeshFormat, ReadOptions, TriangleMesh, read_bytes};
use sha2::{Digest, Sha256};

/// Six times the signed volume is the sum of det(a, b, c): positive when counter-clockwise faces
/// look outward.
fn signed_volume(mesh: &TriangleMesh) -> f64 {
    let corner = |i: u32| glam::Vec3::from(mesh.vertices[i as usize]).as_dvec3();
    let six_volumes =
        mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))));
    six_volumes.sum::<f64>() / 6.0
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What is said of each file: its size with warnings, or the error.
#[test]
fn files_get_their_messages() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mesh/errors.txt");
    let (mut name, mut whole) = (String::new(), String::new());
    answers::check(Path::new(path), |input| {
        let text = changed(input, &whole).unwrap_or_else(|| {
            let (first, text) = input.split_once('\n').unwrap_or((input, ""));
            name = first.to_owned();
            whole = if text.is_empty() { String::new() } else { format!("{text}\n") };
            whole.clone()
        });
        let format = MeshFormat::from_path(Path::new(&name)).unwrap();
        match read_bytes(&name, format, &bytes(&text), &ReadOptions::default()) {
            Err(error) => error.problem(),
            Ok(mesh) => {
                let size =
                    format!("{} vertices, {} triangles", mesh.vertices.len(), mesh.triangles.len());
                [vec![size], mesh.warnings].concat().join("\n")
            }
        }
    });
}

/// `\xNN` is a byte.
fn bytes(text: &str) -> Vec<u8> {
    let mut parts = text.split("\\x");
    let first = parts.next().unwrap_or_default().as_bytes().to_vec();
    parts.fold(first, |mut bytes, part| {
        bytes.push(u8::from_str_radix(&part[..2], 16).unwrap());
        bytes.extend(part[2..].bytes());
        bytes
    })
}
