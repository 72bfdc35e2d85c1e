//! S-DOP, sequential (paper, section 4a): a pair whose spheres overlap goes to the or-DOP test at once.
//!
//! "At once" means a block of some [`BLOCK`] pairs here, since one pair can't fill a vector; no list of the potentially
//! colliding set is kept. The same flow serves the object of interest (section 4c), where some pairs of the block are not
//! refined, and oriented volumes without a sphere stage.

use std::ops::Range;

use super::interest::Chosen;
use super::listing::{First, Source};
use super::refine::Refine;
use super::workers::{Done, Worker, share};
use super::{BLOCK, Stage, batch};
use crate::pairs::PairList;

/// Candidates that pass `first`, then or-DOPs block by block; with `interest`, only for pairs that have a body of interest.
pub(super) fn flow(stage: &mut Stage<'_>, first: First<'_>, interest: Option<&[bool]>) -> Done {
    if stage.lazy {
        return batch::flow(stage, first, interest);
    }
    let mut out = std::mem::take(stage.out);
    let mut workers = std::mem::take(stage.workers);
    let (source, refine) = (stage.source(first), stage.refine());
    let parts = stage.finder.parts();
    let done = share(
        stage.pool,
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
    parts: Range<usize>,
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
