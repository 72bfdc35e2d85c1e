//! Finds the bodies of an index that may touch a volume, one query at a time or in batches.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::index::{QueryIndex, SolidBody, TREES};
use super::tree::Tree;
use super::volume::{QueryError, QueryVolume};
use crate::bodies::Aabb;
use crate::living::BodyId;
use crate::posed::PosedShape;
use crate::rounding::query::is_beyond;
use crate::rounding::{down, up};
use crate::simd::{Kernel, Lanes, Tier, dispatch, in_default_mode};

/// Queries that one thread answers at a time.
const QUERIES_PER_TASK: usize = 32;

/// Answers to many queries, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers<T> {
    all: Vec<T>,
    /// The end of each query's answers.
    ends: Vec<usize>,
}

impl<T> Answers<T> {
    /// The answer to query `query`, counted from 0.
    ///
    /// # Panics
    /// Panics if there was no such query.
    #[must_use]
    pub fn of(&self, query: usize) -> &[T] {
        let start = query.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[start..self.ends[query]]
    }

    /// All answers, in the order of the queries.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[T]> + '_ {
        (0..self.ends.len()).map(|query| self.of(query))
    }

    /// Number of queries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there were no queries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }
}

/// A volume prepared for the tests.
#[derive(Clone, Copy, Debug)]
pub(super) enum Probe<'a> {
    Box([[f64; 3]; 2]),
    Ball([f64; 3], f64),
    Shape(PosedShape<'a>),
}

impl<'a> Probe<'a> {
    fn new(volume: &QueryVolume<'a>) -> Self {
        match *volume {
            QueryVolume::Box { min, max } => Self::Box([min, max]),
            QueryVolume::Ball { centre, radius } => Self::Ball(centre, radius),
            QueryVolume::Shape { shape, rotation, translation, margin } => {
                Self::Shape(shape.at(rotation, translation, margin))
            }
        }
    }

    /// A box about it, seen from `origin`.
    fn bounds(&self, origin: [f64; 3]) -> Aabb {
        let (lo, hi) = match self {
            Self::Box([lo, hi]) => (*lo, *hi),
            Self::Ball(centre, radius) => {
                (centre.map(|x| (x - radius).next_down()), centre.map(|x| (x + radius).next_up()))
            }
            Self::Shape(posed) => return posed.bounds(origin),
        };
        Aabb {
            min: std::array::from_fn(|axis| down(lo[axis] - origin[axis])),
            max: std::array::from_fn(|axis| up(hi[axis] - origin[axis])),
        }
    }

    /// Whether a body may touch it.
    #[inline(always)]
    fn may_touch(&self, solid: SolidBody<'_>) -> bool {
        let ends = |aabb: Aabb| [aabb.min, aabb.max].map(|corner| corner.map(f64::from));
        match (self, solid) {
            (Self::Box([lo, hi]), SolidBody::Box(aabb)) => {
                let [min, max] = ends(aabb);
                (0..3).all(|axis| lo[axis] <= max[axis] && min[axis] <= hi[axis])
            }
            (Self::Ball(centre, radius), SolidBody::Box(aabb)) => {
                let [min, max] = ends(aabb);
                !is_beyond(*centre, *radius, min, max)
            }
            (Self::Shape(posed), SolidBody::Box(aabb)) => {
                let [min, max] = ends(aabb);
                posed.may_touch_box(min, max)
            }
            (Self::Box([lo, hi]), SolidBody::Shape(body)) => body.may_touch_box(*lo, *hi),
            (Self::Ball(centre, radius), SolidBody::Shape(body)) => {
                body.may_touch_ball(*centre, *radius)
            }
            (Self::Shape(posed), SolidBody::Shape(body)) => posed.may_touch(&body),
        }
    }
}

impl QueryVolume<'_> {
    /// The point that it is placed by.
    pub(crate) fn origin(&self) -> [f64; 3] {
        match *self {
            Self::Box { min, .. } => min,
            Self::Ball { centre, .. } => centre,
            Self::Shape { translation, .. } => translation,
        }
    }

    /// The ends of a box about it, off by roundings of f64.
    pub(crate) fn ends(&self) -> [[f64; 3]; 2] {
        let origin = self.origin();
        let Aabb { min, max } = Probe::new(self).bounds(origin);
        [min, max].map(|ends| [0, 1, 2].map(|axis| origin[axis] + f64::from(ends[axis])))
    }
}

impl QueryIndex {
    /// The bodies that may touch a volume, sorted by slot.
    ///
    /// # Errors
    /// A volume outside of the contract ([`QueryVolume`]), or an index that was never updated.
    pub fn touching(&self, volume: &QueryVolume<'_>) -> Result<Vec<BodyId>, QueryError> {
        self.check_updated()?;
        volume.check(0)?;
        let mut found = Vec::new();
        in_default_mode(|| self.touch(volume, &mut found));
        Ok(found)
    }

    /// [`Self::touching`] for many volumes, on all threads.
    ///
    /// # Errors
    /// As [`Self::touching`], for the first such volume.
    pub fn touching_all(&self, volumes: &[QueryVolume<'_>]) -> Result<Answers<BodyId>, QueryError> {
        self.check_updated()?;
        for (query, volume) in volumes.iter().enumerate() {
            volume.check(query)?;
        }
        self.each_of(volumes, |volume, found| self.touch(volume, found))
    }

    /// Answers many queries on all threads. `answer` appends the answer to one query.
    pub(crate) fn each_of<Q: Sync, T: Send>(
        &self,
        queries: &[Q],
        answer: impl Fn(&Q, &mut Vec<T>) + Sync,
    ) -> Result<Answers<T>, QueryError> {
        let pieces = queries.chunks(QUERIES_PER_TASK);
        let mut tasks: Vec<_> = pieces.map(|piece| (piece, Vec::new(), Vec::new())).collect();
        let count = AnswerCount::up_to(self.most_answers);
        in_default_mode(|| {
            self.threads.each(&mut tasks, |_, (piece, all, ends)| {
                for query in *piece {
                    let start = all.len();
                    answer(query, all);
                    count.add(all, start);
                    ends.push(all.len());
                }
            });
        });
        let mut answers = Answers { all: count.room()?, ends: Vec::with_capacity(queries.len()) };
        for (_, all, ends) in tasks {
            let start = answers.all.len();
            answers.all.extend(all);
            answers.ends.extend(ends.into_iter().map(|end| start + end));
        }
        Ok(answers)
    }

    /// Appends the bodies that may touch a volume within the contract, sorted by slot.
    pub(crate) fn touch(&self, volume: &QueryVolume<'_>, found: &mut Vec<BodyId>) {
        let start = found.len();
        let probe = Probe::new(volume);
        let bounds = probe.bounds(self.origin);
        for tree in 0..TREES {
            each_meeting(self.tier, &self.trees[tree], &bounds, &mut |place| {
                if probe.may_touch(self.solid(tree, place)) {
                    found.push(self.id_at(tree, place));
                }
            });
        }
        found[start..].sort_unstable();
    }
}

/// The number of a call's answers, of all threads.
pub(super) struct AnswerCount {
    found: AtomicUsize,
    limit: usize,
}

impl AnswerCount {
    pub fn up_to(limit: usize) -> Self {
        Self { found: AtomicUsize::new(0), limit }
    }

    /// Counts a list's answers from `start` on. Beyond the limit they are not kept.
    pub fn add<T>(&self, list: &mut Vec<T>, start: usize) {
        let new = list.len() - start;
        let before = self.found.fetch_add(new, Ordering::Relaxed);
        if before.saturating_add(new) > self.limit {
            list.truncate(start);
        }
    }

    /// An empty list with room for all.
    pub fn room<T>(self) -> Result<Vec<T>, QueryError> {
        let Self { found, limit } = self;
        let (found, mut list) = (found.into_inner(), Vec::new());
        if found > limit {
            let value = format!("{found} in all, of at most {limit}");
            return Err(QueryError::new(
                0,
                "answers",
                value,
                "raise `most_answers`, or ask less at a time",
            ));
        }
        let memory = list.try_reserve_exact(found);
        memory.map_err(|_| {
            let value = format!("{found} in all, for which there is no memory");
            QueryError::new(0, "answers", value, "ask less at a time, or limit `most_answers`")
        })?;
        Ok(list)
    }
}

/// [`Tree::each_meeting`] in a tier.
fn each_meeting(tier: Tier, tree: &Tree, aabb: &Aabb, take: &mut dyn FnMut(usize)) {
    struct SearchMeeting<'a>(&'a Tree, &'a Aabb, &'a mut dyn FnMut(usize));
    impl Kernel for SearchMeeting<'_> {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) {
            let Self(tree, aabb, take) = self;
            tree.each_meeting(l, aabb, take);
        }
    }
    dispatch(tier, SearchMeeting(tree, aabb, take));
}
