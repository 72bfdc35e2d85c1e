//! S-DOP, sequential (paper, section 4a): a pair whose spheres overlap goes to the or-DOP test at
//! once.
//!
//! "At once" means in blocks of about [`PAIRS_PER_BLOCK`] pairs, because one pair can't fill a
//! vector. No list of the potentially colliding set is kept. The same flow serves objects of
//! interest (section 4c), where some pairs of a block are not refined, and oriented volumes without
//! a sphere stage.

use std::ops::Range;

use super::first_test::{self, FirstVolumeTest};
use super::interest::InterestFilter;
use super::refine::Refine;
use super::{Inputs, Scratch, Task};
use crate::listing::{Listing, Output, PairNames, TaskOutput, Totals, split_work};
use crate::pairs::PairList;
use crate::update::OrDopRows;

/// Pairs per block if no list is kept: few enough for the first-level cache, and enough to make the
/// clock's cost negligible.
const PAIRS_PER_BLOCK: usize = 256;

/// Refines the candidates that pass the first test block by block; with `interest`, only pairs that
/// have a body of interest.
pub(super) fn flow(
    inputs: Inputs<'_>,
    rows: &OrDopRows,
    scratch: &mut Scratch,
    interest: Option<&[bool]>,
    output: Output<'_>,
) -> Totals {
    let listing = first_test::listing(inputs, PairNames::Places);
    let refine = Refine::new(inputs, rows);
    let work = |parts: Range<usize>, task: &mut Task, outlet: &TaskOutput<'_, '_>| {
        refine_blocks(&listing, parts, &refine, interest, task, outlet);
    };
    let units = inputs.arranged.finder.parts();
    split_work(inputs.executor.pool, &mut scratch.tasks, units, output, work)
}

/// Runs one task: candidates are refined whenever they fill a block.
fn refine_blocks(
    listing: &Listing<'_, FirstVolumeTest<'_>>,
    parts: Range<usize>,
    refine: &Refine<'_>,
    interest: Option<&[bool]>,
    task: &mut Task,
    outlet: &TaskOutput<'_, '_>,
) {
    let Task { out, block, selected, survivors, first, refining, seconds, .. } = task;
    let mut flush = |block: &mut PairList| {
        match interest {
            None => refine.test([block.first(), block.second()], refining, seconds, out),
            Some(interest) => {
                let filter = InterestFilter { pairs: block, body: refine.body, interest };
                filter.select(selected);
                survivors.clear();
                let pairs = [selected.first(), selected.second()];
                refine.test(pairs, refining, seconds, survivors);
                filter.merge(survivors, out);
            }
        }
        block.clear();
        outlet.offer(out);
    };
    *first = listing.run(parts, block, PAIRS_PER_BLOCK, &mut flush);
    flush(block);
}
