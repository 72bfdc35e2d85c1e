//! The pipeline: the one place that calls the stages in order and times them.
//!
//! > update → broad phase → overlap → pairs
//!
//! A [`Culler`] is built once for a scene (the paper's Co) and then culls frame after frame. All buffers stay, so in steady
//! state nothing is allocated.

use std::time::Instant;

use crate::broad_phase::AllPairs;
use crate::cost::{Counters, Seconds};
use crate::overlap::intervals::IntervalSlots;
use crate::overlap::ordop::SlabTables;
use crate::overlap::sphere::SphereSlots;
use crate::pairs::PairList;
use crate::scene::bodies::Bodies;
use crate::scene::settings::{CullSettings, Overlap, SettingsError, Strategy, Updates};
use crate::simd::{Level, MAX_WIDTH};
use crate::strategy::{self, Memory, Refine, Stage};
use crate::update::{Intervals, OrDopRows, ShapeFrame, Spheres};
use crate::volume::{Basis, DirectionSet, Hull, OrDop, Shape};

/// Culls the frames of one scene: a fixed set of bodies whose poses change.
#[derive(Debug)]
pub struct Culler {
    settings: CullSettings,
    level: Level,
    frames: Vec<ShapeFrame>,
    tables: SlabTables,
    moving: Vec<u32>,
    finder: AllPairs,
    spheres: Spheres,
    sphere_slots: SphereSlots,
    rows: OrDopRows,
    intervals: Option<Intervals>,
    interval_slots: IntervalSlots,
    interest: Vec<bool>,
    memory: Memory,
    candidates: PairList,
    selected: PairList,
    pairs: PairList,
    stamp: u32,
    counters: Counters,
    seconds: Seconds,
}

/// Which volumes a strategy looks at.
struct Needs {
    spheres: bool,
    rows: bool,
    intervals: Option<DirectionSet>,
}

impl Needs {
    fn of(settings: &CullSettings) -> Self {
        let (spheres, rows, intervals) = match settings.strategy {
            Strategy::None => (false, false, None),
            Strategy::Sphere => (true, false, None),
            Strategy::OrDop | Strategy::Obb => (false, true, None),
            Strategy::Aabb => (false, false, Some(DirectionSet::K6)),
            Strategy::KDop => (false, false, Some(settings.k)),
            Strategy::SDopSequential
            | Strategy::SDopBatch
            | Strategy::SDopObjectOfInterest
            | Strategy::SDopTimeCritical => (true, true, None),
        };
        Self {
            spheres,
            rows,
            intervals,
        }
    }
}

impl Culler {
    /// Prepares culling of `bodies` in the tier `level`. Static bodies' volumes are placed here, once.
    ///
    /// `bodies` must satisfy the contract (see [`check_bodies`](crate::scene::contract::check_bodies)); shapes are in the
    /// order that `bodies.shape` counts in. For [`Strategy::Obb`] each shape's own box replaces its or-DOP.
    ///
    /// # Errors
    /// Settings that can't be carried out: a missing interest or budget, a body that doesn't exist.
    pub fn new(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        level: Level,
    ) -> Result<Self, SettingsError> {
        settings.check(bodies.shape.len())?;
        let start = Instant::now();
        let n = bodies.shape.len();
        let needs = Needs::of(settings);
        let (statics, moving): (Vec<u32>, Vec<u32>) =
            (0..n as u32).partition(|&body| !bodies.dynamic[body as usize]);
        let (frames, tables) = frames_and_tables(shapes, settings);
        let directions = needs.intervals;
        let mut culler = Self {
            settings: settings.clone(),
            level,
            frames,
            tables,
            moving,
            finder: AllPairs::new(&bodies.dynamic),
            spheres: Spheres::new(n),
            sphere_slots: SphereSlots::default(),
            rows: OrDopRows::new(n),
            intervals: directions.map(|directions| Intervals::new(directions, shapes, n)),
            interval_slots: IntervalSlots::default(),
            interest: vec![false; n],
            memory: Memory::default(),
            candidates: PairList::default(),
            selected: PairList::default(),
            pairs: PairList::default(),
            stamp: 1,
            counters: Counters::default(),
            seconds: Seconds::default(),
        };
        culler.update(bodies, &statics, &needs, false);
        culler.seconds.construct = start.elapsed().as_secs_f64();
        Ok(culler)
    }

    /// Culls one frame: the pairs i < j, not both static, that the strategy reports, in an order that depends on the
    /// finder alone. Poses must satisfy the contract.
    pub fn cull(&mut self, bodies: &Bodies) -> &PairList {
        let start = Instant::now();
        self.stamp += 1;
        self.pairs.clear();
        self.candidates.clear();
        let needs = Needs::of(&self.settings);
        let moving = std::mem::take(&mut self.moving);
        let lazy = self.settings.updates == Updates::Lazy;
        self.update(bodies, &moving, &needs, lazy);
        self.count_updates(&needs, moving.len() as u64, lazy);
        self.moving = moving;
        let updated = Instant::now();
        self.seconds.update += (updated - start).as_secs_f64();
        let before = (self.seconds.ordop, self.seconds.update);

        self.fill_slots(&needs);
        self.run(bodies);

        self.counters.reported += self.pairs.len() as u64;
        let refined = (self.seconds.ordop - before.0) + (self.seconds.update - before.1);
        self.seconds.pair_finding += updated.elapsed().as_secs_f64() - refined;
        self.seconds.total += start.elapsed().as_secs_f64();
        &self.pairs
    }

    /// The pairs of the last frame.
    #[must_use]
    pub fn pairs(&self) -> &PairList {
        &self.pairs
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

    /// For time-critical culling, oldest answer first: how many frames ago each listed pair was refined.
    pub fn answer_ages(&self) -> impl Iterator<Item = u32> + '_ {
        self.memory.ages(self.stamp)
    }

    fn update(&mut self, bodies: &Bodies, which: &[u32], needs: &Needs, lazy: bool) {
        if needs.spheres {
            self.spheres.update(&self.frames, bodies, which);
        }
        if needs.rows && !lazy {
            self.rows.update(&self.frames, bodies, which, self.stamp);
        }
        if let Some(intervals) = &mut self.intervals {
            intervals.update(&self.frames, bodies, which);
        }
    }

    fn count_updates(&mut self, needs: &Needs, moved: u64, lazy: bool) {
        let oriented = match self.settings.strategy {
            Strategy::Obb => &mut self.counters.obb,
            _ => &mut self.counters.ordop,
        };
        oriented.updates += if needs.rows && !lazy { moved } else { 0 };
        self.counters.sphere.updates += if needs.spheres { moved } else { 0 };
        match self.settings.strategy {
            Strategy::Aabb => self.counters.aabb.updates += moved,
            Strategy::KDop => self.counters.kdop.updates += moved,
            _ => {}
        }
    }

    /// Brings the volumes of the first test into slot order.
    fn fill_slots(&mut self, needs: &Needs) {
        let order = self.finder.order();
        if needs.spheres || needs.rows {
            self.sphere_slots.fill(order, &self.spheres.of);
        }
        if let Some(intervals) = &self.intervals {
            self.interval_slots.fill(order, &intervals.ends);
        }
    }

    fn run(&mut self, bodies: &Bodies) {
        if let Some(interest) = &self.settings.interest {
            let spheres = &self.spheres.of;
            let centre = |body: usize| [spheres[body][0], spheres[body][1], spheres[body][2]];
            strategy::mark(interest, bodies, centre, &mut self.interest);
        }
        let overlap = match self.settings.strategy {
            Strategy::Obb => Overlap::Full,
            _ => self.settings.overlap,
        };
        let mut stage = Stage {
            level: self.level,
            finder: &self.finder,
            spheres: &self.sphere_slots,
            intervals: &self.interval_slots,
            refine: Refine {
                level: self.level,
                rows: &mut self.rows,
                frames: &self.frames,
                bodies,
                tables: &self.tables,
                overlap,
                lazy: self.settings.updates == Updates::Lazy,
                stamp: self.stamp,
            },
            interest: &self.interest,
            budget: self.settings.budget,
            order: self.settings.order,
            memory: &mut self.memory,
            candidates: &mut self.candidates,
            selected: &mut self.selected,
            counters: &mut self.counters,
            seconds: &mut self.seconds,
            out: &mut self.pairs,
        };
        strategy::cull(self.settings.strategy, &mut stage);
    }
}

/// What updates and pair tests need of each shape: with `obb` the box in place of the or-DOP.
fn frames_and_tables(shapes: &[Shape], settings: &CullSettings) -> (Vec<ShapeFrame>, SlabTables) {
    let boxes: Vec<OrDop> = match settings.strategy {
        Strategy::Obb => shapes
            .iter()
            .map(|s| s.obb(&Hull::of(&s.vertices)))
            .collect(),
        _ => Vec::new(),
    };
    let ordop = |i: usize| boxes.get(i).unwrap_or(&shapes[i].ordop);
    let basis = |i: usize| -> &Basis { &ordop(i).basis };
    let frames = shapes
        .iter()
        .enumerate()
        .map(|(i, shape)| ShapeFrame::new(shape, basis(i)))
        .collect();
    let directions = match settings.strategy {
        Strategy::Obb => DirectionSet::K6,
        _ => shapes
            .first()
            .map_or(settings.k, |shape| shape.ordop.directions),
    };
    let tables = SlabTables::new(
        directions,
        shapes.iter().enumerate().map(|(i, s)| (s, ordop(i))),
    );
    (frames, tables)
}

impl SphereSlots {
    /// Gathers the spheres of all bodies into slot order and pads.
    fn fill(&mut self, order: &[u32], spheres: &[[f32; 4]]) {
        let padded = order.len() + MAX_WIDTH;
        let columns = [&mut self.x, &mut self.y, &mut self.z, &mut self.r];
        for (axis, column) in columns.into_iter().enumerate() {
            column.clear();
            column.extend(order.iter().map(|&body| spheres[body as usize][axis]));
            column.resize(padded, 0.0);
        }
        self.body.clear();
        self.body.extend_from_slice(order);
        self.body.resize(padded, 0);
    }
}

impl IntervalSlots {
    /// Gathers the slabs of all bodies into slot order and pads.
    fn fill(&mut self, order: &[u32], ends: &[[f32; 2]]) {
        let slabs = ends.len().checked_div(order.len()).unwrap_or(0);
        self.lo.resize(slabs, Vec::new());
        self.hi.resize(slabs, Vec::new());
        for (side, columns) in [&mut self.lo, &mut self.hi].into_iter().enumerate() {
            for (slab, column) in columns.iter_mut().enumerate() {
                column.clear();
                let end = |&body: &u32| ends[body as usize * slabs + slab][side];
                column.extend(order.iter().map(end));
                column.resize(order.len() + MAX_WIDTH, 0.0);
            }
        }
        self.body.clear();
        self.body.extend_from_slice(order);
        self.body.resize(order.len() + MAX_WIDTH, 0);
    }
}
