//! Rounds of a verification run. The bodies that a seed or a group of hard cases draws are judged
//! once by every predicate, and then culled in each configuration, in the modes of this turn.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::ledger::Ledger;
use super::run::{RoundError, Run};
use crate::configuration::coverage::{Cell, Judged, ListLedger};
use crate::configuration::cullers::{box_culler, finders};
use crate::configuration::{Mode, Rotation};
use crate::draw::bodies::{ContactSpec, crowd, probe};
use crate::draw::boxes;
use crate::draw::forms::{self, Form};
use crate::draw::hard::HardCaseGroup;
use crate::history::{
    Repeated, Robots, draw_boxes, draw_meshes, history_shapes, judge_boxes, judge_compounds,
    judge_meshes, judge_periodic_boxes, judge_periodic_meshes, judge_queries_of_boxes,
    judge_queries_of_meshes,
};
use crate::truth::answers::{Answers, Predicate};
use crate::truth::compare::{difference, meeting};
use crate::truth::reference_shapes::Shapes;
use sdop::bodies::{Aabb, Bodies};
use sdop::choice::choices;
use sdop::culler::CullError;
use sdop::mesh::ProceduralShape;
use sdop::volume::{Axes, DirectionSet};

/// Judges runs of frames and culls them in each configuration; run number `n` takes turn `turn + n`
/// of the rotation.
///
/// # Errors
/// As [`Run::check`], and poses outside the contract.
pub fn judge_and_check(
    shapes: &Shapes,
    runs: &[Vec<Bodies>],
    variant: (DirectionSet, Axes),
    predicates: &[Predicate],
    (rotation, turn): (&Rotation, u64),
) -> Result<Ledger, RoundError> {
    let mut ledger = Ledger::default();
    for (n, frames) in (turn..).zip(runs) {
        let judge = |frame| Answers::judge(shapes, frame, variant.0, predicates);
        let answers: Vec<Answers> = frames.iter().map(judge).collect::<Result<_, _>>()?;
        answers.iter().for_each(|frame| ledger.note(frame));
        let run = Run { shapes, frames, answers: &answers };
        run.check(variant, &rotation.turn(n), &mut ledger)?;
    }
    Ok(ledger)
}

/// What a seed draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedSource {
    /// A probe among partners that nearly touch it.
    Near,
    /// A crowd in a box, uniform.
    Random,
}

/// The random streams of given boxes and of histories; those of sources have lower numbers.
const BOXES: u64 = 8;
const HISTORIES: u64 = 9;

/// Modes in which each world lives through a history.
const MODES_PER_HISTORY: usize = 3;

/// Given boxes of a seed, in every cell.
///
/// # Errors
/// Threads that the system refuses.
pub fn boxes(seed: u64, rotation: &Rotation) -> Result<Ledger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(BOXES);
    let frames = boxes::draw(&mut |n| rng.random_range(0..n));
    Ok(Ledger { boxes: check_boxes(&frames, rotation)?, ..Ledger::default() })
}

/// Culls the frames in every cell and compares each list with the definition.
///
/// # Errors
/// Threads that the system refuses, invalid boxes.
pub fn check_boxes(frames: &[Vec<Aabb>], rotation: &Rotation) -> Result<ListLedger, CullError> {
    let wanted: Vec<Vec<[u32; 2]>> = frames.iter().map(|boxes| meeting(boxes)).collect();
    let mut ledger = ListLedger {
        required: wanted.iter().map(|pairs| pairs.len() as u64).sum(),
        ..ListLedger::default()
    };
    for (finder, mode @ Mode { tier, threads, .. }) in finders(rotation) {
        let mut culler = box_culler(finder, mode).build()?;
        for (n, (boxes, wanted)) in frames.iter().zip(&wanted).enumerate() {
            let differing = difference(&culler.cull(boxes)?.sorted(), wanted);
            ledger.differ += differing.len() as u64;
            if let (Some(&[i, j]), None) = (differing.first(), &ledger.failure) {
                let [one, other] = [i, j].map(|body| boxes[body as usize]);
                ledger.failure = Some(format!(
                    "given boxes {i} and {j} of {}, frame {n}: {one:?} and {other:?} ({finder}, \
                     {tier}, {threads} threads)",
                    boxes.len()
                ));
            }
        }
        ledger.lists += frames.len() as u64;
        ledger.coverage.count(Cell::of(Judged::Boxes(finder), mode), frames.len() as u64);
    }
    Ok(ledger)
}

choices! {
    /// The long-lived worlds that live through histories.
    HistoryKind, "kind of history", {
        /// Worlds of given boxes.
        Boxes = "boxes",
        /// Worlds of meshes, by every strategy and overlap test.
        Meshes = "meshes",
        /// Worlds of compounds.
        Compounds = "compounds",
        /// Given boxes, and meshes, in space that repeats.
        Periodic = "periodic",
        /// Worlds of boxes, and of meshes, that are asked.
        Queries = "queries",
    }
}

/// Histories of all kinds.
///
/// # Errors
/// As [`history`].
pub fn histories(
    seed: u64,
    number: usize,
    variant: (DirectionSet, Axes),
    rotation: &Rotation,
) -> Result<Ledger, RoundError> {
    let mut ledger = Ledger::default();
    for &kind in HistoryKind::ALL {
        ledger.histories.add(history(kind, seed, number, variant, rotation)?);
    }
    Ok(ledger)
}

/// Long-lived worlds of a kind and of a seed for one or-DOP, number `number` of all that a seed
/// has. The modes of eight or-DOPs fill every cell.
///
/// # Errors
/// As [`judge_meshes`], [`judge_periodic_meshes`], [`judge_queries_of_meshes`] and
/// [`judge_compounds`].
pub fn history(
    kind: HistoryKind,
    seed: u64,
    number: usize,
    (k, axes): (DirectionSet, Axes),
    rotation: &Rotation,
) -> Result<ListLedger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed.wrapping_mul(64).wrapping_add(number as u64));
    rng.set_stream(HISTORIES + kind as u64);
    let all = rotation.modes();
    let modes = |row: usize| {
        let first = row + number * MODES_PER_HISTORY + seed as usize % all.len();
        let modes = (first..).take(MODES_PER_HISTORY);
        modes.map(|turn| all[turn % all.len()]).collect::<Vec<_>>()
    };
    let shapes = |is_far| history_shapes((k, axes), seed, is_far);
    let mut below = |n| rng.random_range(0..n);
    Ok(match kind {
        HistoryKind::Boxes => judge_boxes(&draw_boxes(true, &mut below), &modes(0))?,
        HistoryKind::Meshes => {
            let shapes = shapes(true)?;
            let meshes = draw_meshes(&shapes, &mut below);
            judge_meshes(&shapes, &meshes, (k, axes), modes)?
        }
        HistoryKind::Compounds => {
            let robots = Robots::draw(shapes(false)?, &mut below)?;
            let history = robots.history(&mut below);
            judge_compounds(&robots, &history, (k, axes), modes)?
        }
        HistoryKind::Periodic => {
            let shapes = shapes(false)?;
            let boxes = Repeated::boxes(&draw_boxes(false, &mut below), &mut below);
            let meshes = draw_meshes(&shapes, &mut below);
            let meshes = Repeated::meshes(&shapes, &meshes, &mut below);
            let mut judged = judge_periodic_boxes(&boxes, &modes(0))?;
            judged.add(judge_periodic_meshes(&shapes, &meshes, (k, axes), &modes(0))?);
            judged
        }
        HistoryKind::Queries => {
            let shapes = shapes(true)?;
            let meshes = draw_meshes(&shapes, &mut below);
            let mut judged = judge_queries_of_boxes(&draw_boxes(true, &mut below), &modes(0))?;
            judged.add(judge_queries_of_meshes(&shapes, &meshes, (k, axes), &modes(0))?);
            judged
        }
    })
}

/// Partners of a near round's probe.
pub const PROBE_PARTNERS: usize = 1024;

/// Bodies of a random round.
pub const CROWD: usize = 150;

/// One round: the frame of a seed for one or-DOP, judged by everything but the meshes. The seed is
/// the turn, too.
///
/// # Errors
/// As [`judge_and_check`].
pub fn round(
    source: SeedSource,
    seed: u64,
    (k, axes): (DirectionSet, Axes),
    rotation: &Rotation,
) -> Result<Ledger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(1 + source as u64);
    let shapes = forms::build(&pool(), 1, k, axes, &mut rng)?;
    let frame = match source {
        SeedSource::Near => {
            let shape = seed as usize % shapes.built.len();
            probe(&shapes, &contacts(seed), shape, PROBE_PARTNERS, &mut rng)
        }
        // About a tenth of the pairs' spheres overlap.
        SeedSource::Random => crowd(&shapes, CROWD, 6.5, &mut rng),
    };
    let volumes = &Predicate::ALL[..7];
    // Both sources of one seed take modes that are far apart.
    let turn = seed.wrapping_add(source as u64 * rotation.modes().len() as u64 / 2);
    judge_and_check(&shapes, &[vec![frame]], (k, axes), volumes, (rotation, turn))
}

/// Every procedural shape, each with its own size, and two whose origins are not their balls'
/// centres.
fn pool() -> Vec<Form> {
    let mut forms: Vec<Form> =
        ProceduralShape::NAMES.iter().map(|name| Form::of(name, [-1.0, 1.0])).collect();
    for (name, offset) in [("l-shape", [0.7, -0.3, 0.4]), ("box", [13.1, 7.7, -5.3])] {
        forms.push(Form { radius: None, offset: Some(offset), ..Form::of(name, [0.0; 2]) });
    }
    forms
}

/// Contacts of a near round: every other seed at the origin, the others up to 2²⁰ from it.
fn contacts(seed: u64) -> ContactSpec {
    ContactSpec {
        gap: [0.5, 4.0, 16.0][seed as usize % 3],
        origin: (seed % 2 == 1).then_some([0.0, 20.0]),
        ..ContactSpec::default()
    }
}

/// One group of hard cases for one or-DOP. As many groups as there are modes, numbered from 0, fill
/// every cell: run `n` of group `g` takes turn `g + n`.
///
/// # Errors
/// As [`judge_and_check`], and groups that can't be made.
pub fn group(
    number: usize,
    group: &HardCaseGroup,
    (k, axes): (DirectionSet, Axes),
    rotation: &Rotation,
) -> Result<Ledger, RoundError> {
    let cases = group.cases(k, axes)?;
    judge_and_check(
        &cases.shapes,
        &cases.runs,
        (k, axes),
        &Predicate::ALL,
        (rotation, number as u64),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::configuration::coverage::{Cell, Judged};
    use crate::configuration::variants;
    use sdop::simd::Tier;

    /// Our worlds pass, and a seed's histories fill every cell.
    #[test]
    fn histories_fill_every_cell() {
        let tiers = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
        let rotation = Rotation::new(&tiers);
        let mut all = Ledger::default();
        for (number, variant) in variants().enumerate() {
            all.add(histories(1, number, variant, &rotation).unwrap());
        }
        let judged = all.histories;
        assert_eq!(judged.failure, None);
        assert_eq!((judged.missed, judged.differ), (0, 0));
        assert!(judged.required > 20 * judged.lists, "pairs are near each other");
        let is_of_worlds = |cell: &Cell| matches!(cell.judged, Judged::World(..));
        let cells = Cell::all(&rotation).into_iter().filter(is_of_worlds);
        assert_eq!(judged.coverage.empty(cells), []);
    }
}
