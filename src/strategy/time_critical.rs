//! S-DOP under a budget (the paper's third phase; Hubbard 1996): the potentially colliding set is refined in a chosen order
//! until the budget ends, and what isn't refined counts as colliding (Dingliana & O'Sullivan 2000).
//!
//! A budget of tests gives the same pairs everywhere; a budget of time is looked at after every [`SLICE`] tests.

use std::collections::HashMap;
use std::ops::Range;
use std::time::{Duration, Instant};

use super::Stage;
use super::listing::First;
use super::workers::add;
use crate::cost::VolumeCounters;
use crate::scene::settings::{Budget, Order};

/// Tests between two looks at the clock: some microseconds.
const SLICE: usize = 128;

/// For each pair that spheres reported in the last frame, the frame in which it was last refined (0: never).
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    refined: HashMap<[u32; 2], u32>,
}

pub(super) fn cull(stage: &mut Stage<'_>) {
    let start = Instant::now();
    let listed = stage.list_candidates(First::Sphere);
    add(&mut stage.counters.sphere, listed.first);
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
        refine(stage, done..end);
        done = end;
    }
    let body = |place: u32| stage.places.body[place as usize];
    stage.counters.untested += (stage.candidates.len() - done) as u64;
    for [i, j] in stage.candidates.iter().skip(done) {
        stage.out.push(body(i), body(j));
    }
    if stage.order == Order::OldestAnswer {
        let pairs = stage.candidates.iter().map(|pair| pair.map(body));
        stage.memory.remember(pairs, done, stage.stamp);
    }
}

/// Refines a range of the candidates.
fn refine(stage: &mut Stage<'_>, range: Range<usize>) {
    let mut counters = VolumeCounters {
        updates: stage.make_rows(range.clone()),
        ..VolumeCounters::default()
    };
    let mut out = std::mem::take(stage.out);
    let mut seconds = 0.0;
    let pairs = [
        &stage.candidates.first()[range.clone()],
        &stage.candidates.second()[range],
    ];
    let refine = stage.refine();
    refine.test(pairs, &mut counters, &mut seconds, &mut out);
    *stage.out = out;
    stage.seconds.ordop += seconds;
    add(&mut stage.counters.ordop, counters);
}

/// Sorts the potentially colliding set into the order of refinement. Ties go by body index, so the order is the same for
/// every pair finder.
fn arrange(stage: &mut Stage<'_>) {
    if stage.order == Order::AsFound {
        return;
    }
    let body = |place: u32| stage.places.body[place as usize];
    let bodies = |&pair: &[u32; 2]| pair.map(body);
    let mut pairs: Vec<[u32; 2]> = stage.candidates.iter().collect();
    match stage.order {
        Order::AsFound => {}
        Order::InterestFirst => {
            let dull = |body: u32| !stage.interest[body as usize];
            pairs.sort_unstable_by_key(|pair| {
                let [i, j] = bodies(pair);
                (dull(i) && dull(j), i, j)
            });
        }
        Order::LargestOverlap => {
            let mut keyed: Vec<_> = pairs
                .iter()
                .map(|&pair| (gap(stage.spheres, pair), pair))
                .collect();
            keyed.sort_unstable_by(|(a, first), (b, second)| {
                a.total_cmp(b).then(bodies(first).cmp(&bodies(second)))
            });
            pairs = keyed.into_iter().map(|(_, pair)| pair).collect();
        }
        Order::OldestAnswer => {
            let last = |bodies: &[u32; 2]| stage.memory.refined.get(bodies).copied().unwrap_or(0);
            pairs.sort_unstable_by_key(|pair| (last(&bodies(pair)), bodies(pair)));
        }
    }
    stage.candidates.clear();
    for [i, j] in pairs {
        stage.candidates.push(i, j);
    }
}

/// d²/s² of a pair's inflated spheres: 0 when concentric, 1 when touching.
fn gap(spheres: &[[f32; 4]], pair: [u32; 2]) -> f32 {
    let [a, b] = pair.map(|place| spheres[place as usize]);
    let (dx, dy, dz, s) = (a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] + b[3]);
    (dx * dx + dy * dy + dz * dz) / (s * s)
}

impl Memory {
    /// The frames since each pair of the last potentially colliding set was refined, given the current frame's stamp.
    pub(crate) fn ages(&self, stamp: u32) -> impl Iterator<Item = u32> + '_ {
        self.refined.values().map(move |&last| stamp - last)
    }

    fn remember(&mut self, pairs: impl Iterator<Item = [u32; 2]>, done: usize, stamp: u32) {
        let last = std::mem::take(&mut self.refined);
        self.refined = pairs
            .enumerate()
            .map(|(at, pair)| {
                let before = last.get(&pair).copied().unwrap_or(0);
                (pair, if at < done { stamp } else { before })
            })
            .collect();
    }
}
