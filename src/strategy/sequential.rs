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
        first,
        refined,
        refining,
    } = worker;
    let mut drain = |block: &mut PairList| {
        first.hits += block.len() as u64;
        let pairs = match interest {
            None => &*block,
            Some(interest) => {
                select(block, refine.body, interest, selected, out);
                &*selected
            }
        };
        refine.test([pairs.first(), pairs.second()], refined, refining, out);
        block.clear();
    };
    let tests = source.drained(parts, block, BLOCK, &mut drain);
    drain(block);
    first.tests += tests;
}

/// Splits pairs of places: those with a body of interest to `selected`, the rest as bodies to `out`.
fn select(
    pairs: &PairList,
    body: &[u32],
    interest: &[bool],
    selected: &mut PairList,
    out: &mut PairList,
) {
    selected.clear();
    for [i, j] in pairs.iter() {
        let [a, b] = [i, j].map(|place| body[place as usize]);
        if interest[a as usize] || interest[b as usize] {
            selected.push(i, j);
        } else {
            out.push(a, b);
        }
    }
}

/// The same from a list of all candidates.
fn flow_by_list(stage: &mut Stage<'_>, first: First<'_>, interest: Option<&[bool]>) -> Done {
    let mut done = stage.list_candidates(first);
    if let Some(interest) = interest {
        let mut selected = PairList::default();
        let body = &stage.places.body;
        select(stage.candidates, body, interest, &mut selected, stage.out);
        *stage.candidates = selected;
    }
    done.refined = stage.refine_candidates();
    done
}
