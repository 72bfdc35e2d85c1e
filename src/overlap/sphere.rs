//! Sphere against spheres: cull iff d² > s², s = R_i + R_j, with R from [`inflate_radius`].
//!
//! d² sums the squares of coordinate differences: expanding the square instead would cancel far from the origin.
//!
//! [`inflate_radius`]: crate::rounding::sphere::inflate_radius

use std::ops::Range;

use crate::broad_phase::{Arranged, Block, SlotTest};
use crate::rounding::sphere::apart;
use crate::simd::{LANES, Lanes, MAX_WIDTH, quads_in_columns};

impl SlotTest for Arranged<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        let me = self.ball(i).map(|number| l.splat(number));
        let [x, y, z, r] = self.columns;
        let (mut start, mut found) = (run.start, 0);
        if x.is_empty() {
            while start < run.end {
                let other = l.load_quads(&self.balls[start..]);
                found += list(
                    l,
                    me,
                    other,
                    start..run.end,
                    &mut hits[found..found + MAX_WIDTH],
                );
                start += L::WIDTH;
            }
            return found;
        }
        // Equally long, they need one check of bounds a vector.
        let [y, z, r] = [y, z, r].map(|column| &column[..x.len()]);
        while start < run.end {
            let vector = start..start + L::WIDTH;
            let other = [
                l.load(&x[vector.clone()]),
                l.load(&y[vector.clone()]),
                l.load(&z[vector.clone()]),
                l.load(&r[vector.clone()]),
            ];
            found += list(
                l,
                me,
                other,
                start..run.end,
                &mut hits[found..found + MAX_WIDTH],
            );
            start = vector.end;
        }
        found
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let ours = quads_in_columns(l, &self.balls[block.first()..]);
        let count = block.codes().len();
        let (mut start, mut found) = (0, 0);
        while start < count {
            let (code, [one, other]) = block.balls(l, start, &ours, self.balls);
            let hit = touching(l, one, other, count - start);
            l.compress(hit, code, &mut hits[found..]);
            found += hit.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}

/// Writes the slots of a vector of balls that touch `me`, the vector being the first of `run`'s; how many.
///
/// No branch upon them: it would be foreseen badly, and cost the more the more pairs touch.
#[inline(always)]
fn list<L: Lanes>(
    l: L,
    me: [L::F; 4],
    other: [L::F; 4],
    run: Range<usize>,
    hits: &mut [u32],
) -> usize {
    let hit = touching(l, me, other, run.end - run.start);
    let slot = l.add_u32(l.splat_u32(run.start as u32), l.load_u32(&LANES));
    l.compress(hit, slot, hits);
    hit.count_ones() as usize
}

/// Bits of the lanes below `count` that no gap separates.
#[inline(always)]
fn touching<L: Lanes>(l: L, one: [L::F; 4], other: [L::F; 4], count: usize) -> u32 {
    let (dx, dy, dz) = (other[0] - one[0], other[1] - one[1], other[2] - one[2]);
    let s = other[3] + one[3];
    !l.bits(apart(l, [dx, dy, dz], s)) & l.bits(l.first(count))
}

#[cfg(test)]
mod tests {
    use crate::broad_phase::Slots;
    use crate::broad_phase::whole_vectors::{SLOTS, check};

    #[test]
    fn balls_that_fill_their_vectors_cost_no_vector_more() {
        let mut slots = Slots {
            balls: vec![[1.0; 4]; SLOTS],
            ..Slots::default()
        };
        check(&slots.arranged());
        slots.columns = [(); 4].map(|()| vec![1.0; SLOTS]);
        check(&slots.arranged());
    }
}
