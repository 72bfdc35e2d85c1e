//! Traits for volume tests of slots: candidates come in the two forms of pair finders, and hits are
//! written to a list.

use std::ops::Range;

use super::{Block, SlotBodies};
use crate::simd::{LANES, Lanes, MAX_WIDTH, quads_in_columns};

/// A volume test of slots.
pub trait SlotTest {
    /// Writes the slots of `run` that may touch slot `i` to the front of `hits`, which has room for
    /// the run and one vector. Returns their number.
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize;

    /// Writes the codes of the block's pairs that may touch to the front of `hits`, which has room
    /// for the block and one vector. Returns their number.
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize;
}

/// Writes the slots from `start` on whose bits are set. Returns their number.
///
/// It has no branch on the bits, which would be predicted badly, at a cost that grows with the
/// number of touching pairs.
#[inline(always)]
pub fn list_slots<L: Lanes>(l: L, hit: u32, start: usize, hits: &mut [u32]) -> usize {
    let slot = l.add_u32(l.splat_u32(start as u32), l.load_u32(&LANES));
    l.compress(hit, slot, hits);
    hit.count_ones() as usize
}

/// A volume test of the finder's balls, a vector of pairs at a time.
pub trait BallTest {
    /// The balls.
    fn slots(&self) -> SlotBodies<'_>;

    /// Lanes in which two balls, or the volumes they stand for, are certainly apart. `between` is
    /// the vector from one centre to the other, `radii` are the two radii.
    fn apart<L: Lanes>(&self, l: L, between: [L::F; 3], radii: [L::F; 2]) -> L::M;

    /// The lanes that may touch among `near`, which [`apart`](Self::apart) did not reject; `pair`
    /// gives the slots of a lane. By default these are all lanes in `near`; a test that knows more
    /// than balls can reject some.
    #[inline(always)]
    fn touching<L: Lanes>(
        &self,
        _: L,
        _between: [L::F; 3],
        _radii: [L::F; 2],
        near: u32,
        _pair: impl Fn(usize) -> [usize; 2],
    ) -> u32 {
        near
    }
}

/// Bits of the lanes below `count` in which the two balls, or the volumes they stand for, may
/// touch.
#[inline(always)]
fn hits_of<L: Lanes>(
    test: &impl BallTest,
    l: L,
    [one, other]: [[L::F; 4]; 2],
    count: usize,
    pair: impl Fn(usize) -> [usize; 2],
) -> u32 {
    let between = [other[0] - one[0], other[1] - one[1], other[2] - one[2]];
    let radii = [one[3], other[3]];
    let near = !l.bits(test.apart(l, between, radii)) & l.bits(l.first(count));
    test.touching(l, between, radii, near, pair)
}

impl<T: BallTest> SlotTest for T {
    #[inline(always)]
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        let slots = self.slots();
        let (balls, [x, y, z, r]) = (slots.balls, slots.columns);
        let one = slots.ball(i).map(|number| l.splat(number));
        let (mut start, mut found) = (run.start, 0);
        if x.is_empty() {
            while start < run.end {
                let pairs = [one, l.load_quads(&balls[start..])];
                let hit = hits_of(self, l, pairs, run.end - start, |lane| [i, start + lane]);
                found += list_slots(l, hit, start, &mut hits[found..found + MAX_WIDTH]);
                start += L::WIDTH;
            }
            return found;
        }
        // With equal lengths they need one bounds check per vector.
        let [y, z, r] = [y, z, r].map(|column| &column[..x.len()]);
        while start < run.end {
            let vector = start..start + L::WIDTH;
            let other = [
                l.load(&x[vector.clone()]),
                l.load(&y[vector.clone()]),
                l.load(&z[vector.clone()]),
                l.load(&r[vector]),
            ];
            let hit = hits_of(self, l, [one, other], run.end - start, |lane| [i, start + lane]);
            found += list_slots(l, hit, start, &mut hits[found..found + MAX_WIDTH]);
            start += L::WIDTH;
        }
        found
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let balls = self.slots().balls;
        let ours = quads_in_columns(l, &balls[block.first()..]);
        let (first, codes) = (block.first(), block.codes());
        let (mut start, mut found) = (0, 0);
        while start < codes.len() {
            let (code, pairs) = block.balls(l, start, &ours, balls);
            let hit = hits_of(self, l, pairs, codes.len() - start, |lane| {
                let code = codes[start + lane];
                [first + (code & 15) as usize, (code >> 4) as usize]
            });
            l.compress(hit, code, &mut hits[found..]);
            found += hit.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}
