//! Crowds: pairs in portions, a limit to their number, and the release of memory.

use super::local_origins::Origins;
use super::pair_log::WorldPairs;
use super::{Groups, Ids, UNTURNED, World, WorldError, renumber_column, renumbered_pairs};
use crate::strategy::RefinementRanks;

impl World {
    /// Culls as [`Self::cull`] does and passes the pairs to `take`, about 65,000 at a time. Returns
    /// their number. Then there are no [`Self::pairs`], and for [`Self::events`] the cull found
    /// none.
    ///
    /// Portions are not sorted: their order depends on the finder and on earlier frames, never on
    /// threads. No list of all pairs is kept, so memory doesn't grow with their number, except with
    /// `s-dop-time-critical`, which sorts the potentially colliding set: about thirty bytes for
    /// each of its pairs. With several threads, `take` is called from any of them, one call at a
    /// time.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        mut take: impl FnMut(WorldPairs<'_>) + Send,
    ) -> Result<u64, WorldError> {
        self.prepare()?;
        self.log.take(&self.ids);
        let ids = self.ids.table();
        let pairs = self.culler.cull_in_portions(&self.bodies, |portion| {
            take(WorldPairs::new(portion, ids));
        });
        Ok(pairs?)
    }

    /// Culls as [`Self::cull`] does, if there are at most `limit` pairs. Memory for more is never
    /// allocated.
    ///
    /// # Errors
    /// There are more pairs, and the error has their number: then there are no [`Self::pairs`], and
    /// the frame counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, limit: usize) -> Result<WorldPairs<'_>, WorldError> {
        if !self.cull_changed(limit) || self.log.pairs(&self.ids).len() > limit {
            self.cull_all(|culler, bodies| culler.cull_up_to(bodies, limit).map(|_| ()))?;
        }
        Ok(self.log.pairs(&self.ids))
    }

    /// Bytes of the lists of pairs: those of the last cull, those of the last events, and
    /// intermediate ones.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.log.bytes() + self.culler.pair_bytes()
    }

    /// Frees all memory except that of the present bodies and shapes and the last pairs. Use it
    /// after a crowd. Free slots at the end are removed, too ([`Self::slots`]); ids are still never
    /// reused. The next cull starts without lists, takes as long as a first one, and reports the
    /// same pairs in the same order. A world does this by itself when most of it is gone.
    pub fn shrink_to_fit(&mut self) {
        if self.place().is_ok() {
            self.sweep_margins(false);
        }
        self.log.shrink_to_fit(&self.ids);
        self.renumber(Ids::compact);
        let shapes = self.shape_numbers();
        self.shapes.truncate(shapes);
        self.shapes.shrink_to_fit();
        self.models.truncate(shapes);
        self.models.shrink_to_fit();
        self.interest.shrink_to_fit();
        self.margins.shrink_to_fit();
    }

    /// Changes the rows of all columns, and frees what was kept about former ones. The pairs of the
    /// last cull stay.
    pub(super) fn renumber(&mut self, change: fn(&mut Ids) -> Vec<u32>) {
        self.log.outlive_rows(&self.ids);
        let plan = change(&mut self.ids);
        renumber_column(&mut self.bodies.shape, &plan, 0);
        renumber_column(&mut self.bodies.dynamic, &plan, true);
        renumber_column(&mut self.bodies.rotation, &plan, UNTURNED);
        renumber_column(&mut self.bodies.translation, &plan, [0.0; 3]);
        renumber_column(&mut self.resting, &plan, false);
        renumber_column(&mut self.is_of_interest, &plan, false);
        renumber_column(&mut self.shape, &plan, 0);
        renumber_column(&mut self.translation, &plan, [0.0; 3]);
        renumber_column(&mut self.margin, &plan, 0.0);
        renumber_column(&mut self.rounded, &plan, false);
        renumber_column(&mut self.groups, &plan, Groups::ALL);
        let answers = renumbered_pairs(self.culler.answers().0, &plan);
        self.culler.set_answers(&RefinementRanks(answers));
        let excluded = self.culler.excluded().sorted().into_iter().map(|pair| (pair, ()));
        let excluded = renumbered_pairs(excluded, &plan).into_iter().map(|(pair, ())| pair);
        *self.culler.excluded_mut() = excluded.collect();
        self.movers.forget();
        self.origins = Origins::default();
        self.culler.forget();
        (self.replaced, self.regrouped) = (true, true);
    }
}
