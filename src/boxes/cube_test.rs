//! [`CubeTest`]: the test of given boxes, which are apart iff on some axis one begins after the
//! other's end. Ends are compared without rounding, so the answer is exact.
//!
//! For nearly cubic boxes, the cube around a box and the largest cube inside it
//! ([`cube`](crate::rounding::cube)) differ little: one quad per box decides nearly all pairs, and
//! the boxes of the others are looked up. For long boxes cubes decide little, so their ends are
//! compared directly ([`EndSlots`](crate::broad_phase::EndSlots)).

use crate::bodies::Aabb;
use crate::broad_phase::{BallTest, SlotBodies};
use crate::rounding::cube;
use crate::simd::Lanes;

/// The test of boxes by their cubes, which the finder has in its slots.
#[derive(Clone, Copy, Debug)]
pub struct CubeTest<'a> {
    /// The cubes; slots are named by box.
    pub slots: SlotBodies<'a>,
    /// All boxes, indexed by name.
    pub boxes: &'a [Aabb],
    /// See [`less_than_sure`](crate::rounding::cube::less_than_sure).
    pub less: f32,
}

impl CubeTest<'_> {
    /// Whether two boxes meet, exactly, by their ends. Few pairs need it, so it is kept out of the
    /// vector loop.
    #[cold]
    fn boxes_meet(&self, pair: [usize; 2]) -> bool {
        let [a, b] = pair.map(|slot| &self.boxes[self.slots.names[slot] as usize]);
        a.meets(b)
    }
}

impl BallTest for CubeTest<'_> {
    #[inline(always)]
    fn slots(&self) -> SlotBodies<'_> {
        self.slots
    }

    #[inline(always)]
    fn apart<L: Lanes>(&self, l: L, between: [L::F; 3], [mine, theirs]: [L::F; 2]) -> L::M {
        cube::apart(l, between, mine + theirs)
    }

    #[inline(always)]
    fn touching<L: Lanes>(
        &self,
        l: L,
        between: [L::F; 3],
        [mine, theirs]: [L::F; 2],
        near: u32,
        pair: impl Fn(usize) -> [usize; 2],
    ) -> u32 {
        let sure = cube::sure(l, mine + theirs, self.less);
        let (mut hits, mut open) = (near, near & l.bits(cube::apart(l, between, sure)));
        while open != 0 {
            let lane = open.trailing_zeros();
            open &= open - 1;
            if !self.boxes_meet(pair(lane as usize)) {
                hits &= !(1 << lane);
            }
        }
        hits
    }
}
