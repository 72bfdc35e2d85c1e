//! or-DOP rows of stretches of places that move on through them.
//!
//! A million rows are 64 MB: written by the update and read by the test, they go to memory and
//! back. Pairs come in the order of slots, and where places have nearly that order, rows made
//! shortly before they are wanted are still in the second-level cache. The rows stand in two rings,
//! so that one that leaves makes room for one that comes: bodies that move have the first places,
//! the others the last, and those that are near each other in space lie near each other in both.

use std::ops::Range;

use super::lines::Lines;
use super::lookup::RowsByNumber;
use super::rows::{BODIES, InTurn, Posed};
use crate::simd::{ROW, Tier, dispatch};

/// The longest stretch that is covered; its ring takes 8 MB.
pub const MOST_ROWS: usize = 1 << 16;

/// The shortest ring.
const FEWEST_ROWS: usize = 1 << 12;

/// Rows are made so many at once, beyond those that are wanted.
const TOGETHER: usize = 256;

/// The rows of two stretches of consecutive places, of bodies that move and of bodies that don't.
#[derive(Clone, Debug, Default)]
pub struct RowWindow {
    /// Two rings, each a power of two of rows: the row of a place has the number of its lower bits.
    rings: Lines,
    /// The places whose rows are in each ring, of this frame.
    held: [Range<usize>; 2],
}

impl RowWindow {
    /// Forgets all rows: those of another frame.
    pub fn clear(&mut self) {
        self.held = Default::default();
    }

    /// Sees to it that the rows of these places are there, first those of bodies that move, then
    /// the others. There are no more of either than [`MOST_ROWS`]. Bodies that don't move have
    /// their rows in `made`, by place.
    pub fn cover(
        &mut self,
        tier: Tier,
        posed: Posed<'_>,
        made: &[[f32; ROW]],
        wanted: [Range<usize>; 2],
    ) {
        let longest = wanted[0].len().max(wanted[1].len());
        debug_assert!(longest <= MOST_ROWS, "{wanted:?}");
        let needed = (longest + BODIES + TOGETHER).next_power_of_two();
        if 2 * needed > self.rings.len() {
            self.rings.resize(2 * needed.max(FEWEST_ROWS));
            self.clear(); // each row has another number now
        }
        let ring = self.rings.len() / 2;
        let (first, second) = self.rings.split_at_mut(ring);
        let [moving, still] = &mut self.held;
        let [wanted, wanted_still] = wanted;
        let update = |first, rows: &mut [_]| dispatch(tier, InTurn { posed, first, rows });
        fill(first, moving, wanted, posed.places.moving, update);
        let copy = |first: usize, rows: &mut [[f32; ROW]]| {
            rows.copy_from_slice(&made[first..first + rows.len()]);
        };
        fill(second, still, wanted_still, posed.places.len(), copy);
    }

    /// The rows that are there; bodies that move have the places below `moving`.
    #[must_use]
    pub fn rows(&self, moving: usize) -> RowsByNumber<'_> {
        RowsByNumber::in_rings(&self.rings, moving)
    }
}

/// Sees to it that a ring, which holds the rows of some places, has those that are wanted, and some
/// that follow up to the place `limit`. `make` makes the rows from a place on.
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
    let start = wanted.start / BODIES * BODIES;
    if !(held.start..=held.end).contains(&start) {
        *held = start..start;
    }
    let end = limit.min(wanted.end.next_multiple_of(TOGETHER));
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

    /// Stretches that follow each other, that go back, that leave some out, and that are too long
    /// for the ring that is there.
    #[test]
    fn the_rows_of_covered_places_are_those_of_an_update() {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let mut bodies = Bodies::default();
        for i in 0..40_001 {
            let x = i as f32;
            bodies.push(0, i % 2 == 0, [x, 1.0 - x, 2.0, 3.0], [x, 0.0, -x]);
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
