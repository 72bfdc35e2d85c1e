//! Decides exactly whether two posed meshes intersect: whether their surfaces meet, or a component
//! of one lies inside a closed component of the other.
//!
//! Both meshes' trees are descended together in A's frame. A pair of boxes is skipped if one of six
//! face normals separates it in f64 by more than the rounding error. If no triangles meet, every
//! component is entirely inside or entirely outside of each closed component, so one vertex decides
//! ([`super::parity`]).

use super::parity::inside_closed;
use super::tree::{Content, Node};
use super::view::{Posed, View};
use super::{Path, Record, Tally};
use crate::linear::{Vector, apply, largest, sub, transpose};
use crate::shape::Body;

/// Whether two meshes intersect, and which stages decided it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    /// The answer, true in exact arithmetic.
    pub meets: bool,
    /// The deepest stage that a test on the way needed.
    pub path: Path,
    /// Triangle pairs and ray crossings by stage.
    pub tally: Tally,
}

/// Whether the posed meshes of two bodies intersect.
pub fn overlap(a: &Body, b: &Body) -> Meeting {
    meet((a.shape.mesh(), &a.pose), (b.shape.mesh(), &b.pose))
}

/// Whether two posed meshes intersect.
pub fn meet(a: Posed, b: Posed) -> Meeting {
    let mut record = Record::default();
    let view = View::new(a, b);
    let meets = surfaces_meet(&view, &mut record)
        || contained(&view, &mut record)
        || contained(&View::new(b, a), &mut record);
    Meeting { meets, path: record.deepest, tally: record.tally }
}

/// Is a component of B inside a closed component of A?
fn contained(view: &View, record: &mut Record) -> bool {
    let possible = view.a.components.iter().any(|component| component.closed);
    possible && view.b.representatives.iter().any(|vertex| inside_closed(view, vertex, record))
}

/// Does a triangle of A meet one of B?
fn surfaces_meet(view: &View, record: &mut Record) -> bool {
    let (tree_a, tree_b) = (&view.a.tree, &view.b.tree);
    if tree_a.nodes.is_empty() || tree_b.nodes.is_empty() {
        return false;
    }
    let boxes = Boxes::new(view);
    let mut stack = vec![(0_u32, 0_u32)];
    while let Some((i, j)) = stack.pop() {
        let (node_a, node_b) = (&tree_a.nodes[i as usize], &tree_b.nodes[j as usize]);
        if boxes.apart(node_a, node_b) {
            continue;
        }
        match (node_a.content, node_b.content) {
            (Content::Triangles(a, to_a), Content::Triangles(b, to_b)) => {
                let a = &tree_a.order[a as usize..to_a as usize];
                let b = &tree_b.order[b as usize..to_b as usize];
                if leaves_meet(view, a, b, record) {
                    return true;
                }
            }
            (Content::Boxes(right), Content::Triangles(..)) => {
                stack.extend([(right, j), (i + 1, j)])
            }
            (Content::Triangles(..), Content::Boxes(right)) => {
                stack.extend([(i, right), (i, j + 1)])
            }
            (Content::Boxes(right), _) if larger(node_a, node_b) => {
                stack.extend([(right, j), (i + 1, j)])
            }
            (_, Content::Boxes(right)) => stack.extend([(i, right), (i, j + 1)]),
        }
    }
    false
}

fn larger(a: &Node, b: &Node) -> bool {
    largest(&a.half) >= largest(&b.half)
}

fn leaves_meet(view: &View, a: &[u32], b: &[u32], record: &mut Record) -> bool {
    b.iter().any(|&tb| {
        let mapped = view.b.triangles[tb as usize].each_ref().map(|p| view.map.map(p));
        a.iter().any(|&ta| record.note(view.triangles_meet(ta, tb, &mapped)))
    })
}

/// Separates boxes of A from boxes of B.
///
/// With δ the error of a mapped point and u = 2⁻⁵³: a centre is off by δ along A's axes, √3δ +
/// 170u·size along B's, and the half sizes' sums by as much again; 4δ and 256u of A's reach cover
/// it, as δ is 256u of B's reach and distance.
struct Boxes<'a> {
    view: &'a View<'a>,
    back: [Vector<f64>; 3],
    slack: f64,
}

impl<'a> Boxes<'a> {
    fn new(view: &'a View) -> Self {
        let slack = 4.0 * view.error + 128.0 * f64::EPSILON * view.a.reach;
        Self { view, back: transpose(&view.map.matrix), slack }
    }

    fn apart(&self, a: &Node, b: &Node) -> bool {
        let matrix = &self.view.map.matrix;
        let d = sub(&self.view.map.map(&b.centre), &a.centre);
        let spread = |row: &Vector<f64>, h: &Vector<f64>| {
            row[0].abs() * h[0] + row[1].abs() * h[1] + row[2].abs() * h[2]
        };
        let along_a = |i: usize| d[i].abs() > a.half[i] + spread(&matrix[i], &b.half) + self.slack;
        if (0..3).any(along_a) {
            return true;
        }
        let d = apply(&self.back, &d);
        let along_b =
            |i: usize| d[i].abs() > b.half[i] + spread(&self.back[i], &a.half) + self.slack;
        (0..3).any(along_b)
    }
}
