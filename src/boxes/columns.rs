//! Boxes that are moved by columns, many in one call.

use super::BoxWorld;
use crate::bodies::Aabb;
use crate::bodies::contract::check_column;
use crate::living::{BodyId, WorldError};
use crate::rounding::cube::Cube;
use crate::simd::{Kernel, LANES, Lanes, MAX_WIDTH, dispatch, in_default_mode, numbers_of};

/// The number of boxes that are checked before the first of them moves. Their columns fit into the
/// first cache.
const BLOCK: usize = 512;

impl BoxWorld {
    /// Moves or resizes many boxes: as [`Self::set_bounds`] of one after the other, and several
    /// times as fast. An id that comes twice has the later bounds.
    ///
    /// # Errors
    /// The columns differ in length, and nothing has changed. Or as [`Self::set`]: then the boxes
    /// before the refused one have moved, and no others.
    pub fn set_many(&mut self, ids: &[BodyId], bounds: &[Aabb]) -> Result<(), WorldError> {
        check_column("bounds", bounds.len(), ids.len())?;
        for (ids, bounds) in ids.chunks(BLOCK).zip(bounds.chunks(BLOCK)) {
            let are_sound = || dispatch(self.volumes.frames.tier(), AreSound(bounds));
            if self.members.ids.have(ids) && in_default_mode(are_sound) {
                self.move_all(ids, bounds);
            } else {
                let mut boxes = ids.iter().zip(bounds);
                boxes.try_for_each(|(&id, &bounds)| self.set_bounds(id, bounds))?;
            }
        }
        Ok(())
    }

    /// Gives present boxes valid bounds.
    fn move_all(&mut self, ids: &[BodyId], bounds: &[Aabb]) {
        let row_of = |id: &BodyId| self.members.ids.row_of(id.slot() as u32);
        let is_dynamic = |id: &BodyId| self.volumes.dynamic[row_of(id)];
        // Whether bounds are equal is of no use if the next cull finds all pairs anyway.
        if self.members.movers.are_many() && ids.iter().all(is_dynamic) {
            let all = self.volumes.bounds.as_mut_slice();
            for (id, &bounds) in ids.iter().zip(bounds) {
                all[row_of(id)] = bounds;
            }
        } else {
            let boxes = ids.iter().zip(bounds);
            boxes.for_each(|(id, &bounds)| {
                self.move_to(self.members.ids.row_of(id.slot() as u32), bounds);
            });
        }
    }

    /// Gives a present box valid bounds.
    #[inline(always)]
    pub(super) fn move_to(&mut self, slot: usize, bounds: Aabb) {
        if !bounds.has_bits_of(&self.volumes.bounds[slot]) {
            self.members.note(slot, !self.volumes.dynamic[slot]);
            self.volumes.bounds[slot] = bounds;
        }
    }
}

/// Whether all boxes are valid.
struct AreSound<'a>(&'a [Aabb]);

impl Kernel for AreSound<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> bool {
        let numbers = numbers_of(self.0);
        let all = l.bits(l.first(L::WIDTH));
        let mut sound = all;
        for start in (0..numbers.len()).step_by(MAX_WIDTH) {
            // A number past the end reads the last box.
            let pick = LANES.map(|lane| start as u32 + lane);
            for lane in (0..MAX_WIDTH).step_by(L::WIDTH) {
                let [x, y, z, to_x, to_y, to_z] = l.gather_sixes(numbers, &pick[lane..]);
                sound &= Cube::about(l, [x, y, z], [to_x, to_y, to_z]).sound;
            }
        }
        sound == all
    }
}
