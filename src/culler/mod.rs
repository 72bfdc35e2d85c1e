//! The pipeline: the one place that calls the stages in order and times them.
//!
//! > update → broad phase → overlap → pairs
//!
//! A [`Culler`] is built once for a scene (the paper's Co) and then culls frame after frame. All buffers stay, so in steady
//! state nothing is allocated.

pub(crate) mod models;
mod needs;

use std::time::Instant;

use self::models::Models;
use self::needs::Needs;
use crate::bodies::Bodies;
use crate::bodies::Groups;
use crate::bodies::Places;
use crate::broad_phase::{PairFinder, Reorder};
use crate::counters::{Counters, Seconds};
use crate::overlap::intervals::IntervalSlots;
use crate::pairs::PairList;
use crate::settings::{CullSettings, Finder, Interest, Overlap, SettingsError, Strategy, Updates};
use crate::simd::Tier;
use crate::strategy::{self, Memory, Stage, Worker};
use crate::threads::{Threads, ThreadsError};
use crate::update::{Intervals, OrDopRows, Posed, update_spheres};
use crate::volume::Shape;

/// Culls the frames of one scene: a fixed set of bodies whose poses change.
#[derive(Debug)]
pub struct Culler {
    settings: CullSettings,
    needs: Needs,
    tier: Tier,
    pool: Threads,
    workers: Vec<Worker>,
    models: Models,
    places: Places,
    groups: Option<Vec<Groups>>,
    /// 0, 1, 2 …: the names of slots where pairs are refined further.
    numbers: Vec<u32>,
    order: Vec<u32>,
    finder: PairFinder,
    /// What the finder bins, by place: the spheres, or what contains the volumes of a homogeneous strategy.
    balls: Vec<[f32; 4]>,
    rows: OrDopRows,
    intervals: Option<Intervals>,
    interval_slots: IntervalSlots,
    interest: Vec<bool>,
    memory: Memory,
    candidates: PairList,
    pairs: PairList,
    stamp: u32,
    counters: Counters,
    seconds: Seconds,
}

impl Culler {
    /// Prepares culling of `bodies` in the tier `tier`, on the caller's thread. Static bodies' volumes are placed here, once.
    ///
    /// `bodies` must satisfy the contract (see [`check_bodies`](crate::bodies::contract::check_bodies)); shapes are in the
    /// order that `bodies.shape` counts in. For [`Strategy::Obb`] each shape's own box replaces its or-DOP.
    ///
    /// # Errors
    /// Settings that can't be carried out: a missing interest or budget, a body that doesn't exist.
    pub fn new(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        tier: Tier,
    ) -> Result<Self, SettingsError> {
        settings.check(bodies.shape.len())?;
        let start = Instant::now();
        let n = bodies.shape.len();
        let (models, places) = (Models::new(shapes, settings), Places::new(bodies));
        let population = needs::population(settings.strategy, &models, &places);
        let finder = PairFinder::new(settings.pairs, &population);
        let needs = Needs::of(settings, finder.name());
        let directions = needs.intervals;
        let mut culler = Self {
            settings: settings.clone(),
            needs,
            tier,
            pool: Threads::default(),
            workers: Vec::new(),
            models,
            places,
            groups: None,
            numbers: (0..n as u32).collect(),
            order: Vec::new(),
            finder,
            balls: vec![[0.0; 4]; n],
            rows: OrDopRows::new(n),
            intervals: directions.map(|directions| Intervals::new(directions, shapes, n)),
            interval_slots: IntervalSlots::default(),
            interest: vec![false; n],
            memory: Memory::default(),
            candidates: PairList::default(),
            pairs: PairList::default(),
            stamp: 1,
            counters: Counters::default(),
            seconds: Seconds::default(),
        };
        culler.update_volumes(bodies, 0..n);
        culler.reorder(bodies);
        culler.arrange();
        culler.seconds.construct = start.elapsed().as_secs_f64();
        Ok(culler)
    }

    /// The same culler working on so many threads. Lists, counters and hashes don't depend on their number.
    ///
    /// # Errors
    /// The system refuses to start the threads.
    pub fn with_threads(mut self, threads: usize) -> Result<Self, ThreadsError> {
        self.pool = Threads::new(threads)?;
        Ok(self)
    }

    /// Adds a model: the shape grown by `margin` ≥ 0. A body takes it when `bodies.shape` has the returned number.
    pub(crate) fn grow(&mut self, shape: u32, margin: f32) -> u32 {
        self.models.grow(shape, margin)
    }

    /// Re-reads `bodies.shape` after a change of margin class.
    pub(crate) fn reread_shapes(&mut self, bodies: &Bodies) {
        self.places.reread_shapes(bodies);
    }

    /// Replaces the set of bodies by those that are `present`. Volumes, static ones too, are placed anew; bodies that were
    /// there keep their neighbours.
    pub(crate) fn replace(&mut self, bodies: &Bodies, present: &[bool]) {
        self.places.replace(bodies, present);
        let n = self.places.len();
        self.numbers = (0..n as u32).collect();
        self.balls.resize(n, [0.0; 4]);
        self.rows.resize(n);
        if let Some(intervals) = &mut self.intervals {
            intervals.resize(n);
        }
        self.interest.resize(bodies.len(), false);
        let population = needs::population(self.settings.strategy, &self.models, &self.places);
        self.finder = PairFinder::new(self.settings.pairs, &population);
        self.update_volumes(bodies, 0..n);
        self.reorder(bodies);
        self.arrange();
    }

    /// From now on, only pairs of bodies that may collide are listed; `None`: all may.
    ///
    /// Pairs are filtered behind the first test, whose hits are few, and before anything else is done with them.
    pub fn set_groups(&mut self, groups: Option<Vec<Groups>>) {
        self.groups = groups;
    }

    /// From now on, these are the bodies of interest.
    pub(crate) fn set_interest(&mut self, bodies: Vec<u32>) {
        self.settings.interest = Some(Interest::Bodies(bodies));
    }

    /// The pair finder at work: the one asked for, or what `auto` has picked.
    #[must_use]
    pub fn finder(&self) -> Finder {
        self.finder.name()
    }

    /// Bytes that the pair finder holds.
    #[must_use]
    pub fn finder_bytes(&self) -> usize {
        self.finder.bytes()
    }

    /// Culls one frame: the pairs i < j, not both static, that the strategy reports, in an order that depends on the
    /// finder and on the frames so far alone. Poses must satisfy the contract.
    pub fn cull(&mut self, bodies: &Bodies) -> &PairList {
        let start = Instant::now();
        self.stamp += 1;
        self.pairs.clear();
        self.reorder(bodies);
        let reordered = Instant::now();
        self.update_volumes(bodies, 0..self.places.moving);
        self.count_updates();
        let updated = Instant::now();
        self.seconds.update += (updated - reordered).as_secs_f64();
        let before = (self.seconds.ordop, self.seconds.update);

        self.arrange();
        self.run(bodies);

        self.counters.reported += self.pairs.len() as u64;
        let refined = (self.seconds.ordop - before.0) + (self.seconds.update - before.1);
        let finding = (reordered - start) + updated.elapsed();
        self.seconds.pair_finding += finding.as_secs_f64() - refined;
        self.seconds.total += start.elapsed().as_secs_f64();
        &self.pairs
    }

    /// The pairs of the last frame.
    #[must_use]
    pub fn pairs(&self) -> &PairList {
        &self.pairs
    }

    /// For strategies that list it, the potentially colliding set of the last frame in the order of refinement.
    pub fn potentially_colliding(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.candidates.iter().map(|pair| {
            let [a, b] = pair.map(|place| self.places.body[place as usize]);
            [a.min(b), a.max(b)]
        })
    }

    /// Counters summed over all frames so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Seconds summed over all frames so far; `effects` is left to the caller.
    #[must_use]
    pub fn seconds(&self) -> &Seconds {
        &self.seconds
    }

    /// Whether slots are named by place: or-DOPs and slabs are looked up by place, spheres alone need the body only.
    fn names_are_places(&self) -> bool {
        self.needs.rows || self.needs.intervals.is_some()
    }

    /// Lets the finder put bodies in other places. What has moved is updated anyway, unless it is static.
    fn reorder(&mut self, bodies: &Bodies) {
        if self.settings.strategy == Strategy::None {
            // The control arranges nothing, so there is no order to follow.
            return;
        }
        let by_place = self.names_are_places();
        let names = if by_place {
            &self.numbers
        } else {
            &self.places.body
        };
        let (balls, order) = (&self.balls, &mut self.order);
        let changed = self.finder.reorder(&self.places, balls, names, order);
        if changed == Reorder::None {
            return;
        }
        self.places.reorder(bodies, &mut self.order, by_place);
        if changed == Reorder::All {
            self.update_volumes(bodies, 0..self.places.len());
        }
    }

    /// Updates the volumes in a range of places; with lazy updates, rows of moving bodies are left until a pair
    /// needs them.
    fn update_volumes(&mut self, bodies: &Bodies, range: std::ops::Range<usize>) {
        let (frames, places) = (&self.models.frames, &self.places);
        if self.needs.balls {
            let balls = &mut self.balls;
            update_spheres(&self.pool, balls, frames, bodies, places, range.clone());
        }
        let posed = Posed {
            frames,
            bodies,
            places,
            balls: &[],
        };
        if self.needs.rows {
            let start = match self.settings.updates {
                Updates::Eager => range.start,
                Updates::Lazy => range.start.max(places.moving),
            };
            let eager = start.min(range.end)..range.end;
            let balls = if self.needs.balls { &*self.balls } else { &[] };
            let posed = Posed { balls, ..posed };
            self.rows
                .update(self.tier, &self.pool, posed, eager, self.stamp);
        }
        if let Some(intervals) = &mut self.intervals {
            intervals.update(self.tier, &self.pool, &mut self.balls, posed, range);
        }
    }

    fn count_updates(&mut self) {
        let moved = self.places.moving as u64;
        let spheres_first = self.needs.balls && !self.is_homogeneous();
        self.counters.sphere.updates += if spheres_first { moved } else { 0 };
        let eager = self.needs.rows && self.settings.updates == Updates::Eager;
        let oriented = match self.settings.strategy {
            Strategy::Obb => &mut self.counters.obb,
            _ => &mut self.counters.ordop,
        };
        oriented.updates += if eager { moved } else { 0 };
        match self.settings.strategy {
            Strategy::Aabb => self.counters.aabb.updates += moved,
            Strategy::KDop => self.counters.kdop.updates += moved,
            _ => {}
        }
    }

    /// Whether one volume alone, and not the sphere, decides.
    fn is_homogeneous(&self) -> bool {
        matches!(
            self.settings.strategy,
            Strategy::OrDop | Strategy::Obb | Strategy::Aabb | Strategy::KDop
        )
    }

    /// Brings the bodies, and the volumes of the first test, into slot order.
    fn arrange(&mut self) {
        if self.settings.strategy == Strategy::None {
            return;
        }
        let names = if self.names_are_places() {
            &self.numbers
        } else {
            &self.places.body
        };
        self.finder
            .arrange(self.tier, &self.pool, &self.places, &self.balls, names);
        if let Some(intervals) = &self.intervals {
            let order = &self.finder.slots().names[..self.places.len()];
            self.interval_slots.fill(order, &intervals.ends);
        }
    }

    fn run(&mut self, bodies: &Bodies) {
        if let Some(interest) = &self.settings.interest {
            let frame = |body: usize| &self.models.frames[bodies.shape[body] as usize];
            let centre = |body: usize| {
                let pose = (bodies.rotation[body], bodies.translation[body]);
                let [x, y, z, _] = frame(body).sphere(pose.0, pose.1);
                [x, y, z]
            };
            strategy::mark(interest, bodies, centre, &mut self.interest);
        }
        let overlap = match self.settings.strategy {
            Strategy::Obb => Overlap::Full,
            _ => self.settings.overlap,
        };
        let (tests_before, names_are_places) = (self.first_tests(), self.names_are_places());
        let mut stage = Stage {
            tier: self.tier,
            pool: &self.pool,
            workers: &mut self.workers,
            finder: &self.finder,
            names_are_places,
            places: &self.places,
            groups: self.groups.as_deref(),
            bodies,
            intervals: &self.interval_slots,
            spheres: if self.needs.balls { &self.balls } else { &[] },
            rows: &mut self.rows,
            frames: &self.models.frames,
            tables: &self.models.tables,
            overlap,
            lazy: self.settings.updates == Updates::Lazy,
            stamp: self.stamp,
            interest: &self.interest,
            budget: self.settings.budget,
            order: self.settings.order,
            memory: &mut self.memory,
            candidates: &mut self.candidates,
            counters: &mut self.counters,
            seconds: &mut self.seconds,
            out: &mut self.pairs,
        };
        strategy::cull(self.settings.strategy, &mut stage);
        self.finder.observe(self.first_tests() - tests_before);
    }

    /// How many candidates the first test has had.
    fn first_tests(&self) -> u64 {
        let counters = &self.counters;
        match self.settings.strategy {
            Strategy::OrDop => counters.ordop.tests,
            Strategy::Obb => counters.obb.tests,
            Strategy::Aabb => counters.aabb.tests,
            Strategy::KDop => counters.kdop.tests,
            _ => counters.sphere.tests,
        }
    }
}
