//! A binary tree of axis-aligned boxes over a mesh's triangles, in the body frame.

use crate::linear::Vector;

/// Triangles a leaf holds at most.
const LEAF: usize = 4;

/// A box: centre and half sizes, which the triangles' corners stay inside.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Centre.
    pub centre: Vector<f64>,
    /// Half sizes, rounded up.
    pub half: Vector<f64>,
    /// What is in it.
    pub content: Content,
}

/// What a box holds.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// Two boxes: the next node and this one.
    Boxes(u32),
    /// These places of the order.
    Triangles(u32, u32),
}

/// The tree; node 0 is the root. No triangles, no nodes.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Nodes, a left child right after its parent.
    pub nodes: Vec<Node>,
    /// Triangle numbers, leaf by leaf.
    pub order: Vec<u32>,
}

impl Tree {
    /// Splits at the median along the longest side.
    pub fn new(triangles: &[[Vector<f64>; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..triangles.len() as u32).collect() };
        if !triangles.is_empty() {
            let mut order = std::mem::take(&mut tree.order);
            tree.build(triangles, &mut order, 0);
            tree.order = order;
        }
        tree
    }

    fn build(&mut self, triangles: &[[Vector<f64>; 3]], order: &mut [u32], first: u32) {
        let corners = order.iter().flat_map(|t| &triangles[*t as usize]);
        let empty = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (lo, hi) = corners.fold(empty, |(lo, hi), p| {
            ([0, 1, 2].map(|i| lo[i].min(p[i])), [0, 1, 2].map(|i| hi[i].max(p[i])))
        });
        let centre = [0, 1, 2].map(|i| 0.5 * (lo[i] + hi[i]));
        let half = [0, 1, 2].map(|i| (hi[i] - centre[i]).max(centre[i] - lo[i]).next_up());
        let content = Content::Triangles(first, first + order.len() as u32);
        self.nodes.push(Node { centre, half, content });
        if order.len() <= LEAF {
            return;
        }
        let longest = (0..3).fold(0, |best, i| if half[i] > half[best] { i } else { best });
        let place = |t: &u32| triangles[*t as usize].iter().map(|p| p[longest]).sum::<f64>();
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |s, t| place(s).total_cmp(&place(t)).then(s.cmp(t)));
        let (left, right) = order.split_at_mut(middle);
        let parent = self.nodes.len() - 1;
        self.build(triangles, left, first);
        // A tree over u32 triangle numbers has fewer than 2³² nodes.
        self.nodes[parent].content = Content::Boxes(self.nodes.len() as u32);
        self.build(triangles, right, first + middle as u32);
    }
}
