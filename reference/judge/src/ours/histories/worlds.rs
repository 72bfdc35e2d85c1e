//! The common interface of the long-lived worlds: what a history does to them.

use super::HistoryError;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::compound::PartCuller;
use sdop::periodic::{ImageWorld, Periodic, PeriodicBox};
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

/// A pair as a world reports it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ReportedPair {
    /// The bodies.
    pub bodies: [BodyId; 2],
    /// A part of each; `None` is the pair of the bodies.
    pub parts: Option<[u32; 2]>,
    /// The number of periods by which the second body is moved.
    pub image: [i32; 3],
}

impl ReportedPair {
    /// Two bodies, or two parts of them, where space does not repeat.
    pub fn of(bodies: [BodyId; 2], parts: Option<[u32; 2]>) -> Self {
        let image = [0; 3];
        Self { bodies, parts, image }
    }
}

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
    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError>;
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
        fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
            let pairs = self.cull()?.iter();
            Ok(pairs.map(|bodies| ReportedPair::of(bodies, None)).collect())
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
        let moved = BoxBody { bounds: to.bounds, ..from };
        let rested = BoxBody { motion: to.motion, ..from };
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
        let moved = Body { rotation: to.rotation, translation: to.translation, ..from };
        let rested = Body { motion: to.motion, ..from };
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

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        let pairs = self.cull()?.iter().map(|pair| ReportedPair {
            bodies: pair.bodies,
            parts: None,
            image: pair.image,
        });
        Ok(pairs.collect())
    }

    fn events(&mut self) -> Option<Events> {
        None
    }
}

/// A world of compounds with a culler of their parts, which has followed it from the start.
pub struct CompoundWorld {
    pub world: World,
    pub parts: PartCuller,
}

impl JudgedWorld for CompoundWorld {
    type Body = Body;

    fn insert(&mut self, body: Body) -> Result<BodyId, HistoryError> {
        JudgedWorld::insert(&mut self.world, body)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        JudgedWorld::remove(&mut self.world, id)
    }

    fn change(&mut self, id: BodyId, from: Body, to: Body) -> Result<(), HistoryError> {
        self.world.change(id, from, to)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<(), HistoryError> {
        JudgedWorld::exclude(&mut self.world, pair, excluded)
    }

    fn interest(&mut self, ids: &[BodyId]) -> Result<(), HistoryError> {
        self.world.interest(ids)
    }

    /// The pairs of parts, each pair of bodies before those of its parts.
    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        self.world.cull()?;
        self.parts.cull(&self.world)?;
        let mut listed: Vec<ReportedPair> = Vec::new();
        let mut bodies = self.parts.body_pairs();
        for pair in self.parts.pairs() {
            if listed.last().is_none_or(|last| last.bodies != pair.bodies) {
                listed.extend(bodies.next().map(|ids| ReportedPair::of(ids, None)));
            }
            listed.push(ReportedPair::of(pair.bodies, Some(pair.parts)));
        }
        listed.extend(bodies.map(|ids| ReportedPair::of(ids, None)));
        Ok(listed)
    }

    /// Events are of the world's pairs, of which some may have no pairs of parts.
    fn events(&mut self) -> Option<Events> {
        None
    }
}
