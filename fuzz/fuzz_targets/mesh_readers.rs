//! No input makes a mesh reader panic, and the meshes that it accepts keep the contract, in every
//! format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sdop::mesh::{MeshFormat, ReadOptions, TriangleMesh, read_bytes, write_bytes};

const FORMATS: [MeshFormat; 5] =
    [MeshFormat::Tri, MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Ply, MeshFormat::Off];

fuzz_target!(|data: &[u8]| {
    let Some((which, bytes)) = data.split_first() else {
        return;
    };
    let format = FORMATS[usize::from(*which) % FORMATS.len()];
    let Ok(mesh) = read_bytes("fuzz", format, bytes, &ReadOptions::default()) else {
        return;
    };
    let checked =
        TriangleMesh::new(mesh.name.clone(), mesh.vertices.clone(), mesh.triangles.clone());
    assert!(checked.is_ok(), "an accepted mesh is outside the contract");
    let obj = write_bytes(&mesh, MeshFormat::Obj);
    let again = read_bytes("fuzz", MeshFormat::Obj, &obj, &ReadOptions::default());
    assert_eq!(again.map(|m| m.triangles).ok(), Some(mesh.triangles));
});
