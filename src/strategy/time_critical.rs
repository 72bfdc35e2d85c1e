//! S-DOP under a budget (the paper's third phase; Hubbard 1996): the potentially colliding set is refined in a chosen order
//! until the budget ends, and what isn't refined counts as colliding (Dingliana & O'Sullivan 2000).
//!
//! A budget of tests gives the same pairs everywhere; a budget of time is looked at after every [`SLICE`] tests.

use std::collections::HashMap;
use std::ops::Range;
use std::time::{Duration, Instant};

use super::Stage;
use super::listing::First;
use super::workers::Done;
use crate::counters::VolumeCounters;
use crate::pairs::PairList;
use crate::settings::{Budget, Order};

/// Tests between two looks at the clock: some microseconds.
const SLICE: usize = 128;

/// What a frame leaves to the next: when pairs were refined, and buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// For each pair that spheres reported in the last frame, the frame in which it was last refined (0: never).
    refined: HashMap<[u32; 2], u32>,
    before: HashMap<[u32; 2], u32>,
    keyed: Vec<Keyed>,
}

/// A pair's rank, its bodies, its places: sorted, ties go by body, so the order is the same for every pair finder.
type Keyed = (u32, [u32; 2], [u32; 2]);

pub(super) fn cull(stage: &mut Stage<'_>) -> Done {
    let start = Instant::now();
    let mut done = stage.list_candidates(First::Sphere);
    arrange(stage);
    let (tests, deadline) = match stage.budget {
        Some(Budget::Tests(tests)) => (usize::try_from(tests).unwrap_or(usize::MAX), None),
        Some(Budget::Microseconds(us)) => (usize::MAX, Some(Duration::from_micros(us))),
        None => (usize::MAX, None),
    };
    let candidates = std::mem::take(stage.candidates);
    let limit = tests.min(candidates.len());
    let slice = if deadline.is_some() { SLICE } else { limit };
    let mut refined = 0;
    while refined < limit && deadline.is_none_or(|deadline| start.elapsed() < deadline) {
        let end = limit.min(refined + slice);
        refine(stage, &candidates, refined..end, &mut done.refined);
        refined = end;
    }
    let body = |place: u32| stage.places.body[place as usize];
    stage.counters.untested += (candidates.len() - refined) as u64;
    for [i, j] in candidates.iter().skip(refined) {
        stage.out.push(body(i), body(j));
    }
    if stage.order == Order::OldestAnswer {
        let pairs = candidates.iter().map(|pair| pair.map(body));
        stage.memory.remember(pairs, refined, stage.stamp);
    }
    *stage.candidates = candidates;
    done
}

/// Refines a range of the candidates.
fn refine(
    stage: &mut Stage<'_>,
    candidates: &PairList,
    range: Range<usize>,
    counters: &mut VolumeCounters,
) {
    counters.updates += stage.make_rows(candidates, range.clone());
    let pairs = [
        &candidates.first()[range.clone()],
        &candidates.second()[range],
    ];
    let (mut out, mut seconds) = (std::mem::take(stage.out), 0.0);
    stage.refine().test(pairs, counters, &mut seconds, &mut out);
    *stage.out = out;
    stage.seconds.ordop += seconds;
}

/// Sorts the potentially colliding set into the order of refinement.
fn arrange(stage: &mut Stage<'_>) {
    if stage.order == Order::AsFound {
        return;
    }
    let Memory { refined, keyed, .. } = &mut *stage.memory;
    let dull = |&body: &u32| !stage.interest[body as usize];
    let rank = |bodies: [u32; 2], places: [u32; 2]| match stage.order {
        Order::AsFound => 0,
        Order::InterestFirst => u32::from(bodies.iter().all(dull)),
        // Of numbers that aren't negative, the bits sort as the values do.
        Order::LargestOverlap => gap(stage.spheres, places).to_bits(),
        Order::OldestAnswer => refined.get(&bodies).copied().unwrap_or(0),
    };
    keyed.clear();
    keyed.extend(stage.candidates.iter().map(|places| {
        let bodies = places.map(|place| stage.places.body[place as usize]);
        (rank(bodies, places), bodies, places)
    }));
    keyed.sort_unstable();
    stage.candidates.clear();
    for &(_, _, [i, j]) in &*keyed {
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
    fn remember(&mut self, pairs: impl Iterator<Item = [u32; 2]>, done: usize, stamp: u32) {
        std::mem::swap(&mut self.refined, &mut self.before);
        self.refined.clear();
        self.refined.extend(pairs.enumerate().map(|(at, pair)| {
            let before = self.before.get(&pair).copied().unwrap_or(0);
            (pair, if at < done { stamp } else { before })
        }));
    }
}
