//! The common interface of both long-lived worlds: what a history does to them.

use sdop::boxes::{BoxBody, BoxWorld};
use sdop::world::{Body, BodyId, Events, World, WorldError};
use sdop::{Groups, Motion};

/// A body's properties that both worlds have.
pub trait Properties: Copy + PartialEq {
    /// Whether it is dynamic, resting or fixed.
    fn motion(&mut self) -> &mut Motion;
    /// Which bodies it may collide with.
    fn groups(&mut self) -> &mut Groups;
}

impl Properties for BoxBody {
    fn motion(&mut self) -> &mut Motion {
        &mut self.motion
    }

    fn groups(&mut self) -> &mut Groups {
        &mut self.groups
    }
}

impl Properties for Body {
    fn motion(&mut self) -> &mut Motion {
        &mut self.motion
    }

    fn groups(&mut self) -> &mut Groups {
        &mut self.groups
    }
}

/// A world that is judged.
pub trait JudgedWorld {
    /// What it holds.
    type Body: Properties;

    /// Adds a body.
    fn insert(&mut self, body: Self::Body) -> Result<BodyId, WorldError>;
    /// Removes a body.
    fn remove(&mut self, id: BodyId) -> Result<(), WorldError>;
    /// Changes a body by the narrowest call that does it.
    fn change(&mut self, id: BodyId, from: Self::Body, to: Self::Body) -> Result<(), WorldError>;
    /// Excludes two bodies, or includes them again.
    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<(), WorldError>;
    /// Sets the bodies of interest, where it has some.
    fn interest(&mut self, ids: &[BodyId]) -> Result<(), WorldError>;
    /// Finds the pairs.
    fn cull(&mut self) -> Result<Vec<[BodyId; 2]>, WorldError>;
    /// What has begun and ended.
    fn events(&mut self) -> Events;
}

/// The calls that both worlds have alike.
macro_rules! forwarded {
    ($body:ty) => {
        type Body = $body;

        fn insert(&mut self, body: $body) -> Result<BodyId, WorldError> {
            self.insert(body)
        }

        fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
            self.remove(id)
        }

        fn exclude(&mut self, [a, b]: [BodyId; 2], excluded: bool) -> Result<(), WorldError> {
            let changed = if excluded {
                self.exclude(a, b)
            } else {
                self.include(a, b)
            };
            changed.map(|_| ())
        }

        fn cull(&mut self) -> Result<Vec<[BodyId; 2]>, WorldError> {
            Ok(self.cull()?.iter().collect())
        }

        fn events(&mut self) -> Events {
            self.events()
        }
    };
}

impl JudgedWorld for BoxWorld {
    forwarded!(BoxBody);

    fn change(&mut self, id: BodyId, from: BoxBody, to: BoxBody) -> Result<(), WorldError> {
        let moved = BoxBody {
            bounds: to.bounds,
            ..from
        };
        let rested = BoxBody {
            motion: to.motion,
            ..from
        };
        match to {
            to if to == moved => self.set_bounds(id, to.bounds),
            to if to == rested => self.set_motion(id, to.motion),
            to => self.set(id, to),
        }
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), WorldError> {
        Ok(())
    }
}

impl JudgedWorld for World {
    forwarded!(Body);

    fn change(&mut self, id: BodyId, from: Body, to: Body) -> Result<(), WorldError> {
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
            to if to == moved => self.set_pose(id, to.rotation, to.translation),
            to if to == rested => self.set_motion(id, to.motion),
            to => self.set(id, to),
        }
    }

    fn interest(&mut self, ids: &[BodyId]) -> Result<(), WorldError> {
        self.set_interest(ids)
    }
}
