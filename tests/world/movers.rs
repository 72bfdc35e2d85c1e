//! Worlds in which few bodies change per frame: whatever the history, pairs and events are those of
//! a newly built world.

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sdop::culler::Culler;
use sdop::settings::{CullSettings, Finder, Overlap, Strategy};
use sdop::volume::Shape;
use sdop::world::{Body, BodyId, Groups, Motion, World, WorldSnapshot};

use super::{Pairs, Random, afresh, shapes, ways};

/// Where bodies are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Places {
    /// At multiples of a half, so that many touch to the bit.
    Halves,
    /// Anywhere near the origin, in f64.
    Near,
    /// Far from the origin, which follows them.
    Far,
    /// In two regions, and now and then in a third.
    Apart,
}

const PLACES: [Places; 4] = [Places::Halves, Places::Near, Places::Far, Places::Apart];

impl Places {
    fn draw(self, random: &mut Random) -> [f64; 3] {
        let base = match self {
            Self::Halves => {
                return [(); 3].map(|()| f64::from(random.below(12)) * 0.5 - 3.0);
            }
            Self::Near => 0.0,
            Self::Far => 1.0e9,
            Self::Apart => {
                [0.0, 1.0e9, 1.0e9, 0.0, 0.0, 0.0, 0.0, -1.0e12][random.below(8) as usize]
            }
        };
        // Now and then one that moves the middle of all.
        let wide = if random.below(12) == 0 { 30.0 } else { 4.0 };
        [(); 3].map(|()| base + wide * f64::from(random.unit()) + 0.1)
    }
}

/// A world, what it should hold, and what events should be read against.
struct History {
    shapes: Vec<Shape>,
    way: CullSettings,
    places: Places,
    world: World,
    bodies: BTreeMap<BodyId, Body>,
    interest: Vec<BodyId>,
    watched: Pairs,
    random: Random,
}

pub(super) fn world_of(shapes: &[Shape], way: &CullSettings) -> World {
    World::with(shapes.to_vec(), &Culler::builder().settings(way)).unwrap()
}

impl History {
    fn new(way: &CullSettings, places: Places, seed: u64, count: usize) -> Self {
        let shapes = shapes();
        let mut history = Self {
            world: world_of(&shapes, way),
            shapes,
            way: way.clone(),
            places,
            bodies: BTreeMap::new(),
            interest: Vec::new(),
            watched: Pairs::new(),
            random: Random(ChaCha8Rng::seed_from_u64(seed)),
        };
        for _ in 0..count {
            let body = history.drawn();
            history.insert(body);
        }
        history
    }

    fn drawn(&mut self) -> Body {
        let random = &mut self.random;
        let motion = [Motion::Dynamic, Motion::Resting, Motion::Fixed][random.below(3) as usize];
        let turned = self.places != Places::Halves || random.below(4) == 0;
        let body = random.body(3);
        Body {
            motion,
            translation: self.places.draw(random),
            rotation: if turned { body.rotation } else { Body::default().rotation },
            margin: [0.0, 0.0, 0.1, 0.25][random.below(4) as usize],
            groups: if random.below(3) == 0 { body.groups } else { Groups::ALL },
            ..body
        }
    }

    fn insert(&mut self, body: Body) {
        let id = self.world.insert(body).unwrap();
        assert!(self.bodies.insert(id, body).is_none());
    }

    /// Changes one body in one way, lets one come or go, or changes what is of interest or a shape.
    fn change(&mut self) {
        let drawn = self.drawn();
        let ids: Vec<BodyId> = self.bodies.keys().copied().collect();
        let id = ids[self.random.below(ids.len() as u32) as usize];
        let other = ids[self.random.below(ids.len() as u32) as usize];
        let mut body = self.bodies[&id];
        match self.random.below(16) {
            0 => return self.insert(drawn),
            1 if ids.len() > 30 => {
                self.world.remove(id).unwrap();
                self.bodies.remove(&id);
                self.interest.retain(|&of_interest| of_interest != id);
                return;
            }
            2 => body.groups = drawn.groups,
            3 | 4 => body.motion = drawn.motion,
            5 => body.margin = drawn.margin,
            6 => body.shape = drawn.shape,
            7 => body.translation = self.bodies[&other].translation,
            8 => body = drawn,
            9 => {} // the same body again
            10 if self.random.below(3) == 0 => return self.replace_shape(drawn.shape),
            11 => {
                self.interest = vec![id, other];
                return self.world.set_interest(&[id, other]).unwrap();
            }
            12 => body.rotation = drawn.rotation,
            13 | 14 => body.translation[0] += f64::from(self.random.unit()),
            _ => body.translation = drawn.translation,
        }
        let former = self.bodies.insert(id, body).unwrap();
        let with_motion = Body { motion: body.motion, ..former };
        let (rotation, translation) = (body.rotation, body.translation);
        if (Body { rotation, translation, ..former }) == body {
            self.world.set_pose(id, rotation, translation).unwrap();
        } else if with_motion == body {
            self.world.set_motion(id, body.motion).unwrap();
        } else {
            self.world.set(id, body).unwrap();
        }
        assert_eq!(self.world.body(id).unwrap(), body);
    }

    fn replace_shape(&mut self, number: u32) {
        let mut shape = shapes().swap_remove(self.random.below(3) as usize);
        shape.name = "another".to_owned();
        self.world.replace_shape(number, &shape).unwrap();
        self.shapes[number as usize] = shape;
    }

    /// The pairs of a new world with the same bodies, and of a new culler where it can have them.
    fn wanted(&self) -> Pairs {
        let mut fresh = world_of(&self.shapes, &self.way);
        let old: Vec<BodyId> = self.bodies.keys().copied().collect();
        let new: Vec<BodyId> =
            (self.bodies.values()).map(|&body| fresh.insert(body).unwrap()).collect();
        let number = |id: &BodyId| old.binary_search(id).unwrap();
        let interest: Vec<BodyId> = self.interest.iter().map(|id| new[number(id)]).collect();
        fresh.set_interest(&interest).unwrap();
        let pairs = fresh.cull().unwrap();
        let wanted: Pairs = (pairs.iter())
            .map(|pair| pair.map(|id| old[new.binary_search(&id).unwrap()]))
            .collect();
        let is_plain = self.places == Places::Halves
            && self.interest.is_empty()
            && self.way.strategy != Strategy::SDopTimeCritical
            && self.bodies.values().all(|body| body.margin == 0.0);
        if is_plain {
            let bodies = self.bodies.clone().into_iter().collect();
            assert_eq!(wanted, afresh(&self.shapes, &self.way, &bodies));
        }
        wanted
    }

    fn assert_exact(&mut self, reads_events: bool, frame: usize) {
        let what = format!("{:?}, {:?}, frame {frame}", self.way, self.places);
        self.world.cull().unwrap();
        let wanted = self.wanted();
        let listed: Vec<[BodyId; 2]> = self.world.pairs().collect();
        assert!(
            listed.iter().eq(&wanted),
            "{what}: {:?}",
            wanted.symmetric_difference(&listed.iter().copied().collect())
        );
        assert_eq!(self.world.pairs().len(), wanted.len(), "{what}");
        if reads_events {
            let (events, before) = (self.world.events(), &self.watched);
            let [begun, ended] = [wanted.difference(before), before.difference(&wanted)];
            assert!(events.begun().eq(begun.copied()), "{what}");
            assert!(events.ended().eq(ended.copied()), "{what}");
            let lasting = wanted.intersection(before).copied();
            assert!(events.persisting().eq(lasting), "{what}");
            assert_eq!(events.iter().count(), wanted.union(before).count());
            self.watched = wanted;
        }
    }

    /// Frames of few changes each; now and then of none, and of many. `before_frame` may put
    /// another world in the place of this one, if it makes no difference.
    fn live(&mut self, frames: usize, mut before_frame: impl FnMut(&mut Self, usize)) -> usize {
        let mut pairs = 0;
        for frame in 0..frames {
            before_frame(self, frame);
            let changes = match self.random.below(24) {
                0 => 30,
                calls => calls % 5,
            };
            (0..changes).for_each(|_| self.change());
            let reads_events = self.random.below(3) > 0;
            self.assert_exact(reads_events, frame);
            pairs += self.world.pairs().len();
        }
        pairs
    }
}

#[test]
fn few_movers_leave_exact_pairs() {
    for (number, way) in ways().iter().enumerate() {
        let places = PLACES[number % 4];
        let pairs = History::new(way, places, number as u64, 60).live(40, |_, _| ());
        assert!(pairs > 400 || way.strategy == Strategy::None, "{way:?}: {pairs}");
    }
    for (seed, places) in (100..).zip(PLACES) {
        for (strategy, overlap) in [
            (Strategy::SDopSequential, Overlap::OneSided),
            (Strategy::SDopObjectOfInterest, Overlap::Full),
        ] {
            let way = CullSettings { strategy, overlap, ..CullSettings::default() };
            History::new(&way, places, seed, 120).live(150, |_, _| ());
        }
    }
}

fn through_text(world: &World) -> WorldSnapshot {
    let text = serde_json::to_string(&world.snapshot()).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Clones, worlds restored by another finder, worlds that have given their memory back, and those
/// that were culled otherwise.
#[test]
fn few_movers_in_random_histories() {
    for (seed, places) in (200..).zip(PLACES) {
        for strategy in [Strategy::SDopBatch, Strategy::KDop, Strategy::SDopObjectOfInterest] {
            let way = CullSettings { strategy, ..CullSettings::default() };
            History::new(&way, places, seed, 80).live(120, |history, frame| {
                let world = &mut history.world;
                match frame % 9 {
                    1 => *world = world.clone(),
                    3 => {
                        let saved = through_text(world);
                        let pairs = Finder::ALL[frame % Finder::ALL.len()];
                        let other = CullSettings { pairs, ..history.way.clone() };
                        let mut other = world_of(&history.shapes, &other);
                        other.restore(&saved).unwrap();
                        assert_eq!(other.snapshot(), saved);
                        *world = other;
                    }
                    5 => world.shrink_to_fit(),
                    6 => drop(world.cull_in_portions(|_| ())),
                    8 => drop(world.cull_up_to(frame).map(|pairs| pairs.len())),
                    _ => {}
                }
            });
        }
    }
}
