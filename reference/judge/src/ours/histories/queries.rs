//! Histories in which worlds are asked: after each frame an index of the world is brought up to
//! date, each body's volume is a query, and so is the set beside a copy of it with another origin.
//! The pairs that a cull would report are compared, since queries ignore groups, exclusion and
//! motion.

use std::collections::HashSet;

use sdop::Motion;
use sdop::bodies::Aabb;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::query::{Line, QueryIndex, QueryShape, QuerySource, QueryVolume};
use sdop::settings::{CullSettings, Finder, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet, Shape};
use sdop::world::{Body, BodyId, World};

use super::judge::{
    Life, Truth, answers, box_culler, culler, required_boxes, required_of, with_margins,
};
use super::state::State;
use super::worlds::{JudgedWorld, Properties, ReportedPair};
use super::{ChangeKind, History, HistoryError, HistoryLedger, WorldKind};
use crate::ours::answers::Predicate;
use crate::ours::configurations::Mode;
use crate::ours::reference_shapes::Shapes;

/// A world that can be asked about the volumes of its own bodies.
pub trait AskedWorld: JudgedWorld + QuerySource {
    fn excludes(&self, pair: [BodyId; 2]) -> bool;
    /// The same world with a body far away, which is of any kind.
    fn with_far_body(&self) -> Result<Self, HistoryError>
    where
        Self: Sized;
    /// A point of a body, or near it.
    fn point(body: &Self::Body) -> [f64; 3];
    /// A body as a query. Meshes have these shapes.
    fn volume<'a>(body: &Self::Body, shapes: &'a [QueryShape]) -> QueryVolume<'a>;
}

impl AskedWorld for BoxWorld {
    fn excludes(&self, [a, b]: [BodyId; 2]) -> bool {
        self.is_excluded(a, b)
    }

    fn with_far_body(&self) -> Result<Self, HistoryError> {
        let mut world = self.clone();
        world.insert(Aabb::new([0.0, FAR_AWAY, 0.0], [1.0, FAR_AWAY, 1.0]))?;
        Ok(world)
    }

    fn point(body: &BoxBody) -> [f64; 3] {
        body.bounds.min.map(f64::from)
    }

    fn volume<'a>(body: &BoxBody, _: &'a [QueryShape]) -> QueryVolume<'a> {
        body.bounds.into()
    }
}

impl AskedWorld for World {
    fn excludes(&self, [a, b]: [BodyId; 2]) -> bool {
        self.is_excluded(a, b)
    }

    fn with_far_body(&self) -> Result<Self, HistoryError> {
        let mut world = self.clone();
        world.insert(Body::at(0, [0.0, 0.0, 0.0, 1.0], [0.0, f64::from(FAR_AWAY), 0.0]))?;
        Ok(world)
    }

    fn point(body: &Body) -> [f64; 3] {
        body.translation
    }

    fn volume<'a>(body: &Body, shapes: &'a [QueryShape]) -> QueryVolume<'a> {
        QueryVolume::Shape {
            shape: &shapes[body.shape as usize],
            rotation: body.rotation,
            translation: body.translation,
            margin: body.margin,
        }
    }
}

/// A place that moves the origin of a set of bodies.
const FAR_AWAY: f32 = 3.0e9;

/// A world and its index.
pub struct Asked<W> {
    pub world: W,
    index: QueryIndex,
    shapes: Vec<QueryShape>,
}

impl<W: AskedWorld> Asked<W> {
    pub fn new(world: W, shapes: &[Shape], mode: Mode) -> Result<Self, HistoryError> {
        let index = QueryIndex::with_threads(mode.threads)?;
        Ok(Self {
            world,
            index: index.on_tier(mode.tier),
            shapes: shapes.iter().map(QueryShape::new).collect(),
        })
    }
}

impl<W: AskedWorld> Asked<W> {
    /// Whether an index that has followed the world answers about lines from body to body like a
    /// new one.
    fn is_as_new(&self, bodies: &[(BodyId, W::Body)]) -> Result<bool, HistoryError> {
        let mut new = QueryIndex::new();
        new.update(&self.world);
        let mut is_same = new.len() == self.index.len();
        for two in bodies.windows(2).step_by(bodies.len().div_ceil(4)) {
            let [from, to] = [0, 1].map(|n: usize| W::point(&two[n].1));
            let ray = Line::Ray { origin: from, direction: [1.0, -0.5, 0.25] };
            for line in [Line::Segment { from, to }, ray] {
                is_same &= new.along(&line)? == self.index.along(&line)?;
                is_same &= new.first(&line)? == self.index.first(&line)?;
            }
        }
        Ok(is_same)
    }
}

impl<W: AskedWorld> JudgedWorld for Asked<W> {
    type Body = W::Body;
    type Saved = W::Saved;

    fn insert(&mut self, body: W::Body) -> Result<BodyId, HistoryError> {
        self.world.insert(body)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), HistoryError> {
        self.world.remove(id)
    }

    fn change(&mut self, id: BodyId, from: W::Body, to: W::Body) -> Result<(), HistoryError> {
        self.world.change(id, from, to)
    }

    fn exclude(&mut self, pair: [BodyId; 2], excluded: bool) -> Result<bool, HistoryError> {
        self.world.exclude(pair, excluded)
    }

    fn interest(&mut self, _: &[BodyId]) -> Result<(), HistoryError> {
        Ok(())
    }

    fn cull(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        self.index.update(&self.world);
        let bodies = self.world.all();
        let volumes = bodies.iter().map(|(_, body)| W::volume(body, &self.shapes));
        let found = self.index.touching_all(&volumes.collect::<Vec<_>>())?;
        let mut other = self.index.clone();
        other.update(&self.world.with_far_body()?);
        let both: HashSet<[BodyId; 2]> = self.index.pairs_with(&other)?.into_iter().collect();
        let mut pairs = Vec::new();
        for (&(id, mut body), found) in bodies.iter().zip(found.iter()) {
            for &other in found.iter().filter(|&&other| id < other) {
                let at = bodies.binary_search_by_key(&other, |&(id, _)| id);
                let counts = at.is_ok_and(|at| {
                    let mut partner = bodies[at].1;
                    let motions = [*body.motion(), *partner.motion()];
                    motions != [Motion::Fixed; 2]
                        && body.groups().collide(*partner.groups())
                        && !self.world.excludes([id, other])
                });
                let counts = counts && both.contains(&[id, other]);
                pairs.extend(counts.then(|| ReportedPair::of([id, other], None)));
            }
        }
        if let (Some((id, _)), false) = (bodies.first(), self.is_as_new(&bodies)?) {
            pairs.insert(0, ReportedPair::of([*id; 2], None)); // no pair that there can be
        }
        self.world.cull()?; // from then on, slots of removed bodies are given again
        Ok(pairs)
    }

    fn events(&mut self) -> Option<[Vec<ReportedPair>; 3]> {
        None
    }

    fn all(&self) -> Vec<(BodyId, W::Body)> {
        self.world.all()
    }

    fn save(&self) -> W::Saved {
        self.world.save()
    }

    fn restore(&mut self, saved: &W::Saved) -> Result<(), HistoryError> {
        self.world.restore(saved)
    }

    fn detour(&mut self, kind: ChangeKind) -> Result<(), HistoryError> {
        self.world.detour(kind)
    }
}

/// A history of boxes in these modes.
///
/// # Errors
/// Threads that the system refuses, invalid boxes.
pub fn judge_queries_of_boxes(
    history: &History<BoxBody>,
    modes: &[Mode],
) -> Result<HistoryLedger, HistoryError> {
    let states = State::all(history)?;
    let truth = Truth::exact(required_boxes(&states)); // boxes are compared as they are
    let mut ledger = HistoryLedger::default();
    for &mode in modes {
        let make = |turn| Asked::new(BoxWorld::with(&box_culler(turn, mode))?, &[], mode);
        let life = Life::new(make, history, &states)?;
        life.live(WorldKind::AskedBoxes, mode, &truth, &mut ledger)?;
    }
    Ok(ledger)
}

/// A history of meshes in these modes. All is required that neither balls nor or-DOPs nor the axes
/// of the world separate in exact arithmetic, without margins: a query grows a mesh by its margin
/// on all sides, which is less than its slabs moved out by it.
///
/// # Errors
/// Threads that the system refuses, poses outside the contract.
pub fn judge_queries_of_meshes(
    shapes: &Shapes,
    history: &History<Body>,
    (k, axes): (DirectionSet, Axes),
    modes: &[Mode],
) -> Result<HistoryLedger, HistoryError> {
    let way = CullSettings {
        strategy: Strategy::SDopSequential,
        pairs: Finder::AllPairs,
        overlap: Overlap::TwoSided,
        k,
        axes,
        ..CullSettings::default()
    };
    let asked = |mode| {
        let built = shapes.built.clone();
        let world = World::with(built, &culler(&way, Mode::plain(Tier::SCALAR)))?;
        Asked::new(world, &shapes.built, mode)
    };
    let states = State::all(history)?;
    let grown = with_margins(shapes)?;
    let predicates = [Predicate::Sphere, Predicate::OrDop(way.overlap), Predicate::Aabb];
    let boxes = CullSettings { strategy: Strategy::Aabb, ..way.clone() };
    let required = states.iter().map(|state| {
        let mut state = state.clone();
        let bodies = state.bodies.iter_mut().flatten();
        bodies.for_each(|body| body.margin = 0.0);
        let answers = answers(shapes, &grown, &state, k, &predicates)?;
        let [mut required, by_boxes] =
            [&way, &boxes].map(|way| required_of(shapes, &state, &answers, way));
        required.retain(|pair| by_boxes.binary_search(pair).is_ok());
        Ok(required)
    });
    let required = required.collect::<Result<_, HistoryError>>()?;
    let fresh = states.iter().map(|state| state.fresh(asked(Mode::plain(Tier::SCALAR))?));
    let truth =
        Truth { required, fresh: fresh.collect::<Result<_, _>>()?, may_lack: false, allowed: None };
    let mut ledger = HistoryLedger::default();
    for &mode in modes {
        let life = Life::new(|_| asked(mode), history, &states)?;
        life.live(WorldKind::AskedMeshes, mode, &truth, &mut ledger)?;
    }
    Ok(ledger)
}
