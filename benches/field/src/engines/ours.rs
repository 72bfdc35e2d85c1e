//! Our cullers as a user has them: boxes for the comparison on equal work, and the meshes' volumes
//! that users cull instead of boxes; long-lived worlds that are given what has changed; an index
//! that is asked.

use std::hint::black_box;

use sdop::boxes::{BoxBody, BoxCuller, BoxWorld};
use sdop::culler::Culler;
use sdop::query::{Answers, LineHit, QueryError};
use sdop::settings::Strategy;
use sdop::world::{Body, BodyId, World};
use sdop::{Aabb, Line, Motion, QueryIndex, QueryVolume};
use sdop_bench::remedy::OrReport as _;
use sdop_judge::contestant::Contestant;

use super::events::Events;
use crate::entry::{New, Setup};
use crate::frame::{Frame, Slabs, lower, upper};
use crate::questions::{Question, Questions, RADIUS, Segment, flat};

/// Boxes; spheres alone; spheres, then or-DOPs. A world of boxes; with bodies that are replaced;
/// with all pairs read; all boxes in each frame; a world of meshes. An index.
pub const ENGINES: [(&str, New); 9] = [
    ("sdop boxes", |setup| Ok(Box::new(AllBoxes::new(setup)?))),
    ("sdop spheres", |setup| Ok(Box::new(Meshes::new(setup, Strategy::Sphere)?))),
    ("sdop s-dop", |setup| Ok(Box::new(Meshes::new(setup, Strategy::SDopSequential)?))),
    ("sdop BoxWorld", |setup| Ok(Box::new(Boxes::new(setup, Use::Events)?))),
    ("sdop BoxWorld, insertion and removal", |setup| {
        Ok(Box::new(Boxes::new(setup, Use::Replacement)?))
    }),
    ("sdop BoxWorld, all pairs read", |setup| Ok(Box::new(Boxes::new(setup, Use::AllPairs)?))),
    ("sdop BoxCuller, all boxes", |setup| Ok(Box::new(AllBoxes::new(setup)?))),
    ("sdop World, s-dop", |setup| Ok(Box::new(MeshWorld::new(setup)?))),
    ("sdop", |setup| Ok(Box::new(Asked::new(setup)?))),
];

/// A culler of given boxes with what it has by default, which compares nothing with the last frame.
struct AllBoxes {
    culler: BoxCuller,
    /// All boxes, if frames have only the changed ones.
    boxes: Vec<Aabb>,
}

impl AllBoxes {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let culler = BoxCuller::builder().threads(setup.threads).build().or_report()?;
        let boxes = if setup.is_sparse { setup.first.corners.clone() } else { Vec::new() };
        Ok(Self { culler, boxes })
    }
}

impl Contestant<Frame> for AllBoxes {
    fn frame(&mut self, frame: &Frame) {
        let boxes = match &frame.changed {
            None => &frame.corners,
            Some(changed) => {
                for (&body, &corners) in changed.iter().zip(&frame.corners) {
                    self.boxes[body as usize] = corners;
                }
                &self.boxes
            }
        };
        let pairs = self.culler.cull(boxes);
        assert!(pairs.is_ok(), "{pairs:?}: frames have boxes");
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.culler.pairs().iter().collect()
    }
}

/// A culler with one strategy, k = 18, two-sided, all volumes updated each frame.
struct Meshes(Culler);

impl Meshes {
    fn new(setup: &Setup<'_>, strategy: Strategy) -> miette::Result<Self> {
        let builder = Culler::builder().strategy(strategy).threads(setup.threads);
        Ok(Self(builder.build(&setup.scene.shapes, &setup.first.bodies).or_report()?))
    }
}

impl Contestant<Frame> for Meshes {
    fn frame(&mut self, frame: &Frame) {
        let pairs = self.0.cull(&frame.bodies);
        assert!(pairs.is_ok(), "{pairs:?}: frames keep their bodies");
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.0.pairs().iter().collect()
    }
}

/// What is timed besides the cull.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Events,
    AllPairs,
    Replacement,
}

/// Reads what has begun and ended.
fn read(events: &sdop::world::Events, body_of: &[u32], read: &mut Events) {
    let numbers = |pair: [BodyId; 2]| pair.map(|id| body_of[id.slot()]);
    read.last.clear();
    read.last.extend(events.ended().map(|pair| (numbers(pair), false)));
    read.last.extend(events.begun().map(|pair| (numbers(pair), true)));
}

struct Boxes {
    world: BoxWorld,
    ids: Vec<BodyId>,
    /// The ids of the bodies that the frame moves.
    moved: Vec<BodyId>,
    body_of: Vec<u32>,
    events: Events,
    purpose: Use,
}

impl Boxes {
    fn new(setup: &Setup<'_>, purpose: Use) -> miette::Result<Self> {
        let mut world = BoxWorld::with(&BoxCuller::builder().threads(setup.threads)).or_report()?;
        let ids = setup.first.corners.iter();
        let ids = ids.map(|&corners| world.insert(corners).or_report());
        let ids = ids.collect::<miette::Result<Vec<_>>>()?;
        let mut boxes = Self {
            world,
            body_of: (0..ids.len() as u32).collect(),
            ids,
            moved: Vec::new(),
            events: Events::default(),
            purpose,
        };
        boxes.cull();
        Ok(boxes)
    }

    fn cull(&mut self) {
        let pairs = self.world.cull();
        assert!(pairs.is_ok(), "{pairs:?}: the world has boxes");
        read(&self.world.events(), &self.body_of, &mut self.events);
        if self.purpose == Use::AllPairs {
            for pair in self.world.pairs() {
                black_box(pair);
            }
        }
    }

    /// Removes a body and inserts a new one under its number.
    fn replace(&mut self, body: u32, bounds: Aabb) {
        let removed = self.world.remove(self.ids[body as usize]);
        assert!(removed.is_ok(), "{removed:?}: the body is there");
        let id = match self.world.insert(BoxBody::from(bounds)) {
            Ok(id) => id,
            Err(error) => unreachable!("{error}: frames have boxes"),
        };
        self.ids[body as usize] = id;
        if self.body_of.len() <= id.slot() {
            self.body_of.resize(id.slot() + 1, body);
        }
        self.body_of[id.slot()] = body;
    }
}

impl Contestant<Frame> for Boxes {
    fn frame(&mut self, frame: &Frame) {
        if self.purpose == Use::Replacement {
            for (at, &bounds) in frame.corners.iter().enumerate() {
                self.replace(frame.body(at), bounds);
            }
        } else {
            self.moved.clear();
            let bodies = (0..frame.corners.len()).map(|at| frame.body(at));
            self.moved.extend(bodies.map(|body| self.ids[body as usize]));
            let set = self.world.set_many(&self.moved, &frame.corners);
            assert!(set.is_ok(), "{set:?}: the bodies are there");
        }
        self.cull();
    }

    fn settle(&mut self) {
        self.events.settle();
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.events.pairs()
    }
}

/// A world of resting meshes with what it has by default: full S-DOP.
struct MeshWorld {
    world: World,
    ids: Vec<BodyId>,
    body_of: Vec<u32>,
    events: Events,
}

impl MeshWorld {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let mut world = World::new(setup.scene.shapes.clone()).or_report()?;
        let bodies = &setup.first.bodies;
        let insert = |at: usize| {
            let translation = bodies.translation[at].map(f64::from);
            let body = Body::at(bodies.shape[at], bodies.rotation[at], translation);
            world.insert(Body { motion: Motion::Resting, ..body }).or_report()
        };
        let ids = (0..bodies.len()).map(insert);
        let ids = ids.collect::<miette::Result<Vec<_>>>()?;
        let body_of = (0..ids.len() as u32).collect();
        let mut meshes = Self { world, body_of, ids, events: Events::default() };
        meshes.cull();
        Ok(meshes)
    }

    fn cull(&mut self) {
        let pairs = self.world.cull();
        assert!(pairs.is_ok(), "{pairs:?}: bodies are within the contract");
        read(&self.world.events(), &self.body_of, &mut self.events);
    }
}

impl Contestant<Frame> for MeshWorld {
    fn frame(&mut self, frame: &Frame) {
        for at in 0..frame.bodies.len() {
            let id = self.ids[frame.body(at) as usize];
            let (rotation, place) = (frame.bodies.rotation[at], frame.bodies.translation[at]);
            let set = self.world.set_pose(id, rotation, place.map(f64::from));
            assert!(set.is_ok(), "{set:?}: the body is there");
        }
        self.cull();
    }

    fn settle(&mut self) {
        self.events.settle();
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.events.pairs()
    }
}

/// An index of a world.
struct Asked {
    index: QueryIndex,
    halves: [QueryIndex; 2],
    is_batch: bool,
    probes: Vec<QueryVolume<'static>>,
    balls: Vec<QueryVolume<'static>>,
    lines: Vec<Line>,
    found: Found,
}

/// Answers as our calls return them.
enum Found {
    Bodies(Vec<Vec<BodyId>>),
    Hits(Vec<Vec<LineHit>>),
    ManyBodies(Answers<BodyId>),
    ManyHits(Answers<LineHit>),
    Pairs(Vec<[BodyId; 2]>),
}

impl Asked {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let (questions, threads) = (Questions::of(setup)?, setup.threads);
        let index = |boxes: &[Slabs]| -> miette::Result<QueryIndex> {
            let mut world = BoxWorld::new();
            for slabs in boxes {
                world.insert(Aabb::new(lower(slabs), upper(slabs))).or_report()?;
            }
            let mut index = QueryIndex::with_threads(threads).or_report()?;
            index.update(&world);
            Ok(index)
        };
        let [even, odd] = questions.halves();
        let line = |[from, to]: &Segment| Line::Segment {
            from: from.map(f64::from),
            to: to.map(f64::from),
        };
        let ball = |centre: &[f32; 3]| QueryVolume::Ball {
            centre: centre.map(f64::from),
            radius: f64::from(RADIUS),
        };
        let probe = |slabs: &Slabs| QueryVolume::Box {
            min: lower(slabs).map(f64::from),
            max: upper(slabs).map(f64::from),
        };
        Ok(Self {
            index: index(&questions.boxes)?,
            halves: [index(&even)?, index(&odd)?],
            is_batch: threads > 1,
            probes: questions.probes.iter().map(probe).collect(),
            balls: questions.centres.iter().map(ball).collect(),
            lines: questions.segments.iter().map(line).collect(),
            found: Found::Pairs(Vec::new()),
        })
    }

    fn answer(&self, question: Question) -> Result<Found, QueryError> {
        let (index, lines) = (&self.index, &self.lines);
        let volumes = match question {
            Question::Ball => &self.balls,
            _ => &self.probes,
        };
        Ok(match (question, self.is_batch) {
            (Question::Sets, _) => {
                let [even, odd] = &self.halves;
                Found::Pairs(even.pairs_with(odd)?)
            }
            (Question::Box | Question::Ball, true) => {
                Found::ManyBodies(index.touching_all(volumes)?)
            }
            (Question::Along, true) => Found::ManyHits(index.along_all(lines)?),
            (Question::First, true) => Found::ManyHits(index.first_all(lines)?),
            (Question::Box | Question::Ball, false) => {
                let found = volumes.iter().map(|volume| index.touching(volume));
                Found::Bodies(found.collect::<Result<_, _>>()?)
            }
            (Question::Along, false) => {
                let found = lines.iter().map(|line| index.along(line));
                Found::Hits(found.collect::<Result<_, _>>()?)
            }
            (Question::First, false) => {
                let first = |line| Ok(index.first(line)?.into_iter().collect());
                Found::Hits(lines.iter().map(first).collect::<Result<_, _>>()?)
            }
        })
    }
}

impl Contestant<Frame> for Asked {
    fn frame(&mut self, frame: &Frame) {
        let Some((question, _)) = frame.question else { return };
        match self.answer(question) {
            Ok(found) => self.found = found,
            Err(error) => panic!("{error}"),
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let number = |id: &BodyId| id.slot() as u32;
        let bodies = |ids: &[BodyId]| ids.iter().map(number).collect::<Vec<_>>();
        let of_hits = |hits: &[LineHit]| hits.iter().map(|hit| number(&hit.body)).collect();
        let lists: Vec<Vec<u32>> = match &self.found {
            Found::Bodies(found) => found.iter().map(|ids| bodies(ids)).collect(),
            Found::ManyBodies(found) => found.iter().map(bodies).collect(),
            Found::Hits(found) => found.iter().map(|hits| of_hits(hits)).collect(),
            Found::ManyHits(found) => found.iter().map(of_hits).collect(),
            Found::Pairs(found) => {
                let pairs = found.iter().map(|pair| pair.each_ref().map(number));
                return pairs.map(|[even, odd]| [even, 2 * odd + 1]).collect();
            }
        };
        flat(&lists).collect()
    }
}
