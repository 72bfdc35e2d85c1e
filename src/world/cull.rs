//! A cull of a world, its pairs and its events.

use super::{BodyId, Events, World, WorldError, WorldPairs};
use crate::bodies::{Bodies, Groups};
use crate::culler::{CullError, Culler};
use crate::simd::in_default_mode;

impl World {
    /// Finds the pairs that might touch now, and returns them: the lower slot first, sorted by
    /// slots. Under every strategy, list and order are a function of the present bodies and their
    /// slots, whose order is that of a pair's first and second body (with
    /// [`Order::OldestAnswer`](crate::Order), also of when pairs were refined, and with a budget of
    /// time, of the clock), independent of the finder, of threads and of earlier calls. That holds
    /// for translations that f32 has to round, too: the origins about which they are rounded follow
    /// from the present bodies.
    ///
    /// # Errors
    /// Bodies can't be placed within 2⁶⁰ of an origin, which happens only if meshes are far from
    /// their own origins: [`Self::pairs`] are still those of the cull before. There are more pairs
    /// than memory holds: then there are none.
    pub fn cull(&mut self) -> Result<WorldPairs<'_>, WorldError> {
        if !self.cull_changed(usize::MAX) {
            self.cull_all(|culler, bodies| culler.cull(bodies).map(|_| ()))?;
        }
        Ok(self.log.pairs(&self.ids))
    }

    /// Finds all pairs anew by a function of the culler, which leaves them in its list.
    pub(super) fn cull_all(
        &mut self,
        cull: impl FnOnce(&mut Culler, &Bodies) -> Result<(), CullError>,
    ) -> Result<(), WorldError> {
        self.prepare()?;
        let mut list = self.log.take(&self.ids);
        self.culler.swap_pairs(&mut list);
        let outcome = cull(&mut self.culler, &self.bodies);
        self.culler.swap_pairs(&mut list);
        self.log.put(list, &self.ids);
        outcome?;
        self.movers.all_found();
        if self.movers.expect_few(&self.ids) {
            self.warm_up();
        }
        Ok(())
    }

    /// Brings the culler up to date with the bodies, to find all pairs anew. Until
    /// [`Movers::all_found`], the next cull does so too.
    pub(super) fn prepare(&mut self) -> Result<(), WorldError> {
        self.movers.lose_pairs();
        in_default_mode(|| self.place())?;
        self.sweep_margins(true);
        if std::mem::take(&mut self.replaced) {
            self.culler.exchange(&self.bodies, &self.ids.colliding(&self.groups));
            if !self.interest.is_empty() {
                self.look(); // another body may have taken the slot of one that was of interest
            }
        } else if self.remodelled {
            self.culler.reread_shapes(&self.bodies);
        }
        self.remodelled = false;
        if self.regrouped {
            let all = self.groups.iter().all(|&groups| groups == Groups::ALL);
            self.culler.set_groups((!all).then(|| self.groups.clone()))?;
            self.regrouped = false;
        }
        self.ids.settle();
        Ok(())
    }

    /// Whether [`Self::pairs`] are those of the bodies as they are now.
    pub(crate) fn has_present_pairs(&self) -> bool {
        self.movers.has_present_pairs()
    }

    /// The pairs of the last cull, the lower slot first, sorted by slots.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [BodyId; 2]> + '_ {
        self.log.pairs(&self.ids).iter()
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull. Events don't borrow the world, so bodies may be removed while they are read. Drop them
    /// before the next cull, which otherwise copies the pairs.
    pub fn events(&mut self) -> Events {
        self.log.events(&self.ids)
    }
}
