//! Test helper: a run or a block that fills its vectors exactly must not read one vector more.

use super::{Block, SlotTest};
use crate::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch};

/// Slots in the check: whole vectors in every tier.
pub const SLOTS_PER_CHECK: usize = 2 * MAX_WIDTH;

/// Tests slot 0 against all of [`SLOTS_PER_CHECK`] slots, and as many pairs as a block. All touch.
/// The test's columns have no padding and the block's hits no room after them, so starting another
/// vector panics.
pub fn check(test: &impl SlotTest) {
    struct ListTouching<'a, T>(&'a T);
    impl<T: SlotTest> Kernel for ListTouching<'_, T> {
        type Output = [Vec<u32>; 2];
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let mut slots = vec![0; SLOTS_PER_CHECK + MAX_WIDTH];
            let found = self.0.run(l, 0, 0..SLOTS_PER_CHECK, &mut slots);
            slots.truncate(found);
            let (padded, mut codes) =
                (codes(SLOTS_PER_CHECK + MAX_WIDTH), vec![0; SLOTS_PER_CHECK]);
            let block = Block::new(0, &padded, SLOTS_PER_CHECK);
            let found = self.0.block(l, &block, &mut codes);
            codes.truncate(found);
            [slots, codes]
        }
    }
    let all = [(0..SLOTS_PER_CHECK as u32).collect(), codes(SLOTS_PER_CHECK)];
    for tier in Tier::available() {
        assert_eq!(dispatch(tier, ListTouching(test)), all, "{tier}");
    }
}

/// Pairs of the first sixteen slots and others, as a block writes them.
fn codes(pairs: usize) -> Vec<u32> {
    (0..pairs as u32).map(|pair| (pair << 4) | (pair % 16)).collect()
}
