//! Crowds of boxes: pairs in portions, a limit to their number, and the release of memory.

use super::BoxWorld;
use crate::culler::CullError;
use crate::pairs::PairList;
use crate::strategy::Output;
use crate::world::{WorldError, WorldPairs, shrink_column};

impl BoxWorld {
    /// Culls as [`Self::cull`] does and passes the pairs to `take`, about 65,000 at a time. Returns
    /// their number. Then there are no [`Self::pairs`], and for [`Self::events`] the cull found
    /// none.
    ///
    /// Portions are not sorted: their order depends on the finder and on earlier frames, never on
    /// threads. Memory doesn't grow with the number of pairs. With several threads, `take` is
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
    /// allocated.
    ///
    /// # Errors
    /// There are more pairs, and the error has their number: then there are no [`Self::pairs`], and
    /// the frame counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, limit: usize) -> Result<WorldPairs<'_>, WorldError> {
        if self.cull_changed(limit) && self.log.pairs(&self.ids).len() <= limit {
            return Ok(self.log.pairs(&self.ids));
        }
        let mut kept = self.log.take(&self.ids);
        let pairs = self.cull_by_slots(|portion| kept.append_up_to(portion, limit))?;
        CullError::check_memory(&mut kept)?;
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

    /// Bytes of the lists of pairs: those of the last cull, those of the last events, and
    /// intermediate ones.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.log.bytes() + self.frames.pair_bytes()
    }

    /// Frees all memory except that of the present boxes and the last pairs. Use it after a crowd,
    /// or when most of a world is gone. Free slots at the end are removed, too ([`Self::slots`]);
    /// ids are still never reused. The next cull starts without lists, takes as long as a first
    /// one, and reports the same pairs in the same order.
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
