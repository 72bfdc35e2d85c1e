//! Queries of periodic worlds: which bodies have an image that may touch a volume?

use super::images::{Image, ImageSource, PlacedBody};
use super::periods::{Periods, distance, margin_about};
use super::world::Periodic;
use crate::living::{BodyId, LivingSet};
use crate::query::{Answers, QueryError, QueryIndex, QuerySource, QueryVolume};
use crate::rounding::exp2;
use crate::rounding::period::MOST_PERIODS;
use crate::rounding::query::largest;
use crate::simd::{Tier, in_default_mode};
use crate::threads::ThreadsError;

/// The longest volume, in periods of each axis.
const MOST_LENGTH: f64 = 16.0;

/// 2⁻²⁰: by how many periods a volume is taken to reach farther than it does, more than rounding
/// takes from its place within the period.
const RANGE_ERROR: f64 = exp2(-20);

/// A body that may touch a volume when it is moved by whole periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PeriodicHit {
    /// The body.
    pub body: BodyId,
    /// The number of periods along each axis by which the body is moved, from where the user has
    /// put it, so that it may touch the volume.
    pub image: [i32; 3],
}

/// The bodies of a periodic world, prepared for queries: [`QueryIndex`] for space that repeats.
///
/// A volume may be anywhere, and longer than a period: a body is then reported once for each of its
/// images that may touch the volume. Along a periodic axis a volume has at most 16 periods. Its
/// promise is that of [`QueryIndex`], for the exact periods: no image that shares a point with the
/// volume is missed. Boxes are reported for a box exactly if they meet; for other volumes they
/// count as large as their f32 boxes. There are no queries along lines.
///
/// ```
/// use sdop::QueryVolume;
/// use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicIndex};
///
/// let mut cell = PeriodicBoxes::new([Some(10.0), None, None])?; // y and z have no period
/// let right = cell.insert(PeriodicBox::new([8.0, 0.0, 0.0], [9.5, 1.0, 1.0]))?;
/// let mut index = PeriodicIndex::new();
/// index.update(&cell);
/// let ball = QueryVolume::Ball { centre: [0.0, 0.5, 0.5], radius: 1.0 };
/// let found = index.touching(&ball)?;
/// assert_eq!((found.len(), found[0].body), (1, right));
/// assert_eq!(found[0].image, [-1, 0, 0]); // one period to the left
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PeriodicIndex<V: ImageSource> {
    index: QueryIndex,
    periods: Periods,
    /// How far bodies reach from the middle of the period.
    reach: [f64; 3],
    images: Vec<Image>,
    bodies: Vec<PlacedBody<V::UserBody>>,
}

impl<V: ImageSource> Default for PeriodicIndex<V>
where
    LivingSet<V>: QuerySource,
{
    fn default() -> Self {
        Self::of(QueryIndex::new())
    }
}

impl<V: ImageSource> PeriodicIndex<V>
where
    LivingSet<V>: QuerySource,
{
    /// As [`QueryIndex::new`].
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// As [`QueryIndex::with_threads`].
    ///
    /// # Errors
    /// The system cannot start the threads.
    pub fn with_threads(threads: usize) -> Result<Self, ThreadsError> {
        Ok(Self::of(QueryIndex::with_threads(threads)?))
    }

    fn of(index: QueryIndex) -> Self {
        Self {
            index,
            periods: Periods::default(),
            reach: [0.0; 3],
            images: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// This index with another SIMD tier. Answers don't depend on it.
    #[must_use]
    pub fn on_tier(mut self, tier: Tier) -> Self {
        self.index = self.index.on_tier(tier);
        self
    }

    /// As [`QueryIndex::most_answers`].
    #[must_use]
    pub fn most_answers(mut self, limit: usize) -> Self {
        self.index = self.index.most_answers(limit);
        self
    }

    /// Brings the index up to date with a periodic world, as [`QueryIndex::update`] does. No cull
    /// is needed.
    pub fn update(&mut self, world: &Periodic<V>) {
        self.index.update(world.images());
        (self.periods, self.reach) = (world.periods, world.borders.reach(&world.periods));
        self.images.clone_from(&world.images);
        self.bodies.clone_from(&world.bodies);
    }

    /// The bodies of which an image may touch a volume, each with that image, sorted by slot and
    /// image.
    ///
    /// # Errors
    /// A volume outside of the contract ([`QueryVolume`]), longer than 16 periods, or farther than
    /// 2²⁸ periods from the origin; or an index that was never updated.
    pub fn touching(&self, volume: &QueryVolume<'_>) -> Result<Vec<PeriodicHit>, QueryError> {
        self.index.check_updated()?;
        self.check(0, volume)?;
        let mut found = Vec::new();
        in_default_mode(|| self.touch(volume, &mut found));
        Ok(found)
    }

    /// [`Self::touching`] for many volumes, on all threads.
    ///
    /// # Errors
    /// As [`Self::touching`], for the first such volume.
    pub fn touching_all(
        &self,
        volumes: &[QueryVolume<'_>],
    ) -> Result<Answers<PeriodicHit>, QueryError> {
        self.index.check_updated()?;
        for (query, volume) in volumes.iter().enumerate() {
            self.check(query, volume)?;
        }
        let answer = |volume: &QueryVolume<'_>, found: &mut Vec<_>| self.touch(volume, found);
        self.index.each_of(volumes, answer)
    }

    fn check(&self, query: usize, volume: &QueryVolume<'_>) -> Result<(), QueryError> {
        volume.check(query)?;
        let [lo, hi] = in_default_mode(|| volume.ends());
        let origin = volume.origin();
        for (axis, period) in self.periods.iter() {
            let is_short = hi[axis] - lo[axis] <= MOST_LENGTH * period;
            let farthest = largest([lo[axis], hi[axis], origin[axis]]);
            let is_near = farthest <= MOST_PERIODS * period;
            if !(is_short && is_near) {
                let value = format!("from {lo:?} to {hi:?}");
                let hint = "along a periodic axis, a volume is at most 16 periods long, and at most 2^28 periods away";
                return Err(QueryError::new(query, "volume", value, hint));
            }
        }
        Ok(())
    }

    fn touch(&self, volume: &QueryVolume<'_>, found: &mut Vec<PeriodicHit>) {
        let (start, mut near) = (found.len(), Vec::new());
        let [x, y, z] = self.ways(volume);
        for x in x {
            for y in y.clone() {
                for z in z.clone() {
                    self.touch_moved(volume, [x, y, z], &mut near, found);
                }
            }
        }
        found[start..].sort_unstable();
    }

    /// Appends the bodies that may touch a volume where it is moved back by whole periods. `near`
    /// is room for what the index finds.
    fn touch_moved(
        &self,
        volume: &QueryVolume<'_>,
        way: [i32; 3],
        near: &mut Vec<BodyId>,
        found: &mut Vec<PeriodicHit>,
    ) {
        near.clear();
        self.index.touch(&moved(volume, way, &self.periods), near);
        for id in near {
            let Image { of, axes, shift, .. } = self.images[id.slot()];
            let image = [0, 1, 2].map(|axis| shift[axis] + way[axis]);
            let body = &self.bodies[id.slot()];
            // The other images of a body are found without their own slots.
            if axes == 0 && V::may_touch_volume(&self.periods, body, image, volume) {
                found.push(PeriodicHit { body: of, image });
            }
        }
    }

    /// By how many periods a volume is moved back along each axis to where bodies are held.
    fn ways(&self, volume: &QueryVolume<'_>) -> [std::ops::RangeInclusive<i32>; 3] {
        let [lo, hi] = volume.ends();
        let mut ways = [0..=0, 0..=0, 0..=0];
        for (axis, period) in self.periods.iter() {
            let first = (lo[axis] - self.reach[axis]) / period - RANGE_ERROR;
            let last = (hi[axis] + self.reach[axis]) / period + RANGE_ERROR;
            ways[axis] = first.ceil() as i32..=last.floor() as i32;
        }
        ways
    }
}

/// A volume that contains another one moved back by whole periods.
fn moved<'a>(volume: &QueryVolume<'a>, way: [i32; 3], periods: &Periods) -> QueryVolume<'a> {
    let back = |at: [f64; 3]| periods.moved(at, way.map(|n| -n));
    match *volume {
        QueryVolume::Box { min, max } => {
            let ((min, below), (max, above)) = (back(min), back(max));
            QueryVolume::Box {
                min: [0, 1, 2].map(|axis| outward(min[axis], -below[axis])),
                max: [0, 1, 2].map(|axis| outward(max[axis], above[axis])),
            }
        }
        QueryVolume::Ball { centre, radius } => {
            let (centre, errors) = back(centre);
            let radius = outward(radius, distance(errors));
            QueryVolume::Ball { centre, radius }
        }
        QueryVolume::Shape { shape, rotation, translation, margin } => {
            let (translation, errors) = back(translation);
            QueryVolume::Shape {
                shape,
                rotation,
                translation,
                margin: margin_about(margin, errors),
            }
        }
    }
}

/// An end or a length moved outward by an error, and by the rounding of that sum.
fn outward(x: f64, error: f64) -> f64 {
    if error > 0.0 {
        (x + error).next_up()
    } else if error < 0.0 {
        (x + error).next_down()
    } else {
        x
    }
}
