//! Decimation: the surface keeps its topology and its place, and the result is the same everywhere.

use glam::Vec3;
use sdop::mesh::topology::Topology;
use sdop::mesh::{MeshFormat, ProceduralShape, ReadOptions, TriangleMesh, read, write_bytes};
use sdop_bench::decimate::decimate;

use super::{sha256, signed_volume};

fn shape(name: &str, sizes: &[(&str, f64)]) -> TriangleMesh {
    ProceduralShape::from_name(name, sizes).unwrap().build().unwrap()
}

/// Closed surfaces stay closed and keep their volume.
#[test]
fn decimation_keeps_surfaces_closed() {
    let fine_box = subdivided(shape("box", &[]), 3);
    let cases = [
        (shape("icosphere", &[("subdivisions", 4.0)]), 400, 0.02),
        (shape("torus", &[]), 500, 0.03),
        (shape("knot", &[]), 800, 0.06),
        (fine_box, 12, 1e-6),
        (read("data/meshes/spot.tri", &ReadOptions::default()).unwrap(), 1000, 0.01),
    ];
    for (mesh, target, tolerance) in cases {
        let coarse = decimate(&mesh, target);
        let (before, after) = (Topology::of(&mesh), Topology::of(&coarse));
        assert_eq!(coarse.triangles.len(), target, "{}", mesh.name);
        assert_eq!(after.components.len(), 1, "{}", mesh.name);
        assert!(after.components[0].is_closed(), "{}", mesh.name);
        assert_eq!(
            after.components[0].euler_characteristic(),
            before.components[0].euler_characteristic(),
            "{}",
            mesh.name
        );
        assert_eq!(after.unused_vertices, 0);
        let ratio = signed_volume(&coarse) / signed_volume(&mesh);
        assert!((ratio - 1.0).abs() < tolerance, "{}: {ratio} of the volume", mesh.name);
        TriangleMesh::new("valid", coarse.vertices, coarse.triangles).unwrap();
    }
}

/// Each triangle in four, flat: planes whose inner vertices cost nothing to remove.
fn subdivided(mesh: TriangleMesh, times: u32) -> TriangleMesh {
    let mut mesh = mesh;
    for _ in 0..times {
        let mut edges = std::collections::HashMap::new();
        let mut vertices = mesh.vertices.clone();
        let mut triangles = Vec::new();
        for [a, b, c] in mesh.triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| {
                *edges.entry((from.min(to), from.max(to))).or_insert_with(|| {
                    let [a, b] = [from, to].map(|end| Vec3::from(vertices[end as usize]));
                    vertices.push(((a + b) * 0.5).to_array());
                    vertices.len() as u32 - 1
                })
            });
            triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        mesh = TriangleMesh::new(mesh.name, vertices, triangles).unwrap();
    }
    mesh
}

/// A flat square with a hole's worth of boundary: the corners must survive, far from the origin
/// too.
#[test]
fn an_open_boundary_keeps_its_place() {
    for offset in [Vec3::ZERO, Vec3::new(4096.0, -8192.0, 1024.0)] {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y].map(|v| v + offset);
        let square =
            TriangleMesh::new("square", corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let coarse = decimate(&subdivided(square, 4), 2);
        assert_eq!(coarse.triangles.len(), 2);
        assert_eq!(coarse.vertices, corners.map(|corner| corner.to_array()));
    }
}

#[test]
fn what_cannot_shrink_is_left_alone() {
    let tetrahedron = |apex: Vec3| {
        let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, apex];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        TriangleMesh::new("tetrahedron", vertices, triangles).unwrap()
    };
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let triangle = TriangleMesh::new("one", corners, vec![[0, 1, 2]]).unwrap();
    let point = TriangleMesh::new("point", vec![Vec3::ONE], vec![[0, 0, 0]; 3]).unwrap();
    // Over the low one's base two triangles could fall onto each other without turning over.
    let low = tetrahedron(Vec3::new(0.3, 0.3, 0.01));
    for mesh in [tetrahedron(Vec3::Z), low, triangle, point] {
        assert_eq!(decimate(&mesh, mesh.triangles.len()), mesh);
        assert_eq!(decimate(&mesh, 0), mesh);
    }
}

/// Three vertices about a tube share neighbours without sharing a face: collapsing their edges
/// would pinch it off.
#[test]
fn the_last_triangles_keep_the_genus() {
    for (name, sizes) in [
        ("torus", &[("sides", 3.0), ("segments", 24.0)][..]),
        ("torus", &[]),
        ("gear", &[]),
        ("knot", &[("sides", 4.0)]),
        ("box", &[]),
    ] {
        let mesh = shape(name, sizes);
        let least = decimate(&mesh, 0);
        let (before, after) = (Topology::of(&mesh), Topology::of(&least));
        assert!(least.triangles.len() < mesh.triangles.len(), "{name}");
        assert_eq!(after.closed_components(), 1, "{name}");
        assert_eq!(
            after.components[0].euler_characteristic(),
            before.components[0].euler_characteristic(),
            "{name}"
        );
    }
}

/// The shipped bunny-4k is what the converter makes of the shipped bunny, on this platform too.
#[test]
fn shipped_bunny_is_reproduced() {
    let bunny = read("data/meshes/bunny.tri", &ReadOptions::default()).unwrap();
    let shipped = std::fs::read("data/meshes/bunny-4k.tri").unwrap();
    assert_eq!(sha256(&write_bytes(&decimate(&bunny, 4000), MeshFormat::Tri)), sha256(&shipped));
}
