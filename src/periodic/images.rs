//! The images of bodies: what a world has to know in order to hold them.

use std::fmt::Debug;

use super::PeriodicError;
use super::periods::Periods;
use crate::query::QueryVolume;
use crate::world::{BodyId, WorldError, WorldPairs};

/// Where a body is within one period of each periodic axis, −½ to ½ of it about the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// By how many periods the body is moved to where its middle is within the period.
    pub shift: [i32; 3],
    /// The ends of the moved body along the periodic axes, and a little more.
    pub lo: [f64; 3],
    pub hi: [f64; 3],
    /// Whether its volumes can touch those of another small body in one image at most.
    pub is_small: bool,
}

/// A body as the user has given it, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedBody<B> {
    pub body: B,
    pub place: Placement,
}

/// What is in a slot of the world.
#[derive(Clone, Copy, Debug)]
pub struct Image {
    pub of: BodyId,
    /// One bit per axis along which the body is moved by one period more than to its place.
    pub axes: u8,
    /// The axes along which a body, in its own slot, has images across the border.
    pub across: u8,
    /// By how many periods the body is moved.
    pub shift: [i32; 3],
    pub is_small: bool,
}

impl Image {
    pub fn new(of: BodyId, axes: u8, place: &Placement) -> Self {
        let shift = [0, 1, 2].map(|axis| place.shift[axis] + i32::from(axes >> axis & 1));
        Self { of, axes, across: 0, shift, is_small: place.is_small }
    }
}

/// A world that can hold the images of bodies: [`World`](crate::World) or
/// [`BoxWorld`](crate::BoxWorld).
pub trait ImageWorld: sealed::Sealed {
    /// A body as the user gives it, anywhere.
    type Body: Copy + Debug + PartialEq + Sync;

    /// Whether pairs are decided exactly, so that they don't depend on the period in which a body
    /// is held.
    #[doc(hidden)]
    const IS_EXACT: bool;

    /// Checks a body and finds its place.
    #[doc(hidden)]
    fn place(
        &self,
        slot: usize,
        body: &Self::Body,
        periods: &Periods,
    ) -> Result<Placement, PeriodicError>;

    /// Adds the image of a body that is moved by whole periods and has a place.
    #[doc(hidden)]
    fn add_image(
        &mut self,
        body: &Self::Body,
        shift: [i32; 3],
        periods: &Periods,
    ) -> Result<BodyId, WorldError>;

    /// Changes the image of a body, which has a place.
    #[doc(hidden)]
    fn set_image(&mut self, id: BodyId, body: &Self::Body, shift: [i32; 3], periods: &Periods);

    #[doc(hidden)]
    fn remove_image(&mut self, id: BodyId) -> Result<(), WorldError>;

    #[doc(hidden)]
    fn cull_images(&mut self, limit: Option<usize>) -> Result<WorldPairs<'_>, WorldError>;

    /// Whether a reported pair may touch, the second body moved by whole periods. It is true for at
    /// most one such number. Two small bodies need not be asked about.
    #[doc(hidden)]
    fn may_touch(
        periods: &Periods,
        a: &PlacedBody<Self::Body>,
        b: &PlacedBody<Self::Body>,
        image: [i32; 3],
    ) -> bool;

    /// Whether a body that an index has found may touch a volume, moved by this number of periods.
    #[doc(hidden)]
    fn may_touch_volume(
        _periods: &Periods,
        _body: &PlacedBody<Self::Body>,
        _image: [i32; 3],
        _volume: &QueryVolume<'_>,
    ) -> bool {
        true
    }

    #[doc(hidden)]
    fn has_image(&self, id: BodyId) -> bool;

    #[doc(hidden)]
    fn next_image_slot(&self) -> usize;

    #[doc(hidden)]
    fn set_excluded(&mut self, pair: [BodyId; 2], is_excluded: bool) -> Result<bool, WorldError>;

    #[doc(hidden)]
    fn has_excluded(&self, pair: [BodyId; 2]) -> bool;
}

/// The methods of [`ImageWorld`] that a world has under other names. Images are what it gets from
/// `image`.
macro_rules! forward_images {
    ($body:ty, $image:expr) => {
        fn add_image(
            &mut self,
            body: &$body,
            shift: [i32; 3],
            periods: &Periods,
        ) -> Result<BodyId, WorldError> {
            self.insert($image(body, shift, periods))
        }

        #[inline]
        fn set_image(&mut self, id: BodyId, body: &$body, shift: [i32; 3], periods: &Periods) {
            self.set_checked(id, $image(body, shift, periods));
        }

        fn remove_image(&mut self, id: BodyId) -> Result<(), WorldError> {
            self.remove(id)
        }

        fn cull_images(&mut self, limit: Option<usize>) -> Result<WorldPairs<'_>, WorldError> {
            match limit {
                Some(limit) => self.cull_up_to(limit),
                None => self.cull(),
            }
        }

        #[inline]
        fn has_image(&self, id: BodyId) -> bool {
            self.contains(id)
        }

        fn next_image_slot(&self) -> usize {
            self.next_slot()
        }

        fn set_excluded(
            &mut self,
            [a, b]: [BodyId; 2],
            is_excluded: bool,
        ) -> Result<bool, WorldError> {
            if is_excluded { self.exclude(a, b) } else { self.include(a, b) }
        }

        fn has_excluded(&self, [a, b]: [BodyId; 2]) -> bool {
            self.is_excluded(a, b)
        }
    };
}
pub(super) use forward_images;

pub(super) mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::boxes::BoxWorld {}
    #[cfg(feature = "shapes")]
    impl Sealed for crate::world::World {}
}
