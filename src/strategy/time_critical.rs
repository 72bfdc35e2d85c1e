//! S-DOP under a budget (the paper's third phase; Hubbard 1996): the potentially colliding set is refined in a chosen order
//! until the budget ends, and what isn't refined counts as colliding (Dingliana & O'Sullivan 2000).
//!
//! A budget of tests gives the same pairs everywhere; a budget of time is looked at after every [`SLICE`] tests.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use super::Stage;
use super::batch::list_spheres;
use crate::overlap::sphere::SphereSlots;
use crate::pairs::PairList;
use crate::scene::settings::{Budget, Order};

/// Tests between two looks at the clock: some microseconds.
const SLICE: usize = 128;

/// For each pair that spheres reported in the last frame, the frame in which it was last refined (0: never).
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    refined: HashMap<[u32; 2], u32>,
    slot: Vec<u32>,
}

pub(super) fn cull(stage: &mut Stage<'_>) {
    let start = Instant::now();
    list_spheres(stage);
    arrange(stage);
    let (tests, deadline) = match stage.budget {
        Some(Budget::Tests(tests)) => (usize::try_from(tests).unwrap_or(usize::MAX), None),
        Some(Budget::Microseconds(us)) => (usize::MAX, Some(Duration::from_micros(us))),
        None => (usize::MAX, None),
    };
    let limit = tests.min(stage.candidates.len());
    let mut done = 0;
    while done < limit && deadline.is_none_or(|deadline| start.elapsed() < deadline) {
        let end = if deadline.is_some() {
            limit.min(done + SLICE)
        } else {
            limit
        };
        let pairs = [
            &stage.candidates.first()[done..end],
            &stage.candidates.second()[done..end],
        ];
        stage
            .refine
            .test(pairs, &mut stage.counters.ordop, stage.seconds, stage.out);
        done = end;
    }
    stage.counters.untested += (stage.candidates.len() - done) as u64;
    for [i, j] in stage.candidates.iter().skip(done) {
        stage.out.push(i, j);
    }
    if stage.order == Order::OldestAnswer {
        stage
            .memory
            .remember(stage.candidates, done, stage.refine.stamp);
    }
}

/// Sorts the potentially colliding set into the order of refinement. Ties go by body index, so the order is the same for
/// every pair finder.
fn arrange(stage: &mut Stage<'_>) {
    if stage.order == Order::AsFound {
        return;
    }
    let mut pairs: Vec<[u32; 2]> = stage.candidates.iter().collect();
    match stage.order {
        Order::AsFound => {}
        Order::InterestFirst => {
            let dull = |body: u32| !stage.interest[body as usize];
            pairs.sort_unstable_by_key(|&[i, j]| (dull(i) && dull(j), i, j));
        }
        Order::LargestOverlap => {
            stage.memory.locate(stage.finder.order());
            let mut keyed: Vec<_> = pairs
                .iter()
                .map(|&pair| (stage.memory.gap(stage.spheres, pair), pair))
                .collect();
            keyed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            pairs = keyed.into_iter().map(|(_, pair)| pair).collect();
        }
        Order::OldestAnswer => {
            let last = |pair: &[u32; 2]| stage.memory.refined.get(pair).copied().unwrap_or(0);
            pairs.sort_unstable_by_key(|pair| (last(pair), *pair));
        }
    }
    stage.candidates.clear();
    for [i, j] in pairs {
        stage.candidates.push(i, j);
    }
}

impl Memory {
    /// The frames since each pair of the last potentially colliding set was refined, given the current frame's stamp.
    pub(crate) fn ages(&self, stamp: u32) -> impl Iterator<Item = u32> + '_ {
        self.refined.values().map(move |&last| stamp - last)
    }

    fn remember(&mut self, pairs: &PairList, done: usize, stamp: u32) {
        let last = std::mem::take(&mut self.refined);
        self.refined = pairs
            .iter()
            .enumerate()
            .map(|(at, pair)| {
                let before = last.get(&pair).copied().unwrap_or(0);
                (pair, if at < done { stamp } else { before })
            })
            .collect();
    }

    /// Notes in which slot each body stands.
    fn locate(&mut self, body: &[u32]) {
        self.slot.resize(body.len(), 0);
        for (slot, &body) in body.iter().enumerate() {
            self.slot[body as usize] = slot as u32;
        }
    }

    /// d²/s² of a pair's inflated spheres: 0 when concentric, 1 when touching.
    fn gap(&self, spheres: &SphereSlots, [i, j]: [u32; 2]) -> f32 {
        let [i, j] = [i, j].map(|body| self.slot[body as usize] as usize);
        let (dx, dy) = (spheres.x[i] - spheres.x[j], spheres.y[i] - spheres.y[j]);
        let (dz, s) = (spheres.z[i] - spheres.z[j], spheres.r[i] + spheres.r[j]);
        (dx * dx + dy * dy + dz * dz) / (s * s)
    }
}
