//! `all-pairs`, the paper's finder: all N(N−1)/2 pairs except the S(S−1)/2 static ones.

use std::ops::Range;

use super::{FirstTest, Slots};
use crate::bodies::Places;
use crate::simd::{Lanes, MAX_WIDTH};

/// Slots per part of the work.
const SLOTS_PER_PART: usize = 16;

/// Slots are places. Moving bodies come first, so that the candidates of every moving slot are all
/// slots after it.
#[derive(Clone, Debug, Default)]
pub struct AllPairs {
    slots: Slots,
    moving: usize,
    len: usize,
}

impl AllPairs {
    pub(super) fn arrange(&mut self, places: &Places, balls: &[[f32; 4]], names: &[u32]) {
        (self.moving, self.len) = (places.moving, places.body.len());
        self.slots.names.clear();
        self.slots.names.extend_from_slice(names);
        self.slots.names.resize(self.len + MAX_WIDTH, 0);
        for (axis, column) in self.slots.columns.iter_mut().enumerate() {
            column.clear();
            column.extend(balls.iter().map(|ball| ball[axis]));
            column.resize(self.len + MAX_WIDTH, 0.0);
        }
    }

    pub(super) fn slots(&self) -> &Slots {
        &self.slots
    }

    pub(super) fn parts(&self) -> usize {
        self.moving.div_ceil(SLOTS_PER_PART)
    }

    #[inline(always)]
    pub(super) fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        for i in parts.start * SLOTS_PER_PART..(parts.end * SLOTS_PER_PART).min(self.moving) {
            test.run(l, i, i + 1..self.len);
        }
    }
}
