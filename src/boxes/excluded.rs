//! Pairs that a world of boxes doesn't report.

use super::BoxWorld;
use crate::world::{BodyId, WorldError};

impl BoxWorld {
    /// Excludes a pair of boxes: it is not reported from the next cull on, until [`Self::include`]
    /// or until one of the boxes is removed. Returns whether the pair was included before; a box
    /// and itself are no pair. It costs as much as moving a box, and memory in proportion to the
    /// excluded pairs.
    ///
    /// # Errors
    /// A box that has been removed.
    pub fn exclude(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        let [a, b] = [self.ids.slot(a)?, self.ids.slot(b)?];
        let is_new = a != b && self.excluded.insert(a as u32, b as u32);
        if is_new {
            self.movers.note(a, &self.ids); // its partners are found anew, and so the pair is lost
        }
        Ok(is_new)
    }

    /// Includes an excluded pair again. Returns whether it was excluded.
    ///
    /// # Errors
    /// A box that has been removed.
    pub fn include(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        let [a, b] = [self.ids.slot(a)?, self.ids.slot(b)?];
        let was_excluded = self.excluded.remove(a as u32, b as u32);
        if was_excluded {
            self.movers.note(a, &self.ids);
        }
        Ok(was_excluded)
    }

    /// Whether a pair is excluded. A pair with a removed box is not.
    #[must_use]
    pub fn is_excluded(&self, a: BodyId, b: BodyId) -> bool {
        match [a, b].map(|id| self.ids.slot(id)) {
            [Ok(a), Ok(b)] => self.excluded.contains(a as u32, b as u32),
            _ => false,
        }
    }

    /// The excluded pairs, the lower slot first, sorted by slots.
    #[must_use]
    pub fn excluded(&self) -> Vec<[BodyId; 2]> {
        let pairs = self.excluded.sorted();
        let ids = pairs.into_iter().map(|pair| pair.map(|slot| self.ids.id(slot)));
        ids.collect()
    }
}
