//! The test of listed pairs by their convex hulls, the tightest convex volume, after any culler.

mod gjk;

pub use gjk::{HullGraph, PosedHull, may_touch};

use sdop::bodies::Bodies;
use sdop::counters::VolumeCounters;
use sdop::pairs::PairList;
use sdop::volume::Shape;

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
    /// The hulls of some shapes.
    #[must_use]
    pub fn new(shapes: &[Shape]) -> Self {
        Self {
            graphs: shapes.iter().map(HullGraph::new).collect(),
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
