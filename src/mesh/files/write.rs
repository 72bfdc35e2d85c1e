//! Writing a mesh file; the extension selects the format.
//!
//! Coordinates are the shortest decimals that read back to the same f32, or to the same f64 for a
//! mesh that is far, or nearly far, from its origin. A mesh that is written and read again is the
//! same to the bit. `.tri` files have Bourke's dialect, in which vertices also have a unit normal
//! and a colour. The normal is the area-weighted sum of the adjacent triangles' normals with three
//! decimals, for display only; a vertex without triangles has the normal 0 0 1.

use std::path::Path;

use glam::DVec3;

use super::text::{put, shortest, wide};
use super::{MeshFormat, stl};
use crate::files;
use crate::mesh::far::place;
use crate::mesh::{MeshError, Problem, TriangleMesh, in_f64};

/// Writes a mesh in the format of the path's extension. The file appears only when it is complete.
///
/// # Errors
/// An unknown extension, or a file that cannot be written.
pub fn write(mesh: &TriangleMesh, path: impl AsRef<Path>) -> Result<(), MeshError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    let format = MeshFormat::of_path(path, "written").map_err(|problem| problem.at(&file, None))?;
    files::write(path, write_bytes(mesh, format))
        .map_err(|source| Problem::Io { action: "write", source }.at(&file, None))
}

/// The contents of a mesh file.
pub fn write_bytes(mesh: &TriangleMesh, format: MeshFormat) -> Vec<u8> {
    match format {
        MeshFormat::Tri => tri_text(mesh).into_bytes(),
        MeshFormat::Obj => obj_text(mesh).into_bytes(),
        MeshFormat::Stl => stl::bytes(mesh),
        MeshFormat::Ply => ply_text(mesh).into_bytes(),
        MeshFormat::Off => off_text(mesh).into_bytes(),
    }
}

/// The mesh as a `.tri` file in Bourke's dialect.
fn tri_text(mesh: &TriangleMesh) -> String {
    let mut text = format!("{} {}\n", mesh.vertices.len(), mesh.triangles.len());
    for ([x, y, z], normal) in coordinates(mesh).zip(vertex_normals(mesh)) {
        let [nx, ny, nz] = normal.to_array().map(three_decimals);
        put(&mut text, format_args!("{x} {y} {z} {nx} {ny} {nz} 1 1 1\n"));
    }
    for [a, b, c] in &mesh.triangles {
        put(&mut text, format_args!("{a} {b} {c}\n"));
    }
    text
}

/// The mesh as a Wavefront OBJ file.
fn obj_text(mesh: &TriangleMesh) -> String {
    let mut text = String::new();
    for [x, y, z] in coordinates(mesh) {
        put(&mut text, format_args!("v {x} {y} {z}\n"));
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| u64::from(index) + 1);
        put(&mut text, format_args!("f {a} {b} {c}\n"));
    }
    text
}

/// The mesh as a text PLY file.
fn ply_text(mesh: &TriangleMesh) -> String {
    let real = if mesh.is_far() { "double" } else { "float" };
    let header = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty {real} x\nproperty {real} y\nproperty {real} z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    );
    listed(mesh, header)
}

/// The mesh as an OFF file.
fn off_text(mesh: &TriangleMesh) -> String {
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    listed(mesh, format!("OFF\n{vertices} {triangles} 0\n"))
}

/// A header, then a line for each vertex, and for each triangle with its number of corners.
fn listed(mesh: &TriangleMesh, mut text: String) -> String {
    for [x, y, z] in coordinates(mesh) {
        put(&mut text, format_args!("{x} {y} {z}\n"));
    }
    for [a, b, c] in &mesh.triangles {
        put(&mut text, format_args!("3 {a} {b} {c}\n"));
    }
    text
}

/// Each vertex's coordinates as text that reads back exactly: the shortest f32 if the mesh would be
/// read back without an offset, otherwise the f64.
fn coordinates(mesh: &TriangleMesh) -> impl Iterator<Item = [String; 3]> + '_ {
    let short = !mesh.is_far() && stays_when_shortened(mesh);
    let word = move |x: f64| if short { shortest(x as f32) } else { wide(x) };
    mesh.points().map(move |point| point.map(word))
}

/// Whether a mesh without an offset would be read back without one from the shortest decimals of
/// its f32, which are other numbers as f64.
fn stays_when_shortened(mesh: &TriangleMesh) -> bool {
    let shortened = |x: f64| shortest(x as f32).parse().unwrap_or(x);
    let points: Vec<[f64; 3]> = mesh.points().map(|point| point.map(shortened)).collect();
    let placed = place(&points);
    placed.offset == [0.0; 3] && placed.rounding == 0.0
}

fn three_decimals(value: f64) -> f64 {
    // Adding 0 turns −0 into 0.
    libm::round(value * 1000.0) / 1000.0 + 0.0
}

/// Area-weighted vertex normals; the cross product of a triangle's edges is its unit normal times
/// twice its area.
fn vertex_normals(mesh: &TriangleMesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| in_f64(&mesh.vertices[i as usize]));
        for &corner in triangle {
            sums[corner as usize] += (b - a).cross(c - a);
        }
    }
    sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Z)).collect()
}
