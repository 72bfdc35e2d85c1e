//! One variant at work: a culler, and behind it the hulls where the variant has them.

use std::time::Instant;

use super::gjk::{HullGraph, PosedHull, may_touch};
use super::variant::Variant;
use crate::bodies::Bodies;
use crate::counters::{Counters, VolumeCounters};
use crate::culler::Culler;
use crate::lab::scene::Scene;
use crate::pairs::PairList;
use crate::settings::SettingsError;
use crate::simd::Tier;

/// A variant prepared for a scene's bodies.
#[derive(Debug)]
pub struct Contender {
    culler: Culler,
    hulls: Option<HullTest>,
    seconds: f64,
}

impl Contender {
    /// Builds what the variant needs.
    ///
    /// # Errors
    /// Settings that can't be carried out.
    pub fn new(scene: &Scene, variant: &Variant, tier: Tier) -> Result<Self, SettingsError> {
        let scene = variant.apply(scene);
        Ok(Self {
            culler: Culler::new(&scene.shapes, &scene.bodies, &scene.cull, tier)?,
            hulls: variant.hulls.then(|| HullTest::new(&scene)),
            seconds: 0.0,
        })
    }

    /// Culls one frame; its seconds are added up.
    pub fn frame(&mut self, bodies: &Bodies) -> &PairList {
        let start = Instant::now();
        self.culler.cull(bodies);
        if let Some(hulls) = &mut self.hulls {
            hulls.cull(bodies, self.culler.pairs());
        }
        self.seconds = start.elapsed().as_secs_f64();
        match &self.hulls {
            Some(hulls) => &hulls.kept,
            None => self.culler.pairs(),
        }
    }

    /// Seconds of the last frame.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// The culler's counters, summed over frames.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.culler.counters()
    }

    /// The hulls' counters, summed over frames.
    #[must_use]
    pub fn hull_counters(&self) -> VolumeCounters {
        self.hulls
            .as_ref()
            .map_or_else(Default::default, |h| h.counters)
    }

    /// The culler.
    #[must_use]
    pub fn culler(&self) -> &Culler {
        &self.culler
    }
}

/// The hull test of listed pairs.
#[derive(Debug)]
pub struct HullTest {
    graphs: Vec<HullGraph>,
    /// The pairs of the last frame that the hulls let through.
    pub kept: PairList,
    /// Summed over frames; an update is a pose made when a pair needs it.
    pub counters: VolumeCounters,
}

impl HullTest {
    /// The hulls of a scene's shapes.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self {
            graphs: scene.shapes.iter().map(HullGraph::new).collect(),
            kept: PairList::default(),
            counters: VolumeCounters::default(),
        }
    }

    /// Tests the pairs; the ones that may touch are in `kept` afterwards.
    pub fn cull(&mut self, bodies: &Bodies, pairs: &PairList) {
        let mut posed: Vec<Option<PosedHull<'_>>> = vec![None; bodies.len()];
        self.kept.clear();
        for [i, j] in pairs.iter() {
            let [a, b] = [i, j].map(|body| {
                *posed[body as usize].get_or_insert_with(|| {
                    self.counters.updates += 1;
                    PosedHull::of(&self.graphs, bodies, body as usize)
                })
            });
            if may_touch(&a, &b) {
                self.kept.push(i, j);
            }
        }
        self.counters.tests += pairs.len() as u64;
        self.counters.hits += self.kept.len() as u64;
    }
}
