//! Ways to find the pairs of parts of robots: contestants that are given the robots' poses.

use sdop::compound::{Compound, Part, PartCuller};
use sdop::{Bodies, Body, BodyId, World};
use sdop_bench::remedy::OrReport as _;
use sdop_judge::contestant::Contestant;

use super::scene::{PARTS, Robots, posed, slabs};
use crate::boxes::Frame;
use crate::entry::{Engine, Entry, Setup};
use crate::scenes::{Course, Order, Spread};

/// One body per robot: S-DOP on two levels.
pub struct Compounds {
    world: World,
    ids: Vec<BodyId>,
    culler: PartCuller,
}

impl Compounds {
    pub fn new(robots: &Robots) -> miette::Result<Self> {
        let compound = Compound::build("robot", &robots.shapes, &robots.parts).or_report()?;
        let mut world = World::new(vec![compound.shape().clone()]).or_report()?;
        let ids = robots.frames[0].iter();
        let ids = ids.map(|&robot| world.insert(robot).or_report());
        let ids = ids.collect::<miette::Result<_>>()?;
        let mut culler = PartCuller::new();
        culler.set_parts(0, compound);
        Ok(Self { world, ids, culler })
    }
}

impl Contestant<Vec<Body>> for Compounds {
    fn frame(&mut self, robots: &Vec<Body>) {
        cull(&mut self.world, &self.ids, robots.iter().copied());
        let found = self.culler.cull(&self.world).map(drop);
        assert!(found.is_ok(), "{found:?}");
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.culler.pairs().iter();
        let number = |id: BodyId, part: u32| (id.slot() * PARTS) as u32 + part;
        let numbered =
            pairs.map(|pair| [0, 1].map(|side| number(pair.bodies[side], pair.parts[side])));
        numbered.collect()
    }
}

/// One body per part: pairs within a robot are excluded.
pub struct Parts {
    world: World,
    ids: Vec<BodyId>,
    parts: Vec<Part>,
}

impl Parts {
    pub fn new(robots: &Robots) -> miette::Result<Self> {
        let mut world = World::new(robots.shapes.clone()).or_report()?;
        let parts = posed(&robots.parts, &robots.frames[0]);
        let ids = parts.map(|part| world.insert(part).or_report());
        let ids: Vec<BodyId> = ids.collect::<miette::Result<_>>()?;
        for robot in ids.chunks(PARTS) {
            for (number, &part) in robot.iter().enumerate() {
                for &other in &robot[..number] {
                    world.exclude(part, other).or_report()?;
                }
            }
        }
        Ok(Self { world, ids, parts: robots.parts.clone() })
    }
}

impl Contestant<Vec<Body>> for Parts {
    fn frame(&mut self, robots: &Vec<Body>) {
        cull(&mut self.world, &self.ids, posed(&self.parts, robots));
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.world.pairs();
        pairs.map(|pair| pair.map(|id| id.slot() as u32)).collect()
    }
}

fn cull(world: &mut World, ids: &[BodyId], bodies: impl Iterator<Item = Body>) {
    for (&id, body) in ids.iter().zip(bodies) {
        let set = world.set_pose(id, body.rotation, body.translation);
        assert!(set.is_ok(), "{set:?}");
    }
    let culled = world.cull().map(drop);
    assert!(culled.is_ok(), "{culled:?}");
}

/// An engine that is given the boxes of parts.
pub struct PartBoxes {
    engine: Engine,
    parts: Vec<Part>,
    frame: Frame,
}

impl PartBoxes {
    pub fn new(robots: &Robots, entry: &Entry) -> miette::Result<Self> {
        let parts = robots.parts.clone();
        let mut frame = Frame::default();
        let first = posed(&parts, &robots.frames[0]);
        frame.set_boxes(first.map(|part| slabs(&part)).collect());
        for part in posed(&parts, &robots.frames[0]) {
            let translation = part.translation.map(|x| x as f32);
            Bodies::push(&mut frame.bodies, part.shape, true, part.rotation, translation);
        }
        // The engines take boxes alone; no scene has robots.
        let course = Course::new(Spread::Uniform, 500, Order::Random, 0)?;
        let setup = Setup { scene: &course.scene, first: &frame, threads: 1 };
        Ok(Self { engine: (entry.new)(&setup)?, parts, frame })
    }
}

impl Contestant<Vec<Body>> for PartBoxes {
    fn frame(&mut self, robots: &Vec<Body>) {
        let boxes = posed(&self.parts, robots).map(|part| slabs(&part));
        self.frame.boxes.clear();
        self.frame.boxes.extend(boxes);
        self.engine.frame(&self.frame);
    }

    fn settle(&mut self) {
        self.engine.settle();
    }

    /// Those of two robots.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let mut pairs = self.engine.pairs();
        pairs.retain(|pair| pair[0] / PARTS as u32 != pair[1] / PARTS as u32);
        pairs
    }
}
