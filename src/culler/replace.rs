//! Another set of bodies, and other places for the same ones.

use super::needs;
use super::sample::Sample;
use super::{Culler, check};
use crate::bodies::Bodies;
use crate::broad_phase::{Balls, PairFinder, Reorder};
use crate::settings::Flow;
use crate::simd::in_default_mode;
use crate::update::OrDopRows;

impl Culler {
    /// Re-reads `bodies.shape` after a change of margin class.
    pub(crate) fn reread_shapes(&mut self, bodies: &Bodies) {
        self.set.fixed.shape.clone_from(&bodies.shape);
        self.set.places.reread_shapes(bodies);
    }

    /// Takes up another set of bodies, those that are `present`, as far as it is new: what is known
    /// of the others' neighbours is kept. Volumes of static bodies are placed anew.
    pub(crate) fn exchange(&mut self, bodies: &Bodies, present: &[bool]) {
        in_default_mode(|| {
            let stays = self.take_places(bodies, present);
            let population = needs::population(self.setup.scheme, &self.models, &self.set.places);
            let finder = self.setup.settings.pairs;
            if (self.set.finder).replace(finder, &population, &stays, self.set.places.moving) {
                self.place_static(bodies); // the others in the frame to come
            } else {
                self.begin(bodies);
            }
        });
    }

    /// Replaces the set of bodies by those that are `present`, of which nothing is known.
    #[doc(hidden)]
    pub fn replace(&mut self, bodies: &Bodies, present: &[bool]) {
        self.take_places(bodies, present);
        let population = needs::population(self.setup.scheme, &self.models, &self.set.places);
        self.set.finder = PairFinder::new(self.setup.settings.pairs, &population);
        self.begin(bodies);
    }

    /// Forgets all bodies, and gives back the memory of them and of models that are gone. What was
    /// answered of pairs stays. The next [`Self::exchange`] begins anew.
    pub(crate) fn forget(&mut self) {
        let hulls = self.models.shrink_to_fit();
        if let Some(intervals) = &mut self.volumes.intervals {
            intervals.shrink_to(hulls);
            intervals.forget_bodies();
        }
        self.scratch.forget_lists();
        self.sample = Sample::default();
        self.pairs.shrink_to_fit();
        self.set.groups = None;
        (self.set.places, self.set.fixed, self.set.order) = Default::default();
        (self.volumes.interest, self.volumes.interval_slots) = Default::default();
        (self.volumes.balls, self.volumes.rows) = (Balls::new(0), OrDopRows::default());
        self.replace(&Bodies::default(), &[]);
    }

    /// Gives places to the bodies that are `present`; whether each former place's body keeps its
    /// order.
    fn take_places(&mut self, bodies: &Bodies, present: &[bool]) -> Vec<bool> {
        let stays = self.set.places.replace(&bodies.dynamic, present);
        self.set.places.reread_shapes(bodies);
        self.set.fixed = check::fixed(bodies);
        let n = self.set.places.len();
        self.set.numbers = (0..n as u32).collect();
        self.volumes.balls.resize(n);
        self.volumes.rows.resize(n);
        if let Some(intervals) = &mut self.volumes.intervals {
            intervals.resize(n);
        }
        self.volumes.interest.resize(bodies.len(), false);
        stays
    }

    /// Places all volumes but the rows of bodies that move, which each frame makes anew, and lets a
    /// new finder order and arrange them.
    pub(super) fn begin(&mut self, bodies: &Bodies) {
        let (moving, all) = (self.set.places.moving, self.set.places.len());
        self.update_first(bodies, 0..all);
        self.update_rows(bodies, moving..all);
        self.reorder(bodies);
        self.arrange();
    }

    /// Places all volumes of bodies that don't move.
    fn place_static(&mut self, bodies: &Bodies) {
        let at_rest = self.set.places.moving..self.set.places.len();
        self.update_first(bodies, at_rest.clone());
        self.update_rows(bodies, at_rest);
    }

    /// Lets the finder put bodies in other places. What has moved is updated anyway, unless it is
    /// static.
    pub(super) fn reorder(&mut self, bodies: &Bodies) {
        if self.setup.scheme.flow == Flow::Nothing {
            // Nothing is arranged, so there is no order to follow.
            return;
        }
        let by_place = self.needs.by_place;
        let names = self.needs.names(&self.set.numbers, &self.set.places);
        let (balls, order) = (&self.volumes.balls, &mut self.set.order);
        let changed = self
            .set
            .finder
            .reorder(&self.set.places, balls, names, order);
        if changed == Reorder::None {
            return;
        }
        self.set
            .places
            .reorder(&self.set.fixed, &mut self.set.order, by_place);
        if changed == Reorder::All {
            let (moving, all) = (self.set.places.moving, self.set.places.len());
            self.update_first(bodies, 0..moving);
            if moving < all {
                let fixed = std::mem::take(&mut self.set.fixed);
                self.place_static(&fixed);
                self.set.fixed = fixed;
            }
        }
    }
}
