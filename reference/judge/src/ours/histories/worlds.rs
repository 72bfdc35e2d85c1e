//! The common interface of the long-lived worlds: what a history does to them.

use super::{ChangeKind, HistoryError};
use sdop::boxes::{BoxBody, BoxWorld, BoxWorldSnapshot};
use sdop::compound::PartCuller;
use sdop::periodic::{ImageWorld, Periodic, PeriodicBox, PeriodicPair};
use sdop::world::{Body, BodyId, World, WorldSnapshot};
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

impl From<&PeriodicPair> for ReportedPair {
    fn from(pair: &PeriodicPair) -> Self {
        Self { bodies: pair.bodies, parts: None, image: pair.image }
    }
}

/// A world that is judged.
pub trait JudgedWorld {
    /// What it holds.
    type Body: Properties;
    /// A state of it.
    type Saved;

    /// Adds a body.
    fn insert(&mut self, body: Self::Body) -> Result<BodyId, HistoryError>;
    /// Removes a body.
    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError>;
    /// Changes a body by the narrowest call that does it.
    fn change(&mut self, id: BodyId, from: Self::Body, to: Self::Body) -> Result<(), HistoryError>;
    /// Excludes two bodies, or includes them again. Whether that changes anything.
    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError>;
    /// Sets the bodies of interest, where it has some.
    fn interest(&mut self, ids: &[BodyId]) -> Result<(), HistoryError>;
    /// Finds the pairs. No body is moved where space does not repeat.
    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError>;
    /// What has begun, lasts and has ended since the last call, if the world says it.
    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]>;
    /// All bodies, sorted by slot.
    fn all(&self) -> Vec<(BodyId, Self::Body)>;
    /// Its state.
    fn save(&self) -> Self::Saved;
    /// Goes back to a state, of this world or of another.
    fn restore(&mut self, saved: &Self::Saved) -> Result<(), HistoryError>;
    /// Does what changes no pair, if it can.
    fn detour(&mut self, kind: ChangeKind) -> Result<(), HistoryError>;
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

        fn exclude(&mut self, [a, b]: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError> {
            Ok(if excluded { self.exclude(a, b)? } else { self.include(a, b)? })
        }
    };
}

/// The calls that worlds without periods have alike.
macro_rules! unrepeated {
    ($snapshot:ty) => {
        type Saved = $snapshot;

        fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
            let pairs = self.cull()?.iter();
            Ok(pairs.map(|bodies| ReportedPair::of(bodies, None)).collect())
        }

        fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
            let events = self.events();
            let of = |bodies| ReportedPair::of(bodies, None);
            let (begun, lasting) = (events.begun().map(of), events.persisting().map(of));
            Some([begun.collect(), lasting.collect(), events.ended().map(of).collect()])
        }

        fn all(&self) -> Vec<(BodyId, Self::Body)> {
            self.bodies().collect()
        }

        fn save(&self) -> $snapshot {
            self.snapshot()
        }

        fn restore(&mut self, saved: &$snapshot) -> Result<(), HistoryError> {
            Ok(self.restore(saved)?)
        }

        fn detour(&mut self, kind: ChangeKind) -> Result<(), HistoryError> {
            match kind {
                ChangeKind::Cloned => *self = self.clone(),
                ChangeKind::Shrunk => self.shrink_to_fit(),
                _ => {
                    self.cull_in_portions(|_| ())?;
                    drop(self.cull_up_to(3).map(|pairs| pairs.len())); // the limit may be too low
                }
            }
            Ok(())
        }
    };
}

impl JudgedWorld for BoxWorld {
    forwarded!(BoxBody);
    unrepeated!(BoxWorldSnapshot);

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
    unrepeated!(WorldSnapshot);

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

impl<W: ImageWorld + Clone> JudgedWorld for Periodic<W>
where
    W::Body: Properties,
{
    forwarded!(W::Body);

    type Saved = Self;

    fn change(&mut self, id: BodyId, _: W::Body, to: W::Body) -> Result<(), HistoryError> {
        Ok(self.set(id, to)?)
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        Ok(self.cull()?.iter().map(ReportedPair::from).collect())
    }

    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
        let events = self.events();
        let of = |pairs: &[PeriodicPair]| pairs.iter().map(ReportedPair::from).collect();
        Some([events.begun(), events.persisting(), events.ended()].map(of))
    }

    fn all(&self) -> Vec<(BodyId, W::Body)> {
        self.ids().filter_map(|id| Some((id, self.body(id).ok()?))).collect()
    }

    fn save(&self) -> Self {
        self.clone()
    }

    fn restore(&mut self, saved: &Self) -> Result<(), HistoryError> {
        *self = saved.clone();
        Ok(())
    }

    fn detour(&mut self, _: ChangeKind) -> Result<(), HistoryError> {
        *self = self.clone();
        Ok(())
    }
}

/// A world of compounds with a culler of their parts, which has followed it from the start.
pub struct CompoundWorld {
    pub world: World,
    pub parts: PartCuller,
}

impl JudgedWorld for CompoundWorld {
    type Body = Body;
    type Saved = WorldSnapshot;

    fn insert(&mut self, body: Body) -> Result<BodyId, HistoryError> {
        JudgedWorld::insert(&mut self.world, body)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        JudgedWorld::remove(&mut self.world, id)
    }

    fn change(&mut self, id: BodyId, from: Body, to: Body) -> Result<(), HistoryError> {
        self.world.change(id, from, to)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError> {
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
    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
        None
    }

    fn all(&self) -> Vec<(BodyId, Body)> {
        self.world.all()
    }

    fn save(&self) -> WorldSnapshot {
        self.world.save()
    }

    fn restore(&mut self, saved: &WorldSnapshot) -> Result<(), HistoryError> {
        JudgedWorld::restore(&mut self.world, saved)
    }

    fn detour(&mut self, kind: ChangeKind) -> Result<(), HistoryError> {
        self.world.detour(kind)
    }
}
