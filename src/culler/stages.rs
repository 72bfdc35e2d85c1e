//! The stages of a frame: what moved is updated, bodies are arranged for the finder, and pairs are
//! found and tested.

use std::ops::Range;

use super::Culler;
use crate::bodies::contract::check_poses;
use crate::bodies::{Bodies, PairFilter};
use crate::listing::{Output, SlotNames, Totals};
use crate::settings::{Flow, Updates};
use crate::strategy::{self, Arrangement, FrameVolumes, Inputs, RowTiming};
use crate::update::{UpdateInputs, update_spheres};

impl Culler {
    /// Updates what the first test needs, in a range of places: all volumes except the rows.
    /// Returns whether the poses are within the contract.
    pub(super) fn update_first(&mut self, bodies: &Bodies, range: Range<usize>) -> bool {
        let (frames, places) = (&self.models.frames, &self.set.places);
        let executor = self.threads.get().executor(self.tier);
        let is_sound = if self.needs.balls {
            let balls = &mut self.volumes.balls;
            update_spheres(executor, balls, frames, bodies, places, range.clone())
        } else {
            check_poses(bodies, 0..bodies.len()).is_ok()
        };
        if let Some(intervals) = &mut self.volumes.intervals {
            let posed = UpdateInputs { frames, bodies, places, balls: &[] };
            intervals.update(executor, &mut self.volumes.balls, posed, range);
        }
        is_sound
    }

    /// Computes the rows in a range of places, if the strategy needs rows.
    pub(super) fn update_rows(&mut self, bodies: &Bodies, range: Range<usize>) {
        if !self.needs.rows {
            return;
        }
        let posed = UpdateInputs {
            frames: &self.models.frames,
            bodies,
            places: &self.set.places,
            balls: self.needs.known(&self.volumes.balls),
        };
        let executor = self.threads.get().executor(self.tier);
        self.volumes.rows.update(executor, posed, range, self.volumes.stamp);
    }

    pub(super) fn count_updates(&mut self) {
        let moved = self.set.places.moving as u64;
        if let Some(volume) = self.setup.scheme.first {
            self.counters.of_mut(volume).updates += moved;
        }
        if let Some(volume) = self.setup.scheme.refining
            && self.setup.settings.updates == Updates::Eager
        {
            self.counters.of_mut(volume).updates += moved;
        }
    }

    /// Arranges the bodies and the volumes of the first test in slot order.
    pub(super) fn arrange(&mut self) {
        if self.setup.scheme.flow == Flow::Nothing {
            return;
        }
        let names = self.needs.names(&self.set.numbers, &self.set.places);
        let pool = self.threads.get();
        let executor = pool.executor(self.tier);
        self.set.finder.arrange(executor, &self.set.places, &self.volumes.balls, names, None);
        if let Some(intervals) = &self.volumes.intervals {
            let order = &self.set.finder.names()[..self.set.places.len()];
            self.volumes.interval_slots.fill(pool, order, &intervals.ends);
        }
    }

    /// Finds and tests pairs.
    pub(super) fn run(
        &mut self,
        bodies: &Bodies,
        filter: Option<PairFilter<'_>>,
        output: Output<'_>,
        row_timing: RowTiming,
    ) -> Totals {
        if let Some(interest) = &self.setup.settings.interest {
            let frame = |body: usize| &self.models.frames[self.set.fixed.shape[body] as usize];
            let centre = |body: usize| {
                let pose = (bodies.rotation[body], bodies.translation[body]);
                let [x, y, z, _] = frame(body).sphere(pose.0, pose.1);
                [x, y, z]
            };
            strategy::mark(interest, bodies, centre, &mut self.volumes.interest);
        }
        let body = &self.set.places.body;
        let names = match self.needs.by_place {
            false => SlotNames::Bodies,
            true if self.set.finder.slots_are_places() => SlotNames::Slots(body),
            true => SlotNames::Places(body),
        };
        let inputs = Inputs {
            executor: self.threads.get().executor(self.tier),
            setup: &self.setup,
            tables: &self.models.tables,
            arranged: Arrangement {
                finder: &self.set.finder,
                slots: self.set.finder.slots(&self.volumes.balls),
                names,
                filter: filter.or(PairFilter::of_groups(self.set.groups.as_deref())),
            },
            volumes: FrameVolumes {
                posed: UpdateInputs {
                    frames: &self.models.frames,
                    bodies,
                    places: &self.set.places,
                    balls: self.needs.known(&self.volumes.balls),
                },
                intervals: &self.volumes.interval_slots,
                interest: &self.volumes.interest,
                stamp: self.volumes.stamp,
                row_timing,
            },
        };
        let totals = strategy::cull(inputs, &mut self.volumes.rows, &mut self.scratch, output);
        self.count(&totals);
        totals
    }

    pub(super) fn count(&mut self, totals: &Totals) {
        if let Some(volume) = self.setup.scheme.first {
            *self.counters.of_mut(volume) += totals.first;
        }
        if let Some(volume) = self.setup.scheme.refining {
            *self.counters.of_mut(volume) += totals.refining;
        }
        self.counters.untested += totals.untested;
        let candidates = match self.setup.scheme.first {
            Some(_) => totals.first.tests,
            None => totals.refining.tests,
        };
        self.set.finder.observe(candidates);
        let work = self.needs.work(self.set.places.moving as u64, totals);
        self.threads.expect(work);
    }
}
