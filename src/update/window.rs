//! or-DOP rows of a stretch of places that moves on through them.
//!
//! A million rows are 64 MB: written by the update and read by the test, they go to memory and back. Pairs come in the order of
//! slots, and where places have nearly that order, rows made shortly before they are wanted are still in the second-level cache.
//! The rows stand in a ring, so that one that leaves makes room for one that comes.

use std::ops::Range;

use super::lines::Lines;
use super::rows::{BODIES, InTurn, Posed};
use crate::simd::{Tier, dispatch};

/// The longest stretch that is covered; its ring takes 8 MB.
pub const MOST_ROWS: usize = 1 << 16;

/// The shortest ring.
const FEWEST_ROWS: usize = 1 << 12;

/// Rows are made so many at once, beyond those that are wanted.
const TOGETHER: usize = 256;

/// The rows of consecutive places.
#[derive(Clone, Debug, Default)]
pub struct RowWindow {
    /// A power of two of them: the row of a place has the number of its lower bits.
    ring: Lines,
    /// The places whose rows are there, of this frame.
    places: Range<usize>,
}

impl RowWindow {
    /// Forgets all rows: those of another frame.
    pub fn clear(&mut self) {
        self.places = 0..0;
    }

    /// Sees to it that the rows of these places are there. There are no more of them than [`MOST_ROWS`].
    pub fn cover(&mut self, tier: Tier, posed: Posed<'_>, wanted: Range<usize>) {
        debug_assert!(wanted.len() <= MOST_ROWS, "{wanted:?}");
        let (start, all) = (wanted.start / BODIES * BODIES, posed.places.body.len());
        let needed = (wanted.end - start + TOGETHER).next_power_of_two();
        if needed > self.ring.len() {
            self.ring.resize(needed.max(FEWEST_ROWS));
            self.places = start..start; // each row has another number now
        }
        if !(self.places.start..=self.places.end).contains(&start) {
            self.places = start..start;
        }
        if wanted.end <= self.places.end {
            return;
        }
        let end = all.min(wanted.end.next_multiple_of(TOGETHER));
        let ring = self.ring.len();
        while self.places.end < end {
            let first = self.places.end;
            let at = first % ring;
            let len = (end - first).min(ring - at);
            let rows = &mut self.ring[at..at + len];
            dispatch(tier, InTurn { posed, first, rows });
            self.places.end += len;
        }
        self.places.start = self.places.start.max(end.saturating_sub(ring));
    }

    /// The ring, of a power of two of rows.
    #[must_use]
    pub fn rows(&self) -> &Lines {
        &self.ring
    }
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

    /// Stretches that follow each other, that go back, that leave some out, and that are too long for the ring that is there.
    #[test]
    fn the_rows_of_covered_places_are_those_of_an_update() {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let mut bodies = Bodies::default();
        for i in 0..20_001 {
            let x = i as f32;
            bodies.push(0, true, [x, 1.0 - x, 2.0, 3.0], [x, 0.0, -x]);
        }
        let (places, pool) = (Places::new(&bodies), Threads::default());
        let frames = [ShapeFrame::new(&shape, &shape.ordop.basis)]
            .into_iter()
            .collect();
        let posed = Posed {
            frames: &frames,
            bodies: &bodies,
            places: &places,
            balls: &[],
        };
        for tier in Tier::available() {
            let mut all = OrDopRows::new(20_001);
            all.update(pool.executor(tier), posed, 0..20_001, 1);
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
                20_000..20_001,
            ] {
                window.cover(tier, posed, wanted.clone());
                let ring = window.rows().len();
                assert!(ring.is_power_of_two());
                for place in wanted {
                    let row = window.rows()[place % ring];
                    assert_eq!(row, all.rows[place], "{tier}: {place} of {ring}");
                }
            }
        }
    }
}
