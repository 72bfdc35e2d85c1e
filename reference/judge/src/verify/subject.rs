//! Our cullers as a subject: in every configuration that makes the claim, each in the mode whose
//! turn it is.

use crate::answer::{Answer, AnswerError, StopReason};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::configuration::cullers::{box_culler, culler, finders, settings};
use crate::configuration::{Mode, Rotation, ways};
use crate::contestant::{Contestant, WorldBox};
use crate::history::contestant::Living;
use crate::history::frames::MeshLife;
use crate::history::{Asked, HistoryError};
use crate::subject::{ContestantFactory, Scene, Subject};
use sdop::bodies::Aabb;
use sdop::boxes::{BoxCullerBuilder, BoxWorld};
use sdop::culler::{CullError, Culler};
use sdop::periodic::PeriodicBoxes;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::{Axes, DirectionSet};
use sdop::world::PeriodicWorld;
use sdop::world::World;

/// Whether a strategy makes a claim: it reports every pair of which the claim holds.
#[must_use]
pub fn makes(strategy: Strategy, claim: Claim) -> bool {
    match claim {
        Claim::Sphere => strategy == Strategy::Sphere,
        Claim::OrDop => strategy == Strategy::OrDop,
        _ => !claim.is_of_boxes() && strategy.scheme().culls(),
    }
}

/// Our cullers, in every configuration that makes a claim. What one of them doesn't report counts
/// as not reported, so a miss in any of them is a miss.
pub struct OwnCullers {
    rotation: Rotation,
}

impl OwnCullers {
    /// Our cullers in these modes.
    #[must_use]
    pub fn new(rotation: Rotation) -> Self {
        Self { rotation }
    }

    fn answers(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        // All pairs of a large set would take minutes, and every way of it an hour.
        let is_large = case.frames.iter().any(|frame| frame.bodies.len() > LARGE);
        let is_fast = |finder: Finder| !is_large || finder == Finder::Grid;
        // Another turn for each case.
        let turn = case.name.bytes().map(u64::from).sum::<u64>();
        if case.claim.is_of_boxes() {
            // Claims that have the same cases share the cells.
            let share = if case.claim.base().is_some() && !is_large { SHARES } else { 1 };
            let cells = finders(&self.rotation).filter(|(finder, _)| is_fast(*finder));
            let cells = (turn..).zip(cells).filter(|(n, _)| n.is_multiple_of(share));
            return all_report(cells.map(|(n, way)| boxes(n / share, case, way)));
        }
        let ways = ways(DirectionSet::K18, Axes::Principal).into_iter();
        let ways = ways.filter(|way| makes(way.strategy, case.claim) && is_fast(way.pairs));
        let modes = self.rotation.turn(turn);
        let lists = |(n, (way, &mode)): (u64, (CullSettings, &Mode))| {
            // A culler for all, and a world for some, other ones of each case.
            let in_world = case.claim == Claim::Parts || (n + turn).is_multiple_of(WORLDS);
            let culler = (case.claim != Claim::Parts).then(|| posed(case, &way, mode));
            let in_others = in_world && matches!(case.claim, Claim::Hull | Claim::Mesh);
            let world = in_world.then(|| meshes(case, &way, mode));
            let other = in_others.then(|| others((n + turn) / WORLDS, case, &way, mode));
            all_report(culler.into_iter().chain(world).chain(other))
        };
        all_report((0..).zip(ways.zip(modes.iter().cycle())).map(lists))
    }
}

/// Of so many ways, one is that of a long-lived world of meshes as well.
const WORLDS: u64 = 5;

impl Subject for OwnCullers {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        self.answers(case)
    }
}

/// Of so many cells, one is judged by each case of another claim.
const SHARES: u64 = 5;

/// Bodies of a set that is culled by the fastest finder alone.
const LARGE: usize = 1 << 11;

/// The pairs that all of these answers contain, frame by frame.
fn all_report(
    mut all: impl Iterator<Item = Result<Vec<Answer>, StopReason>>,
) -> Result<Vec<Answer>, StopReason> {
    let mut common = all.next().transpose()?.unwrap_or_default();
    for other in all {
        for (common, mut other) in common.iter_mut().zip(other?) {
            other.pairs.sort_unstable();
            common.pairs.retain(|pair| other.pairs.binary_search(pair).is_ok());
        }
    }
    Ok(common)
}

/// What a contestant answers; one that can't be made has crashed.
fn lived<C: Contestant>(
    case: &Case,
    make: impl Fn(&Scene<'_>) -> Result<C, HistoryError> + Sync,
) -> Result<Vec<Answer>, StopReason> {
    let make = |scene: &Scene<'_>| make(scene).unwrap_or_else(|error| panic!("{error}"));
    ContestantFactory(make).answer(case)
}

/// The frames in a long-lived world of meshes.
fn meshes(case: &Case, way: &CullSettings, mode: Mode) -> Result<Vec<Answer>, StopReason> {
    lived(case, |scene| MeshLife::new(scene.shapes, &culler(way, mode)).map(Living::new))
}

/// The frames by an index of such a world, which is asked about each body's volumes, by a world
/// that might repeat, or by an index of one, whose turn it is.
fn others(n: u64, case: &Case, way: &CullSettings, mode: Mode) -> Result<Vec<Answer>, StopReason> {
    let culler = culler(way, mode);
    let shapes = || case.shapes.clone();
    let periodic = || PeriodicWorld::with(shapes(), &culler, [None; 3]);
    match n % 3 {
        0 => lived(case, |_| {
            let world = World::with(shapes(), &culler)?;
            Ok(Living::new(Asked::new(world, &case.shapes, mode)?))
        }),
        1 => lived(case, |_| Ok(Living::new(periodic()?))),
        _ => lived(case, |_| Ok(Living::new(Asked::new(periodic()?, &case.shapes, mode)?))),
    }
}

/// The frames by one way; the culler is made anew for another set of bodies.
fn posed(case: &Case, way: &CullSettings, mode: Mode) -> Result<Vec<Answer>, StopReason> {
    let made = |frame: &Frame| {
        let way = settings(way.strategy, way, frame.bodies.len());
        culler(&way, mode).build(&case.shapes, &frame.bodies)
    };
    let (mut ours, mut answers) = (None, Vec::new());
    for frame in &case.frames {
        let kept = ours.take().filter(|_| frame.was.is_none());
        let culled = kept.map_or_else(|| made(frame), Ok).and_then(|mut culler: Culler| {
            let pairs = culler.cull(&frame.bodies)?.sorted();
            Ok((culler, Answer { pairs, ..Answer::default() }))
        });
        let (culler, answer) = culled.map_err(|error| AnswerError::Crashed {
            how: error.to_string(),
            answered: answers.len(),
            said: String::new(),
        })?;
        answers.push(answer);
        ours = Some(culler);
    }
    Ok(answers)
}

/// The given boxes by one finder: in a long-lived world, by an index of one or by a culler,
/// whose turn it is and which can have the case's input; or in space that repeats.
fn boxes(n: u64, case: &Case, (finder, mode): (Finder, Mode)) -> Result<Vec<Answer>, StopReason> {
    let builder = box_culler(finder, mode);
    let is_plain = matches!(case.claim, Claim::Aabb | Claim::Order);
    let is_periodic = case.claim == Claim::Periodic;
    let periodic = || PeriodicBoxes::with(&builder, [None; 3]);
    match n % if is_plain { 3 } else { 2 } {
        0 if is_periodic => lived(case, |_| Ok(Living::new(periodic()?))),
        1 if is_periodic => lived(case, |_| Ok(Living::new(Asked::new(periodic()?, &[], mode)?))),
        0 => lived(case, |_| Ok(Living::new(BoxWorld::with(&builder)?))),
        1 => lived(case, |_| Ok(Living::new(Asked::new(BoxWorld::with(&builder)?, &[], mode)?))),
        _ => frames(case, &builder),
    }
}

fn frames(case: &Case, builder: &BoxCullerBuilder) -> Result<Vec<Answer>, StopReason> {
    let crashed = |error: CullError| AnswerError::Crashed {
        how: error.to_string(),
        answered: 0,
        said: String::new(),
    };
    let mut culler = builder.build().map_err(crashed)?;
    let aabb = |&[x0, y0, z0, x1, y1, z1]: &WorldBox| Aabb::new([x0, y0, z0], [x1, y1, z1]);
    let mut answers = Vec::new();
    for frame in &case.frames {
        let boxes: Vec<Aabb> = frame.boxes.iter().map(aabb).collect();
        let pairs = culler.cull(&boxes).map_err(crashed)?.sorted();
        answers.push(Answer { pairs, ..Answer::default() });
    }
    Ok(answers)
}
