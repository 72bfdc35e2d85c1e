//! A culler that gets all boxes anew in each frame.

use super::frame::BoxFrames;
use crate::bodies::contract::{check_column, check_number};
use crate::bodies::{Aabb, Groups, PairFilter};
use crate::counters::VolumeCounters;
use crate::cull_error::CullError;
use crate::pairs::PairList;
use crate::settings::Finder;
use crate::simd::Tier;
use crate::threads::{FrameThreads, Threads, WORTH_WAKING};

/// Finds the boxes that meet, frame after frame.
///
/// ```
/// use sdop::{Aabb, BoxCuller};
///
/// let mut culler = BoxCuller::new();
/// let wall = Aabb::new([-50.0, -0.5, 0.0], [50.0, 0.5, 9.0]);
/// let boxes = [wall, Aabb::new([3.0, 0.5, 1.0], [4.0, 1.5, 2.0]), Aabb::new([3.0, 0.6, 3.0], [4.0, 1.5, 4.0])];
/// assert_eq!(culler.cull(&boxes)?.sorted(), [[0, 1]]); // touching is meeting
/// # Ok::<(), sdop::CullError>(())
/// ```
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct BoxCuller {
    frames: BoxFrames,
    groups: Option<Vec<Groups>>,
    pairs: PairList,
}

/// Settings of a [`BoxCuller`] or a [`BoxWorld`](super::BoxWorld). Each has a default.
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a builder does nothing before `build`"]
pub struct BoxCullerBuilder {
    finder: Finder,
    threads: usize,
    worth_waking: u64,
    tier: Option<Tier>,
}

impl Default for BoxCullerBuilder {
    fn default() -> Self {
        Self { finder: Finder::Auto, threads: 1, worth_waking: WORTH_WAKING, tier: None }
    }
}

impl BoxCullerBuilder {
    /// The algorithm that finds candidates. The reported set doesn't depend on it.
    pub fn finder(self, finder: Finder) -> Self {
        Self { finder, ..self }
    }

    /// Number of threads, the caller's included; 0 means one, and the culler isn't built with more
    /// than 1,024. Frames with little work stay on the caller's thread. Lists and counters don't
    /// depend on it.
    pub fn threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The least work of a frame for which other threads than the caller's are woken, in
    /// nanoseconds of one thread as estimated from counters: a millisecond (2²⁰ ns) by default, 0
    /// for always. Lists and counters don't depend on it.
    pub fn worth_waking(self, nanoseconds: u64) -> Self {
        let worth_waking = nanoseconds;
        Self { worth_waking, ..self }
    }

    /// A SIMD tier instead of the fastest of this CPU. Lists and counters don't depend on it.
    pub fn tier(self, tier: Tier) -> Self {
        let tier = Some(tier);
        Self { tier, ..self }
    }

    /// The culler.
    ///
    /// # Errors
    /// The system cannot start the threads.
    pub fn build(&self) -> Result<BoxCuller, CullError> {
        Ok(BoxCuller::with(self.frames()?))
    }

    pub(super) fn frames(&self) -> Result<BoxFrames, CullError> {
        Ok(self.frames_on(Threads::new(self.threads)?))
    }

    pub(super) fn frames_on(&self, threads: Threads) -> BoxFrames {
        let tier = self.tier.unwrap_or_else(Tier::detect);
        let threads = FrameThreads::new(threads, self.worth_waking);
        BoxFrames::new(self.finder, tier, threads)
    }
}

impl Default for BoxCuller {
    fn default() -> Self {
        Self::with(Self::builder().frames_on(Threads::default()))
    }
}

impl BoxCuller {
    /// A culler with all defaults: the finder that `auto` picks, the fastest tier of this CPU, the
    /// caller's thread.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The choices of [`Self::new`], which can be changed.
    pub fn builder() -> BoxCullerBuilder {
        BoxCullerBuilder::default()
    }

    fn with(frames: BoxFrames) -> Self {
        Self { frames, groups: None, pairs: PairList::default() }
    }

    /// From now on, only pairs of boxes whose groups collide are listed; with `None`, all are. One
    /// entry per box.
    pub fn set_groups(&mut self, groups: Option<Vec<Groups>>) {
        self.groups = groups;
    }

    /// The pairs i < j of boxes that meet and whose groups collide, each once, in an order that
    /// depends only on the finder and on earlier frames. The number of boxes may change from frame
    /// to frame; such a frame takes longer.
    ///
    /// # Errors
    /// An end is infinite or NaN, a lower end is above the upper one, there are more boxes than can
    /// be numbered, the column of groups has another length, or there are more pairs than memory
    /// holds. Then [`Self::pairs`] is empty, and the next frame is culled as usual.
    pub fn cull(&mut self, boxes: &[Aabb]) -> Result<&PairList, CullError> {
        self.list(boxes, None)
    }

    fn list(&mut self, boxes: &[Aabb], limit: Option<usize>) -> Result<&PairList, CullError> {
        self.pairs.clear();
        self.prepare(boxes)?;
        let filter = PairFilter::of_groups(self.groups.as_deref());
        self.frames.list(boxes, filter, limit, &mut self.pairs)?;
        Ok(&self.pairs)
    }

    /// Culls one frame as [`Self::cull`] does and passes its pairs to `take`, about 65,000 at a
    /// time, in the order of that list. Returns their number; [`Self::pairs`] is empty. Memory
    /// doesn't grow with their number. With several threads, `take` is called from any of them, one
    /// call at a time.
    ///
    /// # Errors
    /// As [`Self::cull`].
    pub fn cull_in_portions(
        &mut self,
        boxes: &[Aabb],
        mut take: impl FnMut(&PairList) + Send,
    ) -> Result<u64, CullError> {
        self.pairs.clear();
        self.prepare(boxes)?;
        let filter = PairFilter::of_groups(self.groups.as_deref());
        self.frames.pass_on(boxes, filter, &mut take)
    }

    /// Culls one frame as [`Self::cull`] does, if it has at most `limit` pairs. Memory for more is
    /// never allocated.
    ///
    /// # Errors
    /// There are more pairs, and the error has their number: then [`Self::pairs`] is empty, and the
    /// frame counts as culled. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, boxes: &[Aabb], limit: usize) -> Result<&PairList, CullError> {
        self.list(boxes, Some(limit))
    }

    /// Checks the lengths of a frame's columns. If the number of boxes has changed, all are new.
    fn prepare(&mut self, boxes: &[Aabb]) -> Result<(), CullError> {
        check_number(boxes.len())?;
        if let Some(groups) = &self.groups {
            check_column("groups", groups.len(), boxes.len())?;
        }
        if boxes.len() != self.frames.len() {
            let all = vec![true; boxes.len()];
            self.frames.replace(&all, &all);
        }
        Ok(())
    }

    /// The pairs of the last frame.
    #[must_use]
    pub fn pairs(&self) -> &PairList {
        &self.pairs
    }

    /// Counters summed over all frames: boxes updated, candidates tested, pairs reported.
    #[must_use]
    pub fn counters(&self) -> &VolumeCounters {
        &self.frames.counters
    }

    /// Candidates that the last frame tested to build a list of neighbours, in addition to the
    /// tests that [`Self::counters`] count. See [`Culler::list_tests`](crate::Culler::list_tests).
    #[must_use]
    pub fn list_tests(&self) -> u64 {
        self.frames.list_tests()
    }

    /// Bytes of the lists of pairs: the reported ones and intermediate ones.
    #[must_use]
    pub fn pair_bytes(&self) -> usize {
        self.pairs.bytes() + self.frames.pair_bytes()
    }

    /// Frees the memory of lists of pairs, except that of the last frame's reported ones. Use it
    /// after a crowd, whose memory would otherwise be kept.
    pub fn shrink_to_fit(&mut self) {
        self.pairs.shrink_to_fit();
        self.frames.shrink_to_fit();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::boxes::BoxWorld;

    /// A builder keeps each choice and no other.
    #[test]
    fn builder_keeps_choices() {
        let built = BoxCuller::builder();
        assert_eq!(built, BoxCullerBuilder::default());
        let built = built.threads(3).worth_waking(7).tier(Tier::SCALAR).finder(Finder::Sweep);
        let wanted = BoxCullerBuilder {
            finder: Finder::Sweep,
            threads: 3,
            worth_waking: 7,
            tier: Some(Tier::SCALAR),
        };
        assert_eq!(built, wanted);
        let other = BoxCullerBuilder { threads: 5, ..wanted };
        assert_eq!(built.threads(5), other);
    }

    /// Pairs are those of the last frame.
    #[test]
    fn pairs_are_of_last_frame() {
        let at = |x: f32| Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
        let mut culler = BoxCuller::new();
        assert_eq!(culler.cull(&[at(0.0), at(5.0), at(0.5)]).unwrap().len(), 1);
        assert_eq!(culler.pairs().sorted(), [[0, 2]]);
        culler.cull(&[at(0.0), at(5.0), at(4.5)]).unwrap();
        assert_eq!(culler.pairs().sorted(), [[1, 2]]);
    }

    /// All-pairs tests every pair; `auto` would not.
    #[test]
    fn builder_sets_finder() {
        let row: Vec<Aabb> = (0..2000)
            .map(|i| [i as f32, i as f32 + 0.5])
            .map(|[lo, hi]| Aabb::new([lo, 0.0, 0.0], [hi, 1.0, 1.0]))
            .collect();
        let of = BoxCuller::builder().finder(Finder::AllPairs);
        let (mut culler, mut world) = (of.build().unwrap(), BoxWorld::with(&of).unwrap());
        culler.cull(&row).unwrap();
        for &aabb in &row {
            world.insert(aabb).unwrap();
        }
        world.cull().unwrap();
        let every = VolumeCounters { updates: 2000, tests: 2000 * 1999 / 2, hits: 0 };
        assert_eq!([culler.counters(), world.counters()], [&every; 2]);
    }
}
