//! The images of bodies: what a world has to know in order to hold them.

use std::fmt::Debug;

use super::PeriodicError;
use super::periods::Periods;
use crate::living::{BodyId, LivingSet, VolumeSource};
use crate::query::QueryVolume;

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

/// Volumes of which a set can hold images: [`Boxes`](crate::boxes::Boxes) or `Meshes`.
#[doc(hidden)]
pub trait ImageSource: VolumeSource {
    /// A body as the user gives it, anywhere.
    type UserBody: Copy + Debug + PartialEq + Sync;

    /// Whether pairs are decided exactly, so that they don't depend on the period in which a body
    /// is held.
    const IS_EXACT: bool;

    /// Checks a body and finds its place.
    fn place(
        set: &LivingSet<Self>,
        slot: usize,
        body: &Self::UserBody,
        periods: &Periods,
    ) -> Result<Placement, PeriodicError>;

    /// The image of a body that is moved by whole periods and has a place.
    fn image(body: &Self::UserBody, shift: [i32; 3], periods: &Periods) -> Self::Body;

    /// Whether a reported pair may touch, the second body moved by whole periods. It is true for at
    /// most one such number. Two small bodies need not be asked about.
    fn may_touch(
        periods: &Periods,
        a: &PlacedBody<Self::UserBody>,
        b: &PlacedBody<Self::UserBody>,
        image: [i32; 3],
    ) -> bool;

    /// Whether a body that an index has found may touch a volume, moved by this number of periods.
    fn may_touch_volume(
        _periods: &Periods,
        _body: &PlacedBody<Self::UserBody>,
        _image: [i32; 3],
        _volume: &QueryVolume<'_>,
    ) -> bool {
        true
    }
}
