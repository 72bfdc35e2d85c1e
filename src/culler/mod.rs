//! Culling posed meshes frame by frame: [`Culler`] calls the stages in order and times them.
//!
//! > update → broad phase → overlap → pairs
//!
//! A [`Culler`] is built once for a set of bodies (the paper's Co) and then culls frame after
//! frame. Buffers are kept, so in steady state nothing is allocated.

mod builder;
mod check;
pub(crate) mod models;
mod needs;
mod portions;
mod replace;
mod sample;
mod shapes;
mod stages;

pub use crate::cull_error::CullError;
#[doc(hidden)]
pub use crate::strategy::PlacedCone;
pub use builder::CullerBuilder;
pub(crate) use check::FAR_SHAPE_HELP;

use std::ops::Range;

use self::{models::Models, needs::VolumeNeeds, sample::Sample};
use crate::strategy::RefinementRanks;
use crate::{
    bodies::contract::check_column,
    bodies::{Bodies, Groups, PairFilter, Places},
    broad_phase::{Balls, PairFinder},
    counters::{Clock, Counters, Seconds},
    listing::{Output, Totals, list_up_to},
    overlap::intervals::IntervalSlots,
    pairs::PairList,
    settings::{CullSettings, Finder, Interest},
    simd::{Tier, in_default_mode},
    strategy::{RowTiming, Scratch, Setup},
    threads::FrameThreads,
    update::{Intervals, OrDopRows},
    volume::{Shape, check_bodies},
};

/// Finds the pairs of bodies that might touch, frame after frame: for a fixed set of bodies whose
/// poses change.
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct Culler {
    setup: Setup,
    needs: VolumeNeeds,
    tier: Tier,
    threads: FrameThreads,
    models: Models,
    set: BodySet,
    volumes: Volumes,
    scratch: Scratch,
    sample: Sample,
    pairs: PairList,
    counters: Counters,
    seconds: Seconds,
}

/// What changes with the bodies and their places only: at [`Culler::refresh`], and when places are
/// sorted anew.
#[derive(Clone, Debug)]
struct BodySet {
    places: Places,
    groups: Option<Vec<Groups>>,
    /// What doesn't change between two frames, as it was at the last [`Culler::refresh`], or when
    /// static bodies were last found elsewhere.
    fixed: Bodies,
    /// Runs of static bodies, whose poses each frame compares with those in `fixed`. None for a
    /// caller that replaces bodies itself ([`Culler::replace`]).
    watched: Vec<Range<usize>>,
    /// 0, 1, 2 …: the slots' names when pairs are refined after the first test.
    numbers: Vec<u32>,
    order: Vec<u32>,
    finder: PairFinder,
}

/// The volumes that each frame updates, by place.
#[derive(Clone, Debug)]
struct Volumes {
    /// The balls that the finder bins: the bounding spheres, or balls around the volumes of a
    /// strategy without spheres.
    balls: Balls,
    rows: OrDopRows,
    intervals: Option<Intervals>,
    interval_slots: IntervalSlots,
    /// Whether each body is of interest.
    interest: Vec<bool>,
    /// Counts frames from 1.
    stamp: u32,
}

impl Culler {
    /// Builds a culler with the defaults: sequential S-DOP with the two-sided test, the finder that
    /// `auto` picks, the fastest tier of this CPU and the caller's thread.
    ///
    /// # Errors
    /// As [`CullerBuilder::build`].
    pub fn new(shapes: &[Shape], bodies: &Bodies) -> Result<Self, CullError> {
        Self::builder().build(shapes, bodies)
    }

    /// A builder, to change the defaults of [`Self::new`].
    pub fn builder() -> CullerBuilder {
        CullerBuilder::default()
    }

    fn build(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        tier: Tier,
        mut threads: FrameThreads,
    ) -> Result<Self, CullError> {
        check::directions(shapes, settings)?;
        check_bodies(bodies, shapes)?;
        settings.check(bodies.len())?;
        let start = Clock::start();
        let n = bodies.shape.len();
        let (models, places) = (Models::new(shapes, settings), Places::new(bodies));
        let setup = Setup::new(settings);
        let population = needs::population(setup.scheme, &models, &places);
        let finder = PairFinder::new(settings.pairs, &population);
        let needs = VolumeNeeds::of(setup.scheme, settings.k, finder.name());
        let directions = needs.intervals;
        threads.expect(needs.work(n as u64, &Totals::default()));
        let mut culler = Self {
            setup,
            needs,
            tier,
            threads,
            models,
            set: BodySet {
                places,
                groups: None,
                fixed: check::fixed(bodies),
                watched: check::static_runs(bodies),
                numbers: (0..n as u32).collect(),
                order: Vec::new(),
                finder,
            },
            volumes: Volumes {
                balls: Balls::new(n),
                rows: OrDopRows::new(n),
                intervals: directions.map(|directions| Intervals::new(directions, shapes, n)),
                interval_slots: IntervalSlots::default(),
                interest: vec![false; n],
                stamp: 1,
            },
            scratch: Scratch::default(),
            sample: Sample::default(),
            pairs: PairList::default(),
            counters: Counters::default(),
            seconds: Seconds::default(),
        };
        culler.begin(bodies);
        culler.seconds.construct = start.seconds();
        Ok(culler)
    }

    /// Sets the collision groups, one entry per body: from now on, only pairs whose groups may
    /// collide are listed. `None` removes the groups.
    ///
    /// Groups are compared after the first test, when few pairs are left, and before any other
    /// test.
    ///
    /// # Errors
    /// The column's length is not the number of bodies; the groups stay as they were.
    pub fn set_groups(&mut self, groups: Option<Vec<Groups>>) -> Result<(), CullError> {
        if let Some(groups) = &groups {
            check_column("groups", groups.len(), self.set.fixed.len())?;
        }
        self.set.groups = groups;
        Ok(())
    }

    /// From now on, a budget that is spent on pairs as they are found is spent on them in the order
    /// of their bodies.
    pub(crate) fn set_canonical(&mut self) {
        self.setup.is_canonical = true;
    }

    /// When each pair of the last frame was last refined, for the order
    /// [`Order::OldestAnswer`](crate::Order::OldestAnswer).
    pub(crate) fn answers(&self) -> RefinementRanks {
        self.scratch.answers()
    }

    /// Replaces the refinement history by that of another culler.
    pub(crate) fn set_answers(&mut self, answers: &RefinementRanks) {
        self.volumes.stamp = self.volumes.stamp.max(answers.latest());
        self.scratch.set_answers(answers);
    }

    /// Sets the bodies of interest from now on.
    #[doc(hidden)]
    pub fn set_interest(&mut self, interest: Interest) {
        self.setup.settings.interest = Some(interest);
    }

    /// A body's ball centre, and the distance from it within which the body can be part of a pair
    /// ([`border`](crate::rounding::border)).
    #[cfg(feature = "internals")]
    #[doc(hidden)]
    pub fn reach(&self, shape: u32, q: [f32; 4], t: [f32; 3]) -> ([f32; 3], f32) {
        use crate::rounding::border::{reach, reach_of_box};
        let frame = &self.models.frames[shape as usize];
        let [x, y, z, inflated] = frame.sphere(q, t);
        let reach = match self.needs.intervals {
            Some(_) => reach_of_box(inflated, t, frame.reach()),
            None => reach(inflated),
        };
        ([x, y, z], reach)
    }

    /// The pair finder in use: that of the settings, or the one that `auto` has picked.
    #[must_use]
    pub fn finder(&self) -> Finder {
        self.set.finder.name()
    }

    /// Bytes that the pair finder holds.
    #[must_use]
    pub fn finder_bytes(&self) -> usize {
        self.set.finder.bytes()
    }

    /// Candidates that the last frame tested to build a list of neighbours, in addition to the
    /// tests in [`Self::counters`]. There are at most three times as many as the grid would test,
    /// plus 48 per body; a search that reaches this limit is abandoned and counts as the limit.
    #[must_use]
    pub fn list_tests(&self) -> u64 {
        self.set.finder.list_tests()
    }

    /// Culls one frame and returns the reported pairs: i < j, not both static, each once. Their
    /// order depends only on the finder and on earlier frames.
    ///
    /// Poses of static bodies are compared with those of the frame before. A frame in which one of
    /// them differs takes about twice as long.
    ///
    /// # Errors
    /// A number of bodies other than the culler was built for; a `dynamic` flag or a shape that has
    /// changed since the last [`Self::refresh`]; a pose that breaks the contract; more pairs than
    /// memory holds. [`Self::pairs`] is then empty, and the next frame is culled as if
    /// this one had not happened.
    ///
    /// One thing is not checked: the rotation of a body whose ball is centred at its origin, in
    /// strategies that test balls first. If it is zero or not finite, the or-DOP test rejects no
    /// pair of this body, so every pair whose balls meet is reported.
    pub fn cull(&mut self, bodies: &Bodies) -> Result<&PairList, CullError> {
        let mut pairs = std::mem::take(&mut self.pairs);
        let outcome = self.list(bodies, None, None, &mut pairs);
        self.pairs = pairs;
        outcome.map(|()| &self.pairs)
    }

    /// Culls one frame into an empty list, if it has no more pairs than the limit. Pairs pass this
    /// filter, or that of the culler's groups.
    pub(crate) fn list(
        &mut self,
        bodies: &Bodies,
        filter: Option<PairFilter<'_>>,
        limit: Option<usize>,
        pairs: &mut PairList,
    ) -> Result<(), CullError> {
        pairs.clear();
        if let Some(limit) = limit {
            return list_up_to(limit, pairs, |take| self.pass_on(bodies, filter, take));
        }
        let start = Clock::start();
        self.check_set(bodies)?;
        self.follow_static(bodies)?;
        let outcome = self.cull_into(bodies, filter, Output::List(pairs), start);
        self.counters.reported += pairs.len() as u64;
        outcome.and(CullError::check_memory(pairs))
    }

    /// Culls one frame, which began at `start`, and writes its pairs to `output`.
    fn cull_into(
        &mut self,
        bodies: &Bodies,
        filter: Option<PairFilter<'_>>,
        output: Output<'_>,
        start: Clock,
    ) -> Result<(), CullError> {
        in_default_mode(|| self.cull_frame(bodies, filter, output, start))
    }

    fn cull_frame(
        &mut self,
        bodies: &Bodies,
        filter: Option<PairFilter<'_>>,
        output: Output<'_>,
        start: Clock,
    ) -> Result<(), CullError> {
        let mut clock = start;
        self.volumes.stamp += 1;
        self.reorder(bodies);
        let reordering = clock.lap();
        let row_timing = RowTiming::of(&self.setup, &self.set.places, &output);
        let moving = 0..self.set.places.moving;
        if !self.update_first(bodies, moving.clone()) {
            self.check_moved(bodies)?;
        }
        if row_timing == RowTiming::BeforePairs {
            self.update_rows(bodies, moving);
        }
        self.count_updates();
        let updating = clock.lap();
        self.arrange();
        let totals = self.run(bodies, filter, output, row_timing);

        let finding = reordering + clock.seconds();
        let refining = totals.refining_seconds + totals.update_seconds;
        self.seconds.update += updating + totals.update_seconds;
        self.seconds.ordop += totals.refining_seconds;
        self.seconds.pair_finding += finding - refining;
        self.seconds.total += start.seconds();
        Ok(())
    }

    /// The pairs of the last frame.
    #[must_use]
    pub fn pairs(&self) -> &PairList {
        &self.pairs
    }

    /// The potentially colliding set of the last frame in the order of refinement, for strategies
    /// that list it.
    pub fn potentially_colliding(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.scratch.candidates.iter().map(|pair| {
            let [a, b] = pair.map(|place| self.set.places.body[place as usize]);
            [a.min(b), a.max(b)]
        })
    }

    /// Counters summed over all frames so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Seconds summed over all frames so far. `effects` is 0 here; the caller may fill it in.
    #[must_use]
    pub fn seconds(&self) -> &Seconds {
        &self.seconds
    }
}
