//! Crowds: pairs in portions, a limit to their number, and the release of memory.

use super::ids::shrink_column;
use super::local_origins::Origins;
use super::pair_log::WorldPairs;
use super::{World, WorldError};

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
        let generation = self.ids.generation();
        let pairs = self.culler.cull_in_portions(&self.bodies, |portion| {
            take(WorldPairs::new(portion, generation));
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
    /// after a crowd, or when most of a world is gone. Free slots at the end are removed, too
    /// ([`Self::slots`]); ids are still never reused. The next cull starts without lists, takes as
    /// long as a first one, and reports the same pairs in the same order.
    pub fn shrink_to_fit(&mut self) {
        if self.place().is_ok() {
            self.sweep_margins(false);
        }
        self.log.shrink_to_fit(&self.ids);
        let slots = self.ids.shrink();
        shrink_column(&mut self.bodies.shape, slots);
        shrink_column(&mut self.bodies.dynamic, slots);
        shrink_column(&mut self.bodies.rotation, slots);
        shrink_column(&mut self.bodies.translation, slots);
        shrink_column(&mut self.resting, slots);
        shrink_column(&mut self.is_of_interest, slots);
        shrink_column(&mut self.shape, slots);
        shrink_column(&mut self.translation, slots);
        shrink_column(&mut self.margin, slots);
        shrink_column(&mut self.rounded, slots);
        shrink_column(&mut self.groups, slots);
        let shapes = self.shape_numbers();
        shrink_column(&mut self.shapes, shapes);
        shrink_column(&mut self.models, shapes);
        self.interest.shrink_to_fit();
        self.margins.shrink_to_fit();
        self.culler.excluded_mut().shrink_to_fit();
        self.movers.forget();
        self.origins = Origins::default();
        self.culler.forget();
        (self.replaced, self.regrouped) = (true, true);
    }
}
