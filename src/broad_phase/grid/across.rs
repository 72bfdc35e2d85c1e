//! Pairs between two levels of the grid: whichever side is cheaper searches for the other.

use super::level::GridLevel;
use super::{Grid, GridPart, PartSearch};
use crate::broad_phase::BlockPage;
use crate::rounding::widen;

/// How bodies of one level find those of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelSearch {
    /// Each searches the cells around it.
    Cells,
    /// Each is tested against all.
    All,
}

/// The cost of searching one row of cells, in bodies tested in a long run (10 cycles per row, 0.7
/// per body).
const BODIES_PER_ROW_SEARCH: f64 = 15.0;

/// The cheapest way to find the pairs of two levels, estimated from bodies and sizes: whether `a`
/// searches for `b`, and how.
pub fn plan(a: &GridLevel, b: &GridLevel) -> (bool, LevelSearch) {
    let all = a.range.len() as f64 * b.range.len() as f64;
    let mut best = (a.range.len() < b.range.len(), LevelSearch::All, all);
    for (seeker, target, is_a) in [(a, b, true), (b, a, false)] {
        let across = 2.0 * (seeker.widest + target.widest) / target.cells.size();
        // Nearly always. Rounding and the seeker's position may add one.
        let span = across + 1.0;
        if span >= f64::from(target.cells.most_span()) {
            continue;
        }
        let cells = |axis: usize| span.min(f64::from(target.cells.count()[axis]));
        let found =
            all * (0..3).map(|i| cells(i) / f64::from(target.cells.count()[i])).product::<f64>();
        let cost = seeker.range.len() as f64 * cells(1) * cells(2) * BODIES_PER_ROW_SEARCH + found;
        if cost < best.2 {
            best = (is_a, LevelSearch::Cells, cost);
        }
    }
    (best.0, best.1)
}

impl Grid {
    /// Lists pairs of which one slot is in the search's first block and the other in another level;
    /// as many as there is room for.
    #[inline(always)]
    pub(super) fn across(
        &self,
        part: &GridPart,
        how: LevelSearch,
        search: &mut PartSearch,
        page: &mut BlockPage,
    ) {
        let (grown, target) = (self.levels[part.seeker].reach, &self.levels[part.level]);
        let (starts, bodies) = (target.starts.as_slice(), search.block());
        let (table, most_span) = (target.cells.table_len(), target.cells.most_span());
        let mut pen = page.restart(bodies.start);
        for lane in search.lane..bodies.len() {
            if how == LevelSearch::All {
                pen.push_long(lane, target.slots());
                continue;
            }
            let resumed = search.row.take();
            let ball = &self.slots.balls[bodies.start + lane];
            let reach = f64::from(widen(grown.of(ball[3]))) + target.widest;
            let Some([lo, hi]) = target.cells.around(ball, reach) else {
                continue;
            };
            let [mut z, mut y] = resumed.unwrap_or([lo[2], lo[1]]);
            if (0..3).any(|axis| hi[axis] - lo[axis] >= most_span) {
                if pen.is_full(1) {
                    (search.lane, search.row) = (lane, None);
                    return pen.done();
                }
                pen.push(lane, target.slots());
                continue;
            }
            while z <= hi[2] {
                while y <= hi[1] {
                    if pen.is_full(2) {
                        (search.lane, search.row) = (lane, Some([z, y]));
                        return pen.done();
                    }
                    let row = target.cells.index([lo[0], y, z]) as usize;
                    let end = row + (hi[0] - lo[0]) as usize + 1;
                    pen.push(lane, starts[row]..starts[end.min(table)]);
                    if end > table {
                        pen.push(lane, starts[0]..starts[end - table]);
                    }
                    y += 1;
                }
                (z, y) = (z + 1, lo[1]);
            }
        }
        pen.done();
        search.next_block();
    }
}

#[cfg(test)]
mod tests {
    use super::super::PartKind;
    use super::super::cells::{Cells, TableLayout};
    use std::ops::Range;

    use super::*;
    use crate::broad_phase::{BallBounds, Block, FirstTest};
    use crate::simd::{Kernel, Lanes, Tier, dispatch};

    const TARGETS: usize = 24;
    const SEEKERS: usize = 30;

    /// How often each target is a candidate of each seeker.
    struct PairCount([[u32; TARGETS]; SEEKERS]);

    impl FirstTest for PairCount {
        fn run<L: Lanes>(&mut self, _: L, i: usize, run: Range<usize>) {
            run.for_each(|j| self.0[i - TARGETS][j] += 1);
        }
        fn block<L: Lanes>(&mut self, _: L, block: &Block<'_>) {
            for &code in block.codes() {
                let i = block.first() + (code & 15) as usize;
                self.0[i - TARGETS][(code >> 4) as usize] += 1;
            }
        }
    }

    struct SearchAcross<'a>(&'a Grid);

    impl Kernel for SearchAcross<'_> {
        type Output = PairCount;
        fn run<L: Lanes>(self, l: L) -> PairCount {
            let mut count = PairCount([[0; TARGETS]; SEEKERS]);
            self.0.find(l, 0..1, &mut count);
            count
        }
    }

    /// In a table this short the rows of a fourth cell overlap those of the first.
    #[test]
    fn wide_search_finds_each_once() {
        for radius in [0.9, 1.0, 1.5, 2.1, 3.0, 40.0] {
            let balls: Vec<[f32; 4]> = (0..TARGETS + SEEKERS)
                .map(|i| {
                    let (x, y, z) = (i % 3, i / 3 % 8, i % 2);
                    let radius = if i < TARGETS { 1.0 } else { radius };
                    [1.7 * x as f32, 2.3 * y as f32, 1e5 * z as f32, radius]
                })
                .collect();
            let names: Vec<u32> = (0..balls.len() as u32).collect();
            let levels = [0..TARGETS, TARGETS..balls.len()]
                .map(|range| GridLevel::new(range, TableLayout::Wrapped));
            let mut grid = Grid {
                levels: levels.to_vec(),
                moving_levels: 2,
                fixed_sorted: false,
                ..Grid::default()
            };
            let pool = crate::threads::Threads::default();
            let executor = crate::threads::Executor { tier: Tier::SCALAR, pool: &pool };
            grid.arrange(executor, &balls, &names);
            let (slots, kind) =
                (grid.levels[1].range.clone(), PartKind::Across(LevelSearch::Cells));
            grid.parts = vec![GridPart { slots, seeker: 1, level: 0, kind }];
            let PairCount(found) = dispatch(Tier::SCALAR, SearchAcross(&grid));
            for (i, found) in (TARGETS..).zip(found) {
                for (j, times) in found.into_iter().enumerate() {
                    let [a, b] = [i, j].map(|slot| grid.slots.balls[slot]);
                    let meet = (0..3).all(|k| (a[k] - b[k]).abs() <= a[3] + b[3]);
                    assert!(times <= 1 && times >= u32::from(meet), "{radius}: {times}");
                }
            }
        }
    }

    /// A level of this many bodies, the widest of radius `widest`, with this many cells along each
    /// axis, which are at least as wide as that body.
    fn level(bodies: usize, widest: f32, cells: [u8; 3], layout: TableLayout) -> GridLevel {
        let mut level = GridLevel::new(0..bodies, layout);
        let hi = cells.map(|count| 2.0 * widest * (f32::from(count) - 1.0));
        let bounds = BallBounds { lo: [0.0; 3], hi, widest };
        level.cells = Cells::fit(&bounds, bodies, layout);
        assert_eq!(level.cells.count(), cells.map(u32::from));
        level.widest = widen(widest).into();
        level
    }

    /// A look at a row costs fifteen tests: of n bodies in a box of c cells, s of which a seeker
    /// may reach, cells are looked through when 15·s_y·s_z < n·(1 − s_x·s_y·s_z/c).
    #[test]
    fn search_mode_follows_row_cost() {
        for (radius, cells, most) in
            [(0.5, [10, 4, 2], 116), (1.5, [20, 8, 6], 431), (0.25, [9, 9, 9], 95)]
        {
            for seekers in [1, 7] {
                let seekers = level(seekers, radius, [1; 3], TableLayout::Box);
                let target = |bodies| level(bodies, 0.5, cells, TableLayout::Box);
                for (bodies, search) in [(most, LevelSearch::All), (most + 1, LevelSearch::Cells)] {
                    let target = target(bodies);
                    assert_eq!(plan(&seekers, &target), (true, search), "{radius}, {bodies}");
                    assert_eq!(plan(&target, &seekers), (false, search), "{radius}, {bodies}");
                }
            }
        }
    }

    /// Only seekers of similar size search a wrapped table.
    #[test]
    fn wrapped_table_needs_similar_seekers() {
        let target = level(10_000, 0.5, [200; 3], TableLayout::Wrapped);
        for (radius, search) in [(0.5, LevelSearch::Cells), (0.6, LevelSearch::All)] {
            let seeker = level(1, radius, [1; 3], TableLayout::Box);
            assert_eq!(plan(&seeker, &target), (true, search), "{radius}");
        }
    }
}
