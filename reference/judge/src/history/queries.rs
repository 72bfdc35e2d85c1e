//! Histories in which worlds are asked: after each frame an index of the world is brought up to
//! date, each body's volume is a query, and so is the set beside a copy of it with another origin.
//! The pairs that a cull would report are compared, since queries ignore groups, exclusion and
//! motion.

use std::collections::HashSet;

use sdop::LivingSet;
use sdop::Motion;
use sdop::bodies::Aabb;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::periodic::{ImageSource, Periodic, PeriodicBox, PeriodicHit, PeriodicIndex};
use sdop::query::{Line, QueryIndex, QueryShape, QuerySource, QueryVolume};
use sdop::settings::{CullSettings, Finder, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet, Shape};
use sdop::world::{Body, BodyId, World};

use super::judge::{Life, Truth, answers, required_boxes, required_of, with_margins};
use super::state::State;
use super::worlds::{JudgedWorld, Listing, Properties, ReportedPair};
use super::{History, HistoryError, WorldKind};
use crate::configuration::Mode;
use crate::configuration::coverage::ListLedger;
use crate::configuration::cullers::{box_culler, culler, finder};
use crate::truth::answers::Predicate;
use crate::truth::reference_shapes::Shapes;

/// Bodies that an index reports, each with its image.
type Found = Vec<(BodyId, [i32; 3])>;

/// A body as a query. Meshes have these shapes.
pub trait AskedBody {
    fn volume<'a>(&self, shapes: &'a [QueryShape]) -> QueryVolume<'a>;
}

impl AskedBody for BoxBody {
    fn volume<'a>(&self, _: &'a [QueryShape]) -> QueryVolume<'a> {
        self.bounds.into()
    }
}

impl AskedBody for PeriodicBox {
    fn volume<'a>(&self, _: &'a [QueryShape]) -> QueryVolume<'a> {
        QueryVolume::Box { min: self.min, max: self.max }
    }
}

impl AskedBody for Body {
    fn volume<'a>(&self, shapes: &'a [QueryShape]) -> QueryVolume<'a> {
        QueryVolume::Shape {
            shape: &shapes[self.shape as usize],
            rotation: self.rotation,
            translation: self.translation,
            margin: self.margin,
        }
    }
}

/// A world that can be asked about the volumes of its own bodies.
pub trait AskedWorld: JudgedWorld<Body: AskedBody> + Clone {
    /// What is asked.
    type Index;

    /// An index that follows such a world.
    fn index(mode: Mode) -> Result<Self::Index, HistoryError>;
    /// Whether two bodies are excluded.
    fn excludes(&self, pair: [BodyId; 2]) -> bool;
    /// What an index finds in the volumes of all bodies; none if it contradicts itself.
    fn ask(
        &self,
        index: &mut Self::Index,
        bodies: &[(BodyId, Self::Body)],
        volumes: &[QueryVolume<'_>],
    ) -> Result<Option<Vec<Found>>, HistoryError>;
}

/// What an index of a world finds, in volumes and in another set, if lines find the same as in a
/// new one.
fn ask_both<B: Copy>(
    (index, worlds): (&mut QueryIndex, [&impl QuerySource; 2]),
    bodies: &[(BodyId, B)],
    point: impl Fn(&B) -> [f64; 3],
    volumes: &[QueryVolume<'_>],
) -> Result<Option<Vec<Found>>, HistoryError> {
    index.update(worlds[0]);
    let [mut new, mut other] = [QueryIndex::new(), index.clone()];
    new.update(worlds[0]);
    let mut is_same = new.len() == index.len();
    for two in bodies.windows(2).step_by(bodies.len().div_ceil(4).max(1)) {
        let [from, to] = [0, 1].map(|n: usize| point(&two[n].1));
        let ray = Line::Ray { origin: from, direction: [1.0, -0.5, 0.25] };
        for line in [Line::Segment { from, to }, ray] {
            is_same &= new.along(&line)? == index.along(&line)?;
            is_same &= new.first(&line)? == index.first(&line)?;
        }
    }
    other.update(worlds[1]);
    let both: HashSet<[BodyId; 2]> = index.pairs_with(&other)?.into_iter().collect();
    let found = index.touching_all(volumes)?;
    let found = bodies.iter().zip(found.iter()).map(|((id, _), found)| {
        let in_both = found.iter().filter(|other| both.contains(&[*id, **other]));
        in_both.map(|&other| (other, [0; 3])).collect()
    });
    Ok(is_same.then(|| found.collect()))
}

impl AskedWorld for BoxWorld {
    type Index = QueryIndex;

    fn index(mode: Mode) -> Result<QueryIndex, HistoryError> {
        Ok(QueryIndex::with_threads(mode.threads)?.on_tier(mode.tier))
    }

    fn excludes(&self, [a, b]: [BodyId; 2]) -> bool {
        self.is_excluded(a, b)
    }

    fn ask(
        &self,
        index: &mut QueryIndex,
        bodies: &[(BodyId, BoxBody)],
        volumes: &[QueryVolume<'_>],
    ) -> Result<Option<Vec<Found>>, HistoryError> {
        let mut other = self.clone();
        other.insert(Aabb::new([0.0, FAR_AWAY, 0.0], [1.0, FAR_AWAY, 1.0]))?;
        let point = |body: &BoxBody| body.bounds.min.map(f64::from);
        ask_both((index, [self, &other]), bodies, point, volumes)
    }
}

impl AskedWorld for World {
    type Index = QueryIndex;

    fn index(mode: Mode) -> Result<QueryIndex, HistoryError> {
        BoxWorld::index(mode)
    }

    fn excludes(&self, [a, b]: [BodyId; 2]) -> bool {
        self.is_excluded(a, b)
    }

    fn ask(
        &self,
        index: &mut QueryIndex,
        bodies: &[(BodyId, Body)],
        volumes: &[QueryVolume<'_>],
    ) -> Result<Option<Vec<Found>>, HistoryError> {
        let mut other = self.clone();
        other.insert(Body::at(0, [0.0, 0.0, 0.0, 1.0], [0.0, f64::from(FAR_AWAY), 0.0]))?;
        ask_both((index, [self, &other]), bodies, |body| body.translation, volumes)
    }
}

impl<V: ImageSource> AskedWorld for Periodic<V>
where
    LivingSet<V>: QuerySource,
    Self: JudgedWorld<Body = V::UserBody>,
    V::UserBody: AskedBody,
{
    type Index = PeriodicIndex<V>;

    fn index(mode: Mode) -> Result<PeriodicIndex<V>, HistoryError> {
        Ok(PeriodicIndex::with_threads(mode.threads)?.on_tier(mode.tier))
    }

    fn excludes(&self, [a, b]: [BodyId; 2]) -> bool {
        self.is_excluded(a, b)
    }

    fn ask(
        &self,
        index: &mut PeriodicIndex<V>,
        _: &[(BodyId, V::UserBody)],
        volumes: &[QueryVolume<'_>],
    ) -> Result<Option<Vec<Found>>, HistoryError> {
        index.update(self);
        let found = index.touching_all(volumes)?;
        let hits = |hits: &[PeriodicHit]| hits.iter().map(|hit| (hit.body, hit.image)).collect();
        Ok(Some(found.iter().map(hits).collect()))
    }
}

/// A place that moves the origin of a set of bodies.
const FAR_AWAY: f32 = 3.0e9;

/// A world and its index.
pub struct Asked<W: AskedWorld> {
    pub world: W,
    index: W::Index,
    shapes: Vec<QueryShape>,
}

impl<W: AskedWorld> Asked<W> {
    pub fn new(world: W, shapes: &[Shape], mode: Mode) -> Result<Self, HistoryError> {
        let shapes = shapes.iter().map(QueryShape::new).collect();
        Ok(Self { world, index: W::index(mode)?, shapes })
    }
}

impl<W: AskedWorld> Listing for Asked<W> {
    type World = W;

    fn world(&self) -> &W {
        &self.world
    }

    fn world_mut(&mut self) -> &mut W {
        &mut self.world
    }

    fn list(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        let bodies = self.world.all();
        let volumes: Vec<_> = bodies.iter().map(|(_, body)| body.volume(&self.shapes)).collect();
        let mut pairs = Vec::new();
        match self.world.ask(&mut self.index, &bodies, &volumes)? {
            Some(found) => {
                for (&(id, mut body), found) in bodies.iter().zip(found) {
                    for (other, image) in found.into_iter().filter(|found| id < found.0) {
                        let at = bodies.binary_search_by_key(&other, |&(id, _)| id);
                        let counts = at.is_ok_and(|at| {
                            let mut partner = bodies[at].1;
                            let motions = [*body.motion(), *partner.motion()];
                            motions != [Motion::Fixed; 2]
                                && body.groups().collide(*partner.groups())
                                && !self.world.excludes([id, other])
                        });
                        let pair = ReportedPair { image, ..ReportedPair::of([id, other], None) };
                        pairs.extend(counts.then_some(pair));
                    }
                }
            }
            // No pair that there can be.
            None => pairs.extend(bodies.first().map(|(id, _)| ReportedPair::of([*id; 2], None))),
        }
        self.world.cull()?; // from then on, slots of removed bodies are given again
        Ok(pairs)
    }
}

/// A history of boxes in these modes.
///
/// # Errors
/// Threads that the system refuses, invalid boxes.
pub fn judge_queries_of_boxes(
    history: &History<BoxBody>,
    modes: &[Mode],
) -> Result<ListLedger, HistoryError> {
    let states = State::all(history)?;
    let truth = Truth::exact(required_boxes(&states)); // boxes are compared as they are
    let mut ledger = ListLedger::default();
    for &mode in modes {
        let make = |turn| Asked::new(BoxWorld::with(&box_culler(finder(turn), mode))?, &[], mode);
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
) -> Result<ListLedger, HistoryError> {
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
    let mut ledger = ListLedger::default();
    for &mode in modes {
        let life = Life::new(|_| asked(mode), history, &states)?;
        life.live(WorldKind::AskedMeshes, mode, &truth, &mut ledger)?;
    }
    Ok(ledger)
}
