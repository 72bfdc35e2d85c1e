//! Replaces `posed` without the feature `shapes`: all bodies are boxes, and these
//! types have no values.

use crate::bodies::contract::ContractError;
use crate::bodies::{Aabb, LineTrack};

/// A shape, of which there are none without the feature `shapes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryShape {}

impl QueryShape {
    pub(crate) fn reach(&self) -> f64 {
        match *self {}
    }

    pub(crate) fn radius_about_pose(&self) -> f64 {
        match *self {}
    }

    pub(crate) fn check_pose(
        &self,
        _: usize,
        _: [f32; 4],
        _: [f64; 3],
    ) -> Result<(), ContractError> {
        match *self {}
    }

    pub(crate) fn at(&self, _: [f32; 4], _: [f64; 3], _: f32) -> PosedShape<'_> {
        match *self {}
    }
}

#[derive(Clone, Debug)]
pub(crate) enum PosedBodies {}

impl PosedBodies {
    pub fn shorten(&mut self, _: usize) {
        match *self {}
    }

    pub fn at(&self, _: usize) -> Option<PosedShape<'_>> {
        match *self {}
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct PosedShape<'a>(&'a QueryShape);

impl PosedShape<'_> {
    pub fn bounds(&self, _: [f64; 3]) -> Aabb {
        match *self.0 {}
    }

    pub fn may_touch_ball(&self, _: [f64; 3], _: f64) -> bool {
        match *self.0 {}
    }

    pub fn may_touch_box(&self, _: [f64; 3], _: [f64; 3]) -> bool {
        match *self.0 {}
    }

    pub fn may_touch(&self, _: &Self) -> bool {
        match *self.0 {}
    }

    pub fn crossed_by(&self, _: &LineTrack) -> Option<f64> {
        match *self.0 {}
    }
}
