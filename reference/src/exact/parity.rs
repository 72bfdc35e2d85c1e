//! Is a point inside a closed component? It is if a segment from it to a point outside crosses the
//! surface an odd number of times.
//!
//! A mesh in which every edge has two faces is a cycle modulo 2, so the parity is the same for
//! every segment that misses all edges and corners. If a segment hits one, the next segment of a
//! fixed sequence is tried. A face of no area would touch every segment in its plane. As a chain it
//! is zero, so it is skipped; if a segment runs through it, the edges of its neighbours show that.

use super::Record;
use super::mesh::Mesh;
use super::tree::{Content, Node};
use super::view::View;
use crate::linear::{Vector, largest, sub};
use crate::number::{dyadic, power_of_two};

/// Segments tried: nearly always one is enough.
const SEGMENTS: u64 = 1000;
/// Bits of an outer point's coordinates: short numbers keep the integers short.
const RAY_BITS: i32 = 20;

impl Mesh {
    /// The unit that the outer points are multiples of: they lie beyond four times the mesh's
    /// reach.
    pub fn ray_unit(&self) -> i32 {
        let (mantissa, exponent) = dyadic(self.reach);
        let bits = 64 - mantissa.leading_zeros() as i32;
        bits + exponent + 3 - RAY_BITS
    }

    /// The n-th point outside.
    fn outside(&self, n: u64) -> Vector<f64> {
        let scale = power_of_two(self.ray_unit());
        let half = 1_u64 << (RAY_BITS - 1);
        let draw = |i: u64| {
            let mixed = (3 * n + i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            ((mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) % half
        };
        [
            (half + draw(0)) as f64,
            draw(1) as f64 - half as f64 / 2.0,
            draw(2) as f64 - half as f64 / 2.0,
        ]
        .map(|k| k * scale)
    }
}

/// Whether a point of B's frame, not on A's surface, is inside a closed component of A.
pub fn inside_closed(view: &View, point: &Vector<f64>, record: &mut Record) -> bool {
    let Some(root) = view.a.tree.nodes.first() else {
        return false;
    };
    let mapped = view.map.map(point);
    let offset = sub(&mapped, &root.centre);
    if (0..3).any(|i| offset[i].abs() > root.half[i] + 2.0 * view.error) {
        return false;
    }
    let mut parities = (0..SEGMENTS)
        .filter_map(|n| odd_component(view, point, &mapped, &view.a.outside(n), record));
    // A segment fails when it meets one of finitely many edges or starts on the surface, which the
    // caller excludes.
    parities
        .next()
        .unwrap_or_else(|| unreachable!("{SEGMENTS} segments from {point:?} all touch an edge"))
}

/// Whether a closed component is crossed an odd number of times; `None` when the segment touches an
/// edge.
fn odd_component(
    view: &View,
    point: &Vector<f64>,
    mapped: &Vector<f64>,
    outside: &Vector<f64>,
    record: &mut Record,
) -> Option<bool> {
    let mesh = view.a;
    let mut odd = vec![false; mesh.components.len()];
    let segment = Segment::new(mapped, outside, view.error);
    let mut stack = vec![0_u32];
    while let Some(index) = stack.pop() {
        let node = &mesh.tree.nodes[index as usize];
        if segment.misses(node) {
            continue;
        }
        match node.content {
            Content::Boxes(right) => stack.extend([index + 1, right]),
            Content::Triangles(from, to) => {
                for &t in &mesh.tree.order[from as usize..to as usize] {
                    let component = mesh.component_of[t as usize] as usize;
                    if mesh.components[component].closed && !mesh.has_no_area(t) {
                        let crosses = record.note(view.crosses(point, mapped, outside, t))?;
                        odd[component] ^= crosses;
                    }
                }
            }
        }
    }
    Some(odd.contains(&true))
}

/// A segment against boxes: separating axes in f64, which miss nothing that the exact segment hits.
struct Segment {
    middle: Vector<f64>,
    half: Vector<f64>,
    slack: f64,
}

impl Segment {
    /// Ends off by `error` and a few ulps of the larger one, which is the outer.
    fn new(p: &Vector<f64>, q: &Vector<f64>, error: f64) -> Self {
        let middle = [0, 1, 2].map(|i| 0.5 * (p[i] + q[i]));
        let half = [0, 1, 2].map(|i| 0.5 * (q[i] - p[i]));
        Self { middle, half, slack: 2.0 * error + 16.0 * f64::EPSILON * largest(q) }
    }

    fn misses(&self, node: &Node) -> bool {
        let (d, h, b) = (sub(&self.middle, &node.centre), &self.half, &node.half);
        let size = largest(&d) + largest(h) + largest(b);
        let along = |i: usize| d[i].abs() > b[i] + h[i].abs() + self.slack;
        let across = |i: usize, j: usize| {
            let reach = b[i] * h[j].abs() + b[j] * h[i].abs();
            (d[i] * h[j] - d[j] * h[i]).abs() > reach + 8.0 * self.slack * size
        };
        (0..3).any(along) || across(0, 1) || across(1, 2) || across(2, 0)
    }
}
