//! Crowds of boxes: pairs in portions, a limit to their number, and memory that is given back.

use super::BoxWorld;
use crate::culler::CullError;
use crate::pairs::PairList;
use crate::strategy::Output;
use crate::world::{WorldError, WorldPairs, shrink_column};

impl BoxWorld {
    /// Culls as [`Self::cull`] does and hands the pairs to `take`, some 65,000 at a time. Returns
    /// their number; there are no [`Self::pairs`] then, and [`Self::events`] see a cull without
    /// any.
    ///
    /// Portions are not sorted: their order depends on the finder and on the frames so far, never
    /// on threads. Memory doesn't grow with the number of pairs. With several threads, `take` is
    /// called from any of them, one call at a time.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        mut take: impl FnMut(WorldPairs<'_>) + Send,
    ) -> Result<u64, WorldError> {
        // Those of bodies that are there don't change in a cull.
        let generation = self.ids.generation().clone();
        self.log.take(&self.ids);
        self.cull_by_slots(|portion| take(WorldPairs::new(portion, &generation)))
    }

    /// Culls as [`Self::cull`] does, if there are at most `limit` pairs. Memory for more is never
    /// taken.
    ///
    /// # Errors
    /// More pairs than that, with their number: there are no [`Self::pairs`] then, and the frame
    /// counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, limit: usize) -> Result<WorldPairs<'_>, WorldError> {
        if self.cull_changed(limit) && self.log.pairs(&self.ids).len() <= limit {
            return Ok(self.log.pairs(&self.ids));
        }
        let mut kept = self.log.take(&self.ids);
        let pairs = self.cull_by_slots(|portion| kept.append_up_to(portion, limit))?;
        if kept.len() as u64 != pairs {
            return Err(CullError::TooManyPairs { pairs, limit }.into());
        }
        self.log.put(kept, &self.ids);
        self.movers.all_found();
        Ok(self.log.pairs(&self.ids))
    }

    fn cull_by_slots(&mut self, mut take: impl FnMut(&PairList) + Send) -> Result<u64, WorldError> {
        let mut reported = 0;
        let mut sink = |portion: &mut PairList| {
            reported += portion.len() as u64;
            take(portion);
        };
        self.cull_into(Output::Portions(&mut sink))?;
        Ok(reported)
    }

    /// Bytes that lists of pairs hold: those of the last cull, those that events were last read of,
    /// and those on the way to them.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.log.bytes() + self.frames.pair_bytes()
    }

    /// Gives back all memory but what the boxes that are there need, and the last pairs: after a
    /// crowd, or after most of a world has gone. Free slots at the end are given back, too
    /// ([`Self::slots`]); ids are still never given again. The next cull begins anew, at the price
    /// of a first one, and reports the same pairs in the same order.
    pub fn shrink_to_fit(&mut self) {
        self.log.shrink_to_fit(&self.ids);
        let slots = self.ids.shrink();
        shrink_column(&mut self.bounds, slots);
        shrink_column(&mut self.dynamic, slots);
        shrink_column(&mut self.resting, slots);
        shrink_column(&mut self.groups, slots);
        self.excluded.shrink_to_fit();
        self.count_groups();
        self.movers.forget();
        self.frames.forget();
        self.replaced = true;
    }
}
