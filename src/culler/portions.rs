//! Culling crowds: pairs in portions, and a limit to their number.
//!
//! Fifty thousand bodies in one place have 1.25·10⁹ pairs, a list of ten gigabytes. In portions
//! they need only the memory of a few portions per thread.

use super::{CullError, Culler};
use crate::bodies::{Bodies, PairFilter};
use crate::counters::Clock;
use crate::listing::Output;
use crate::pairs::PairList;

impl Culler {
    /// Culls one frame as [`Self::cull`] does, but passes its pairs to `take`, about 65,000 at a
    /// time and in the same order. Returns the number of pairs; [`Self::pairs`] is empty.
    ///
    /// No list of all pairs is kept, so memory doesn't grow with their number, and
    /// [`Self::potentially_colliding`] is empty. The exception is `s-dop-time-critical` in an order
    /// other than `as-found`, which sorts the potentially colliding set and keeps about thirty
    /// bytes for each of its pairs. With several threads, `take` is called from any of them, one
    /// call at a time. Its time is not part of [`Self::seconds`], but counts against a time budget.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        bodies: &Bodies,
        mut take: impl FnMut(&PairList) + Send,
    ) -> Result<u64, CullError> {
        self.pairs.clear();
        self.pass_on(bodies, None, &mut take)
    }

    /// [`Self::cull_in_portions`] of pairs that pass this filter, or that of the culler's groups.
    pub(crate) fn pass_on(
        &mut self,
        bodies: &Bodies,
        filter: Option<PairFilter<'_>>,
        take: &mut (dyn FnMut(&PairList) + Send),
    ) -> Result<u64, CullError> {
        let start = Clock::start();
        self.check_set(bodies)?;
        self.follow_static(bodies)?;
        let (mut reported, mut taking, mut whole) = (0, 0.0, Ok(()));
        let mut sink = |portion: &mut PairList| {
            let start = Clock::start();
            if portion.is_lost() {
                whole = Err(CullError::OutOfMemory);
            }
            reported += portion.len() as u64;
            take(portion);
            taking += start.seconds();
        };
        let outcome = self.cull_into(bodies, filter, Output::Portions(&mut sink), start);
        self.counters.reported += reported;
        self.seconds.pair_finding -= taking;
        self.seconds.total -= taking;
        outcome.and(whole)?;
        Ok(reported)
    }

    /// Culls one frame as [`Self::cull`] does, but fails if it has more than `limit` pairs. Memory
    /// for more is never allocated.
    ///
    /// # Errors
    /// More than `limit` pairs; the error has their number, [`Self::pairs`] is empty and the frame
    /// counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, bodies: &Bodies, limit: usize) -> Result<&PairList, CullError> {
        let mut pairs = std::mem::take(&mut self.pairs);
        let outcome = self.list(bodies, None, Some(limit), &mut pairs);
        self.pairs = pairs;
        outcome.map(|()| &self.pairs)
    }

    /// Bytes that lists of pairs hold, including intermediate lists.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.pairs.bytes() + self.scratch.pair_bytes()
    }

    /// Frees the memory of lists of pairs beyond what the last frame's list needs. Call it after a
    /// crowd, whose memory would otherwise stay allocated.
    pub fn shrink_to_fit(&mut self) {
        self.pairs.shrink_to_fit();
        self.scratch.shrink_to_fit();
    }
}
