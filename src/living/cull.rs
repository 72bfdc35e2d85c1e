//! A cull of a set, its pairs and its events.

use super::{Events, LivingSet, VolumeSource, WorldError, WorldPairs};
use crate::counters::Clock;
use crate::pairs::PairList;
use crate::simd::in_default_mode;

impl<V: VolumeSource> LivingSet<V> {
    /// Finds the pairs that might touch now, and returns them: the lower slot first, sorted by
    /// slots. They are not both fixed, their groups collide, and they aren't
    /// [excluded](Self::exclude). For boxes, they are exactly those that meet.
    ///
    /// List and order are a function of the present bodies and their slots, whose order is that of
    /// a pair's first and second body, independent of the finder, of threads and of earlier calls.
    /// In a `World`, the order `OldestAnswer` of a budget also depends on when pairs were refined,
    /// and a budget of time on the clock. It holds for translations that f32 has to round, too: the
    /// origins about which they are rounded follow from the present bodies.
    ///
    /// # Errors
    /// Bodies of a `World` can't be placed within 2⁶⁰ of an origin, which happens only if meshes
    /// are far from their own origins: [`Self::pairs`] are still those of the cull before. There
    /// are more pairs than memory holds: then there are none.
    pub fn cull(&mut self) -> Result<WorldPairs<'_>, WorldError> {
        self.cull_within(None)
    }

    /// Culls as [`Self::cull`] does, if there are at most `limit` pairs. Memory for more is never
    /// allocated.
    ///
    /// # Errors
    /// There are more pairs, and the error has their number: then there are no [`Self::pairs`], and
    /// the frame counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, limit: usize) -> Result<WorldPairs<'_>, WorldError> {
        self.cull_within(Some(limit))
    }

    pub(crate) fn cull_within(
        &mut self,
        limit: Option<usize>,
    ) -> Result<WorldPairs<'_>, WorldError> {
        let most = limit.unwrap_or(usize::MAX);
        if !self.cull_changed(most) || self.pairs().len() > most {
            self.prepare()?;
            let mut list = self.members.pairs.take(&self.members.ids);
            let outcome = self.volumes.list_all(&self.members, limit, &mut list);
            self.members.pairs.put(list, &self.members.ids);
            outcome?;
            self.members.movers.all_found();
            if self.members.movers.expect_few(&self.members.ids) {
                self.warm_up();
            }
        }
        Ok(self.members.pairs.pairs(&self.members.ids))
    }

    /// Culls as [`Self::cull`] does and passes the pairs to `take`, about 65,000 at a time. Returns
    /// their number. Then there are no [`Self::pairs`], and for [`Self::events`] the cull found
    /// none.
    ///
    /// Portions are not sorted: their order depends on the finder and on earlier frames, never on
    /// threads. No list of all pairs is kept, so memory doesn't grow with their number, except in a
    /// `World` with the strategy `s-dop-time-critical`, which sorts the potentially colliding set:
    /// about thirty bytes for each of its pairs. With several threads, `take` is called from any of
    /// them, one call at a time.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        mut take: impl FnMut(WorldPairs<'_>) + Send,
    ) -> Result<u64, WorldError> {
        self.prepare()?;
        self.members.pairs.take(&self.members.ids);
        let ids = self.members.ids.table();
        let take = &mut |portion: &PairList| take(WorldPairs::new(portion, ids));
        self.volumes.pass_on_all(&self.members, take)
    }

    /// Prepares to find all pairs anew. Until [`Movers::all_found`](super::movers::Movers), the
    /// next cull does so too.
    fn prepare(&mut self) -> Result<(), WorldError> {
        self.members.movers.lose_pairs();
        self.volumes.prepare(&mut self.members)?;
        self.members.ids.settle();
        Ok(())
    }

    /// Updates the pairs of the last cull by the bodies that have changed. Returns false if finding
    /// all pairs would be faster, if a pair's verdict depends on other pairs, or if these bodies
    /// are near more than `most` others: then all pairs must be found anew.
    fn cull_changed(&mut self, most: usize) -> bool {
        let Self { members, volumes } = self;
        if !members.movers.are_few() || !volumes.judges_pairs_alone() {
            return false;
        }
        let start = Clock::start();
        let counted;
        if members.movers.none_changed() {
            counted = members.movers.counters(&members.ids);
            members.movers.end();
        } else {
            let Some(found) = in_default_mode(|| volumes.find_changed(members, most)) else {
                return false;
            };
            counted = members.movers.counters(&members.ids);
            members.pairs.apply(&found, &members.movers, &members.ids);
            members.movers.end_search(found);
            volumes.end_changed(members);
        }
        members.ids.settle();
        let pairs = members.pairs.pairs(&members.ids).len();
        volumes.count_changed(counted, pairs, start.seconds());
        true
    }

    /// Prepares what the next cull needs if few bodies change until then.
    pub(crate) fn warm_up(&mut self) {
        if self.volumes.judges_pairs_alone() {
            let Self { members, volumes } = self;
            members.pairs.keep_by_body(&members.ids);
            in_default_mode(|| volumes.make_index(members));
            volumes.warm_up(members);
        }
    }

    /// Continues after a cull whose pairs are known, since which no bodies but these have changed.
    #[cfg(feature = "serde")]
    pub(crate) fn resume(&mut self, changed: &[u32]) {
        self.members.movers.resume(changed, &self.members.ids);
        self.warm_up();
    }

    /// Whether [`Self::pairs`] are those of the bodies as they are now.
    pub(crate) fn has_present_pairs(&self) -> bool {
        self.members.movers.has_present_pairs()
    }

    /// The pairs of the last cull, the lower slot first, sorted by slots.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [super::BodyId; 2]> + '_ {
        self.members.pairs.pairs(&self.members.ids).iter()
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull. Events don't borrow the set, so bodies may be removed while they are read. Drop them
    /// before the next cull, which otherwise copies the pairs.
    pub fn events(&mut self) -> Events {
        self.members.pairs.events(&self.members.ids)
    }

    /// Bytes of the lists of pairs: those of the last cull, those of the last events, and
    /// intermediate ones.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.members.pairs.bytes() + self.volumes.pair_bytes()
    }
}
