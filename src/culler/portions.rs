//! Crowds: pairs in portions, and a limit to their number.
//!
//! Fifty thousand bodies in one place are 1.25·10⁹ pairs, ten gigabytes as a list. Taken in
//! portions, they need the memory of a few portions per thread, whatever their number.

use std::time::{Duration, Instant};

use super::{CullError, Culler};
use crate::bodies::Bodies;
use crate::pairs::PairList;
use crate::strategy::Output;

impl Culler {
    /// Culls one frame as [`Self::cull`] does and hands its pairs to `take`, some 65,000 at a time,
    /// in the order of that list. Returns their number; [`Self::pairs`] is empty.
    ///
    /// No list of all pairs is kept, so memory doesn't grow with their number, and
    /// [`Self::potentially_colliding`] is empty. The exception is `s-dop-time-critical` in another
    /// order than `as-found`: to sort the potentially colliding set, it keeps some thirty bytes for
    /// each of its pairs. With several threads, `take` is called from any of them, one call at a
    /// time; its time is not counted in [`Self::seconds`], but does count against a budget of time.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        bodies: &Bodies,
        mut take: impl FnMut(&PairList) + Send,
    ) -> Result<u64, CullError> {
        let start = Instant::now();
        self.check_set(bodies)?;
        let (mut reported, mut taking) = (0, Duration::ZERO);
        let mut sink = |portion: &mut PairList| {
            let start = Instant::now();
            reported += portion.len() as u64;
            take(portion);
            taking += start.elapsed();
        };
        self.pairs.clear();
        let outcome = self.cull_into(bodies, Output::Portions(&mut sink), start);
        self.counters.reported += reported;
        self.seconds.pair_finding -= taking.as_secs_f64();
        self.seconds.total -= taking.as_secs_f64();
        outcome?;
        Ok(reported)
    }

    /// Culls one frame as [`Self::cull`] does, if it has at most `limit` pairs. Memory for more is
    /// never taken.
    ///
    /// # Errors
    /// More pairs than that, with their number: [`Self::pairs`] is empty then, and the frame counts
    /// as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, bodies: &Bodies, limit: usize) -> Result<&PairList, CullError> {
        let mut kept = std::mem::take(&mut self.pairs);
        kept.clear();
        let outcome = self.cull_in_portions(bodies, |portion| kept.append_up_to(portion, limit));
        let pairs = outcome?;
        let is_whole = kept.len() as u64 == pairs;
        self.pairs = kept;
        if is_whole {
            return Ok(&self.pairs);
        }
        self.pairs.clear();
        Err(CullError::TooManyPairs { pairs, limit })
    }

    /// Bytes that lists of pairs hold: the reported ones, and those on the way to them.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.pairs.bytes() + self.scratch.pair_bytes()
    }

    /// Gives back the memory of lists of pairs beyond what the last frame's reported ones take:
    /// after a crowd, which would hold it for ever.
    pub fn shrink_to_fit(&mut self) {
        self.pairs.shrink_to_fit();
        self.scratch.shrink_to_fit();
    }
}
