//! A world with periodic axes: bodies, their images, and the pairs of both.

use super::PeriodicError;
use super::borders::Borders;
use super::images::{Image, ImageSource, PlacedBody, Placement};
use super::pairs::{PeriodicEvents, PeriodicPair, merge};
use super::periods::Periods;
use crate::cull_error::CullError;
use crate::living::{BodyId, Ids, LivingSet, WorldError};
use crate::simd::in_default_mode;

/// The images of all bodies are placed anew if more than one in this number of bodies was set.
const BODIES_PER_CHANGE: usize = 16;

/// A long-lived set of bodies in space that repeats along some axes. See the [module](super).
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct Periodic<V: ImageSource> {
    pub(super) periods: Periods,
    ids: Ids,
    /// The image of each body that is held within the period, by the body's slot.
    homes: Vec<BodyId>,
    /// All images.
    world: LivingSet<V>,
    /// The bodies by slot of that image; slots of other images have invalid entries.
    pub(super) bodies: Vec<PlacedBody<V::UserBody>>,
    /// The images by slot of the world.
    pub(super) images: Vec<Image>,
    /// The other images of each body, by slot of the first.
    ghosts: Vec<Vec<BodyId>>,
    pub(super) borders: Borders,
    /// Slots of bodies whose images across borders have to be placed by the next cull, or of all.
    late: Vec<u32>,
    are_all_late: bool,
    /// Whether one of them lacks an image or has jumped to another border; the others have an image
    /// too many.
    is_any_missing: bool,
    /// Number of bodies set since the last cull.
    sets: usize,
    pairs: Vec<PeriodicPair>,
    /// Those of them that were found at the images of a border.
    across: Vec<PeriodicPair>,
    /// The pairs when events were last read.
    seen: Vec<PeriodicPair>,
}

impl<V: ImageSource> Periodic<V> {
    pub(crate) fn of(
        world: LivingSet<V>,
        periods: [Option<f64>; 3],
    ) -> Result<Self, PeriodicError> {
        let periods = Periods::new(periods)?;
        Ok(Self {
            periods,
            ids: Ids::default(),
            homes: Vec::new(),
            world,
            bodies: Vec::new(),
            images: Vec::new(),
            ghosts: Vec::new(),
            borders: Borders::new(&periods),
            late: Vec::new(),
            are_all_late: false,
            is_any_missing: false,
            sets: 0,
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
        let slots: Vec<usize> = self.ids.filled().map(|row| self.homes[row].slot()).collect();
        let place = |(id, &slot): (BodyId, &usize)| {
            V::place(&self.world, id.slot(), &self.bodies[slot].body, &periods)
        };
        let places = || self.ids.iter().zip(&slots).map(place).collect::<Result<Vec<_>, _>>();
        let places = in_default_mode(places)?;
        (self.periods, self.borders) = (periods, Borders::new(&periods));
        self.are_all_late = true;
        in_default_mode(|| {
            for (slot, place) in slots.into_iter().zip(places) {
                let body = self.bodies[slot].body;
                self.put(slot, &body, &place);
            }
        });
        Ok(())
    }

    /// Adds a body, anywhere. Slots are those of bodies: images take none.
    ///
    /// # Errors
    /// Along a periodic axis, the body is as long as half of the period or longer, or farther than
    /// 2²⁸ periods from the origin; or it is outside of the contract.
    pub fn insert(&mut self, body: impl Into<V::UserBody>) -> Result<BodyId, PeriodicError> {
        let body = body.into();
        in_default_mode(|| {
            let place = V::place(&self.world, self.ids.next_slot(), &body, &self.periods)?;
            let home = self.world.insert(V::image(&body, place.shift, &self.periods))?;
            let row = self.ids.next();
            if self.ids.take() {
                self.homes.push(home);
            }
            self.homes[row] = home;
            let id = self.ids.id(row as u32);
            self.name(home, Image::new(id, 0, &place), PlacedBody { body, place });
            self.look_across(home.slot(), &place);
            Ok(id)
        })
    }

    /// Removes a body. Pairs of the last cull still contain it; those of the next cull don't.
    ///
    /// # Errors
    /// The body has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), PeriodicError> {
        let home = self.homes[self.ids.remove(id)?];
        for ghost in self.ghosts[home.slot()].drain(..) {
            self.world.remove(ghost)?;
        }
        Ok(self.world.remove(home)?)
    }

    /// The body as it was inserted or set.
    ///
    /// # Errors
    /// The body has been removed.
    pub fn body(&self, id: BodyId) -> Result<V::UserBody, PeriodicError> {
        Ok(self.bodies[self.slot(id)?].body)
    }

    /// Changes any properties of a body. It may move by any distance.
    ///
    /// # Errors
    /// The body has been removed, or as [`Self::insert`].
    pub fn set(&mut self, id: BodyId, body: impl Into<V::UserBody>) -> Result<(), PeriodicError> {
        let (slot, body) = (self.slot(id)?, body.into());
        in_default_mode(|| {
            let mut place = V::place(&self.world, id.slot(), &body, &self.periods)?;
            if V::IS_EXACT {
                self.settle(slot, &mut place);
            }
            self.put(slot, &body, &place);
            Ok(())
        })
    }

    /// Whether the body exists.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.ids.slot(id).is_ok()
    }

    /// The ids of all bodies, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.ids.iter()
    }

    /// All present bodies as they were inserted or set, sorted by slot.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, V::UserBody)> + '_ {
        let body = |row: usize| self.bodies[self.homes[row].slot()].body;
        self.ids.filled().map(move |row| (self.ids.id(row as u32), body(row)))
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Excludes a pair of bodies with all of their images: it is not reported until
    /// [`Self::include`] or until one of the bodies is removed. Returns whether the pair was
    /// included before.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn exclude(&mut self, a: BodyId, b: BodyId) -> Result<bool, PeriodicError> {
        let [a, b] = [self.home(a)?, self.home(b)?];
        Ok(self.world.exclude(a, b)?)
    }

    /// Includes an excluded pair again. Returns whether it was excluded.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn include(&mut self, a: BodyId, b: BodyId) -> Result<bool, PeriodicError> {
        let [a, b] = [self.home(a)?, self.home(b)?];
        Ok(self.world.include(a, b)?)
    }

    /// Whether a pair is excluded.
    #[must_use]
    pub fn is_excluded(&self, a: BodyId, b: BodyId) -> bool {
        match [a, b].map(|id| self.home(id)) {
            [Ok(a), Ok(b)] => self.world.is_excluded(a, b),
            _ => false,
        }
    }

    /// The world that holds the bodies and their images across borders, for its counters. Ids there
    /// are those of images.
    #[must_use]
    pub fn images(&self) -> &LivingSet<V> {
        &self.world
    }

    /// Finds the pairs of which an image may touch, each once, and the image. They are sorted by
    /// slots.
    ///
    /// # Errors
    /// There are more images than can be numbered, or as the world's `cull`. [`Self::pairs`] are
    /// those of the cull before.
    pub fn cull(&mut self) -> Result<&[PeriodicPair], PeriodicError> {
        self.cull_images(None)
    }

    /// Culls as [`Self::cull`] does, if images have at most `limit` pairs. A pair across a corner
    /// of the period is found at several images, and counts as often. Memory for more is never
    /// allocated.
    ///
    /// # Errors
    /// There are more pairs, and the error has their number. Otherwise as [`Self::cull`].
    pub fn cull_up_to(&mut self, limit: usize) -> Result<&[PeriodicPair], PeriodicError> {
        self.cull_images(Some(limit))
    }

    fn cull_images(&mut self, limit: Option<usize>) -> Result<&[PeriodicPair], PeriodicError> {
        if self.are_all_late || !self.late.is_empty() {
            in_default_mode(|| self.place_late())?;
        }
        self.sets = 0;
        self.find(limit)?;
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

    /// The image of a present body that is held within the period.
    fn home(&self, id: BodyId) -> Result<BodyId, WorldError> {
        self.ids.slot(id).map(|row| self.homes[row])
    }

    /// The slot of that image.
    fn slot(&self, id: BodyId) -> Result<usize, WorldError> {
        self.home(id).map(BodyId::slot)
    }

    /// Notes what a slot of the world has got.
    fn name(&mut self, id: BodyId, image: Image, body: PlacedBody<V::UserBody>) {
        let slot = id.slot();
        if self.images.len() <= slot {
            self.images.resize(slot + 1, image);
            self.bodies.resize(slot + 1, body);
            self.ghosts.resize(slot + 1, Vec::new());
        }
        (self.images[slot], self.bodies[slot]) = (image, body);
    }

    /// Keeps a body that has moved a little on its side of a border. If it must be wrapped, so are
    /// all by the next cull, so that others need not be in the frames after it.
    #[inline]
    fn settle(&mut self, slot: usize, place: &mut Placement) {
        let former = &self.bodies[slot].place.lo;
        if self.periods.is_jump(former, &place.lo) {
            self.borders.keep(place, former, &self.periods);
            if self.periods.is_jump(former, &place.lo) {
                self.is_any_missing = true;
                self.note_late(slot);
            }
        }
    }

    /// Sets a present body and the images that it has.
    #[inline]
    fn put(&mut self, slot: usize, body: &V::UserBody, place: &Placement) {
        let (image, placed) = (&mut self.images[slot], &mut self.bodies[slot]);
        (placed.body, placed.place) = (*body, *place);
        (image.shift, image.is_small) = (place.shift, place.is_small);
        let home = self.homes[image.of.slot()];
        self.world.set_checked(home, &V::image(body, place.shift, &self.periods));
        if self.images[slot].across != 0 {
            self.put_ghosts(slot);
        }
        self.look_across(slot, place);
    }

    /// Sets the images across borders that a body has.
    fn put_ghosts(&mut self, slot: usize) {
        let (of, PlacedBody { body, place }) = (self.images[slot].of, &self.bodies[slot]);
        for &ghost in &self.ghosts[slot] {
            let image = Image::new(of, self.images[ghost.slot()].axes, place);
            self.world.set_checked(ghost, &V::image(body, image.shift, &self.periods));
            self.images[ghost.slot()] = image;
        }
    }

    /// Notes a body that has been set if it lacks an image across a border, or has one too many.
    #[inline]
    fn look_across(&mut self, slot: usize, Placement { lo, hi, .. }: &Placement) {
        self.sets += 1;
        if self.borders.grow(lo, hi, &self.periods) {
            self.are_all_late = true;
        }
        let across = self.images[slot].across;
        let is_missing = self.borders.near(lo, 0.0) & !across != 0;
        if is_missing || across & !self.borders.near(lo, 2.0) != 0 {
            self.is_any_missing |= is_missing;
            self.note_late(slot);
        }
    }

    /// Makes the next cull place the images of a body.
    fn note_late(&mut self, slot: usize) {
        if self.late.len() == self.images.len() {
            self.are_all_late = true; // some bodies were set many times
        }
        if !self.are_all_late {
            self.late.push(slot as u32);
        }
    }

    /// Places the images of the bodies that need it. If many bodies move, all are placed at once,
    /// with some slack, so that the next frames need not do so.
    fn place_late(&mut self) -> Result<(), WorldError> {
        let late = std::mem::take(&mut self.late);
        let are_many = self.sets * BODIES_PER_CHANGE > self.images.len();
        let are_all = self.are_all_late || are_many && self.is_any_missing;
        self.are_all_late = true; // until those are placed that need it
        if are_all {
            (0..self.images.len()).try_for_each(|slot| self.place_anew(slot))?;
        } else if !are_many {
            (late.into_iter()).try_for_each(|slot| self.place_anew(slot as usize))?;
        }
        (self.are_all_late, self.is_any_missing) = (false, false);
        Ok(())
    }

    /// Wraps the body in a slot, if there is one, and places its images.
    fn place_anew(&mut self, slot: usize) -> Result<(), WorldError> {
        let Image { of, axes, .. } = self.images[slot];
        if axes != 0 || self.slot(of) != Ok(slot) {
            return Ok(());
        }
        let (body, periods) = (&self.bodies[slot].body, &self.periods);
        if V::IS_EXACT // others are wrapped whenever they are set
            && let Ok(place) = V::place(&self.world, of.slot(), body, periods)
            && place.shift != self.images[slot].shift
        {
            let home = self.homes[of.slot()];
            self.world.set_checked(home, &V::image(body, place.shift, periods));
            self.images[slot] =
                Image { across: self.images[slot].across, ..Image::new(of, 0, &place) };
            self.bodies[slot].place = place;
        }
        let across = self.borders.near(&self.bodies[slot].place.lo, 1.0);
        self.place_ghosts(slot, across)
    }

    /// Gives a body the images beyond the upper borders of these axes, and no others.
    fn place_ghosts(&mut self, slot: usize, across: u8) -> Result<(), WorldError> {
        if across | self.images[slot].across == 0 {
            return Ok(());
        }
        let (id, placed) = (self.images[slot].of, self.bodies[slot]);
        let mut former = std::mem::take(&mut self.ghosts[slot]);
        let mut ghosts = Vec::new();
        let mut axes = (1..8_u8).filter(|axes| axes & !across == 0);
        let outcome = axes.try_for_each(|axes| {
            let image = Image::new(id, axes, &placed.place);
            let (body, shift, periods) = (&placed.body, image.shift, &self.periods);
            let ghost = match former.pop() {
                Some(ghost) => {
                    self.world.set_checked(ghost, &V::image(body, shift, periods));
                    ghost
                }
                None => self.world.insert(V::image(body, shift, periods))?,
            };
            ghosts.push(ghost);
            self.name(ghost, image, placed);
            Ok(())
        });
        for ghost in former {
            self.world.remove(ghost)?;
        }
        self.ghosts[slot] = ghosts;
        self.images[slot].across = across;
        outcome
    }

    /// Culls the images and lists the pairs of their bodies.
    fn find(&mut self, limit: Option<usize>) -> Result<(), WorldError> {
        let found = self.world.cull_within(limit)?;
        self.pairs.clear();
        self.across.clear();
        // Those across borders are few, and are merged into them.
        self.pairs.try_reserve(found.len()).map_err(|_| CullError::OutOfMemory)?;
        for [a, b] in found {
            let [one, two] = [a, b].map(|id| &self.images[id.slot()]);
            // Two images that are moved along one axis are found without that, too.
            if one.axes & two.axes != 0 || one.of == two.of {
                continue;
            }
            let (first, second) = if one.of < two.of { (one, two) } else { (two, one) };
            let bodies = [first.of, second.of];
            let image = [0, 1, 2].map(|axis| second.shift[axis] - first.shift[axis]);
            if !(one.is_small && two.is_small) {
                let home = |id: BodyId| self.homes[id.slot()].slot();
                let [placed, other] = bodies.map(|id| &self.bodies[home(id)]);
                if !V::may_touch(&self.periods, placed, other, image) {
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
        let (world, homes) = (&self.world, &self.homes);
        let is_excluded = |pair: &PeriodicPair| {
            let [a, b] = pair.bodies.map(|id| homes[id.slot()]);
            world.is_excluded(a, b)
        };
        self.across.retain(|pair| !is_excluded(pair));
        self.across.sort_unstable();
        self.pairs.sort(); // they are, unless slots of images were given again in another order
        merge(&mut self.pairs, &self.across);
        self.ids.settle();
        Ok(())
    }
}
