//! The bounds of all bodies, kept up to date body by body.

use std::ops::Range;

use super::bounds::BodyBounds;
use crate::simd::prefetch;

/// Slots per leaf.
const SLOTS_PER_LEAF: usize = 16;

/// A binary tree over slots: each node has the bounds of the bodies below it.
#[derive(Clone, Debug)]
pub(super) struct BoundsTree {
    /// The root is 1, the children of i are 2i and 2i + 1, and the leaves are the second half.
    nodes: Vec<BodyBounds>,
}

impl BoundsTree {
    /// A tree of `slots` slots. `of_slots` returns the bounds of the bodies in a range of slots,
    /// whose end may be larger.
    pub fn new(slots: usize, of_slots: impl Fn(Range<usize>) -> BodyBounds) -> Self {
        let leaves = slots.div_ceil(SLOTS_PER_LEAF).next_power_of_two();
        let mut nodes = vec![BodyBounds::EMPTY; 2 * leaves];
        for leaf in 0..leaves {
            nodes[leaves + leaf] = of_slots(slots_of(leaf));
        }
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].union(nodes[2 * node + 1]);
        }
        Self { nodes }
    }

    /// Whether it has at least this number of slots.
    pub fn has_room_for(&self, slots: usize) -> bool {
        slots <= self.nodes.len() / 2 * SLOTS_PER_LEAF
    }

    /// Updates the bounds after a change in one slot.
    pub fn update(&mut self, slot: usize, of_slots: impl Fn(Range<usize>) -> BodyBounds) {
        let leaf = slot / SLOTS_PER_LEAF;
        let (mut node, mut bounds) = (self.nodes.len() / 2 + leaf, of_slots(slots_of(leaf)));
        while self.nodes[node] != bounds {
            self.nodes[node] = bounds;
            if node == 1 {
                return;
            }
            node /= 2;
            bounds = self.nodes[2 * node].union(self.nodes[2 * node + 1]);
        }
    }

    /// Prefetches what [`Self::update`] of a slot will read; `of_slots` does so for a range.
    pub fn prefetch(&self, slot: usize, of_slots: impl Fn(Range<usize>)) {
        let leaf = slot / SLOTS_PER_LEAF;
        let node = self.nodes.len() / 2 + leaf;
        for node in [node, node ^ 1, node / 2, (node / 2) ^ 1] {
            self.nodes.get(node).map(prefetch);
        }
        of_slots(slots_of(leaf));
    }

    /// The bounds of all bodies.
    pub fn whole(&self) -> BodyBounds {
        self.nodes[1]
    }
}

fn slots_of(leaf: usize) -> Range<usize> {
    leaf * SLOTS_PER_LEAF..(leaf + 1) * SLOTS_PER_LEAF
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// Changes lead to the bounds of all.
    #[test]
    fn bounds_follow_changes() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for slots in [1, 15, 16, 17, 300] {
            let mut bodies: Vec<Option<[f64; 3]>> = vec![None; slots];
            let of = |bodies: &[Option<[f64; 3]>], range: Range<usize>| {
                let some = bodies.iter().take(range.end).skip(range.start).flatten();
                BodyBounds::of(some.map(|&t| (0, t, t[1].abs())))
            };
            let mut tree = BoundsTree::new(slots, |range| of(&bodies, range));
            assert!(tree.has_room_for(slots) && !tree.has_room_for(20 * slots + 40));
            for _ in 0..2000 {
                let mut draw = |n: u32| random.next_u32() % n;
                let slot = draw(slots as u32) as usize;
                let place = [(); 3].map(|()| f64::from(draw(40)) / [1.0, 10.0][draw(2) as usize]);
                bodies[slot] = (draw(3) > 0).then_some(place);
                tree.update(slot, |range| of(&bodies, range));
                assert_eq!(tree.whole(), of(&bodies, 0..slots));
            }
        }
    }
}
