//! Changes a culler's set of bodies, and reorders the bodies.

use super::needs;
use super::sample::Sample;
use super::{Culler, check};
use crate::bodies::Bodies;
use crate::broad_phase::{Balls, PairFinder, Reorder};
use crate::settings::Flow;
use crate::simd::in_default_mode;
use crate::update::OrDopRows;

impl Culler {
    /// Reads `bodies.shape` again after a change of margin class.
    pub(crate) fn reread_shapes(&mut self, bodies: &Bodies) {
        self.set.fixed.shape.clone_from(&bodies.shape);
        self.set.places.reread_shapes(bodies);
    }

    /// Changes the set of bodies to those that are `present`, and keeps what is known of the
    /// neighbours of bodies that stay. Volumes of static bodies are computed again.
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

    /// Replaces the set of bodies by those that are `present`, without using any knowledge of
    /// earlier frames. From then on, the caller has to do so when static bodies change.
    #[doc(hidden)]
    pub fn replace(&mut self, bodies: &Bodies, present: &[bool]) {
        self.take_places(bodies, present);
        let population = needs::population(self.setup.scheme, &self.models, &self.set.places);
        self.set.finder = PairFinder::new(self.setup.settings.pairs, &population);
        self.set.watched.clear();
        self.begin(bodies);
    }

    /// Drops all bodies and frees their memory and that of removed models. The refinement history
    /// stays. The next [`Self::exchange`] starts from nothing.
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

    /// Assigns places to the bodies that are `present`. Returns, for each former place, whether its
    /// body kept its order.
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

    /// Computes all volumes except the rows of moving bodies, which each frame computes, and lets a
    /// new finder order and arrange them.
    pub(super) fn begin(&mut self, bodies: &Bodies) {
        let (moving, all) = (self.set.places.moving, self.set.places.len());
        self.update_first(bodies, 0..all);
        self.update_rows(bodies, moving..all);
        self.reorder(bodies);
        self.arrange();
    }

    /// Computes all volumes of static bodies.
    fn place_static(&mut self, bodies: &Bodies) {
        let at_rest = self.set.places.moving..self.set.places.len();
        self.update_first(bodies, at_rest.clone());
        self.update_rows(bodies, at_rest);
    }

    /// Lets the finder reorder places. Moving bodies are updated afterwards anyway; static ones are
    /// moved here.
    pub(super) fn reorder(&mut self, bodies: &Bodies) {
        if self.setup.scheme.flow == Flow::Nothing {
            // Nothing is arranged yet, so there is no order to follow.
            return;
        }
        let by_place = self.needs.by_place;
        let names = self.needs.names(&self.set.numbers, &self.set.places);
        let (balls, order) = (&self.volumes.balls, &mut self.set.order);
        let changed = self.set.finder.reorder(&self.set.places, balls, names, order);
        if changed == Reorder::None {
            return;
        }
        self.set.places.reorder(&self.set.fixed, &mut self.set.order, by_place);
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
