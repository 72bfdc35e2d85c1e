//! A mesh prepared for exact judgement: its tree, its components and which of them are closed.
//!
//! A component is a set of triangles that shared vertices join. It is closed if each edge of its
//! faces is shared by exactly two of them. Triangles that name a vertex twice belong to the surface
//! but do not count as faces. Only closed components have an inside.
//!
//! Vertices are first told apart by their indices. Components that are then open are joined again
//! with one vertex per position: a box whose faces have vertices of their own is a box.

use dashu_int::IBig;

use super::tree::Tree;
use crate::InvalidInput;
use crate::linear::{Vector, cross, largest, sub};
use crate::number::{Number, unit_of};
use crate::volume::check_mesh;

/// A connected part of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Component {
    /// One of its vertices.
    pub vertex: u32,
    /// Whether it has an inside.
    pub closed: bool,
}

/// A mesh, its tree and its components.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Corners of each triangle.
    pub triangles: Vec<[Vector<f64>; 3]>,
    /// The component of each triangle.
    pub component_of: Vec<u32>,
    /// The components.
    pub components: Vec<Component>,
    /// A vertex of each component.
    pub representatives: Vec<Vector<f64>>,
    /// Boxes over the triangles.
    pub tree: Tree,
    /// Largest |coordinate|.
    pub reach: f64,
    /// All coordinates are multiples of 2^unit.
    pub unit: i32,
}

impl Mesh {
    /// Prepares a mesh. Vertices that no triangle uses are not part of it.
    ///
    /// # Errors
    /// When a vertex is not finite or an index is out of range.
    pub fn new(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, InvalidInput> {
        check_mesh(vertices, triangles)?;
        Ok(Self::checked(vertices, triangles))
    }

    /// [`Mesh::new`] of a mesh that was checked before.
    pub(crate) fn checked(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let (mut components, mut component_of) = components(vertices.len(), triangles);
        let merged = merge(vertices, triangles, |t| components[component_of[t] as usize].closed);
        if merged != triangles {
            (components, component_of) = self::components(vertices.len(), &merged);
        }
        let point = |i: u32| vertices[i as usize].map(f64::from);
        let corners: Vec<_> = triangles.iter().map(|t| t.map(point)).collect();
        let representatives = components.iter().map(|c| point(c.vertex)).collect();
        let reach = corners.iter().flatten().map(largest).fold(0.0, f64::max);
        let unit = unit_of(corners.iter().flatten().flatten().copied());
        let tree = Tree::new(&corners);
        Self { triangles: corners, component_of, components, representatives, tree, reach, unit }
    }

    /// Whether a triangle's corners lie on one line, exactly: nearly all have an area that f64
    /// sees.
    pub fn has_no_area(&self, t: u32) -> bool {
        let [a, b, c] = &self.triangles[t as usize];
        let normal = cross(&sub(b, a), &sub(c, a));
        let sides = largest(&sub(b, a)) * largest(&sub(c, a));
        if largest(&normal) > 16.0 * f64::EPSILON * sides {
            return false;
        }
        let [a, b, c] = [a, b, c].map(|p| p.map(|x| IBig::lift(x, self.unit)));
        cross(&sub(&b, &a), &sub(&c, &a)).iter().all(IBig::is_zero)
    }
}

/// The components, and the component of each triangle.
fn components(vertices: usize, triangles: &[[u32; 3]]) -> (Vec<Component>, Vec<u32>) {
    let roots = roots(vertices, triangles);
    let mut number = vec![u32::MAX; vertices];
    let mut components = Vec::new();
    let mut component_of = Vec::with_capacity(triangles.len());
    for [vertex, _, _] in triangles {
        let root = roots[*vertex as usize] as usize;
        if number[root] == u32::MAX {
            number[root] = components.len() as u32;
            components.push(Component { vertex: *vertex, closed: false });
        }
        component_of.push(number[root]);
    }
    mark_closed(&mut components, triangles, &component_of);
    (components, component_of)
}

/// The triangles, where those of open components name one vertex per position: the first of the
/// vertices sorted by position.
fn merge(
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
    closed: impl Fn(usize) -> bool,
) -> Vec<[u32; 3]> {
    let is_open = |(t, _): &(usize, &[u32; 3])| !closed(*t);
    let open = triangles.iter().enumerate().filter(is_open).flat_map(|(_, triangle)| triangle);
    let mut open: Vec<u32> = open.copied().collect();
    // 0 and −0 are equal.
    let position = |vertex: u32| vertices[vertex as usize].map(|x| (x + 0.0).to_bits());
    open.sort_unstable_by_key(|vertex| (position(*vertex), *vertex));
    let mut first: Vec<u32> = (0..vertices.len() as u32).collect();
    for equal in open.chunk_by(|a, b| position(*a) == position(*b)) {
        equal.iter().for_each(|vertex| first[*vertex as usize] = equal[0]);
    }
    triangles.iter().map(|triangle| triangle.map(|vertex| first[vertex as usize])).collect()
}

/// Union–find: for each vertex the representative of its component.
fn roots(vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    fn find(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    let mut parent: Vec<u32> = (0..vertices as u32).collect();
    for [a, b, c] in triangles {
        let root = find(&mut parent, *a);
        for other in [b, c] {
            let joined = find(&mut parent, *other);
            parent[joined as usize] = root;
        }
    }
    (0..vertices as u32).map(|v| find(&mut parent, v)).collect()
}

/// Closed: at least one face, and runs of exactly two in the sorted edge list.
fn mark_closed(components: &mut [Component], triangles: &[[u32; 3]], component_of: &[u32]) {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for ([a, b, c], component) in triangles.iter().zip(component_of) {
        if a != b && b != c && c != a {
            components[*component as usize].closed = true;
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (*component, a.min(b), a.max(b))));
        }
    }
    edges.sort_unstable();
    for shared in edges.chunk_by(|e, f| e == f).filter(|run| run.len() != 2) {
        components[shared[0].0 as usize].closed = false;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot build its input has failed")]
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]];

    fn closed(triangles: &[[u32; 3]]) -> Vec<bool> {
        let vertices: Vec<[f32; 3]> =
            (0..12).map(|i| [i as f32, (i * i % 7) as f32, (i % 3) as f32]).collect();
        Mesh::new(&vertices, triangles).unwrap().components.iter().map(|c| c.closed).collect()
    }

    /// Closed is two faces an edge in every component.
    #[test]
    fn closed_needs_two_faces_per_edge() {
        assert_eq!(closed(&TETRAHEDRON), [true]);
        assert_eq!(closed(&TETRAHEDRON[..3]), [false]);
        let two = [&TETRAHEDRON[..], &[[5, 6, 7]]].concat();
        assert_eq!(closed(&two), [true, false]);
        let fin = [&TETRAHEDRON[..], &[[0, 1, 5]]].concat();
        assert_eq!(closed(&fin), [false]);
        let thread = [&TETRAHEDRON[..], &[[0, 0, 1], [4, 4, 4]]].concat();
        assert_eq!(closed(&thread), [true, false]);
        let doubled = [&TETRAHEDRON[..], &TETRAHEDRON[..]].concat();
        assert_eq!(closed(&doubled), [false]);
    }

    #[test]
    fn boxes_hold_their_triangles() {
        let vertices: Vec<[f32; 3]> = (0..100)
            .map(|i| [(i as f32).sin(), (i as f32 * 1.7).cos() / 3.0, i as f32 * 0.01])
            .collect();
        let triangles: Vec<[u32; 3]> = (0..98).map(|i| [i, i + 1, i + 2]).collect();
        let mesh = Mesh::new(&vertices, &triangles).unwrap();
        let mut seen = vec![0; triangles.len()];
        for node in &mesh.tree.nodes {
            if let super::super::tree::Content::Triangles(from, to) = node.content {
                for t in &mesh.tree.order[from as usize..to as usize] {
                    seen[*t as usize] += 1;
                    let inside = |p: &Vector<f64>| {
                        (0..3).all(|i| (p[i] - node.centre[i]).abs() <= node.half[i])
                    };
                    assert!(mesh.triangles[*t as usize].iter().all(inside));
                }
            }
        }
        assert!(seen.iter().all(|n| *n == 1));
    }
}
