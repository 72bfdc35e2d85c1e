//! Which rank gets which unit. Whoever is free gets the next that needs no quiet machine; those that are timed come behind all
//! of them, and one at a time on a node.

use std::collections::{BTreeMap, VecDeque};

use super::Sweep;

/// What is left to do, and who could do it.
pub(super) struct Queue<'a> {
    work: &'a dyn Sweep,
    beside: VecDeque<usize>,
    timed: VecDeque<usize>,
    /// Whether timed units may run beside others on a node.
    share_cores: bool,
    /// The node of each rank.
    nodes: BTreeMap<usize, String>,
    /// The unit that a rank has.
    busy: BTreeMap<usize, usize>,
    /// Those that have none, who was busy last first: it has at hand what timed units share.
    idle: VecDeque<usize>,
}

/// What becomes of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Move {
    /// It goes to a rank.
    Start { unit: usize, rank: usize },
    /// It is too late for it.
    Leave { unit: usize },
}

impl<'a> Queue<'a> {
    pub(super) fn new(work: &'a dyn Sweep, units: &[usize], share_cores: bool) -> Self {
        let (timed, beside) = units.iter().partition(|&&unit| work.timed(unit));
        Self {
            work,
            beside,
            timed,
            share_cores,
            nodes: BTreeMap::new(),
            busy: BTreeMap::new(),
            idle: VecDeque::new(),
        }
    }

    /// A rank is ready for its first unit.
    pub(super) fn arrives(&mut self, rank: usize, node: &str) {
        self.nodes.insert(rank, node.to_owned());
        self.idle.push_back(rank);
    }

    /// A rank's unit has ended.
    pub(super) fn ended(&mut self, rank: usize) {
        self.busy.remove(&rank);
        self.idle.push_front(rank);
    }

    /// Whether any rank has a unit.
    pub(super) fn under_way(&self) -> bool {
        !self.busy.is_empty()
    }

    /// The next unit that can be begun or is left out; `None` until a rank arrives or a unit ends.
    pub(super) fn next(&mut self) -> Option<Move> {
        let place = (0..self.idle.len()).find(|&place| self.serves(self.idle[place]))?;
        let unit = self.beside.pop_front().or_else(|| self.timed.pop_front())?;
        if !self.work.starts(unit) {
            return Some(Move::Leave { unit });
        }
        let rank = self.idle.remove(place)?;
        self.busy.insert(rank, unit);
        Some(Move::Start { unit, rank })
    }

    /// Whether an idle rank can have the next unit.
    fn serves(&self, rank: usize) -> bool {
        let node = self.nodes.get(&rank);
        let quiet = || self.busy.keys().all(|other| self.nodes.get(other) != node);
        self.share_cores || !self.beside.is_empty() || quiet()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::collections::BTreeSet;

    use super::super::Header;
    use super::*;

    /// Odd units are timed; unit 6 comes too late.
    struct Mixed;

    impl Sweep for Mixed {
        fn header(&self) -> miette::Result<Header> {
            unreachable!()
        }
        fn name(&self, unit: usize) -> String {
            unit.to_string()
        }
        fn run(&self, _: usize) -> miette::Result<String> {
            unreachable!()
        }
        fn timed(&self, unit: usize) -> bool {
            unit % 2 == 1
        }
        fn starts(&self, unit: usize) -> bool {
            unit != 6
        }
    }

    const UNITS: [usize; 9] = [0, 1, 2, 3, 4, 5, 6, 7, 8];
    const NODES: [(usize, &str); 4] = [(1, "a"), (2, "a"), (3, "b"), (4, "b")];

    /// All units done by ranks on two nodes; of those under way the one ends first that began first, or last. Who began what, in
    /// order, and beside which units on its node.
    fn played(share_cores: bool, first: bool) -> Vec<(usize, usize, Vec<usize>)> {
        let mut queue = Queue::new(&Mixed, &UNITS, share_cores);
        let (mut said, mut left, mut began) = (Vec::new(), Vec::new(), VecDeque::new());
        for (rank, node) in NODES {
            queue.arrives(rank, node);
        }
        loop {
            while let Some(next) = queue.next() {
                match next {
                    Move::Leave { unit } => left.push(unit),
                    Move::Start { unit, rank } => {
                        let node = &queue.nodes[&rank];
                        let others = queue
                            .busy
                            .iter()
                            .filter(|&(other, _)| *other != rank && queue.nodes[other] == *node);
                        said.push((rank, unit, others.map(|(_, &unit)| unit).collect()));
                        began.push_back(rank);
                    }
                }
            }
            let ends = if first {
                began.pop_front()
            } else {
                began.pop_back()
            };
            let Some(rank) = ends else { break };
            queue.ended(rank);
        }
        assert_eq!(left, [6]);
        assert!(!queue.under_way());
        said
    }

    #[test]
    fn every_unit_goes_to_one_rank_and_timed_ones_have_their_node_to_themselves() {
        for first in [true, false] {
            let said = played(false, first);
            let mut units: Vec<usize> = said.iter().map(|(_, unit, _)| *unit).collect();
            assert_eq!(units[..4], [0, 2, 4, 8]);
            units.sort_unstable();
            assert_eq!(units, [0, 1, 2, 3, 4, 5, 7, 8]);
            for (_, unit, beside) in &said {
                assert!(unit % 2 == 0 || beside.is_empty(), "{said:?}");
            }
            let nodes = said.iter().filter(|(_, unit, _)| unit % 2 == 1);
            let nodes: BTreeSet<usize> = nodes.map(|(rank, ..)| rank.div_ceil(2)).collect();
            assert_eq!(nodes.len(), if first { 2 } else { 1 }, "{said:?}");
        }
    }

    #[test]
    fn ranks_that_share_their_cores_time_side_by_side() {
        let said = played(true, true);
        assert_eq!(said.len(), 8);
        let beside = said
            .iter()
            .filter(|(_, unit, beside)| unit % 2 == 1 && !beside.is_empty());
        assert!(beside.count() > 0, "{said:?}");
    }
}
