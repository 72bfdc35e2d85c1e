//! S-DOP in batches (paper, section 4b): the potentially colliding set is listed first, then its
//! or-DOPs are tested.
//!
//! Lazy updates need the pairs before rows are computed, so with lazy updates every refining
//! strategy uses this flow. If the output is in portions, so is the list.

use super::first_test::list;
use super::interest::InterestFilter;
use super::refine::Refiner;
use super::{Inputs, Scratch, Tasks};
use crate::listing::{Output, PairNames, Totals};
use crate::pairs::PairList;
use crate::update::OrDopRows;

/// Lists the candidates that pass the first test, then refines them; with `interest`, only those
/// that have a body of interest.
pub(super) fn flow(
    inputs: Inputs<'_>,
    rows: &mut OrDopRows,
    scratch: &mut Scratch,
    interest: Option<&[bool]>,
    output: Output<'_>,
) -> Totals {
    let Scratch { tasks, candidates, selected, survivors, portion, .. } = scratch;
    let mut batch = Batch {
        refiner: Refiner::new(inputs, rows),
        body: inputs.bodies_by_place(),
        interest,
        selected,
        survivors,
    };
    let listed = match output {
        Output::List(out) => {
            let listed = list(inputs, PairNames::Places, tasks, Output::List(candidates));
            batch.refine(candidates, Some(tasks), out);
            listed
        }
        Output::Portions(sink) => {
            let mut take = |candidates: &mut PairList| {
                portion.clear();
                batch.refine(candidates, None, portion);
                sink(portion);
            };
            list(inputs, PairNames::Places, tasks, Output::Portions(&mut take))
        }
    };
    Totals { first: listed.first, ..batch.refiner.totals }
}

/// Refines listed candidates.
struct Batch<'a> {
    refiner: Refiner<'a>,
    /// The body in each place.
    body: &'a [u32],
    interest: Option<&'a [bool]>,
    selected: &'a mut PairList,
    survivors: &'a mut PairList,
}

impl Batch<'_> {
    /// Appends the reported pairs among `candidates` to `out`, in their order; on all threads if
    /// `tasks` are given.
    fn refine(&mut self, candidates: &PairList, tasks: Option<&mut Tasks>, out: &mut PairList) {
        let Some(interest) = self.interest else {
            return self.refiner.refine(candidates, tasks, out);
        };
        let filter = InterestFilter { pairs: candidates, body: self.body, interest };
        filter.select(self.selected);
        self.survivors.clear();
        self.refiner.refine(self.selected, tasks, self.survivors);
        filter.merge(self.survivors, out);
    }
}
