//! Connected components, and which of them are closed.
//!
//! A component is a set of triangles joined by shared vertices. It is closed if each of its edges
//! is shared by exactly two faces. Only a closed component has an inside, which exact intersection
//! needs (odd ray parity). Triangles with a repeated vertex join components but do not count as
//! faces, so a component without other triangles is open.
//!
//! Many files have several vertices at one position, one for each normal or texture coordinate.
//! Therefore components that their indices don't close are joined again with one vertex per
//! position. Components that are closed by their indices stay apart, even if they touch others.

use std::collections::HashMap;

use robust::{Coord, orient2d};

use super::TriangleMesh;

/// Counts of one connected component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Component {
    /// Vertices that its triangles use.
    pub vertices: usize,
    /// Triangles, degenerate ones included.
    pub triangles: usize,
    /// Triangles with a repeated index.
    pub degenerate: usize,
    /// Edges of its faces.
    pub edges: usize,
    /// Edges of exactly one face.
    pub boundary_edges: usize,
    /// Edges of three faces or more.
    pub non_manifold_edges: usize,
}

impl Component {
    /// Every edge shared by exactly two faces, and at least one face.
    pub fn is_closed(&self) -> bool {
        self.edges > 0 && self.boundary_edges == 0 && self.non_manifold_edges == 0
    }

    /// Vertices − edges + faces: 2 for a sphere, 0 for a torus.
    pub fn euler_characteristic(&self) -> i64 {
        (self.vertices + self.triangles - self.degenerate) as i64 - self.edges as i64
    }
}

/// A mesh's components and their sums.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topology {
    /// The components, in the order of their lowest vertex index.
    pub components: Vec<Component>,
    /// For each triangle, the index of its component.
    pub component_of: Vec<usize>,
    /// Vertices that no triangle uses.
    pub unused_vertices: usize,
    /// Vertices of open components that count as the first vertex at their position.
    pub merged_vertices: usize,
}

impl Topology {
    /// Finds the components of a mesh.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let by_index = Self::by_index(mesh.vertices.len(), &mesh.triangles);
        let (triangles, merged_vertices) = by_index.merge(mesh);
        if merged_vertices == 0 {
            return by_index;
        }
        let merged = Self::by_index(mesh.vertices.len(), &triangles);
        Self { unused_vertices: by_index.unused_vertices, merged_vertices, ..merged }
    }

    /// The triangles with one vertex, the first, per position in open components, and how many
    /// vertices that replaces.
    fn merge(&self, mesh: &TriangleMesh) -> (Vec<[u32; 3]>, usize) {
        let mut at = HashMap::new();
        let mut merged: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
        for (triangle, &component) in mesh.triangles.iter().zip(&self.component_of) {
            if !self.components[component].is_closed() {
                for &vertex in triangle {
                    // x + 0.0 turns −0 into 0 and changes nothing else.
                    let position = mesh.vertices[vertex as usize].map(|x| (x + 0.0).to_bits());
                    merged[vertex as usize] = *at.entry(position).or_insert(vertex);
                }
            }
        }
        let count = (0..).zip(&merged).filter(|(vertex, first)| vertex != *first).count();
        (mesh.triangles.iter().map(|t| t.map(|vertex| merged[vertex as usize])).collect(), count)
    }

    fn by_index(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let roots = vertex_roots(vertices, triangles);
        let mut number_of_root = HashMap::new();
        let mut used = vec![false; vertices];
        for &index in triangles.as_flattened() {
            used[index as usize] = true;
        }
        let mut components: Vec<Component> = Vec::new();
        for (vertex, _) in used.iter().enumerate().filter(|&(_, used)| *used) {
            let number = *number_of_root.entry(roots[vertex]).or_insert_with(|| {
                components.push(Component::default());
                components.len() - 1
            });
            components[number].vertices += 1;
        }
        let component_of: Vec<usize> =
            triangles.iter().map(|t| number_of_root[&roots[t[0] as usize]]).collect();
        for (triangle, &number) in triangles.iter().zip(&component_of) {
            components[number].triangles += 1;
            components[number].degenerate += usize::from(!is_face(triangle));
        }
        for ((a, _), faces) in edge_counts(triangles) {
            let component = &mut components[number_of_root[&roots[a as usize]]];
            component.edges += 1;
            component.boundary_edges += usize::from(faces == 1);
            component.non_manifold_edges += usize::from(faces > 2);
        }
        let unused_vertices = used.iter().filter(|used| !**used).count();
        Self { components, component_of, unused_vertices, merged_vertices: 0 }
    }

    /// The whole mesh's counts, summed over its components (unused vertices belong to none).
    pub fn total(&self) -> Component {
        self.components.iter().fold(Component::default(), |sum, c| Component {
            vertices: sum.vertices + c.vertices,
            triangles: sum.triangles + c.triangles,
            degenerate: sum.degenerate + c.degenerate,
            edges: sum.edges + c.edges,
            boundary_edges: sum.boundary_edges + c.boundary_edges,
            non_manifold_edges: sum.non_manifold_edges + c.non_manifold_edges,
        })
    }

    /// How many components are closed.
    pub fn closed_components(&self) -> usize {
        self.components.iter().filter(|c| c.is_closed()).count()
    }
}

/// How many triangles have no area, decided exactly: a repeated index, two equal corners, or three
/// corners on a line.
///
/// Those with three different indices still count as faces of their component.
#[must_use]
pub fn without_area(mesh: &TriangleMesh) -> usize {
    mesh.triangles.iter().filter(|triangle| !has_area(mesh, triangle)).count()
}

/// Whether a triangle's corners are not on a line.
pub(super) fn has_area(mesh: &TriangleMesh, triangle: &[u32; 3]) -> bool {
    let corners = triangle.map(|i| mesh.vertices[i as usize]);
    // Points are on a line exactly if their projections onto all three coordinate planes are.
    [(0, 1), (1, 2), (2, 0)].iter().any(|&(x, y)| {
        let [a, b, c] = corners.map(|v| Coord { x: f64::from(v[x]), y: f64::from(v[y]) });
        orient2d(a, b, c) != 0.0
    })
}

fn is_face([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// How many faces share each edge, keyed by (lower, higher) vertex index.
fn edge_counts(triangles: &[[u32; 3]]) -> HashMap<(u32, u32), u32> {
    let mut counts = HashMap::with_capacity(triangles.len() * 3 / 2);
    for &[a, b, c] in triangles.iter().filter(|t| is_face(t)) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *counts.entry((from.min(to), from.max(to))).or_default() += 1;
        }
    }
    counts
}

/// Union–find over vertices with path halving: for each vertex the representative of its component.
fn vertex_roots(vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertices as u32).collect();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c)] {
            let (from, to) = (root(&mut parent, from), root(&mut parent, to));
            parent[from.max(to) as usize] = from.min(to);
        }
    }
    (0..parent.len() as u32).map(|vertex| root(&mut parent, vertex)).collect()
}

fn root(parent: &mut [u32], mut vertex: u32) -> u32 {
    while parent[vertex as usize] != vertex {
        let grandparent = parent[parent[vertex as usize] as usize];
        parent[vertex as usize] = grandparent;
        vertex = grandparent;
    }
    vertex
}
