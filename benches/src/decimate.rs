//! Decimation: edge collapse in the order of the quadric error.
//!
//! M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997. A
//! plane with unit normal n and offset d has the squared distance (n·x + d)²; a vertex's quadric is
//! the area-weighted sum over its triangles' planes, and collapsing the edge ab to x costs (Q_a +
//! Q_b)(x). The cheapest edge goes first. Additional planes, perpendicular to the triangles at
//! boundary edges, keep an open boundary in place.
//!
//! This is our own code because no maintained Rust crate promises the same bits on every platform,
//! and the shipped meshes must not depend on the machine. It uses plain f64 operations and breaks
//! ties by index.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

use glam::{DMat3, DVec3, Vec3};
use sdop::mesh::TriangleMesh;

/// Collapses edges until at most `target` triangles are left, or until every further collapse would
/// change the surface's topology or turn a triangle over. Closed components stay closed. Unused
/// vertices and triangles with a repeated index are removed too. A mesh that consists only of
/// those, or is small enough already, is returned unchanged.
pub fn decimate(mesh: &TriangleMesh, target: usize) -> TriangleMesh {
    let mut surface = Surface::new(mesh);
    if surface.alive == 0 || mesh.triangles.len() <= target {
        return mesh.clone();
    }
    let mut queue: BinaryHeap<EdgeCollapse> =
        surface.edges().map(|edge| surface.candidate(edge)).collect();
    while surface.alive > target
        && let Some(candidate) = queue.pop()
    {
        if surface.is_current(&candidate) && surface.may_collapse(&candidate) {
            surface.collapse(&candidate);
            let kept = candidate.edge.0;
            let neighbours = surface.neighbours(kept);
            queue.extend(
                neighbours.into_iter().map(|n| surface.candidate((kept.min(n), kept.max(n)))),
            );
        }
    }
    surface.into_mesh(mesh)
}

/// Q(x) = x·Ax + 2b·x + c.
#[derive(Clone, Copy)]
struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Quadric {
    fn zero() -> Self {
        Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 }
    }

    /// weight·(n·(x − p))².
    fn of_plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let offset = -normal.dot(point);
        let a = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        Self { a: a * weight, b: normal * (offset * weight), c: offset * offset * weight }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    fn at(&self, x: DVec3) -> f64 {
        x.dot(self.a * x) + 2.0 * self.b.dot(x) + self.c
    }

    /// The point of least error, unless the planes leave it undetermined (flat or straight
    /// surroundings).
    fn minimum(&self) -> Option<DVec3> {
        let trace = self.a.x_axis.x + self.a.y_axis.y + self.a.z_axis.z;
        let determined = self.a.determinant() > LEAST_DETERMINANT * trace * trace * trace;
        determined.then(|| self.a.inverse() * -self.b)
    }
}

/// Below this share of trace³ (1/27 at best), the planes are too close to parallel to determine a
/// point.
const LEAST_DETERMINANT: f64 = 1e-7;

/// Weight of a boundary edge's perpendicular plane, relative to a triangle of the edge's size.
const BOUNDARY_WEIGHT: f64 = 100.0;

/// Least cosine between a triangle's normals before and after a collapse.
const LEAST_TURN: f64 = 0.2;

/// An edge that may be collapsed, and the resulting position. It is stale once either end has
/// moved.
struct EdgeCollapse {
    cost: f64,
    edge: (u32, u32),
    versions: (u32, u32),
    position: DVec3,
}

impl Ord for EdgeCollapse {
    /// Reversed, because the heap returns the greatest first: the cheapest edge, then the one with
    /// the lowest indices.
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then_with(|| other.edge.cmp(&self.edge))
    }
}

impl PartialOrd for EdgeCollapse {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for EdgeCollapse {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for EdgeCollapse {}

struct Surface {
    /// The origin of `positions`. Quadrics about a far origin would lose their digits.
    origin: DVec3,
    positions: Vec<DVec3>,
    quadrics: Vec<Quadric>,
    /// How often each vertex has moved.
    versions: Vec<u32>,
    /// The remaining triangles at each vertex.
    around: Vec<Vec<u32>>,
    /// `None` for removed triangles.
    triangles: Vec<Option<[u32; 3]>>,
    alive: usize,
}

impl Surface {
    fn new(mesh: &TriangleMesh) -> Self {
        let count = mesh.vertices.len();
        let in_f64 = |vertex: &[f32; 3]| Vec3::from(*vertex).as_dvec3();
        let origin = mesh.vertices.first().map_or(DVec3::ZERO, in_f64);
        let mut surface = Self {
            origin,
            positions: mesh.vertices.iter().map(|v| in_f64(v) - origin).collect(),
            quadrics: vec![Quadric::zero(); count],
            versions: vec![0; count],
            around: vec![Vec::new(); count],
            triangles: Vec::new(),
            alive: 0,
        };
        let proper = mesh.triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a);
        for &triangle in proper {
            for vertex in triangle {
                surface.around[vertex as usize].push(surface.alive as u32);
            }
            surface.triangles.push(Some(triangle));
            surface.alive += 1;
        }
        surface.add_quadrics();
        surface
    }

    fn add_quadrics(&mut self) {
        for triangle in self.triangles.clone().into_iter().flatten() {
            let cross = self.cross(triangle);
            let normal = cross.normalize_or_zero();
            let plane = Quadric::of_plane(normal, self.position(triangle[0]), cross.length());
            for (i, vertex) in triangle.into_iter().enumerate() {
                self.add(vertex, &plane);
                let next = triangle[(i + 1) % 3];
                if self.shared(vertex, next).count() == 1 {
                    let edge = self.position(next) - self.position(vertex);
                    let standing = edge.cross(normal).normalize_or_zero();
                    let weight = BOUNDARY_WEIGHT * edge.length_squared();
                    let plane = Quadric::of_plane(standing, self.position(vertex), weight);
                    self.add(vertex, &plane);
                    self.add(next, &plane);
                }
            }
        }
    }

    fn add(&mut self, vertex: u32, quadric: &Quadric) {
        let sum = &mut self.quadrics[vertex as usize];
        *sum = sum.plus(quadric);
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// Twice the area times the normal.
    fn cross(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|vertex| self.position(vertex));
        (b - a).cross(c - a)
    }

    fn triangles_at(&self, vertex: u32) -> impl Iterator<Item = [u32; 3]> {
        self.around[vertex as usize].iter().filter_map(|&t| self.triangles[t as usize])
    }

    /// The triangles on both sides of an edge.
    fn shared(&self, a: u32, b: u32) -> impl Iterator<Item = [u32; 3]> {
        self.triangles_at(a).filter(move |triangle| triangle.contains(&b))
    }

    fn neighbours(&self, vertex: u32) -> BTreeSet<u32> {
        self.triangles_at(vertex).flatten().filter(|&other| other != vertex).collect()
    }

    fn edges(&self) -> impl Iterator<Item = (u32, u32)> {
        let vertices = 0..self.positions.len() as u32;
        vertices.flat_map(|a| {
            self.neighbours(a).into_iter().filter(move |b| a < *b).map(move |b| (a, b))
        })
    }

    fn candidate(&self, edge: (u32, u32)) -> EdgeCollapse {
        let (a, b) = (self.position(edge.0), self.position(edge.1));
        let quadric = self.quadrics[edge.0 as usize].plus(&self.quadrics[edge.1 as usize]);
        let choices = [quadric.minimum(), Some((a + b) * 0.5), Some(a), Some(b)];
        let mut best = (f64::INFINITY, a);
        for position in choices.into_iter().flatten() {
            let cost = quadric.at(position).max(0.0);
            if cost < best.0 {
                best = (cost, position);
            }
        }
        let versions = (self.versions[edge.0 as usize], self.versions[edge.1 as usize]);
        EdgeCollapse { cost: best.0, edge, versions, position: best.1 }
    }

    fn is_current(&self, candidate: &EdgeCollapse) -> bool {
        let (a, b) = candidate.edge;
        candidate.versions == (self.versions[a as usize], self.versions[b as usize])
    }

    fn may_collapse(&self, candidate: &EdgeCollapse) -> bool {
        let (a, b) = candidate.edge;
        let touched = |triangle: &[u32; 3]| !(triangle.contains(&a) && triangle.contains(&b));
        let at_a: Vec<[u32; 3]> = self.triangles_at(a).filter(touched).collect();
        let at_b: Vec<[u32; 3]> = self.triangles_at(b).filter(touched).collect();
        self.keeps_topology(a, b, &at_a, &at_b)
            && !at_a.iter().chain(&at_b).any(|&triangle| self.turns_over(triangle, candidate))
    }

    /// The link condition: the ends share no neighbour except those across the edge's one or two
    /// faces. In addition, no boundary is bridged, no component vanishes and no triangle coincides
    /// with another (a tetrahedron's would).
    fn keeps_topology(&self, a: u32, b: u32, at_a: &[[u32; 3]], at_b: &[[u32; 3]]) -> bool {
        let faces = self.shared(a, b).count();
        let common = self.neighbours(a).intersection(&self.neighbours(b)).count();
        let bridge = faces == 2 && self.on_boundary(a) && self.on_boundary(b);
        let vanishes = at_a.is_empty() && at_b.is_empty();
        let link = |triangles: &[[u32; 3]], end: u32| -> BTreeSet<(u32, u32)> {
            let opposite =
                |t: &[u32; 3]| t.iter().copied().filter(|&v| v != end).collect::<Vec<_>>();
            triangles.iter().map(opposite).map(|e| (e[0].min(e[1]), e[0].max(e[1]))).collect()
        };
        let folds = !link(at_a, a).is_disjoint(&link(at_b, b));
        (1..=2).contains(&faces) && common == faces && !bridge && !vanishes && !folds
    }

    /// Whether a triangle at one of the ends would lose its area or turn over.
    fn turns_over(&self, triangle: [u32; 3], candidate: &EdgeCollapse) -> bool {
        let (a, b) = candidate.edge;
        let before = self.cross(triangle);
        let [p, q, r] =
            triangle.map(|v| if v == a || v == b { candidate.position } else { self.position(v) });
        let after = (q - p).cross(r - p);
        after == DVec3::ZERO || before.dot(after) < LEAST_TURN * before.length() * after.length()
    }

    /// Whether some edge at the vertex has only one face.
    fn on_boundary(&self, vertex: u32) -> bool {
        self.neighbours(vertex).into_iter().any(|other| self.shared(vertex, other).count() == 1)
    }

    /// Moves both ends to the candidate's position and keeps the first.
    fn collapse(&mut self, candidate: &EdgeCollapse) {
        let (a, b) = candidate.edge;
        for t in std::mem::take(&mut self.around[b as usize]) {
            let Some(triangle) = self.triangles[t as usize] else {
                continue;
            };
            if triangle.contains(&a) {
                self.triangles[t as usize] = None;
                self.alive -= 1;
            } else {
                self.triangles[t as usize] = Some(triangle.map(|v| if v == b { a } else { v }));
                self.around[a as usize].push(t);
            }
        }
        let gone = self.quadrics[b as usize];
        self.add(a, &gone);
        self.positions[a as usize] = candidate.position;
        self.versions[a as usize] += 1;
        self.versions[b as usize] += 1;
        for vertex in self.neighbours(a).into_iter().chain([a]) {
            let living = |t: &u32| self.triangles[*t as usize].is_some();
            let around = std::mem::take(&mut self.around[vertex as usize]);
            self.around[vertex as usize] = around.into_iter().filter(living).collect();
        }
    }

    /// The remaining triangles with the vertices that they use, in their original order.
    fn into_mesh(self, mesh: &TriangleMesh) -> TriangleMesh {
        let mut new_index = vec![None; self.positions.len()];
        let mut vertices = Vec::new();
        for (vertex, position) in self.positions.iter().enumerate() {
            if !self.around[vertex].is_empty() {
                new_index[vertex] = Some(vertices.len() as u32);
                vertices.push((self.origin + position).as_vec3().to_array());
            }
        }
        let renumber = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| new_index[vertex as usize]);
            Some([a?, b?, c?])
        };
        let triangles = self.triangles.into_iter().flatten().filter_map(renumber).collect();
        TriangleMesh { vertices, triangles, ..mesh.clone() }
    }
}
