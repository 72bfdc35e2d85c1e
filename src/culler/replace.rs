//! Changing a culler's set of bodies, and reordering them.

use super::needs;
use super::{Culler, check};
use crate::bodies::Bodies;
use crate::broad_phase::{Balls, PairFinder, Reorder};
use crate::settings::Flow;
use crate::simd::in_default_mode;
use crate::update::OrDopRows;

impl Culler {
    /// Reads `bodies.shape` again after a change of margin class.
    pub(crate) fn reread_shapes(&mut self, bodies: &Bodies) {
        self.fixed.shape.clone_from(&bodies.shape);
        self.places.reread_shapes(bodies);
    }

    /// Changes the set of bodies to those that are `present`, and keeps what is known of the
    /// neighbours of bodies that stay. Volumes of static bodies are computed again.
    pub(crate) fn exchange(&mut self, bodies: &Bodies, present: &[bool]) {
        in_default_mode(|| {
            let stays = self.take_places(bodies, present);
            let population = needs::population(self.scheme, &self.models, &self.places);
            let finder = self.settings.pairs;
            if (self.finder).replace(finder, &population, &stays, self.places.moving) {
                self.place_static(bodies); // the others in the frame to come
            } else {
                self.begin(bodies);
            }
        });
    }

    /// Replaces the set of bodies by those that are `present`, without using any knowledge of
    /// earlier frames.
    #[doc(hidden)]
    pub fn replace(&mut self, bodies: &Bodies, present: &[bool]) {
        self.take_places(bodies, present);
        let population = needs::population(self.scheme, &self.models, &self.places);
        self.finder = PairFinder::new(self.settings.pairs, &population);
        self.begin(bodies);
    }

    /// Drops all bodies and frees their memory and that of removed models. The refinement history
    /// stays. The next [`Self::exchange`] starts from nothing.
    pub(crate) fn forget(&mut self) {
        let hulls = self.models.shrink_to_fit();
        if let Some(intervals) = &mut self.intervals {
            intervals.shrink_to(hulls);
            intervals.forget_bodies();
        }
        self.scratch.forget_lists();
        self.pairs.shrink_to_fit();
        self.groups = None;
        (self.places, self.fixed, self.order) = Default::default();
        (self.interest, self.interval_slots) = Default::default();
        (self.balls, self.rows) = (Balls::new(0), OrDopRows::default());
        self.replace(&Bodies::default(), &[]);
    }

    /// Assigns places to the bodies that are `present`. Returns, for each former place, whether its
    /// body kept its order.
    fn take_places(&mut self, bodies: &Bodies, present: &[bool]) -> Vec<bool> {
        let stays = self.places.replace(&bodies.dynamic, present);
        self.places.reread_shapes(bodies);
        self.fixed = check::fixed(bodies);
        let n = self.places.len();
        self.numbers = (0..n as u32).collect();
        self.balls.resize(n);
        self.rows.resize(n);
        if let Some(intervals) = &mut self.intervals {
            intervals.resize(n);
        }
        self.interest.resize(bodies.len(), false);
        stays
    }

    /// Computes all volumes except the rows of moving bodies, which each frame computes, and lets a
    /// new finder order and arrange them.
    pub(super) fn begin(&mut self, bodies: &Bodies) {
        let (moving, all) = (self.places.moving, self.places.len());
        self.update_first(bodies, 0..all);
        self.update_rows(bodies, moving..all);
        self.reorder(bodies);
        self.arrange();
    }

    /// Computes all volumes of static bodies.
    fn place_static(&mut self, bodies: &Bodies) {
        let at_rest = self.places.moving..self.places.len();
        self.update_first(bodies, at_rest.clone());
        self.update_rows(bodies, at_rest);
    }

    /// Lets the finder reorder places. Moving bodies are updated afterwards anyway; static ones are
    /// moved here.
    pub(super) fn reorder(&mut self, bodies: &Bodies) {
        if self.scheme.flow == Flow::Nothing {
            // Nothing is arranged yet, so there is no order to follow.
            return;
        }
        let by_place = self.names_are_places();
        let names = if by_place {
            &self.numbers
        } else {
            &self.places.body
        };
        let (balls, order) = (&self.balls, &mut self.order);
        let changed = self.finder.reorder(&self.places, balls, names, order);
        if changed == Reorder::None {
            return;
        }
        self.places.reorder(&self.fixed, &mut self.order, by_place);
        if changed == Reorder::All {
            let (moving, all) = (self.places.moving, self.places.len());
            self.update_first(bodies, 0..moving);
            if moving < all {
                let fixed = std::mem::take(&mut self.fixed);
                self.place_static(&fixed);
                self.fixed = fixed;
            }
        }
    }
}
