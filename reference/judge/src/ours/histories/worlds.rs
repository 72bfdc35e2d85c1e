//! The common interface of the long-lived worlds: what a history does to them.

use super::HistoryError;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::periodic::{ImageWorld, Periodic, PeriodicBox, PeriodicPair};
use sdop::world::{Body, BodyId, Events, World};
use sdop::{Groups, Motion};

/// A body's properties that all worlds have.
pub trait Properties: Copy + PartialEq {
    /// Whether it is dynamic, resting or fixed.
    fn motion(&mut self) -> &mut Motion;
    /// Which bodies it may collide with.
    fn groups(&mut self) -> &mut Groups;
}

macro_rules! properties {
    ($($body:ty),+) => {
        $(impl Properties for $body {
            fn motion(&mut self) -> &mut Motion {
                &mut self.motion
            }

            fn groups(&mut self) -> &mut Groups {
                &mut self.groups
            }
        })+
    };
}
properties!(Body, BoxBody, PeriodicBox);

/// A world that is judged.
pub trait JudgedWorld {
    /// What it holds.
    type Body: Properties;

    /// Adds a body.
    fn insert(&mut self, body: Self::Body) -> Result<BodyId, HistoryError>;
    /// Removes a body.
    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError>;
    /// Changes a body by the narrowest call that does it.
    fn change(&mut self, id: BodyId, from: Self::Body, to: Self::Body) -> Result<(), HistoryError>;
    /// Excludes two bodies, or includes them again.
    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<(), HistoryError>;
    /// Sets the bodies of interest, where it has some.
    fn interest(&mut self, ids: &[BodyId]) -> Result<(), HistoryError>;
    /// Finds the pairs. No body is moved where space does not repeat.
    fn cull(&mut self) -> Result<Vec<PeriodicPair>, HistoryError>;
    /// What has begun and ended, where the world has events.
    fn events(&mut self) -> Option<Events>;
}

/// The calls that all worlds have alike.
macro_rules! forwarded {
    ($body:ty) => {
        type Body = $body;

        fn insert(&mut self, body: $body) -> Result<BodyId, HistoryError> {
            Ok(self.insert(body)?)
        }

        fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
            Ok(self.remove(id)?)
        }

        fn exclude(&mut self, [a, b]: [BodyId; 2], excluded: bool) -> Result<(), HistoryError> {
            if excluded {
                self.exclude(a, b)?;
            } else {
                self.include(a, b)?;
            }
            Ok(())
        }
    };
}

/// The calls that worlds without periods have alike.
macro_rules! unrepeated {
    () => {
        fn cull(&mut self) -> Result<Vec<PeriodicPair>, HistoryError> {
            let image = [0; 3];
            let pairs = self.cull()?.iter();
            Ok(pairs.map(|bodies| PeriodicPair { bodies, image }).collect())
        }

        fn events(&mut self) -> Option<Events> {
            Some(self.events())
        }
    };
}

impl JudgedWorld for BoxWorld {
    forwarded!(BoxBody);
    unrepeated!();

    fn change(&mut self, id: BodyId, from: BoxBody, to: BoxBody) -> Result<(), HistoryError> {
        let moved = BoxBody {
            bounds: to.bounds,
            ..from
        };
        let rested = BoxBody {
            motion: to.motion,
            ..from
        };
        match to {
            to if to == moved => self.set_bounds(id, to.bounds)?,
            to if to == rested => self.set_motion(id, to.motion)?,
            to => self.set(id, to)?,
        }
        Ok(())
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }
}

impl JudgedWorld for World {
    forwarded!(Body);
    unrepeated!();

    fn change(&mut self, id: BodyId, from: Body, to: Body) -> Result<(), HistoryError> {
        let moved = Body {
            rotation: to.rotation,
            translation: to.translation,
            ..from
        };
        let rested = Body {
            motion: to.motion,
            ..from
        };
        match to {
            to if to == moved => self.set_pose(id, to.rotation, to.translation)?,
            to if to == rested => self.set_motion(id, to.motion)?,
            to => self.set(id, to)?,
        }
        Ok(())
    }

    fn interest(&mut self, ids: &[BodyId]) -> Result<(), HistoryError> {
        Ok(self.set_interest(ids)?)
    }
}

impl<W: ImageWorld> JudgedWorld for Periodic<W>
where
    W::Body: Properties,
{
    forwarded!(W::Body);

    fn change(&mut self, id: BodyId, _: W::Body, to: W::Body) -> Result<(), HistoryError> {
        Ok(self.set(id, to)?)
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }

    fn cull(&mut self) -> Result<Vec<PeriodicPair>, HistoryError> {
        Ok(self.cull()?.to_vec())
    }

    fn events(&mut self) -> Option<Events> {
        None
    }
}
