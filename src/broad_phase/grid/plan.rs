//! Planning the levels: as few levels as possible without crowded cells.
//!
//! Balls that overlap little can crowd a cell only if they are much smaller than it. Therefore,
//! while cells are crowded, the bodies in the largest octave of radii get a level of their own, and
//! the rest is examined again with smaller cells. Bodies of one size give one level, a giant among
//! many small bodies gives two.

use std::ops::Range;

use super::cells::{Cells, TableLayout};
use super::level::{AssignCells, GridLevel};
use crate::broad_phase::BallBounds;
use crate::simd::{Tier, in_one_lane};

/// The mean number of bodies in a body's cell, including itself, above which large bodies are split
/// off. Uniform scenes reach it at 13 sphere partners per body.
const MOST_PER_CELL: u64 = 4;

/// The most levels of moving bodies, and of static bodies.
const MOST_LEVELS: usize = 24;

/// By which factor a wrapped table must reduce the candidates to be used, because its rows are
/// scattered in memory.
const LEAST_WRAP_GAIN: u64 = 2;

/// Splits a range of places into levels, largest balls first. `order` lists the places in the range
/// and gets sorted by level; within a level the order stays.
pub fn levels(balls: &[[f32; 4]], range: Range<usize>, order: &mut [u32]) -> Vec<GridLevel> {
    let mut levels = Vec::new();
    let mut from = 0;
    while from < order.len() {
        let rest = &mut order[from..];
        let mut level = gather(balls, rest);
        let (mut layout, crowd) = fit(&level);
        let half = 0.5 * BallBounds::of(Tier::SCALAR, &level).widest;
        let wide = |place: &u32| balls[*place as usize][3] > half;
        let crowded = crowd > MOST_PER_CELL * rest.len() as u64 && levels.len() + 1 < MOST_LEVELS;
        let mut count = rest.len();
        // No ball is large if the largest radius is infinite.
        let wide_count = rest.iter().filter(|place| wide(place)).count();
        if crowded && (1..count).contains(&wide_count) {
            rest.sort_by_key(|place| !wide(place));
            count = wide_count;
            level = gather(balls, &rest[..count]);
            layout = fit(&level).0;
        }
        let start = range.start + from;
        levels.push(GridLevel::new(start..start + count, layout));
        from += count;
    }
    levels
}

fn gather(balls: &[[f32; 4]], places: &[u32]) -> Vec<[f32; 4]> {
    places.iter().map(|&p| balls[p as usize]).collect()
}

/// The better table layout for some balls, and how crowded its cells are: the sum, over all balls,
/// of the number of balls in the same cell.
fn fit(balls: &[[f32; 4]]) -> (TableLayout, u64) {
    let bounds = BallBounds::of(Tier::SCALAR, balls);
    let [in_box, wrapped] = [TableLayout::Box, TableLayout::Wrapped]
        .map(|layout| Cells::fit(&bounds, balls.len(), layout));
    let crowd_in_box = crowd(&in_box, balls);
    if in_box.size() > wrapped.size() {
        let crowd_wrapped = crowd(&wrapped, balls);
        if LEAST_WRAP_GAIN * crowd_wrapped < crowd_in_box {
            return (TableLayout::Wrapped, crowd_wrapped);
        }
    }
    (TableLayout::Box, crowd_in_box)
}

fn crowd(cells: &Cells, balls: &[[f32; 4]]) -> u64 {
    let mut cell_of = vec![0; balls.len()];
    let to = &mut cell_of;
    in_one_lane(AssignCells { cells, balls, to });
    let mut counts = vec![0u64; cells.table_len()];
    for &cell in &cell_of {
        // A NaN centre has no cell.
        if let Some(count) = counts.get_mut(cell as usize) {
            *count += 1;
        }
    }
    counts.iter().map(|n| n * n).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places and the layout of each level for some balls.
    fn planned(balls: &[[f32; 4]]) -> Vec<(Vec<u32>, TableLayout)> {
        let mut order: Vec<u32> = (0..balls.len() as u32).collect();
        let levels = levels(balls, 10..10 + balls.len(), &mut order);
        let places = levels.iter().map(|level| {
            let own = level.range.start - 10..level.range.end - 10;
            (order[own].to_vec(), level.cells.layout())
        });
        places.collect()
    }

    /// Small balls in one cell of a giant, and giants, the last of the column.
    fn giants(small: u32, wide: u32) -> Vec<[f32; 4]> {
        let near = |i: u32| [0.1 * i as f32, 0.0, 0.0, 0.01];
        let far = |i: u32| [1000.0 * (i + 1) as f32, 0.0, 0.0, 100.0];
        (0..small).map(near).chain((0..wide).map(far)).collect()
    }

    /// Giants leave crowds of small bodies and no others.
    #[test]
    fn giants_leave_small_crowds() {
        let alone = |range: Range<u32>| (range.collect::<Vec<_>>(), TableLayout::Box);
        // In the mean (n² + 1)/(n + 1) bodies are in a body's cell: 4 at most, and they stay.
        for small in 1..5 {
            assert_eq!(planned(&giants(small, 1)), [alone(0..small + 1)]);
        }
        for (small, wide) in [(6, 1), (9, 2), (30, 3)] {
            let expected = [alone(small..small + wide), alone(0..small)];
            assert_eq!(planned(&giants(small, wide)), expected, "{small}, {wide}");
        }
        // Bodies of one size stay together in any crowd.
        assert_eq!(planned(&giants(100, 0)), [alone(0..100)]);
        assert_eq!(planned(&[]), []);
    }

    /// Bodies of all sizes have 24 levels and no more.
    #[test]
    fn levels_are_at_most_24() {
        let octave = |i: i32| [0.0, 0.0, 0.0, 0.5_f32.powi(i)];
        // The last four share a level.
        for (octaves, expected) in [(20, 17), (26, 23), (27, 24), (28, 24), (60, 24)] {
            let balls: Vec<_> = (0..octaves).map(octave).collect();
            assert_eq!(planned(&balls).len(), expected, "{octaves}");
        }
    }

    /// A table is wrapped if and only if that halves the crowd.
    #[test]
    fn wrapping_requires_halving() {
        let mut wrapped = [0; 2];
        for (n, step) in (2..120).flat_map(|n| [0.7_f32, 1.0, 1.5, 4.0].map(|step| (n, step))) {
            let at = |i: usize| i as f32 * step;
            let balls: Vec<_> = (0..n).map(|i| [at(i), at(i), at(i), 0.5]).collect();
            let bounds = BallBounds::of(Tier::SCALAR, &balls);
            let [in_box, others] = [TableLayout::Box, TableLayout::Wrapped]
                .map(|layout| Cells::fit(&bounds, n, layout));
            let crowds = [&in_box, &others].map(|cells| crowd(cells, &balls));
            let halves = in_box.size() > others.size() && 2 * crowds[1] < crowds[0];
            let expected = if halves {
                (TableLayout::Wrapped, crowds[1])
            } else {
                (TableLayout::Box, crowds[0])
            };
            assert_eq!(fit(&balls), expected, "{n}, {step}");
            wrapped[usize::from(halves)] += 1;
        }
        assert!(wrapped.iter().all(|&times| times > 20), "{wrapped:?}");
    }
}
