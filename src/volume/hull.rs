//! The convex hull, exact: Quickhull (Barber, Dobkin, Huhdanpaa 1996) on Shewchuk's predicates.
//!
//! World-aligned volumes are fitted to hull vertices only, so a vertex lost here would be a missed
//! collision later. Every decision is the sign of an exact orient3d, and a facet is visible from a
//! point only if the point is *strictly* outside. Therefore no degenerate facet arises, the visible
//! region is a disk, and the result is a closed surface with all vertices on or inside it.
//! Duplicate, coplanar and cospherical vertices need no tolerance, and the algorithm cannot fail.
//! The distances that choose the next vertex are approximate; they affect only the speed.
//!
//! (Existing crates did not suffice: quickhull works in f32 and turns a facet of the bunny inside
//! out; chull's facets change from run to run, and it fails on rotated grids.)

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::flat_hull;
use crate::mesh::in_f64;

/// The convex hull of a shape's vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// Indices of the hull's vertices, ascending; all vertices if they are coplanar.
    pub vertices: Vec<u32>,
    /// Triangles over the shape's vertices, counter-clockwise from outside; empty if the vertices
    /// are coplanar.
    pub facets: Vec<[u32; 3]>,
}

impl Hull {
    /// The hull of finite vertices.
    #[must_use]
    pub fn of(vertices: &[impl Into<[f32; 3]> + Copy]) -> Self {
        let points: Vec<_> = vertices.iter().map(|&v| coordinates(v.into())).collect();
        let Some(simplex) = initial_simplex(&points) else {
            return Self { vertices: (0..vertices.len() as u32).collect(), facets: Vec::new() };
        };
        let facets = HullBuilder::new(&points, simplex).run();
        let mut used: Vec<u32> = facets.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        Self { vertices: used, facets }
    }

    /// The positions of the hull's vertices, to which world-aligned volumes are fitted.
    #[must_use]
    pub fn points(&self, vertices: &[impl Into<[f32; 3]> + Copy]) -> Vec<[f32; 3]> {
        let position = |&i: &u32| vertices[i as usize].into();
        self.vertices.iter().map(position).collect()
    }

    /// Indices of the hull's corners, ascending. Unlike `vertices`, these are only the corners for
    /// a flat hull too.
    #[must_use]
    pub fn corners(&self, vertices: &[impl Into<[f32; 3]> + Copy]) -> Vec<u32> {
        if !self.facets.is_empty() {
            return self.vertices.clone();
        }
        let points: Vec<_> = vertices.iter().map(|&v| coordinates(v.into())).collect();
        flat_hull::corners(&points)
    }

    /// The hull's volume, from the shape's vertices.
    #[must_use]
    pub fn volume(&self, vertices: &[impl Into<[f32; 3]> + Copy]) -> f64 {
        self.fold_facets(vertices, |[p, q, r]| p.dot(q.cross(r)) / 6.0)
    }

    /// The hull's surface area, from the shape's vertices.
    #[must_use]
    pub fn area(&self, vertices: &[impl Into<[f32; 3]> + Copy]) -> f64 {
        self.fold_facets(vertices, |[p, q, r]| (q - p).cross(r - p).length() / 2.0)
    }

    /// Sums a measure of each facet's corners, relative to one hull vertex.
    fn fold_facets(
        &self,
        vertices: &[impl Into<[f32; 3]> + Copy],
        measure: impl Fn([DVec3; 3]) -> f64,
    ) -> f64 {
        let position = |i: u32| in_f64(&vertices[i as usize].into());
        let origin = self.vertices.first().map_or(DVec3::ZERO, |&i| position(i));
        let facets = self.facets.iter();
        // Starts from 0, because the sum of no floats is −0.
        facets.map(|f| measure(f.map(|i| position(i) - origin))).fold(0.0, |sum, part| sum + part)
    }
}

type HullPoint = Coord3D<f64>;

fn coordinates(vertex: [f32; 3]) -> HullPoint {
    let [x, y, z] = vertex.map(f64::from);
    HullPoint { x, y, z }
}

/// How far `p` is outside the plane of (a, b, c), counter-clockwise from outside: exact sign,
/// approximate size.
fn height(points: &[HullPoint], [a, b, c]: [u32; 3], p: u32) -> f64 {
    let [a, b, c, p] = [a, b, c, p].map(|i| points[i as usize]);
    -orient3d(a, b, c, p)
}

/// Four vertices that are not coplanar, the first three clockwise seen from the fourth; `None` if
/// all are coplanar.
fn initial_simplex(points: &[HullPoint]) -> Option<[u32; 4]> {
    let farthest = |measure: &dyn Fn(u32) -> f64| {
        let candidates = (0..points.len() as u32).map(|i| (i, measure(i)));
        let best = candidates.max_by(|a, b| a.1.total_cmp(&b.1));
        best.filter(|(_, size)| *size > 0.0).map(|(i, _)| i)
    };
    let from_first = |i: u32| {
        let (p, q) = (points[0], points[i as usize]);
        (p.x - q.x).abs() + (p.y - q.y).abs() + (p.z - q.z).abs()
    };
    let a = 0;
    let b = farthest(&from_first)?;
    let c = farthest(&|i| off_line(points[a as usize], points[b as usize], points[i as usize]))?;
    let d = farthest(&|i| height(points, [a, b, c], i).abs())?;
    Some(if height(points, [a, b, c], d) > 0.0 { [a, c, b, d] } else { [a, b, c, d] })
}

/// The largest of the three projected areas of the triangle abp: 0 exactly if p is on the line ab.
fn off_line(a: HullPoint, b: HullPoint, p: HullPoint) -> f64 {
    let area =
        |project: fn(HullPoint) -> Coord<f64>| orient2d(project(a), project(b), project(p)).abs();
    let xy = area(|p| Coord { x: p.x, y: p.y });
    let yz = area(|p| Coord { x: p.y, y: p.z });
    let zx = area(|p| Coord { x: p.z, y: p.x });
    xy.max(yz).max(zx)
}

/// A facet of the growing hull.
struct Facet {
    corners: [u32; 3],
    /// The facet across the edge from corner k to corner k + 1.
    neighbours: [u32; 3],
    /// Vertices strictly outside this facet, with their heights. Each vertex is in the list of one
    /// facet.
    outside: Vec<(u32, f64)>,
    /// Whether later facets have replaced it.
    dead: bool,
    /// The last step in which this facet was visited.
    visited: u32,
}

/// An edge between a visible facet and one that remains.
struct HorizonEdge {
    from: u32,
    to: u32,
    beyond: u32,
}

struct HullBuilder<'a> {
    points: &'a [HullPoint],
    facets: Vec<Facet>,
    /// Buffer: the new facet whose horizon edge starts at each vertex.
    starting_at: Vec<u32>,
    step: u32,
}

impl<'a> HullBuilder<'a> {
    fn new(points: &'a [HullPoint], [a, b, c, d]: [u32; 4]) -> Self {
        let facet = |corners, neighbours| Facet {
            corners,
            neighbours,
            outside: Vec::new(),
            dead: false,
            visited: 0,
        };
        let facets = vec![
            facet([a, b, c], [1, 2, 3]),
            facet([b, a, d], [0, 3, 2]),
            facet([c, b, d], [0, 1, 3]),
            facet([a, c, d], [0, 2, 1]),
        ];
        let mut builder = Self { points, facets, starting_at: vec![0; points.len()], step: 0 };
        builder.distribute((0..points.len() as u32).collect(), 0);
        builder
    }

    fn run(mut self) -> Vec<[u32; 3]> {
        let mut next = 0;
        // New facets are appended, so one pass over the growing list visits each facet once.
        while next < self.facets.len() {
            if !self.facets[next].dead && !self.facets[next].outside.is_empty() {
                self.extend_to_farthest(next as u32);
            }
            next += 1;
        }
        let alive = self.facets.iter().filter(|f| !f.dead);
        alive.map(|f| f.corners).collect()
    }

    /// Assigns each vertex to the first facet, from number `first` on, that it is strictly outside
    /// of.
    fn distribute(&mut self, vertices: Vec<u32>, first: usize) {
        for vertex in vertices {
            for facet in &mut self.facets[first..] {
                let height = height(self.points, facet.corners, vertex);
                if height > 0.0 {
                    facet.outside.push((vertex, height));
                    break;
                }
            }
        }
    }

    /// Replaces all facets that are visible from the farthest outside vertex of `facet` by the cone
    /// from that vertex to their horizon.
    fn extend_to_farthest(&mut self, facet: u32) {
        let outside = self.facets[facet as usize].outside.iter();
        let Some(&(apex, _)) = outside.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return;
        };
        let (horizon, orphans) = self.remove_visible(facet, apex);
        let first = self.facets.len();
        for (i, edge) in horizon.iter().enumerate() {
            self.starting_at[edge.from as usize] = (first + i) as u32;
        }
        // Facet i has the edges from → to, to → apex and apex → from. It shares the last one with
        // the facet whose horizon edge ends at `from`.
        for edge in &horizon {
            let number = self.facets.len() as u32;
            let across = &mut self.facets[edge.beyond as usize];
            let shared = (0..3).find(|&k| across.corners[k] == edge.to);
            across.neighbours[shared.unwrap_or(0)] = number;
            self.facets.push(Facet {
                corners: [edge.from, edge.to, apex],
                neighbours: [edge.beyond, self.starting_at[edge.to as usize], u32::MAX],
                outside: Vec::new(),
                dead: false,
                visited: 0,
            });
        }
        for number in first..self.facets.len() {
            let next = self.facets[number].neighbours[1];
            self.facets[next as usize].neighbours[2] = number as u32;
        }
        self.distribute(orphans, first);
    }

    /// Removes the facets that are visible from `apex`. Returns their horizon and the other
    /// vertices outside them.
    fn remove_visible(&mut self, start: u32, apex: u32) -> (Vec<HorizonEdge>, Vec<u32>) {
        self.step += 1;
        let (mut horizon, mut orphans, mut stack) = (Vec::new(), Vec::new(), vec![start]);
        self.facets[start as usize].dead = true;
        while let Some(number) = stack.pop() {
            let facet = &mut self.facets[number as usize];
            let (corners, neighbours) = (facet.corners, facet.neighbours);
            let outside = std::mem::take(&mut facet.outside);
            orphans.extend(outside.into_iter().map(|(v, _)| v).filter(|&v| v != apex));
            for k in 0..3 {
                let beyond = &mut self.facets[neighbours[k] as usize];
                if beyond.visited != self.step && !beyond.dead {
                    beyond.visited = self.step;
                    if height(self.points, beyond.corners, apex) > 0.0 {
                        beyond.dead = true;
                        stack.push(neighbours[k]);
                    }
                }
                if !beyond.dead {
                    horizon.push(HorizonEdge {
                        from: corners[k],
                        to: corners[(k + 1) % 3],
                        beyond: neighbours[k],
                    });
                }
            }
        }
        (horizon, orphans)
    }
}
