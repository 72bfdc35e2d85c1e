//! Large worlds: f64 translations, culled in f32 about local origins.
//!
//! The origins are a function of the present bodies, never of earlier frames. If all translations
//! are f32, they stay as they are. Otherwise bodies near each other are placed about one origin,
//! and bodies in far-apart places have an [origin per region](super::regions).

use std::ops::Range;

use super::bounds::{BodyBounds, is_placed};
use super::bounds_tree::BoundsTree;
use super::region::{PlacedBody, Region};
use super::regions::{Regions, regions};
use super::{Meshes, WorldError};
use crate::bodies::contract::is_within_limit;
use crate::living::Members;
use crate::rounding::narrow::turn_error;
use crate::simd::{CACHE_LINE, prefetch};
use crate::update::offset::{compose, reach_about_pose};

/// The number of changed bodies by which prefetching is ahead.
const PREFETCH_DISTANCE: usize = 3;

/// The origins about which bodies are placed.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum LocalOrigins {
    /// All translations stay as they are.
    World,
    One(Region),
    Many(Regions),
}

impl LocalOrigins {
    /// The origins for these bodies, whose translations are at most 2⁶⁰ in size, or slightly more
    /// if meshes are far from their own origins.
    fn of(bodies: impl Iterator<Item = PlacedBody> + Clone) -> Self {
        if bodies.clone().all(|(_, t, _)| is_placed(t)) {
            return Self::World;
        }
        Self::within(BodyBounds::of(bodies.clone()), bodies)
    }

    /// The origins for bodies with these bounds. Single bodies are read only if the bounds are
    /// wide.
    fn within(bounds: BodyBounds, bodies: impl Iterator<Item = PlacedBody>) -> Self {
        if bounds.are_placed {
            return Self::World;
        }
        let many = bounds.is_wide().then(|| regions(bodies.collect(), bounds));
        match many.flatten() {
            Some(regions) => Self::Many(regions),
            None => Self::One(bounds.region()),
        }
    }

    /// The local translation of a slot's body, and the bound of its error.
    fn place(&self, slot: usize, t: [f64; 3]) -> ([f32; 3], f64) {
        match self {
            Self::World => (t.map(|x| x as f32), 0.0),
            Self::One(region) => region.place(t),
            Self::Many(regions) => regions.of(slot).place(t),
        }
    }
}

/// The origins of the last cull, and the bounds of all bodies, from which they follow.
#[derive(Clone, Debug)]
pub(super) struct Origins {
    local: LocalOrigins,
    /// `None` while each cull reads all bodies.
    bounds: Option<BoundsTree>,
}

impl Default for Origins {
    fn default() -> Self {
        Self { local: LocalOrigins::World, bounds: None }
    }
}

impl Origins {
    /// The origin of the last cull, if there was one for all, in bits; the world's is `None`.
    #[cfg(feature = "serde")]
    pub fn saved(&self) -> Option<Option<[u64; 3]>> {
        match &self.local {
            LocalOrigins::World => Some(None),
            LocalOrigins::One(region) => Some(Some(region.origin.map(f64::to_bits))),
            LocalOrigins::Many(_) => None,
        }
    }

    /// The origin that was saved.
    #[cfg(feature = "serde")]
    pub fn restored(origin: Option<[u64; 3]>) -> Self {
        let one = |origin: [u64; 3]| {
            LocalOrigins::One(Region { origin: origin.map(f64::from_bits), corner: [0.0; 3] })
        };
        Self { local: origin.map_or(LocalOrigins::World, one), bounds: None }
    }
}

impl Meshes {
    /// Places all bodies about the origins of the last cull.
    #[cfg(feature = "serde")]
    pub(super) fn place_again(&mut self, members: &mut Members) -> Result<(), WorldError> {
        self.place_all(self.origins.local.clone(), members)
    }

    /// Reads the bounds of all bodies, before single ones change.
    pub(super) fn read_bounds(&mut self, members: &Members) {
        let of_slots = |range: Range<usize>| BodyBounds::of(self.placed_in(members, range));
        self.origins.bounds = Some(BoundsTree::new(members.ids.rows(), of_slots));
    }

    /// Places all bodies about local origins, in the models that their margins and rounding need.
    pub(super) fn place(&mut self, members: &mut Members) -> Result<(), WorldError> {
        let local = LocalOrigins::of(self.placed_in(members, 0..members.ids.rows()));
        self.origins.bounds = None;
        self.place_all(local, members)
    }

    /// Places the bodies that have changed since the last cull, and all others if an origin has
    /// changed. Notes those whose place or model has changed.
    pub(super) fn place_changed(&mut self, members: &mut Members) -> Result<(), WorldError> {
        let slots = members.ids.rows();
        let bounds = self.origins.bounds.take();
        let of_slots = |range: Range<usize>| BodyBounds::of(self.placed_in(members, range));
        let bounds = match bounds.filter(|bounds| bounds.has_room_for(slots)) {
            Some(mut bounds) => {
                let changed = members.movers.changed();
                for (number, &slot) in changed.iter().enumerate() {
                    if let Some(&ahead) = changed.get(number + PREFETCH_DISTANCE) {
                        bounds.prefetch(ahead as usize, |range| self.prefetch(members, range));
                        self.prefetch_place(ahead as usize);
                    }
                    bounds.update(slot as usize, of_slots);
                }
                bounds
            }
            None => BoundsTree::new(slots, of_slots),
        };
        let local = LocalOrigins::within(bounds.whole(), self.placed_in(members, 0..slots));
        self.origins.bounds = Some(bounds);
        if local != self.origins.local {
            return self.place_all(local, members);
        }
        for number in 0..members.movers.changed().len() {
            let slot = members.movers.changed()[number] as usize;
            if members.ids.present()[slot] {
                self.place_body(slot, &local, members)?;
            }
        }
        Ok(())
    }

    /// Places all bodies about these origins, and notes those whose place or model changes.
    fn place_all(&mut self, local: LocalOrigins, members: &mut Members) -> Result<(), WorldError> {
        for slot in 0..members.ids.rows() {
            if members.ids.present()[slot] && self.place_body(slot, &local, members)? {
                members.note(slot, false);
            }
        }
        self.origins.local = local;
        Ok(())
    }

    /// Places the body in a slot. Returns whether its place or its model has changed.
    #[inline]
    fn place_body(
        &mut self,
        slot: usize,
        local: &LocalOrigins,
        members: &mut Members,
    ) -> Result<bool, WorldError> {
        let (translation, composed) = self.composed(slot);
        let (place, moved) = local.place(slot, translation);
        if !is_within_limit(&place) {
            return Err(WorldError::Apart(members.ids.id(slot as u32)));
        }
        let moved = moved + composed;
        let shape = self.shape[slot] as usize;
        let (reach, margin) = (self.shapes[shape].reach, self.margin[slot]);
        let grow = |model, margin| self.culler.grow(model, margin);
        let model = self.margins.model(self.models[shape], reach, margin, moved, grow);
        let is_new = self.bodies.shape[slot] != model;
        let is_moved = self.bodies.translation[slot] != place;
        self.remodelled |= is_new;
        members.replaced |= !self.bodies.dynamic[slot] && (is_new || is_moved);
        self.bodies.shape[slot] = model;
        self.bodies.translation[slot] = place;
        Ok(is_new || is_moved)
    }

    /// Prefetches what [`Self::placed_in`] reads of these slots.
    fn prefetch(&self, members: &Members, slots: Range<usize>) {
        let lines = slots.clone().step_by(CACHE_LINE / size_of::<[f64; 3]>());
        for slot in lines {
            self.translation.get(slot).map(prefetch);
        }
        let slot = slots.start;
        members.ids.present().get(slot).map(prefetch);
        self.shape.get(slot).map(prefetch);
        self.margin.get(slot).map(prefetch);
    }

    /// Prefetches what [`Self::place_body`] changes.
    fn prefetch_place(&self, slot: usize) {
        self.bodies.translation.get(slot).map(prefetch);
        self.bodies.shape.get(slot).map(prefetch);
        self.bodies.dynamic.get(slot).map(prefetch);
    }

    /// Number, translation and reach of the bodies in some slots.
    fn placed_in<'a>(
        &'a self,
        members: &'a Members,
        slots: Range<usize>,
    ) -> impl Iterator<Item = PlacedBody> + Clone + 'a {
        let slots = slots.start..slots.end.min(members.ids.rows());
        let present = slots.filter(move |&slot| members.ids.present()[slot]);
        present.map(move |slot| {
            let (translation, composed) = self.composed(slot);
            let reach = f64::from(self.shapes[self.shape[slot] as usize].reach);
            let size = reach + f64::from(self.margin[slot]) + composed;
            (slot, translation, size)
        })
    }

    /// The translation of the vertices of the body in a slot, and a bound on what its rounding and
    /// that of the rotation move.
    #[inline]
    fn composed(&self, slot: usize) -> ([f64; 3], f64) {
        let shape = &self.shapes[self.shape[slot] as usize];
        let (rotation, offset) = (self.bodies.rotation[slot], shape.pose_offset);
        let (place, error) = compose(rotation, self.translation[slot], offset);
        let reach = reach_about_pose(shape.reach.into(), offset);
        (place, error + turn_error(self.rounded[slot], reach))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies of size 1 at these places, in slots that begin at 3.
    fn local(places: &[[f64; 3]]) -> LocalOrigins {
        LocalOrigins::of(places.iter().zip(3..).map(|(&t, slot)| (slot, t, 1.0)))
    }

    #[test]
    fn f32_translations_stay() {
        let far = [[1.0e9, -3.5, 0.0], [2.0f64.powi(50), 7.25, 2.0f64.powi(-149)]];
        let local = local(&far);
        assert_eq!(local.place(3, far[0]), ([1.0e9, -3.5, 0.0], 0.0));
        assert_eq!(local.place(4, far[1]).1, 0.0);
    }

    #[test]
    fn far_bodies_get_an_origin() {
        let far = [[1.0e9 + 0.1, 0.0, 0.0], [1.0e9 + 8.3, 1.0, 0.0]];
        let local = local(&far);
        let [a, b] = [0, 1].map(|i| local.place(3 + i, far[i]));
        // Within 64 of an origin, instead of 10⁹ from it.
        assert!(a.0[0].abs() <= 64.0 && a.1 < 1.0e-5, "{a:?}");
        assert!((b.0[0] - a.0[0] - 8.2).abs() < 1.0e-5, "{b:?}");
    }

    #[test]
    fn bodies_about_the_origin_keep_it() {
        let near = [[-900.1, 3.0, 0.5], [1000.0, 0.25, 0.0]];
        let local = local(&near);
        assert_eq!(local.place(4, near[1]), ([1000.0, 0.25, 0.0], 0.0));
        assert_eq!(local.place(3, near[0]).0, near[0].map(|x| x as f32));
    }

    #[test]
    fn far_regions_are_brought_together() {
        let places: Vec<[f64; 3]> = (0..1000_u32)
            .map(|i| [f64::from(i) * 1.0e9 + 0.1, f64::from(i % 7) * -3.0e11, 0.7])
            .collect();
        let local = local(&places);
        let placed: Vec<[f32; 3]> = (0..1000)
            .map(|i| {
                let (place, moved) = local.place(3 + i, places[i]);
                assert!(moved < 2.0_f64.powi(-10), "{moved}");
                place
            })
            .collect();
        for (i, a) in placed.iter().enumerate() {
            for b in &placed[i + 1..] {
                let apart = (0..3).fold(0.0_f32, |m, i| m.max((a[i] - b[i]).abs()));
                assert!(apart >= 8.0, "{a:?} {b:?}");
            }
        }
    }
}
