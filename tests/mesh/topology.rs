//! Components, closedness and counts of small meshes that are easy to get wrong, and of the shipped
//! meshes.

use glam::Vec3;
use sdop::mesh::topology::{Component, Topology, without_area};
use sdop::mesh::{MAX_COORDINATE, ReadOptions, TriangleMesh, read};

use crate::forms::BOX_FACES;

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn topology(vertices: usize, triangles: &[[u32; 3]]) -> Topology {
    let vertices = (0..vertices).map(|i| Vec3::splat(i as f32)).collect::<Vec<_>>();
    Topology::of(&TriangleMesh::new("mesh", vertices, triangles.to_vec()).unwrap())
}

fn closed(topology: &Topology) -> Vec<bool> {
    topology.components.iter().map(Component::is_closed).collect()
}

/// Components are joined by vertices and each is closed or open by itself.
#[test]
fn components_close_independently() {
    let second = TETRAHEDRON.map(|t| t.map(|i| i + 4));
    let both = topology(9, &[&second[..], &TETRAHEDRON[..3]].concat());
    assert_eq!(closed(&both), [false, true]);
    assert_eq!(both.component_of, [1, 1, 1, 1, 0, 0, 0]);
    assert_eq!(both.unused_vertices, 1);
    assert_eq!(both.components[0].boundary_edges, 3);
    assert_eq!(both.components[0].euler_characteristic(), 1);
    assert_eq!(both.components[1].euler_characteristic(), 2);
    assert_eq!(both.closed_components(), 1);

    let at_one_vertex = topology(7, &[TETRAHEDRON, TETRAHEDRON.map(|t| t.map(|i| i + 3))].concat());
    assert_eq!(closed(&at_one_vertex), [true]);
    assert_eq!(at_one_vertex.total().edges, 12);
}

/// An edge of three faces is not closed.
#[test]
fn three_faces_are_not_closed() {
    let fin = topology(5, &[&TETRAHEDRON[..], &[[0, 1, 4]]].concat());
    assert_eq!(closed(&fin), [false]);
    assert_eq!((fin.total().boundary_edges, fin.total().non_manifold_edges), (2, 1));
    let double = topology(4, &[TETRAHEDRON, TETRAHEDRON].concat());
    assert_eq!(closed(&double), [false]);
    assert_eq!(double.total().non_manifold_edges, 6);
}

#[test]
fn degenerate_triangles_are_no_faces() {
    let with_sliver = topology(4, &[&TETRAHEDRON[..], &[[0, 1, 1]]].concat());
    assert_eq!(closed(&with_sliver), [true]);
    assert_eq!((with_sliver.total().triangles, with_sliver.total().degenerate), (5, 1));
    let joined = topology(
        8,
        &[&TETRAHEDRON[..], &TETRAHEDRON.map(|t| t.map(|i| i + 4)), &[[0, 7, 7]]].concat(),
    );
    assert_eq!(closed(&joined), [true]);
    let point = topology(1, &[[0, 0, 0]]);
    assert_eq!(closed(&point), [false]);
    assert_eq!((point.total().edges, point.total().vertices), (0, 1));
}

/// A box whose triangles have vertices of their own, at 0 or −0, is closed; so is one by its
/// indices that touches it.
#[test]
fn equal_positions_are_one_vertex() {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|bit| bit as f32);
    let own = BOX_FACES.as_flattened().iter().enumerate();
    let own = own.map(|(n, &i)| corner(i as usize).map(|x| if n % 2 == 0 { -x } else { 0.0 - x }));
    let mut vertices: Vec<[f32; 3]> = own.collect();
    let mut triangles: Vec<[u32; 3]> = (0..12).map(|t| [0, 1, 2].map(|i| 3 * t + i)).collect();
    let open = TriangleMesh::new("box", vertices.clone(), triangles[1..].to_vec()).unwrap();
    assert_eq!(closed(&Topology::of(&open)), [false]);
    triangles.extend(BOX_FACES.map(|t| t.map(|i| i + 36)));
    vertices.extend((0..8).map(corner));
    let mesh = TriangleMesh::from_f32(&vertices, &triangles).unwrap();
    let topology = Topology::of(&mesh);
    assert_eq!(closed(&topology), [true, true]);
    assert_eq!((topology.merged_vertices, topology.total().vertices), (28, 16));
    assert_eq!(topology.components[0].euler_characteristic(), 2);
}

/// What data/meshes/README.md says of each file.
#[test]
fn shipped_meshes_match_their_table() {
    let expected = [
        // vertices, unused, triangles, components, closed, boundary edges
        ("spot", [2930, 0, 5856, 1, 1, 0]),
        ("teapot", [3644, 0, 6320, 3, 0, 160]),
        ("bunny", [35947, 1113, 69451, 1, 0, 223]),
        ("bunny-4k", [2066, 0, 4000, 1, 0, 138]),
    ];
    for (name, counts) in expected {
        let path = format!("data/meshes/{name}.tri");
        let mesh = read(&path, &ReadOptions::default()).unwrap();
        let topology = Topology::of(&mesh);
        let found = [
            mesh.vertices.len(),
            topology.unused_vertices,
            mesh.triangles.len(),
            topology.components.len(),
            topology.closed_components(),
            topology.total().boundary_edges,
        ];
        assert_eq!(mesh.name, name);
        assert_eq!(found, counts, "{name}");
        assert_eq!(topology.total().non_manifold_edges, 0, "{name}");
        let others = topology.unused_vertices + topology.merged_vertices;
        assert_eq!(topology.total().vertices + others, mesh.vertices.len());
    }
}

#[test]
fn a_mesh_keeps_its_contract() {
    let message = |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| {
        let vertices = vertices.iter().copied().map(Vec3::from_array).collect::<Vec<_>>();
        TriangleMesh::new("knob", vertices, triangles.to_vec()).unwrap_err().problem()
    };
    let (point, triangle) = ([0.0; 3], [0, 0, 0]);
    let above = f32::from_bits(MAX_COORDINATE.to_bits() + 1);
    let cases = [
        (message(&[], &[triangle]), "knob: the mesh has no vertices"),
        (message(&[point], &[]), "knob: the mesh has no triangles"),
        (
            message(&[point], &[triangle, [0, 1, 0]]),
            "knob: triangle 1 names vertex 1, but the vertices are 0 to 0",
        ),
        (
            message(&[point, [0.0, f32::NEG_INFINITY, 0.0]], &[triangle]),
            "knob: vertex 1 has the coordinate -inf: not a finite f32",
        ),
        (
            message(&[[0.0, 0.0, -above]], &[triangle]),
            "knob: vertex 0 has the coordinate -1.1529216e18: beyond 2^60",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
    let largest = Vec3::splat(-MAX_COORDINATE);
    assert!(TriangleMesh::new("largest", vec![largest], vec![triangle]).is_ok());
}

/// Exactly: the last triangle's corners are on a line but for half an ulp.
#[test]
fn triangles_without_area_are_counted() {
    let vertices = [
        [0.0, 0.0, 0.0],
        [1.0, 1.0, 1.0],
        [3.0, 3.0, 3.0],
        [0.0, 0.0, -0.0],
        [3.0, 3.0, 3.0000002],
    ];
    let triangles = vec![[0, 1, 1], [0, 1, 2], [0, 3, 2], [2, 2, 2], [0, 1, 4]];
    let mesh = TriangleMesh::new("a", vertices, triangles).unwrap();
    assert_eq!(without_area(&mesh), 4);
    assert_eq!(Topology::of(&mesh).total().degenerate, 3);
}
