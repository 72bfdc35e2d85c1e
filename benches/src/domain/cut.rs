//! [`Cuts`]: recursive bisection of space, one cell per rank.
//!
//! The ranks are halved repeatedly, and space with them. Each plane is perpendicular to the axis of
//! largest extent of its part's ball centres, and the number of centres below it is the share of
//! the lower ranks. A plane is one of the f32 coordinates, found digit by digit from counts that
//! are summed over ranks (a radix selection). No rank sees another's bodies, and the planes depend
//! only on the set of centres, not on which rank holds them. A centre below a plane belongs to the
//! lower side, and one on or above it to the upper side. Every rank compares the same two f32.
//!
//! Maintained partitioners (coupe, the METIS family) need a mesh, or all points in one memory;
//! those that use MPI are C libraries which have to be installed separately. Selection over ranks
//! takes less code than a binding to them.

use super::float_key::{key, of_key};
use crate::network::Network;

/// Where space is cut, and who owns what.
#[derive(Clone, Debug, PartialEq)]
pub struct Cuts {
    /// The first is the whole; a plane's parts come after it.
    nodes: Vec<CutNode>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CutNode {
    /// The cell of a rank.
    Cell(usize),
    /// A plane across an axis, and the nodes on either side.
    Plane { axis: usize, at: f32, below: usize, above: usize },
}

/// A node that is not cut yet: consecutive ranks that share it.
#[derive(Clone, Copy, Debug)]
struct OpenPart {
    node: usize,
    first: usize,
    ranks: usize,
}

impl OpenPart {
    fn below(&self) -> usize {
        self.ranks / 2
    }
}

/// A digit of the selection: eight bits.
const BITS_PER_DIGIT: u32 = 8;
const DIGIT_VALUES: usize = 1 << BITS_PER_DIGIT;

impl Cuts {
    /// One cell, that of rank 0.
    #[must_use]
    pub fn none() -> Self {
        Self { nodes: vec![CutNode::Cell(0)] }
    }

    /// Cuts space for the centres of all ranks' bodies, of which these are this rank's. Collective.
    pub fn make(network: &impl Network, centres: &[[f32; 3]]) -> Self {
        let mut cuts = Self::none();
        let mut parts = vec![OpenPart { node: 0, first: 0, ranks: network.size() }];
        // The part that each centre lies in; none once that part is a cell.
        let mut part_of = vec![Some(0); centres.len()];
        loop {
            parts.retain(|part| {
                part.ranks > 1 || {
                    cuts.nodes[part.node] = CutNode::Cell(part.first);
                    false
                }
            });
            if parts.is_empty() {
                return cuts;
            }
            cuts.assign(&parts, centres, &mut part_of);
            let axes = widest_axes(network, &parts, centres, &part_of);
            let planes = select(network, &parts, centres, &part_of, &axes);
            let mut halves = Vec::new();
            for ((part, axis), at) in parts.iter().zip(axes).zip(planes) {
                let (below, above) = (cuts.nodes.len(), cuts.nodes.len() + 1);
                cuts.nodes[part.node] = CutNode::Plane { axis, at, below, above };
                cuts.nodes.extend([CutNode::Cell(part.first); 2]);
                let (first, middle) = (part.first, part.first + part.below());
                halves.push(OpenPart { node: below, first, ranks: part.below() });
                halves.push(OpenPart {
                    node: above,
                    first: middle,
                    ranks: part.ranks - part.below(),
                });
            }
            parts = halves;
        }
    }

    /// Finds the part that each centre lies in.
    fn assign(&self, parts: &[OpenPart], centres: &[[f32; 3]], part_of: &mut [Option<u32>]) {
        let mut part_at = vec![None; self.nodes.len()];
        for (number, part) in parts.iter().enumerate() {
            // Fewer parts than ranks.
            part_at[part.node] = Some(number as u32);
        }
        for (centre, part) in centres.iter().zip(part_of) {
            *part = part_at[self.node(*centre)];
        }
    }

    /// The node that isn't cut in which a centre lies.
    fn node(&self, centre: [f32; 3]) -> usize {
        let mut node = 0;
        while let CutNode::Plane { axis, at, below, above } = self.nodes[node] {
            node = if centre[axis] < at { below } else { above };
        }
        node
    }

    /// The rank that owns a body whose ball has this centre.
    #[must_use]
    pub fn owner(&self, centre: [f32; 3]) -> usize {
        match self.nodes[self.node(centre)] {
            CutNode::Cell(rank) => rank,
            CutNode::Plane { .. } => unreachable!("a walk ends in a cell"),
        }
    }

    /// Calls `visit` for every rank whose cell is within `far` of a centre in each coordinate, and
    /// its distance so measured.
    pub fn near(&self, centre: [f32; 3], far: f64, visit: &mut impl FnMut(usize, f64)) {
        self.walk(0, centre, [0.0; 3], far, visit);
    }

    /// `gap` is how far the node is along each axis, of the planes so far.
    fn walk(
        &self,
        node: usize,
        centre: [f32; 3],
        gap: [f64; 3],
        far: f64,
        visit: &mut impl FnMut(usize, f64),
    ) {
        match self.nodes[node] {
            CutNode::Cell(rank) => visit(rank, gap[0].max(gap[1]).max(gap[2])),
            CutNode::Plane { axis, at, below, above } => {
                // The sign of a difference is that of the comparison, so that the own side is at
                // distance 0.
                let beyond = f64::from(centre[axis]) - f64::from(at);
                for (side, away) in [(below, beyond), (above, -beyond)] {
                    let mut gap = gap;
                    gap[axis] = gap[axis].max(away);
                    if !(gap[axis] > far) {
                        self.walk(side, centre, gap, far, visit);
                    }
                }
            }
        }
    }

    /// Lower and upper end of each rank's cell along each axis.
    #[must_use]
    pub fn cells(&self, ranks: usize) -> Vec<[[f32; 3]; 2]> {
        let everywhere = [[f32::NEG_INFINITY; 3], [f32::INFINITY; 3]];
        let mut cells = vec![everywhere; ranks];
        let mut stack = vec![(0, everywhere)];
        while let Some((node, cell)) = stack.pop() {
            match self.nodes[node] {
                CutNode::Cell(rank) => cells[rank] = cell,
                CutNode::Plane { axis, at, below, above } => {
                    let [mut lower, mut upper] = [cell; 2];
                    (lower[1][axis], upper[0][axis]) = (at, at);
                    stack.extend([(below, lower), (above, upper)]);
                }
            }
        }
        cells
    }
}

/// The axis along which each part's centres reach farthest; of equal ones the first.
fn widest_axes(
    network: &impl Network,
    parts: &[OpenPart],
    centres: &[[f32; 3]],
    part_of: &[Option<u32>],
) -> Vec<usize> {
    // Both ends as largest numbers: the lower ones' keys are turned round.
    let mut ends = vec![[0_u64; 6]; parts.len()];
    for (centre, part) in centres.iter().zip(part_of) {
        if let Some(part) = part {
            let ends = &mut ends[*part as usize];
            for axis in 0..3 {
                let key = key(centre[axis]);
                ends[axis] = ends[axis].max(u64::from(!key));
                ends[3 + axis] = ends[3 + axis].max(u64::from(key));
            }
        }
    }
    network.max(ends.as_flattened_mut());
    let widest = |ends: &[u64; 6]| {
        let end = |key: u64| f64::from(of_key(key as u32));
        let extent = |axis: usize| end(ends[3 + axis]) - end(u64::from(!(ends[axis] as u32)));
        (1..3).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best })
    };
    ends.iter().map(widest).collect()
}

/// The coordinate of each part that has the lower ranks' share of its centres below it.
fn select(
    network: &impl Network,
    parts: &[OpenPart],
    centres: &[[f32; 3]],
    part_of: &[Option<u32>],
    axes: &[usize],
) -> Vec<f32> {
    let mut prefix = vec![0_u32; parts.len()];
    let mut wanted = vec![None; parts.len()];
    for shift in (0..u32::BITS)
        .step_by(BITS_PER_DIGIT as usize)
        .map(|done| u32::BITS - BITS_PER_DIGIT - done)
    {
        let mut counts = vec![[0_u64; DIGIT_VALUES]; parts.len()];
        for (centre, part) in centres.iter().zip(part_of) {
            let Some(part) = part.map(|part| part as usize) else {
                continue;
            };
            let key = key(centre[axes[part]]);
            // What the digits before have left; before the first, everything.
            if (u64::from(key) >> (shift + BITS_PER_DIGIT))
                == (u64::from(prefix[part]) >> (shift + BITS_PER_DIGIT))
            {
                counts[part][(key >> shift) as usize % DIGIT_VALUES] += 1;
            }
        }
        network.sum(counts.as_flattened_mut());
        for (number, part) in parts.iter().enumerate() {
            let counts = &counts[number];
            let all = || counts.iter().sum::<u64>() * part.below() as u64 / part.ranks as u64;
            let mut below = *wanted[number].get_or_insert_with(all);
            let mut digit = 0;
            while digit + 1 < DIGIT_VALUES && counts[digit] <= below {
                below -= counts[digit];
                digit += 1;
            }
            wanted[number] = Some(below);
            prefix[number] |= (digit as u32) << shift;
        }
    }
    // A part without centres has been led beyond all numbers, and any plane will do.
    let plane = |prefix: u32| Some(of_key(prefix)).filter(|at| at.is_finite()).unwrap_or(0.0);
    prefix.into_iter().map(plane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::on_ranks;

    /// Points of a lattice with many equal coordinates, and some far away.
    fn points() -> Vec<[f32; 3]> {
        let lattice =
            (0..600).map(|i| [(i % 10) as f32, (i / 10 % 6) as f32 - 3.0, (i / 60) as f32 * 0.25]);
        let far = (0..40).map(|i| [-1.0e6 * i as f32, 1.0e-30 * i as f32, -0.0]);
        lattice.chain(far).collect()
    }

    /// The cuts when rank r holds every so-many-th point, or all points are rank 0's.
    fn cuts(ranks: usize, points: &[[f32; 3]], dealt: bool) -> Cuts {
        let made = on_ranks(ranks, |net| {
            let mine = points.iter().enumerate();
            let mine =
                mine.filter(|(i, _)| if dealt { i % ranks == net.rank() } else { net.rank() == 0 });
            let mine: Vec<_> = mine.map(|(_, point)| *point).collect();
            Cuts::make(net, &mine)
        });
        assert!(made.iter().all(|cuts| *cuts == made[0]), "ranks differ");
        made[0].clone()
    }

    #[test]
    fn planes_depend_on_the_set_alone() {
        for ranks in [1, 2, 3, 8, 13] {
            assert_eq!(cuts(ranks, &points(), true), cuts(ranks, &points(), false), "{ranks}");
        }
    }

    /// Ranks own equal numbers of points that differ.
    #[test]
    fn ranks_own_equal_shares() {
        let points: Vec<_> = (0..1000_u32)
            .map(|i| {
                [i.wrapping_mul(2_654_435_761), i.wrapping_mul(40_503), i * i]
                    .map(|n| (n % 9973) as f32)
            })
            .collect();
        for ranks in [2, 3, 5, 8] {
            let cuts = cuts(ranks, &points, true);
            let mut owned = vec![0; ranks];
            points.iter().for_each(|point| owned[cuts.owner(*point)] += 1);
            let fair = points.len() / ranks;
            assert!(owned.iter().all(|&n| n + 8 >= fair && n <= fair + 8), "{owned:?}");
        }
    }

    /// Equal points have one owner and nothing is cut at infinity.
    #[test]
    fn equal_points_have_one_owner() {
        for points in [vec![[1.0, 2.0, 3.0]; 50], Vec::new()] {
            let cuts = cuts(5, &points, true);
            let owners: Vec<_> = points.iter().map(|point| cuts.owner(*point)).collect();
            assert!(owners.windows(2).all(|two| two[0] == two[1]));
            assert!(cuts.owner([f32::MAX, 0.0, f32::MIN]) < 5);
        }
    }

    /// The cell of a point is its owner's and nearness is the distance to cells.
    #[test]
    fn near_cells_match_their_distance() {
        let points = points();
        let ranks = 8;
        let cuts = cuts(ranks, &points, true);
        let cells = cuts.cells(ranks);
        for point in &points {
            let far = 1.5;
            let distance = |rank: usize| {
                let [lo, hi] = cells[rank];
                let gap = |axis: usize| {
                    let [x, lo, hi] = [point[axis], lo[axis], hi[axis]].map(f64::from);
                    (lo - x).max(x - hi).max(0.0)
                };
                gap(0).max(gap(1)).max(gap(2))
            };
            let owner = cuts.owner(*point);
            let [lo, hi] = cells[owner];
            assert!((0..3).all(|axis| lo[axis] <= point[axis] && point[axis] < hi[axis]));
            let mut seen = Vec::new();
            cuts.near(*point, far, &mut |rank, away| {
                assert_eq!(away, distance(rank));
                seen.push(rank);
            });
            seen.sort_unstable();
            let expected: Vec<_> = (0..ranks).filter(|&rank| distance(rank) <= far).collect();
            assert_eq!(seen, expected);
        }
    }
}
