//! Which bodies share a level: as few levels as keep cells from crowding.
//!
//! Balls that overlap little can only crowd a cell by being much smaller than it. So the widest octave gets a level of its
//! own as long as the cells that it asks for are crowded, and what is left is looked at again, with smaller cells. One size
//! gives one level, a giant among many small ones two.

use std::ops::Range;

use super::cells::{Cells, Layout};
use super::level::{Assign, Level};
use crate::broad_phase::Bounds;
use crate::simd::{self, dispatch};

/// Bodies that a body may find in its own cell, itself included, in the mean, before wide ones are split off. Uniform
/// scenes reach it at 13 sphere partners a body.
const CROWD: u64 = 4;

/// Levels for moving or for static bodies each.
const MOST_LEVELS: usize = 24;

/// A wrapped table must promise to halve the candidates: its rows lie scattered.
const WORTH_WRAPPING: u64 = 2;

/// Splits a range of places into levels, widest balls first. `order` lists the places in the range and is sorted by
/// level; within a level it stays as it was.
pub fn levels(balls: &[[f32; 4]], range: Range<usize>, order: &mut [u32]) -> Vec<Level> {
    let mut levels = Vec::new();
    let mut from = 0;
    while from < order.len() {
        let rest = &mut order[from..];
        let mut level = gather(balls, rest);
        let (mut layout, crowd) = fit(&level);
        let half = 0.5 * Bounds::of(simd::Tier::SCALAR, &level).widest;
        let wide = |place: &u32| balls[*place as usize][3] > half;
        let crowded = crowd > CROWD * rest.len() as u64 && levels.len() + 1 < MOST_LEVELS;
        let mut count = rest.len();
        if crowded && !rest.iter().all(wide) {
            rest.sort_by_key(|place| !wide(place));
            count = rest.iter().filter(|place| wide(place)).count();
            level = gather(balls, &rest[..count]);
            layout = fit(&level).0;
        }
        let start = range.start + from;
        levels.push(Level::new(start..start + count, layout));
        from += count;
    }
    levels
}

fn gather(balls: &[[f32; 4]], places: &[u32]) -> Vec<[f32; 4]> {
    places.iter().map(|&p| balls[p as usize]).collect()
}

/// The better layout for some balls, and how crowded its cells are: the sum over balls of the balls in the same cell.
fn fit(balls: &[[f32; 4]]) -> (Layout, u64) {
    let bounds = Bounds::of(simd::Tier::SCALAR, balls);
    let [in_box, wrapped] =
        [Layout::Box, Layout::Wrapped].map(|layout| Cells::fit(&bounds, balls.len(), layout));
    let crowd_in_box = crowd(&in_box, balls);
    if in_box.size() > wrapped.size() {
        let crowd_wrapped = crowd(&wrapped, balls);
        if WORTH_WRAPPING * crowd_wrapped < crowd_in_box {
            return (Layout::Wrapped, crowd_wrapped);
        }
    }
    (Layout::Box, crowd_in_box)
}

fn crowd(cells: &Cells, balls: &[[f32; 4]]) -> u64 {
    let mut cell_of = vec![0; balls.len()];
    let to = &mut cell_of;
    dispatch(simd::Tier::SCALAR, Assign { cells, balls, to });
    let mut counts = vec![0u64; cells.table_len()];
    for &cell in &cell_of {
        counts[cell as usize] += 1;
    }
    counts.iter().map(|n| n * n).sum()
}
