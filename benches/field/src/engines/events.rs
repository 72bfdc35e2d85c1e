//! The pairs of engines that only report which pairs began and ended.

use std::collections::HashMap;

/// A pair that has begun (true) or ended.
pub type Change = ([u32; 2], bool);

/// What an engine has reported.
#[derive(Default)]
pub struct Events {
    /// In the last frame: the engine's answer.
    pub last: Vec<Change>,
    /// In all frames that are settled.
    log: Vec<Change>,
}

impl Events {
    /// Adds the last frame to the others.
    pub fn settle(&mut self) {
        self.log.extend(&self.last);
    }

    /// What the changes add up to. A pair that begins twice is there twice, so that the check sees
    /// it.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let mut counts: HashMap<[u32; 2], i32> = HashMap::new();
        for &(mut pair, begins) in &self.log {
            pair.sort_unstable();
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
        let last = vec![([2, 1], true), ([3, 4], true), ([1, 2], false), ([3, 4], true)];
        let mut events = Events { last, ..Events::default() };
        events.settle();
        assert_eq!(events.pairs(), [[3, 4], [3, 4]]);
    }
}
