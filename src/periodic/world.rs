//! A world with periodic axes: bodies, their images, and the pairs of both.

use super::images::{ImageWorld, PlacedBody, Placement};
use super::periods::Periods;
use super::{PeriodicError, PeriodicEvents};
use crate::simd::in_default_mode;
use crate::world::{BodyId, WorldError};

/// The factor by which the widest body counts as wider than it is, so that bodies of nearly the
/// same size don't all become the widest so far.
const WIDEST_FACTOR: f64 = 1.0 + 1.0 / 64.0;

/// 2⁻⁴⁰, as a multiple of the period: more than rounding takes from the ends of placed bodies. A
/// body that is nearer to the border than that has an image across it.
const BORDER_ERROR: f64 = 1.0 / (1_u64 << 40) as f64;

/// Two bodies that may touch, the second one moved by whole periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PeriodicPair {
    /// The bodies, the lower slot first.
    pub bodies: [BodyId; 2],
    /// The number of periods along each axis by which the second body is moved, from where the user
    /// has put it, so that it may touch the first.
    pub image: [i32; 3],
}

/// A long-lived set of bodies in space that repeats along some axes. See the [module](super).
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct Periodic<W: ImageWorld> {
    periods: Periods,
    /// All images. An image that is not moved has the id of its body.
    world: W,
    /// The bodies by slot of the world; slots of images have invalid entries.
    bodies: Vec<PlacedBody<W::Body>>,
    /// The images by slot of the world.
    images: Vec<Image>,
    /// The other images of each body, by slot.
    ghosts: Vec<Vec<BodyId>>,
    /// Along each axis, no body is wider than twice this.
    widest: [f64; 3],
    /// Slots of bodies whose images have to be placed, and a mark at each.
    changed: Vec<u32>,
    is_changed: Vec<bool>,
    are_all_changed: bool,
    pairs: Vec<PeriodicPair>,
    /// Those of them that were found at the images of a border.
    across: Vec<PeriodicPair>,
    /// The pairs when events were last read.
    seen: Vec<PeriodicPair>,
}

/// What is in a slot of the world.
#[derive(Clone, Copy, Debug)]
struct Image {
    of: BodyId,
    /// One bit per axis along which the body is moved by one period more than to its place.
    axes: u8,
    /// By how many periods the body is moved.
    shift: [i32; 3],
    is_small: bool,
}

impl Image {
    fn new(of: BodyId, axes: u8, place: &Placement) -> Self {
        let shift = [0, 1, 2].map(|axis| place.shift[axis] + i32::from(axes >> axis & 1));
        Self {
            of,
            axes,
            shift,
            is_small: place.is_small,
        }
    }
}

impl<W: ImageWorld> Periodic<W> {
    pub(super) fn of(world: W, periods: [Option<f64>; 3]) -> Result<Self, PeriodicError> {
        Ok(Self {
            periods: Periods::new(periods)?,
            world,
            bodies: Vec::new(),
            images: Vec::new(),
            ghosts: Vec::new(),
            widest: [0.0; 3],
            changed: Vec::new(),
            is_changed: Vec::new(),
            are_all_changed: false,
            pairs: Vec::new(),
            across: Vec::new(),
            seen: Vec::new(),
        })
    }

    /// The period of each axis that has one.
    #[must_use]
    pub fn periods(&self) -> [Option<f64>; 3] {
        self.periods.get()
    }

    /// Changes the periods. Bodies stay where the user has put them.
    ///
    /// # Errors
    /// A period is not a length between 2⁻⁵⁶ and 2⁵⁶, or a body is too large or too far away for
    /// it. Nothing is changed.
    pub fn set_periods(&mut self, periods: [Option<f64>; 3]) -> Result<(), PeriodicError> {
        let periods = Periods::new(periods)?;
        let slots: Vec<usize> = self.slots_of_bodies().collect();
        let place = |&slot: &usize| self.world.place(slot, &self.bodies[slot].body, &periods);
        let places = in_default_mode(|| slots.iter().map(place).collect::<Result<Vec<_>, _>>())?;
        (self.periods, self.widest) = (periods, [0.0; 3]);
        for (slot, place) in slots.into_iter().zip(places) {
            let body = self.bodies[slot].body;
            self.put(slot, PlacedBody { body, place });
        }
        Ok(())
    }

    /// Adds a body, anywhere.
    ///
    /// # Errors
    /// Along a periodic axis, the body is as long as half of the period or longer, or farther than
    /// 2²⁸ periods from the origin; or it is outside of the contract.
    pub fn insert(&mut self, body: impl Into<W::Body>) -> Result<BodyId, PeriodicError> {
        let body = body.into();
        in_default_mode(|| {
            let slot = self.world.next_image_slot();
            let place = self.world.place(slot, &body, &self.periods)?;
            let id = self.world.add_image(&body, place.shift, &self.periods)?;
            self.name(id, Image::new(id, 0, &place), PlacedBody { body, place });
            self.put(id.slot(), PlacedBody { body, place });
            Ok(id)
        })
    }

    /// Removes a body. Pairs of the last cull still contain it; those of the next cull don't.
    ///
    /// # Errors
    /// The body has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), PeriodicError> {
        let slot = self.slot(id)?;
        for ghost in self.ghosts[slot].drain(..) {
            self.world.remove_image(ghost)?;
        }
        Ok(self.world.remove_image(id)?)
    }

    /// The body as it was inserted or set.
    ///
    /// # Errors
    /// The body has been removed.
    pub fn body(&self, id: BodyId) -> Result<W::Body, PeriodicError> {
        Ok(self.bodies[self.slot(id)?].body)
    }

    /// Changes any properties of a body. It may move by any distance.
    ///
    /// # Errors
    /// The body has been removed, or as [`Self::insert`].
    pub fn set(&mut self, id: BodyId, body: impl Into<W::Body>) -> Result<(), PeriodicError> {
        let (slot, body) = (self.slot(id)?, body.into());
        let place = in_default_mode(|| self.world.place(slot, &body, &self.periods))?;
        self.put(slot, PlacedBody { body, place });
        Ok(())
    }

    /// Whether the body exists.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.slot(id).is_ok()
    }

    /// The ids of all bodies, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.slots_of_bodies().map(|slot| self.images[slot].of)
    }

    /// Excludes a pair of bodies with all of their images: it is not reported until
    /// [`Self::include`] or until one of the bodies is removed. Returns whether the pair was
    /// included before.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn exclude(&mut self, a: BodyId, b: BodyId) -> Result<bool, PeriodicError> {
        self.slot(a)?;
        self.slot(b)?;
        Ok(self.world.set_excluded([a, b], true)?)
    }

    /// Includes an excluded pair again. Returns whether it was excluded.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn include(&mut self, a: BodyId, b: BodyId) -> Result<bool, PeriodicError> {
        self.slot(a)?;
        self.slot(b)?;
        Ok(self.world.set_excluded([a, b], false)?)
    }

    /// Whether a pair is excluded.
    #[must_use]
    pub fn is_excluded(&self, a: BodyId, b: BodyId) -> bool {
        self.world.has_excluded([a, b])
    }

    /// The world that holds the bodies and their images across borders, for its counters. A body
    /// has the same id there.
    #[must_use]
    pub fn images(&self) -> &W {
        &self.world
    }

    /// Finds the pairs of which an image may touch, each once, and the image. They are sorted by
    /// slots.
    ///
    /// # Errors
    /// There are more images than can be numbered, or as the world's `cull`. [`Self::pairs`] are
    /// those of the cull before.
    pub fn cull(&mut self) -> Result<&[PeriodicPair], PeriodicError> {
        in_default_mode(|| self.place_changed())?;
        self.find()?;
        Ok(&self.pairs)
    }

    /// The pairs of the last cull.
    #[must_use]
    pub fn pairs(&self) -> &[PeriodicPair] {
        &self.pairs
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull. It takes one pass over the pairs of both.
    pub fn events(&mut self) -> PeriodicEvents {
        let events = PeriodicEvents::between(&self.seen, &self.pairs);
        self.seen.clone_from(&self.pairs);
        events
    }

    /// The slot of a present body.
    fn slot(&self, id: BodyId) -> Result<usize, WorldError> {
        let slot = id.slot();
        let is_body = self.world.has_image(id) && self.images[slot].axes == 0;
        is_body.then_some(slot).ok_or(WorldError::Gone(id))
    }

    fn slots_of_bodies(&self) -> impl Iterator<Item = usize> + '_ {
        let slots = self.images.iter().enumerate();
        let bodies = slots.filter(|(_, image)| image.axes == 0 && self.world.has_image(image.of));
        bodies.map(|(slot, _)| slot)
    }

    /// Notes what a slot of the world has got.
    fn name(&mut self, id: BodyId, image: Image, body: PlacedBody<W::Body>) {
        let slot = id.slot();
        if self.images.len() <= slot {
            self.images.resize(slot + 1, image);
            self.bodies.resize(slot + 1, body);
            self.ghosts.resize(slot + 1, Vec::new());
            self.is_changed.resize(slot + 1, false);
        }
        self.images[slot] = image;
    }

    /// Keeps a body as it is from now on. Its images are placed by the next cull.
    fn put(&mut self, slot: usize, placed: PlacedBody<W::Body>) {
        for (axis, _) in self.periods.iter() {
            let half = 0.5 * (placed.place.hi[axis] - placed.place.lo[axis]);
            if half > self.widest[axis] {
                self.widest[axis] = half * WIDEST_FACTOR;
                self.are_all_changed = true;
            }
        }
        self.bodies[slot] = placed;
        self.note(slot);
    }

    fn note(&mut self, slot: usize) {
        if !std::mem::replace(&mut self.is_changed[slot], true) {
            self.changed.push(slot as u32);
        }
    }

    /// Places the images of all bodies that have changed.
    fn place_changed(&mut self) -> Result<(), WorldError> {
        if std::mem::take(&mut self.are_all_changed) {
            (0..self.images.len()).for_each(|slot| self.note(slot));
        }
        for number in 0..self.changed.len() {
            let slot = self.changed[number] as usize;
            let id = self.images[slot].of;
            if self.images[slot].axes == 0 && self.world.has_image(id) {
                self.place_images(id)?;
            }
        }
        for slot in self.changed.drain(..) {
            self.is_changed[slot as usize] = false;
        }
        Ok(())
    }

    /// Places the image of a body within the period, and those beyond the upper borders that other
    /// bodies may touch across them: of no axis but those near the lower border.
    fn place_images(&mut self, id: BodyId) -> Result<(), WorldError> {
        let slot = id.slot();
        let PlacedBody { body, place } = self.bodies[slot];
        self.images[slot] = Image::new(id, 0, &place);
        self.world
            .set_image(id, &body, place.shift, &self.periods)?;
        let near = self.near_borders(&place);
        let mut former = std::mem::take(&mut self.ghosts[slot]);
        let mut placed = Vec::new();
        let mut axes = (1..8_u8).filter(|axes| axes & !near == 0);
        let outcome = axes.try_for_each(|axes| {
            let image = Image::new(id, axes, &place);
            let ghost = match former.pop() {
                Some(ghost) => {
                    placed.push(ghost);
                    self.world
                        .set_image(ghost, &body, image.shift, &self.periods)?;
                    ghost
                }
                None => {
                    let ghost = self.world.add_image(&body, image.shift, &self.periods)?;
                    placed.push(ghost);
                    ghost
                }
            };
            self.name(ghost, image, PlacedBody { body, place });
            Ok(())
        });
        for ghost in former {
            self.world.remove_image(ghost)?;
        }
        self.ghosts[slot] = placed;
        outcome
    }

    /// The axes along which a body is so near to the lower border that one at the upper border may
    /// touch it.
    fn near_borders(&self, place: &Placement) -> u8 {
        let axes = self.periods.iter().map(|(axis, period)| {
            let nearest = self.widest[axis] - (0.5 - BORDER_ERROR) * period;
            u8::from(place.lo[axis] <= nearest) << axis
        });
        axes.sum()
    }

    /// Culls the images and lists the pairs of their bodies.
    fn find(&mut self) -> Result<(), WorldError> {
        let found = self.world.cull_images()?;
        self.pairs.clear();
        self.across.clear();
        for [a, b] in found {
            let [one, two] = [a, b].map(|id| self.images[id.slot()]);
            // Two images that are moved along one axis are found without that, too.
            if one.axes & two.axes != 0 || one.of == two.of {
                continue;
            }
            let (first, second) = if one.of < two.of {
                (one, two)
            } else {
                (two, one)
            };
            let bodies = [first.of, second.of];
            let image = [0, 1, 2].map(|axis| second.shift[axis] - first.shift[axis]);
            if !(one.is_small && two.is_small) {
                let [placed, other] = bodies.map(|id| &self.bodies[id.slot()]);
                if !W::may_touch(&self.periods, placed, other, image) {
                    continue;
                }
            }
            let pair = PeriodicPair { bodies, image };
            if one.axes | two.axes == 0 {
                self.pairs.push(pair);
            } else {
                self.across.push(pair);
            }
        }
        let world = &self.world;
        self.across.retain(|pair| !world.has_excluded(pair.bodies));
        self.across.sort_unstable();
        merge(&mut self.pairs, &self.across);
        Ok(())
    }
}

/// Merges a sorted list into another.
fn merge(pairs: &mut Vec<PeriodicPair>, others: &[PeriodicPair]) {
    let (mut left, mut end) = (pairs.len(), pairs.len() + others.len());
    pairs.extend_from_slice(others);
    for &other in others.iter().rev() {
        while left > 0 && pairs[left - 1] > other {
            (left, end) = (left - 1, end - 1);
            pairs[end] = pairs[left];
        }
        end -= 1;
        pairs[end] = other;
    }
}
