//! The common interface of the long-lived worlds: what a history does to them.

use super::{ChangeKind, HistoryError};
use sdop::boxes::{BoxBody, BoxWorld, BoxWorldSnapshot};
use sdop::compound::PartCuller;
use sdop::periodic::{ImageSource, Periodic, PeriodicBox, PeriodicPair};
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
    /// Does what changes no pair, if it can. Whether what it was told then is right.
    fn detour(&mut self, kind: ChangeKind) -> Result<bool, HistoryError>;
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

        fn detour(&mut self, kind: ChangeKind) -> Result<bool, HistoryError> {
            match kind {
                ChangeKind::Cloned => *self = self.clone(),
                ChangeKind::Shrunk => self.shrink_to_fit(),
                _ => {
                    let mut portions = Vec::new();
                    let told = self.cull_in_portions(|portion| portions.extend(portion))?;
                    portions.sort_unstable();
                    let is_all = told == portions.len() as u64 && self.pairs().len() == 0;
                    let is_listed = self.cull_up_to(portions.len())?.sorted() == portions;
                    let less = portions.len().checked_sub(1);
                    let is_beyond = less.is_none_or(|less| self.cull_up_to(less).is_err());
                    return Ok(is_all && is_listed && is_beyond);
                }
            }
            Ok(true)
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

impl<V: ImageSource> JudgedWorld for Periodic<V>
where
    V::UserBody: Properties,
{
    forwarded!(V::UserBody);

    type Saved = Self;

    fn change(&mut self, id: BodyId, _: V::UserBody, to: V::UserBody) -> Result<(), HistoryError> {
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

    fn all(&self) -> Vec<(BodyId, V::UserBody)> {
        self.ids().filter_map(|id| Some((id, self.body(id).ok()?))).collect()
    }

    fn save(&self) -> Self {
        self.clone()
    }

    fn restore(&mut self, saved: &Self) -> Result<(), HistoryError> {
        *self = saved.clone();
        Ok(())
    }

    fn detour(&mut self, _: ChangeKind) -> Result<bool, HistoryError> {
        *self = self.clone();
        Ok(true)
    }
}

/// A world that goes on as another one does, but lists pairs in its own way and has no events.
pub trait Listing {
    /// The other one.
    type World: JudgedWorld;
    /// The other one.
    fn world(&self) -> &Self::World;
    /// The other one.
    fn world_mut(&mut self) -> &mut Self::World;
    /// Finds the pairs.
    fn list(&mut self) -> Result<Vec<ReportedPair>, HistoryError>;
}

impl<L: Listing> JudgedWorld for L {
    type Body = <L::World as JudgedWorld>::Body;
    type Saved = <L::World as JudgedWorld>::Saved;

    fn insert(&mut self, body: Self::Body) -> Result<BodyId, HistoryError> {
        self.world_mut().insert(body)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        self.world_mut().remove(id)
    }

    fn change(&mut self, id: BodyId, from: Self::Body, to: Self::Body) -> Result<(), HistoryError> {
        self.world_mut().change(id, from, to)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError> {
        self.world_mut().exclude(pair, excluded)
    }

    fn interest(&mut self, ids: &[BodyId]) -> Result<(), HistoryError> {
        self.world_mut().interest(ids)
    }

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        self.list()
    }

    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
        None
    }

    fn all(&self) -> Vec<(BodyId, Self::Body)> {
        self.world().all()
    }

    fn save(&self) -> Self::Saved {
        self.world().save()
    }

    fn restore(&mut self, saved: &Self::Saved) -> Result<(), HistoryError> {
        self.world_mut().restore(saved)
    }

    fn detour(&mut self, kind: ChangeKind) -> Result<bool, HistoryError> {
        self.world_mut().detour(kind)
    }
}

/// A world of compounds with a culler of their parts, which has followed it from the start. Events
/// are of the world's pairs, of which some may have no pairs of parts.
pub struct CompoundWorld {
    pub world: World,
    pub parts: PartCuller,
}

impl Listing for CompoundWorld {
    type World = World;

    fn world(&self) -> &World {
        &self.world
    }

    fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The pairs of parts, each pair of bodies before those of its parts.
    fn list(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
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
}
