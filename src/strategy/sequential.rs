//! S-DOP, sequential (paper, section 4a): a pair whose spheres overlap goes to the or-DOP test at once.
//!
//! "At once" means a block of some [`BLOCK`] pairs here, since one pair can't fill a vector; no list of the potentially
//! colliding set is kept, except with lazy updates, which need it whole. The same flow serves the object of interest, where
//! some pairs of the block are not refined, and oriented volumes without a sphere stage.

use super::listing::{First, Source};
use super::refine::Refine;
use super::workers::{Done, Worker, add, share};
use super::{BLOCK, Stage};
use crate::pairs::PairList;

pub(super) fn cull(stage: &mut Stage<'_>) {
    let done = flow(stage, First::Sphere, None);
    add(&mut stage.counters.sphere, done.first);
    add(&mut stage.counters.ordop, done.refined);
}

/// Candidates that pass `first`, then or-DOPs block by block; with `interest`, only for pairs that have a body of interest.
pub(super) fn flow(stage: &mut Stage<'_>, first: First<'_>, interest: Option<&[bool]>) -> Done {
    if stage.lazy {
        return flow_by_list(stage, first, interest);
    }
    let mut out = std::mem::take(stage.out);
    let mut workers = std::mem::take(stage.workers);
    let (source, refine) = (stage.source(first), stage.refine());
    let parts = stage.finder.parts();
    let done = share(
        stage.crew,
        &mut workers,
        parts,
        &mut out,
        |parts, worker| {
            work(&source, parts, &refine, interest, worker);
        },
    );
    (*stage.out, *stage.workers) = (out, workers);
    stage.seconds.ordop += done.refining;
    done
}

/// One worker's share: its list is drained whenever a block is full.
fn work(
    source: &Source<'_>,
    parts: std::ops::Range<usize>,
    refine: &Refine<'_>,
    interest: Option<&[bool]>,
    worker: &mut Worker,
) {
    let Worker {
        out,
        block,
        selected,
        passed,
        first,
        refined,
        refining,
    } = worker;
    let mut drain = |block: &mut PairList| {
        first.hits += block.len() as u64;
        match interest {
            None => refine.test([block.first(), block.second()], refined, refining, out),
            Some(interest) => {
                let chosen = Chosen {
                    pairs: block,
                    body: refine.body,
                    interest,
                };
                chosen.select(selected);
                passed.clear();
                let pairs = [selected.first(), selected.second()];
                refine.test(pairs, refined, refining, passed);
                chosen.merge(passed, out);
            }
        }
        block.clear();
    };
    let tests = source.drained(parts, block, BLOCK, &mut drain);
    drain(block);
    first.tests += tests;
}

/// Pairs of places, some of which have a body of interest.
struct Chosen<'a> {
    pairs: &'a PairList,
    /// The body in each place.
    body: &'a [u32],
    interest: &'a [bool],
}

impl Chosen<'_> {
    /// Every pair with its bodies, and whether one of them is of interest.
    fn judged(&self) -> impl Iterator<Item = ([u32; 2], [u32; 2], bool)> {
        self.pairs.iter().map(|places| {
            let bodies = places.map(|place| self.body[place as usize]);
            let chosen = bodies.iter().any(|&body| self.interest[body as usize]);
            (places, bodies, chosen)
        })
    }

    /// Lists the pairs that are to be refined.
    fn select(&self, selected: &mut PairList) {
        selected.clear();
        for ([i, j], _, chosen) in self.judged() {
            if chosen {
                selected.push(i, j);
            }
        }
    }

    /// Appends, as bodies, the pairs that weren't to be refined and those that `passed`, in their common order: a list
    /// must not show where blocks, and so threads, begin.
    fn merge(&self, passed: &PairList, out: &mut PairList) {
        let mut passed = passed.iter().peekable();
        for (_, [a, b], chosen) in self.judged() {
            if !chosen || passed.next_if_eq(&[a, b]).is_some() {
                out.push(a, b);
            }
        }
    }
}

/// The same from a list of all candidates.
fn flow_by_list(stage: &mut Stage<'_>, first: First<'_>, interest: Option<&[bool]>) -> Done {
    let mut done = stage.list_candidates(first);
    let Some(interest) = interest else {
        done.refined = stage.refine_candidates();
        return done;
    };
    let mut selected = PairList::default();
    Chosen {
        pairs: stage.candidates,
        body: &stage.places.body,
        interest,
    }
    .select(&mut selected);
    let listed = std::mem::replace(stage.candidates, selected);
    done.refined = stage.refine_candidates();
    let passed = std::mem::take(stage.out);
    Chosen {
        pairs: &listed,
        body: &stage.places.body,
        interest,
    }
    .merge(&passed, stage.out);
    *stage.candidates = listed;
    done
}
