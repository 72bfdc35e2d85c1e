//! Our cullers as a subject: in every way that they have, each in the mode whose turn it is.

use super::run::RoundError;
use super::{lives, parts};
use crate::answer::{Answer, AnswerError, StopReason};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::WorldBox;
use crate::ours::boxes::BoxCell;
use crate::ours::compare::{culler, settings};
use crate::ours::configurations::{Mode, Rotation, ways};
use crate::ours::histories::HistoryError;
use crate::shrink::Lists;
use crate::subject::Subject;
use sdop::bodies::Aabb;
use sdop::periodic::PeriodicBoxes;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Axes, DirectionSet};

/// Whether a strategy makes a claim: it reports every pair of which the claim holds.
#[must_use]
pub fn makes(strategy: Strategy, claim: Claim) -> bool {
    match claim {
        Claim::Sphere => strategy == Strategy::Sphere,
        Claim::OrDop => strategy == Strategy::OrDop,
        Claim::Hull | Claim::Mesh | Claim::Parts => strategy.scheme().culls(),
        Claim::Aabb
        | Claim::Order
        | Claim::Filter
        | Claim::Restore
        | Claim::Margin
        | Claim::Periodic => false,
    }
}

/// Every way to cull that makes a claim. What one of them doesn't report counts as not reported, so
/// a miss in any of them is a miss.
pub struct EveryWay {
    rotation: Rotation,
}

impl EveryWay {
    /// Our cullers in these modes.
    #[must_use]
    pub fn new(rotation: Rotation) -> Self {
        Self { rotation }
    }

    /// The claims that our cullers make.
    pub const CLAIMS: [Claim; 8] = [
        Claim::Sphere,
        Claim::Aabb,
        Claim::OrDop,
        Claim::Hull,
        Claim::Mesh,
        Claim::Order,
        Claim::Parts,
        Claim::Periodic,
    ];

    fn lists(&self, case: &Case) -> Result<Lists, RoundError> {
        if case.claim.is_of_boxes() {
            let cells = BoxCell::all(&self.rotation);
            return all_report(cells.map(|(cell, mode)| match case.claim {
                Claim::Periodic => Ok(periodic(case, cell, mode)?),
                _ => boxes(case, cell, mode),
            }));
        }
        let ways = ways(DirectionSet::K18, Axes::Principal).into_iter();
        let ways = ways.filter(|way| makes(way.strategy, case.claim));
        // Another turn for each case.
        let turn = case.name.bytes().map(u64::from).sum();
        let modes = self.rotation.turn(turn);
        let lists = |(way, &mode): (CullSettings, &Mode)| match case.claim {
            Claim::Parts => Ok(parts::lists(case, &way, mode)?),
            _ => posed(case, &way, mode),
        };
        all_report(ways.zip(modes.iter().cycle()).map(lists))
    }
}

impl Subject for EveryWay {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let lists = self.lists(case).map_err(|error| AnswerError::Crashed {
            how: error.to_string(),
            answered: 0,
            said: String::new(),
        })?;
        let answer = |pairs| Answer { pairs, ns: None };
        Ok(lists.into_iter().map(answer).collect())
    }
}

/// The pairs that all of these lists contain, frame by frame; the lists are sorted.
fn all_report(
    mut lists: impl Iterator<Item = Result<Lists, RoundError>>,
) -> Result<Lists, RoundError> {
    let mut common = lists.next().transpose()?.unwrap_or_default();
    for other in lists {
        for (common, other) in common.iter_mut().zip(other?) {
            common.retain(|pair| other.binary_search(pair).is_ok());
        }
    }
    Ok(common)
}

/// The frames by one way; the culler is made anew for another set of bodies.
fn posed(case: &Case, way: &CullSettings, mode: Mode) -> Result<Lists, RoundError> {
    let made = |frame: &Frame| {
        let way = settings(way.strategy, way, frame.bodies.len());
        culler(&case.shapes, &frame.bodies, &way, mode)
    };
    let (mut ours, mut lists) = (None, Vec::new());
    for frame in &case.frames {
        let kept = ours.take().filter(|_| frame.was.is_none());
        let mut culler = kept.map_or_else(|| made(frame), Ok)?;
        lists.push(culler.cull(&frame.bodies)?.sorted());
        ours = Some(culler);
    }
    Ok(lists)
}

/// The given boxes by one finder.
fn boxes(case: &Case, cell: BoxCell, mode: Mode) -> Result<Lists, RoundError> {
    let mut culler = cell.culler(mode)?;
    let aabb = |&[x0, y0, z0, x1, y1, z1]: &WorldBox| Aabb::new([x0, y0, z0], [x1, y1, z1]);
    let list = |frame: &Frame| {
        let boxes: Vec<Aabb> = frame.boxes.iter().map(aabb).collect();
        Ok(culler.cull(&boxes)?.sorted())
    };
    case.frames.iter().map(list).collect()
}

/// The boxes and their images by one finder, in one world for all frames.
fn periodic(case: &Case, cell: BoxCell, mode: Mode) -> Result<Lists, HistoryError> {
    let periods = |frame: &Frame| frame.periods.unwrap_or_default();
    let first = case.frames.first().map_or([None; 3], periods);
    let mut world = PeriodicBoxes::with(&cell.builder(mode), first)?;
    lives::lists(&mut world, case, Frame::periodic_box, |world, frame| {
        if world.periods() != periods(frame) {
            world.set_periods(periods(frame))?;
        }
        Ok(())
    })
}
