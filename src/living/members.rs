//! What a set knows of its bodies apart from their volumes.

use super::live_pairs::LivePairs;
use super::movers::Movers;
use super::{BodyId, Groups, Ids, Motion, WorldError, renumber_column, renumbered_pairs};
use crate::bodies::{ExcludedPairs, PairFilter, PairRules};
use crate::broad_phase::IndexedBox;
use crate::pairs::FoundPartners;

/// The bodies of a set by row: who they are, which of them may be pairs, which have changed, and
/// which pairs were reported.
#[derive(Clone, Debug, Default)]
pub struct Members {
    pub(crate) ids: Ids,
    pub(crate) resting: Vec<bool>,
    pub(crate) groups: Vec<Groups>,
    /// Number of rows whose groups don't collide with all.
    pub(super) grouped: usize,
    pub(crate) excluded: ExcludedPairs,
    pub(crate) pairs: LivePairs,
    pub(crate) movers: Movers,
    /// Whether the set of bodies, or a fixed body, differs from that in the volumes' finder.
    pub(crate) replaced: bool,
}

impl Members {
    /// Gives the next row to a body. Returns whether the row is new.
    pub(super) fn take(&mut self) -> bool {
        let is_new = self.ids.take();
        if is_new {
            self.resting.push(false);
            self.groups.push(Groups::ALL);
        }
        is_new
    }

    #[inline]
    pub(super) fn put(&mut self, row: usize, motion: Motion, groups: Groups) {
        self.resting[row] = motion == Motion::Resting;
        let former = std::mem::replace(&mut self.groups[row], groups);
        self.replaced |= former.collide_with_none() != groups.collide_with_none();
        self.grouped += usize::from(groups != Groups::ALL);
        self.grouped -= usize::from(former != Groups::ALL);
    }

    /// Notes that a body has changed, and whether the finder must be given the set anew.
    #[inline]
    pub(crate) fn note(&mut self, row: usize, is_replaced: bool) {
        self.replaced |= is_replaced;
        self.movers.note(row, &self.ids);
    }

    pub(super) fn set_excluded(
        &mut self,
        pair: [BodyId; 2],
        is_excluded: bool,
    ) -> Result<bool, WorldError> {
        let [a, b] = [self.ids.slot(pair[0])?, self.ids.slot(pair[1])?];
        let is_changed = match is_excluded {
            true => a != b && self.excluded.insert(a as u32, b as u32),
            false => self.excluded.remove(a as u32, b as u32),
        };
        if is_changed {
            self.note(a, false); // its partners are found anew, and so the pair is lost or comes
        }
        Ok(is_changed)
    }

    /// Changes the rows. Returns their plan, as [`Ids::compact`] and [`Ids::add_rows`] do.
    pub(super) fn renumber(&mut self, change: fn(&mut Ids) -> Vec<u32>) -> Vec<u32> {
        self.pairs.outlive_rows(&self.ids);
        let plan = change(&mut self.ids);
        renumber_column(&mut self.resting, &plan, false);
        renumber_column(&mut self.groups, &plan, Groups::ALL);
        let excluded = self.excluded.sorted().into_iter().map(|pair| (pair, ()));
        let excluded = renumbered_pairs(excluded, &plan).into_iter().map(|(pair, ())| pair);
        self.excluded = excluded.collect();
        self.count_groups();
        self.movers.forget();
        self.replaced = true;
        plan
    }

    /// Counts the bodies that don't collide with all, after the column has been replaced.
    pub(super) fn count_groups(&mut self) {
        let groups = self.groups.iter();
        self.grouped = groups.filter(|groups| **groups != Groups::ALL).count();
    }

    /// Which pairs pass if their volumes meet, where not all do.
    pub(crate) fn filter(&self) -> Option<PairFilter<'_>> {
        let groups = (self.grouped > 0).then_some(&*self.groups);
        PairFilter::new(groups, &self.excluded)
    }

    /// The partners of these bodies, of which `indexed` returns the boxes: see [`Movers::find`].
    pub(crate) fn find(
        &mut self,
        found: &mut FoundPartners,
        most: usize,
        mut indexed: impl FnMut(u32, &Ids, &[Groups]) -> IndexedBox,
    ) -> Option<usize> {
        let Self { ids, groups, excluded, movers, .. } = self;
        movers.list(found.bodies.iter().map(|&row| indexed(row, ids, groups)));
        movers.find(found, PairRules { groups, excluded }, most)
    }
}
