//! Computes the boxes of some bodies, and tests listed pairs as a frame would.
//!
//! A world that knows the pairs of the last frame tests only the pairs of changed bodies. Their
//! volumes are computed by the same kernels as a frame's, in separate places, and tested by the
//! same comparisons, so a pair has the same verdict either way.

use super::Culler;
use crate::bodies::{Aabb, Bodies, Places};
use crate::broad_phase::Balls;
use crate::counters::{Clock, RestCounters, VolumeCounters};
use crate::overlap::ordop::OrDopColumns;
use crate::pairs::{FoundPartners, PairList};
use crate::rounding::{down, sphere::apart, up, widen};
use crate::settings::Flow;
use crate::simd::{Kernel, Lanes, in_one_lane};
use crate::threads::FrameWork;
use crate::update::{OrDopRows, RowsByNumber, UpdateInputs, update_spheres};

/// The volumes of some bodies: first of those that have changed, then of those near each of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    places: Places,
    balls: Balls,
    /// World-aligned slabs, in the order of [`Intervals`](crate::update::Intervals).
    ends: Vec<[f32; 2]>,
    rows: OrDopRows,
    /// Pairs of places, the one of the lower body first.
    pairs: PairList,
    survivors: PairList,
}

impl Culler {
    /// Whether a pair's verdict is a function of its two bodies. It is in every strategy that tests
    /// pairs and has no budget.
    pub(crate) fn judges_pairs_alone(&self) -> bool {
        match self.setup.scheme.flow {
            Flow::FirstTest | Flow::Sequential | Flow::Batch | Flow::OfInterest => true,
            Flow::Nothing | Flow::TimeCritical => false,
        }
    }

    /// The box around each of these bodies. Two bodies whose boxes don't meet are never reported.
    pub(crate) fn boxes_of(&mut self, bodies: &Bodies, some: &[u32]) -> Vec<Aabb> {
        let start = Clock::start();
        self.sample.places.body.clear();
        self.place_sample(bodies, some);
        let sample = &self.sample;
        let boxes = if self.volumes.intervals.is_some() {
            let slabs = sample.ends.len() / some.len().max(1);
            let boxes = sample.ends.chunks_exact(slabs.max(1));
            boxes.map(box_of_slabs).collect()
        } else {
            sample.balls.iter().map(box_about).collect()
        };
        self.seconds.update += start.seconds();
        boxes
    }

    /// Keeps the reported pairs among those whose boxes meet. The bodies are those of the last call
    /// of [`Self::boxes_of`]; `interest` has whether each is of interest.
    pub(crate) fn test_found(
        &mut self,
        bodies: &Bodies,
        found: &mut FoundPartners,
        interest: &[bool],
    ) {
        let mut clock = Clock::start();
        self.place_sample(bodies, &found.partners);
        let candidates = found.partners.len();
        self.count_sample_updates(candidates);
        self.seconds.update += clock.lap();
        if let Some(volume) = self.setup.scheme.first {
            let counted = self.keep_near(found);
            *self.counters.of_mut(volume) += counted;
        }
        self.seconds.pair_finding += clock.lap();
        let mut refined = 0;
        if let Some(volume) = self.setup.scheme.refining {
            let counted = self.refine_found(bodies, found, interest);
            refined = counted.tests;
            *self.counters.of_mut(volume) += counted;
        }
        self.seconds.ordop += clock.seconds();
        self.threads.expect(FrameWork {
            updates: self.sample.places.len() as u64,
            candidates: found.partners.len() as u64,
            refined,
        });
    }

    /// Counts a frame whose pairs were found from its changed bodies alone, and its seconds.
    pub(crate) fn count_sampled(&mut self, counted: RestCounters, pairs: usize, seconds: f64) {
        self.counters.rest += counted;
        self.counters.reported += pairs as u64;
        self.seconds.total += seconds;
    }

    /// Gives places to more bodies after those of the sample, and computes their volumes for the
    /// first test.
    fn place_sample(&mut self, bodies: &Bodies, more: &[u32]) {
        let Sample { places, balls, ends, .. } = &mut self.sample;
        let first = places.len();
        places.body.extend_from_slice(more);
        places.reread_shapes(bodies);
        places.moving = places.len();
        let range = first..places.len();
        balls.resize(range.end);
        let executor = self.threads.get().executor(self.tier);
        match &mut self.volumes.intervals {
            Some(intervals) => {
                let frames = &self.models.frames;
                let posed = UpdateInputs { frames, bodies, places, balls: &[] };
                std::mem::swap(&mut intervals.ends, ends);
                intervals.resize(range.end);
                intervals.update(executor, balls, posed, range);
                std::mem::swap(&mut intervals.ends, ends);
            }
            None => _ = update_spheres(executor, balls, &self.models.frames, bodies, places, range),
        }
    }

    /// Counts updates of the first test's volumes.
    pub(crate) fn count_sample_updates(&mut self, updates: usize) {
        if let Some(volume) = self.setup.scheme.first {
            self.counters.of_mut(volume).updates += updates as u64;
        }
    }

    /// Keeps the pairs that pass the first test, of bodies in the first places with partners in the
    /// places after them.
    fn keep_near(&self, found: &mut FoundPartners) -> VolumeCounters {
        let Sample { balls, ends: slabs, places, .. } = &self.sample;
        let (tests, count) = (found.partners.len() as u64, found.present);
        if self.volumes.intervals.is_some() {
            let each = slabs.len() / places.len().max(1);
            let of = |place: usize| &slabs[place * each..(place + 1) * each];
            found.retain(|number, at, _| meet(of(number), of(count + at)));
        } else {
            in_one_lane(KeepNear { balls, found });
        }
        VolumeCounters { updates: 0, tests, hits: found.partners.len() as u64 }
    }

    /// Keeps the pairs that pass the refining test, and those that need no refinement.
    fn refine_found(
        &mut self,
        bodies: &Bodies,
        found: &mut FoundPartners,
        interest: &[bool],
    ) -> VolumeCounters {
        let is_refined = |a: u32, b: u32| {
            self.setup.scheme.flow != Flow::OfInterest
                || interest[a as usize]
                || interest[b as usize]
        };
        let Sample { places, rows, pairs, survivors, .. } = &mut self.sample;
        places.body.truncate(found.present);
        places.body.extend_from_slice(&found.partners);
        places.reread_shapes(bodies);
        places.moving = places.len();
        rows.resize(places.len());
        let posed = UpdateInputs { frames: &self.models.frames, bodies, places, balls: &[] };
        let executor = self.threads.get().executor(self.tier);
        rows.update(executor, posed, 0..places.len(), self.volumes.stamp);
        pairs.clear();
        survivors.clear();
        let mut at = found.present as u32;
        for (number, (body, partners)) in (0..).zip(found.iter()) {
            for &other in partners {
                if is_refined(body, other) {
                    let [i, j] = if body < other { [number, at] } else { [at, number] };
                    pairs.push(i, j);
                }
                at += 1;
            }
        }
        let columns = OrDopColumns {
            rows: RowsByNumber::all(&rows.rows),
            tables: &self.models.tables,
            overlap: self.setup.scheme.overlap(self.setup.settings.overlap),
        };
        let tested = columns.test_pairs(self.tier, pairs.first(), pairs.second(), survivors);
        let mut survivors = survivors.iter().map(|[i, j]| i.max(j) as usize).peekable();
        let (count, some) = (found.present, std::mem::take(&mut found.bodies));
        found.retain(|number, at, other| {
            let passed = survivors.next_if_eq(&(count + at)).is_some();
            passed || !is_refined(some[number], other)
        });
        found.bodies = some;
        VolumeCounters { updates: places.len() as u64, tests: tested.tests, hits: tested.hits }
    }
}

/// The sphere test of listed pairs.
struct KeepNear<'a> {
    /// Those of the bodies, then those of their partners.
    balls: &'a [[f32; 4]],
    found: &'a mut FoundPartners,
}

impl Kernel for KeepNear<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let count = self.found.present;
        self.found.retain(|number, at, _| {
            let [a, b] = [number, count + at].map(|place| self.balls[place].map(|x| l.splat(x)));
            let between = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            l.bits(apart(l, between, a[3] + b[3])) & 1 == 0
        });
    }
}

/// Whether no direction separates two bodies' slabs.
fn meet(a: &[[f32; 2]], b: &[[f32; 2]]) -> bool {
    let mut slabs = a.iter().zip(b);
    slabs.all(|(&[lo, hi], &[other_lo, other_hi])| !(lo > other_hi || other_lo > hi))
}

/// The box of world-aligned slabs, of which the first three are along the axes.
fn box_of_slabs(slabs: &[[f32; 2]]) -> Aabb {
    Aabb::new(
        std::array::from_fn(|axis| slabs[axis][0]),
        std::array::from_fn(|axis| slabs[axis][1]),
    )
}

/// A box around a ball. If balls are not apart, these boxes meet: along every axis they are as wide
/// as a sweep's ends, which include the rounding of the sphere test.
fn box_about(&[x, y, z, radius]: &[f32; 4]) -> Aabb {
    let reach = f64::from(widen(radius));
    let centre = [x, y, z].map(f64::from);
    Aabb::new(centre.map(|x| down(x - reach)), centre.map(|x| up(x + reach)))
}
