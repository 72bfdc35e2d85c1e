//! Boxes in space that repeats, which touch across the borders of its cells.
//!
//! Boxes are in rows of two. Along some axes, the first box of a row ends exactly where an image of
//! the second one begins, or overlaps it by an ulp, or ends an ulp before it. Along the others,
//! both are in one place. Ends and periods are whole numbers of a short binary unit, so that their
//! sums are exact, unless a kind is about other numbers.

use rand::{Rng, RngExt};

use super::boxes::of_boxes;
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use crate::contestant::WorldBox;
use sdop::rounding::floor_f32;

/// Where boxes touch, or what changes from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeriodicKind {
    /// Across the border of one axis.
    Face,
    /// Across the borders of two axes at once.
    Edge,
    /// Across the borders of all axes at once.
    Corner,
    /// One of two boxes is many periods away, and the period has all bits of an f64.
    Far,
    /// One of two boxes begins so near to zero that its sum with a period, rounded, is the period.
    Rounded,
    /// The periods change from frame to frame, and nothing else does.
    Changed,
    /// The first box of each row moves across a border. Then half of them continue, and half jump
    /// back by a period; in every other case these are removed, and new ones are inserted there.
    Crossing,
}

const ROWS: usize = 12;
const FRAMES: usize = 6;
const UNIT: f32 = 1.0 / 64.0;
/// The shortest period, and by how much the longest is longer.
const PERIODS: [f64; 2] = [32.0, 8.0];
/// How far a box moves per frame.
const STEP: f32 = 24.0 * UNIT;

type Periods = [Option<f64>; 3];

/// A case whose boxes touch across the border of the axis of this number, modulo 3, or of the other
/// two, or of several.
pub fn touching(
    kind: PeriodicKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let crossed: [bool; 3] = std::array::from_fn(|axis| match kind {
        PeriodicKind::Face => axis == number as usize % 3,
        PeriodicKind::Edge => axis != number as usize % 3,
        PeriodicKind::Corner => true,
        _ => axis == number as usize % 3 || rng.random(),
    });
    let periods = draw_periods(kind, crossed, rng);
    // If periods change, half of the rows touch by the first ones and half by the second ones.
    let across =
        |row: usize| [0, 1, 2].map(|axis| periods[row % 2][axis].filter(|_| crossed[axis]));
    let rows: Vec<[WorldBox; 2]> =
        (0..ROWS).map(|row| row_boxes(kind, row, across(row), rng)).collect();
    let count = match kind {
        PeriodicKind::Changed | PeriodicKind::Crossing => FRAMES,
        _ => 1,
    };
    let (mut shapes, mut frames) = (Vec::new(), Vec::new());
    for n in 0..count {
        let mut boxes = Vec::new();
        for (row, &[mut first, second]) in rows.iter().enumerate() {
            if kind == PeriodicKind::Crossing {
                first = moved(first, row, n, across(row));
            }
            boxes.extend(in_order(row, [first, second]));
        }
        let dynamic = (0..boxes.len()).map(|i| i % 5 != 4).collect();
        let (point, frame) = of_boxes(boxes, dynamic)?;
        shapes = vec![point];
        frames.push(Frame {
            periods: Some(match kind {
                PeriodicKind::Changed if n == 3 => [None; 3],
                _ => periods[n % 2],
            }),
            was: (kind == PeriodicKind::Crossing && number % 2 == 1 && n > 0).then(|| former(n)),
            ..frame
        });
    }
    Ok(DrawnCase { shapes, frames })
}

/// The periods of all axes that are crossed and of some others: two sets for frames that change
/// them, otherwise the same set twice.
fn draw_periods(kind: PeriodicKind, crossed: [bool; 3], rng: &mut impl Rng) -> [Periods; 2] {
    let has_period = crossed.map(|crossed| crossed || rng.random());
    let mut set = || {
        has_period.map(|has_period| {
            let more = match kind {
                PeriodicKind::Far => rng.random_range(0.0..PERIODS[1]),
                // Half a period is a whole number of units, too.
                _ => f64::from(2.0 * units(0..=256, rng)),
            };
            has_period.then_some(PERIODS[0] + more)
        })
    };
    let first = set();
    match kind {
        PeriodicKind::Changed => [first, set()],
        _ => [first; 2],
    }
}

fn units(range: std::ops::RangeInclusive<i32>, rng: &mut impl Rng) -> f32 {
    UNIT * rng.random_range(range) as f32 // few units
}

/// Two boxes that touch across the borders of the axes that have a period here.
fn row_boxes(kind: PeriodicKind, row: usize, across: Periods, rng: &mut impl Rng) -> [WorldBox; 2] {
    let (mut first, mut second) = ([0.0; 6], [0.0; 6]);
    for axis in 0..3 {
        let sides = [units(1..=64, rng), units(1..=64, rng)];
        let (end, begin) = match across[axis] {
            Some(period) => across_border(kind, row, period, rng),
            None => {
                let begin = units(-1024..=1024, rng);
                (begin + sides[0], begin)
            }
        };
        (first[axis], first[axis + 3]) = (end - sides[0], end);
        (second[axis], second[axis + 3]) = (begin, begin + sides[1]);
    }
    [first, second]
}

/// Where the first box of a row ends, and where the second one begins: at an image of that end. In
/// every third row it begins an ulp lower, and in another third an ulp higher, so that the boxes
/// are apart.
fn across_border(kind: PeriodicKind, row: usize, period: f64, rng: &mut impl Rng) -> (f32, f32) {
    let near = |begin: f32| [begin, begin.next_down(), begin.next_up()][row % 3];
    match kind {
        PeriodicKind::Far => {
            // Exact.
            let rest = |end: f32| f64::from(end) % period;
            let ends: [f32; 64] = std::array::from_fn(|_| far_end(period, rng));
            // The nearer to zero the image is, the finer is the f32 there.
            let end = ends.into_iter().fold(ends[0], |best, end| {
                if rest(end).abs() < rest(best).abs() { end } else { best }
            });
            (end, near(floor_f32(rest(end))))
        }
        PeriodicKind::Rounded => {
            let tiny = 2_f32.powi(-rng.random_range(60..=120));
            let end = period as f32 * rng.random_range(1..=4) as f32;
            (end, [0.0, -tiny, tiny][row % 3])
        }
        _ => {
            // The border of a cell about zero, or of one that begins there.
            let border = period as f32 * [0.5, 1.0][row / 4 % 2];
            let end = border + units(-16..=16, rng);
            (end, near(end - period as f32))
        }
    }
}

/// A position some hundreds to many millions of periods away, half of the time as far as may be.
fn far_end(period: f64, rng: &mut impl Rng) -> f32 {
    let exponent = if rng.random() { 26 } else { rng.random_range(8..=26) };
    let side = if rng.random() { 1.0 } else { -1.0 };
    (side * rng.random_range(1.0..2.0) * 2_f64.powi(exponent) * period) as f32
}

/// In half of the rows, the first box has the higher number.
fn in_order<T>(row: usize, [first, second]: [T; 2]) -> [T; 2] {
    if (row / 2).is_multiple_of(2) { [first, second] } else { [second, first] }
}

/// The frame in which the boxes of a row touch.
fn touch_frame(row: usize) -> usize {
    2 + row % 2
}

/// Whether the first box of a row jumps back after it has crossed the border.
fn jumps(row: usize) -> bool {
    row < ROWS / 2
}

/// The first box of a row in a frame, on its way across the borders.
fn moved(mut first: WorldBox, row: usize, n: usize, across: Periods) -> WorldBox {
    let way = STEP * (n as f32 - touch_frame(row) as f32); // few frames
    for axis in 0..3 {
        if let Some(period) = across[axis] {
            let jump = if jumps(row) && n > touch_frame(row) { period as f32 } else { 0.0 };
            first[axis] += way - jump;
            first[axis + 3] += way - jump;
        }
    }
    first
}

/// The former numbers of all boxes; one that has just jumped is new.
fn former(n: usize) -> Vec<Option<u32>> {
    let rows = (0..ROWS).flat_map(|row| {
        let is_new = jumps(row) && n == touch_frame(row) + 1;
        in_order(row, [is_new, false])
    });
    let numbers = rows.zip(0..);
    numbers.map(|(is_new, number)| (!is_new).then_some(number)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::truth::images;

    /// Of each three rows, the first ones touch to the bit: they meet in one image, across as many
    /// borders as the kind is about, and not if an end moves by an ulp. The last ones are apart.
    #[test]
    fn rows_touch_across_borders() {
        for (kind, borders) in
            [(PeriodicKind::Face, 1), (PeriodicKind::Edge, 2), (PeriodicKind::Corner, 3)]
        {
            for number in 0..3 {
                let case = touching(kind, number, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
                let frame = &case.frames[0];
                let periods = frame.periods.unwrap();
                for row in 0..ROWS {
                    let pair = [frame.boxes[2 * row], frame.boxes[2 * row + 1]];
                    let [first, mut second] = in_order(row, pair);
                    let met = images(&first, &second, periods);
                    assert_eq!(met.len(), usize::from(row % 3 < 2), "{kind:?}, row {row}");
                    let Some(image) = met.first() else { continue };
                    let crossed: Vec<usize> = (0..3).filter(|&axis| image[axis] != 0).collect();
                    assert_eq!(crossed.len(), borders, "{kind:?}, row {row}");
                    second[crossed[0]] = second[crossed[0]].next_up();
                    let still = !images(&first, &second, periods).is_empty();
                    assert_eq!(still, row % 3 == 1, "{kind:?}, row {row}");
                }
            }
        }
    }
}
