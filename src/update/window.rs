//! [`RowWindow`]: or-DOP rows of a moving window of places.
//!
//! A million rows are 64 MB, which the update would write to memory and the test would read back.
//! Pairs come in the order of slots. If places have nearly that order, rows can be computed shortly
//! before they are needed and are still in the second-level cache. Rows are in two rings, in which
//! new rows overwrite old ones: one for moving bodies, which have the first places, and one for
//! static bodies. Neighbours in space are near each other in both.

use std::ops::Range;

use super::aligned_rows::AlignedRows;
use super::rows::{BODIES_PER_BATCH, ConsecutiveRows, UpdateInputs};
use super::rows_by_number::RowsByNumber;
use crate::simd::{ROW, Tier, dispatch};

/// The longest window, in rows; its ring takes 8 MB.
pub const MOST_ROWS: usize = 1 << 16;

/// The shortest ring, in rows.
const FEWEST_ROWS: usize = 1 << 12;

/// Rows that are computed at once, beyond those that are needed.
const ROWS_PER_BATCH: usize = 256;

/// The rows of two ranges of consecutive places, one of moving and one of static bodies.
#[derive(Clone, Debug, Default)]
pub struct RowWindow {
    /// Two rings whose length is a power of two. The lower bits of a place are the index of its
    /// row.
    rings: AlignedRows,
    /// The places whose rows of this frame are in each ring.
    held: [Range<usize>; 2],
}

impl RowWindow {
    /// Forgets all rows, at the start of a frame.
    pub fn clear(&mut self) {
        self.held = Default::default();
    }

    /// Ensures that the rows of these two ranges of places are in the rings: first of moving
    /// bodies, then of static ones. Each range has at most [`MOST_ROWS`] places. The rows of static
    /// bodies are copied from `made`, which is by place.
    pub fn cover(
        &mut self,
        tier: Tier,
        posed: UpdateInputs<'_>,
        made: &[[f32; ROW]],
        wanted: [Range<usize>; 2],
    ) {
        let longest = wanted[0].len().max(wanted[1].len());
        debug_assert!(longest <= MOST_ROWS, "{wanted:?}");
        let needed = (longest + BODIES_PER_BATCH + ROWS_PER_BATCH).next_power_of_two();
        if 2 * needed > self.rings.len() {
            self.rings.resize(2 * needed.max(FEWEST_ROWS));
            self.clear(); // each row has another number now
        }
        let ring = self.rings.len() / 2;
        let (first, second) = self.rings.split_at_mut(ring);
        let [moving, still] = &mut self.held;
        let [wanted, wanted_still] = wanted;
        let update = |first, rows: &mut [_]| dispatch(tier, ConsecutiveRows { posed, first, rows });
        fill(first, moving, wanted, posed.places.moving, update);
        let copy = |first: usize, rows: &mut [[f32; ROW]]| {
            rows.copy_from_slice(&made[first..first + rows.len()]);
        };
        fill(second, still, wanted_still, posed.places.len(), copy);
    }

    /// The rows in the rings. Moving bodies have the places below `moving`.
    #[must_use]
    pub fn rows(&self, moving: usize) -> RowsByNumber<'_> {
        RowsByNumber::in_rings(&self.rings, moving)
    }
}

/// Ensures that a ring has the rows of the places that are wanted, and computes some of the
/// following ones, up to the place `limit`. `make` computes the rows from a place on.
fn fill(
    ring: &mut [[f32; ROW]],
    held: &mut Range<usize>,
    wanted: Range<usize>,
    limit: usize,
    make: impl Fn(usize, &mut [[f32; ROW]]),
) {
    if wanted.is_empty() {
        return;
    }
    let start = wanted.start / BODIES_PER_BATCH * BODIES_PER_BATCH;
    if !(held.start..=held.end).contains(&start) {
        *held = start..start;
    }
    let end = limit.min(wanted.end.next_multiple_of(ROWS_PER_BATCH));
    while held.end < end {
        let at = held.end % ring.len();
        let len = (end - held.end).min(ring.len() - at);
        make(held.end, &mut ring[at..at + len]);
        held.end += len;
    }
    held.start = held.start.max(held.end.saturating_sub(ring.len()));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::bodies::{Bodies, Places};
    use crate::mesh::ProceduralShape;
    use crate::threads::Threads;
    use crate::update::{OrDopRows, ShapeFrame};
    use crate::volume::{Shape, ShapeSpec};

    /// Stretches that follow each other, that go back, that leave some out, and that are as long as
    /// the ring that is there, or longer.
    #[test]
    fn window_rows_match_an_update() {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let mut bodies = Bodies::default();
        for i in 0..40_001 {
            let x = i as f32;
            bodies.push(0, i % 2 == 0, [x, 1.0 - x, 2.0, 3.0], [x, 0.0, -x]);
        }
        let (places, pool) = (Places::new(&bodies), Threads::default());
        let frames = [ShapeFrame::new(&shape, &shape.ordop.basis)].into_iter().collect();
        let posed = UpdateInputs { frames: &frames, bodies: &bodies, places: &places, balls: &[] };
        // Twenty thousand and one that move, then as many less one that don't.
        let moving = places.moving;
        let mut last = 0..0;
        for tier in Tier::available() {
            let mut all = OrDopRows::new(40_001);
            all.update(pool.executor(tier), posed, 0..40_001, 1);
            let mut still = all.rows.clone();
            still[..moving].fill([f32::NAN; ROW]);
            let mut window = RowWindow::default();
            for wanted in [
                5..300,
                290..2000,
                1900..4500,
                4400..8100,
                8090..8100,
                100..200,
                19_000..19_900,
                19_800..20_001,
                9000..18_000,
                17_900..20_001,
                3..16_387, // as long as the ring, which has no room for the rest of its batches
                20_000..20_001,
                0..0,
                77..80,
            ] {
                // Static bodies in the stretches that moving ones had before.
                let others = last.start + moving..(last.end + moving).min(places.len());
                last = wanted.clone();
                window.cover(tier, posed, &still, [wanted.clone(), others.clone()]);
                let rows = window.rows(moving);
                for place in wanted.chain(others) {
                    let row = rows[rows.find(place as u32) as usize];
                    assert_eq!(row, all.rows[place], "{tier}: {place}");
                }
            }
        }
    }
}
