//! Crowds of boxes: pairs in portions, a limit to their number, and the release of memory.

use super::BoxWorld;
use crate::bodies::{Aabb, Groups};
use crate::culler::CullError;
use crate::pairs::PairList;
use crate::strategy::Output;
use crate::world::{Ids, WorldError, WorldPairs, renumber_column, renumbered_pairs};

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
        let ids = self.ids.table().clone(); // those of present boxes don't change in a cull
        self.log.take(&self.ids);
        self.cull_by_slots(|portion| take(WorldPairs::new(portion, &ids)))
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
        self.all_found();
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

    /// Frees all memory except that of the present boxes and the last pairs. Use it after a crowd.
    /// Free slots at the end are removed, too ([`Self::slots`]); ids are still never reused. The
    /// next cull starts without lists, takes as long as a first one, and reports the same pairs in
    /// the same order. A world does this by itself when most of it is gone.
    pub fn shrink_to_fit(&mut self) {
        self.log.shrink_to_fit(&self.ids);
        self.renumber(Ids::compact);
    }

    /// Changes the rows of all columns, and frees what was kept about former ones. The pairs of the
    /// last cull stay.
    pub(super) fn renumber(&mut self, change: fn(&mut Ids) -> Vec<u32>) {
        self.log.outlive_rows(&self.ids);
        let plan = change(&mut self.ids);
        renumber_column(&mut self.bounds, &plan, Aabb::default());
        renumber_column(&mut self.dynamic, &plan, true);
        renumber_column(&mut self.resting, &plan, false);
        renumber_column(&mut self.groups, &plan, Groups::ALL);
        let excluded = self.excluded.sorted().into_iter().map(|pair| (pair, ()));
        let excluded = renumbered_pairs(excluded, &plan).into_iter().map(|(pair, ())| pair);
        self.excluded = excluded.collect();
        self.count_groups();
        self.movers.forget();
        self.frames.forget();
        self.replaced = true;
    }
}
