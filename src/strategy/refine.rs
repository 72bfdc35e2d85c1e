//! The or-DOP test of listed pairs.

use std::ops::Range;
use std::time::Instant;

use super::Stage;
use super::workers::{Worker, share};
use crate::counters::VolumeCounters;
use crate::overlap::ordop::OrDopColumns;
use crate::pairs::PairList;
use crate::simd::{MAX_WIDTH, Tier};
use crate::update::Posed;

/// The or-DOP test with made rows: takes pairs of places, leaves pairs of bodies.
#[derive(Clone, Copy)]
pub(super) struct Refine<'a> {
    pub tier: Tier,
    pub columns: OrDopColumns<'a>,
    /// The body in each place.
    pub body: &'a [u32],
}

impl Refine<'_> {
    /// Tests pairs and appends the survivors to `out`, in list order. A block a call: the dispatch is paid once for all.
    pub fn test(
        &self,
        [first, second]: [&[u32]; 2],
        counters: &mut VolumeCounters,
        seconds: &mut f64,
        out: &mut PairList,
    ) {
        let start = Instant::now();
        let listed = out.len();
        let tested = self.columns.test_pairs(self.tier, first, second, out);
        out.rename(listed, self.body);
        counters.tests += tested.tests;
        counters.hits += tested.hits;
        *seconds += start.elapsed().as_secs_f64();
    }
}

impl<'a> Stage<'a> {
    /// The test with the rows as they are.
    pub(super) fn refine(&self) -> Refine<'_> {
        Refine {
            tier: self.tier,
            columns: OrDopColumns {
                rows: &self.rows.rows,
                tables: self.tables,
                overlap: self.overlap,
            },
            body: &self.places.body,
        }
    }

    /// With lazy updates: makes the rows of a range of the listed pairs that this frame lacks. Returns their number.
    pub(super) fn make_rows(&mut self, list: &PairList, range: Range<usize>) -> u64 {
        if !self.lazy {
            return 0;
        }
        let begin = Instant::now();
        let mut made = 0;
        for column in [list.first(), list.second()] {
            let wanted = &column[range.clone()];
            let posed = Posed {
                frames: self.frames,
                bodies: self.bodies,
                places: self.places,
                balls: self.spheres,
            };
            made += self
                .rows
                .update_missing(self.tier, posed, wanted, self.stamp);
        }
        self.seconds.update += begin.elapsed().as_secs_f64();
        made
    }

    /// Tests all pairs of a list, on all threads, and appends the survivors to `out`.
    pub(super) fn refine_list(&mut self, list: &PairList, out: &mut PairList) -> VolumeCounters {
        let updates = self.make_rows(list, 0..list.len());
        let vectors = list.len().div_ceil(MAX_WIDTH);
        let mut workers = std::mem::take(self.workers);
        let refine = self.refine();
        let done = share(self.pool, &mut workers, vectors, out, |range, worker| {
            let pairs = range.start * MAX_WIDTH..(range.end * MAX_WIDTH).min(list.len());
            let pairs = [&list.first()[pairs.clone()], &list.second()[pairs]];
            let Worker {
                out,
                refined,
                refining,
                ..
            } = worker;
            refine.test(pairs, refined, refining, out);
        });
        *self.workers = workers;
        self.seconds.ordop += done.refining;
        VolumeCounters {
            updates,
            ..done.refined
        }
    }
}
