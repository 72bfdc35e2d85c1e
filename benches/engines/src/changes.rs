//! The pairs of engines that only report which pairs began and ended.

use std::collections::HashMap;

/// All changes so far, in order.
#[derive(Clone, Debug, Default)]
pub struct Changes(Vec<([u32; 2], bool)>);

impl Changes {
    /// A pair begins or ends.
    pub fn note(&mut self, mut pair: [u32; 2], begins: bool) {
        pair.sort_unstable();
        self.0.push((pair, begins));
    }

    /// Bytes of the list.
    pub fn bytes(&self) -> u64 {
        (self.0.capacity() * size_of::<([u32; 2], bool)>()) as u64
    }

    /// What the changes add up to. A pair that begins twice is there twice, so that the check sees
    /// it.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let mut counts: HashMap<[u32; 2], i32> = HashMap::new();
        for &(pair, begins) in &self.0 {
            *counts.entry(pair).or_default() += if begins { 1 } else { -1 };
        }
        let repeat = |(pair, count): ([u32; 2], i32)| (0..count).map(move |_| pair);
        counts.into_iter().flat_map(repeat).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What ended is gone and what began twice shows.
    #[test]
    fn ended_pairs_leave_the_sum() {
        let mut changes = Changes::default();
        for (pair, begins) in [([2, 1], true), ([3, 4], true), ([1, 2], false), ([3, 4], true)] {
            changes.note(pair, begins);
        }
        assert_eq!(changes.pairs(), [[3, 4], [3, 4]]);
    }
}
