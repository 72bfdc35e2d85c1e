//! Judges frames in a verification run: exact answers once, then every configuration against them
//! and against all-pairs, in the modes of this turn.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use sdop_reference::exact::Tally;

use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::ours::answers::{Answers, Predicate, explained_by_margins};
use crate::ours::boxes::{self, BoxLedger};
use crate::ours::compare::{Count, compare, culler, difference, found, settings};
use crate::ours::draw::{ContactSpec, crowd, probe};
use crate::ours::forms::{self, Form, FormError};
use crate::ours::hard::{Group, GroupError};
use crate::ours::judged::{InvalidInput, Shapes};
use crate::ours::matrix::Matrix;
use crate::ours::ways::{Mode, Rotation, rows};
use crate::score::Miss;
use crate::shrink::{Lists, Smallest, shrink_while};
use sdop::bodies::Bodies;
use sdop::culler::CullError;
use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Finder, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};

/// The error of a round that can't be run.
#[derive(Debug, thiserror::Error)]
pub enum RoundError {
    /// A culler that can't be made, or bodies that it refuses.
    #[error(transparent)]
    Cull(#[from] CullError),
    /// Numbers that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A group of hard cases.
    #[error(transparent)]
    Group(#[from] GroupError),
}

/// What lists are counted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Judged {
    /// The strategy.
    pub strategy: Strategy,
    /// The overlap test, for strategies that have one.
    pub overlap: Option<Overlap>,
}

/// Everything that was judged: sums over frames.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// Answers by predicate: pairs that overlap, and which stage decided.
    pub predicates: [(u64, Tally); Predicate::ALL.len()],
    /// Lists against answers; a pair counts once for each finder that listed it.
    pub rows: BTreeMap<Judged, Count>,
    /// Pairs missed or found by one finder alone, with all that is needed to see it again.
    pub failures: Vec<Failure>,
    /// In which cells lists were judged.
    pub matrix: Matrix,
    /// Lists of given boxes.
    pub boxes: BoxLedger,
}

/// A missed pair, or one on which a finder disagrees with all-pairs.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The culler's settings.
    pub settings: CullSettings,
    /// How it was computed.
    pub mode: Mode,
    /// The frames up to the one with the pair.
    pub case: Case,
    /// The pair.
    pub pair: [u32; 2],
    /// Whether the exact answers ask for it; otherwise all-pairs has it and this list not, or the
    /// other way round.
    pub missed: bool,
}

impl Failure {
    /// The smallest case that fails by these settings; `None` when it doesn't fail again.
    #[must_use]
    pub fn smallest(&self, time: Duration) -> Option<Smallest> {
        shrink_while(&self.case, time, &|case| self.again(case).ok().flatten())
    }

    /// The first pair of a case that is wrong by these settings, and the lists.
    fn again(&self, case: &Case) -> Result<Option<(Miss, Lists)>, RoundError> {
        let shapes = Shapes::new(case.shapes.clone())?;
        let frames: Vec<Bodies> = case.frames.iter().map(|f| f.bodies.clone()).collect();
        let k = self.settings.k;
        let judge = |frame| Answers::judge(&shapes, frame, k, &Predicate::ALL);
        let answers: Vec<Answers> = frames.iter().map(judge).collect::<Result<_, _>>()?;
        let run = Run {
            shapes: &shapes,
            frames: &frames,
            answers: &answers,
        };
        let Some(first) = frames.first() else {
            return Ok(None);
        };
        let way = settings(self.settings.strategy, &self.settings, first.len());
        let mut ledger = Ledger::default();
        let lists = run.check_way(
            &way,
            self.mode,
            &mut ExpectedLists::new(&run, &way),
            &mut ledger,
        )?;
        Ok(ledger.failures.first().map(|failure| {
            let (frame, pair) = (failure.case.frames.len() - 1, failure.pair);
            (Miss { frame, pair }, lists)
        }))
    }
}

impl Ledger {
    /// Counts a frame's answers.
    pub fn note(&mut self, answers: &Answers) {
        for ((overlaps, tally), predicate) in self.predicates.iter_mut().zip(Predicate::ALL) {
            *overlaps += answers.of(predicate).iter().filter(|x| **x).count() as u64;
            tally.add(&answers.tally(predicate));
        }
    }

    /// Counts one list.
    pub fn count(&mut self, settings: &CullSettings, count: &Count) {
        let row = Judged {
            strategy: settings.strategy,
            overlap: settings
                .strategy
                .scheme()
                .has_overlap_test()
                .then_some(settings.overlap),
        };
        self.rows.entry(row).or_default().add(count);
    }

    /// Adds another ledger. A few failures are enough.
    pub fn add(&mut self, other: Self) {
        for (mine, (overlaps, tally)) in self.predicates.iter_mut().zip(other.predicates) {
            mine.0 += overlaps;
            mine.1.add(&tally);
        }
        for (row, count) in other.rows {
            self.rows.entry(row).or_default().add(&count);
        }
        self.matrix.add(&other.matrix);
        self.boxes.add(other.boxes);
        self.failures.extend(other.failures);
        self.failures.truncate(MOST_FAILURES);
    }

    /// Missed pairs in all.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.rows.values().map(|count| count.missed).sum()
    }

    /// Pairs on which a list and that of all-pairs differ, in all.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.rows.values().map(|count| count.differ).sum()
    }
}

const MOST_FAILURES: usize = 8;

/// Frames that one culler sees, and their exact answers.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// The shapes.
    pub shapes: &'a Shapes,
    /// The frames, all with the same bodies.
    pub frames: &'a [Bodies],
    /// One a frame.
    pub answers: &'a [Answers],
}

impl Run<'_> {
    /// Culls the frames in every way, way number `w` in the mode numbered `w` modulo their number,
    /// and holds every list against the answers and against that of all-pairs.
    ///
    /// # Errors
    /// Settings that the bodies can't have.
    pub fn check(
        &self,
        variant: (DirectionSet, Axes),
        modes: &[Mode],
        ledger: &mut Ledger,
    ) -> Result<(), RoundError> {
        for (n, row) in rows(variant).iter().enumerate() {
            self.check_row(n, row, modes, ledger)?;
        }
        Ok(())
    }

    /// The same for row number `n` of [`rows`] alone.
    ///
    /// # Errors
    /// As [`Run::check`].
    pub fn check_row(
        &self,
        n: usize,
        row: &CullSettings,
        modes: &[Mode],
        ledger: &mut Ledger,
    ) -> Result<(), RoundError> {
        let Some(first) = self.frames.first() else {
            return Ok(());
        };
        let row = settings(row.strategy, row, first.len());
        let mut expected = ExpectedLists::new(self, &row);
        for (finder, &pairs) in Finder::ALL.iter().enumerate() {
            let mode = modes[(n * Finder::ALL.len() + finder) % modes.len()];
            let way = CullSettings {
                pairs,
                updates: mode.updates,
                ..row.clone()
            };
            self.check_way(&way, mode, &mut expected, ledger)?;
        }
        Ok(())
    }

    fn check_way(
        &self,
        way: &CullSettings,
        mode: Mode,
        expected: &mut ExpectedLists<'_>,
        ledger: &mut Ledger,
    ) -> Result<Vec<Vec<[u32; 2]>>, RoundError> {
        let mut culler = culler(&self.shapes.built, &self.frames[0], way, mode)?;
        let mut lists = Vec::new();
        ledger.matrix.count(way, mode, self.frames.len() as u64);
        for (n, (frame, answers)) in self.frames.iter().zip(self.answers).enumerate() {
            let list = culler.cull(frame)?.sorted();
            let (mut count, missed, extra) = compare(answers, way, &list);
            if !way.strategy.scheme().has_budget() {
                for pair in extra {
                    let margin = u64::from(expected.explained(n, pair)?);
                    count.margin += margin;
                    count.bound -= margin;
                }
            }
            let differing = difference(&found(&culler, way), expected.found(n, mode.tier)?);
            count.differ = differing.len() as u64;
            ledger.count(way, &count);
            let wrong = missed.first().or(differing.first());
            if let (Some(&pair), true) = (wrong, ledger.failures.len() < MOST_FAILURES) {
                ledger.failures.push(Failure {
                    settings: way.clone(),
                    mode,
                    case: self.case(n),
                    pair,
                    missed: !missed.is_empty(),
                });
            }
            lists.push(list);
        }
        Ok(lists)
    }

    /// The frames up to this one as a case.
    fn case(&self, last: usize) -> Case {
        let shapes = &self.shapes.built;
        let frame = |bodies: &Bodies| Frame::fitted(bodies.clone(), shapes);
        Case {
            name: "ours".to_owned(),
            flag: String::new(),
            source: String::new(),
            claim: Claim::Mesh,
            claims: vec![Claim::Mesh],
            shapes: shapes.clone(),
            frames: self.frames[..=last].iter().map(frame).collect(),
        }
    }
}

/// What the lists of one strategy and overlap test are held against, whichever finder and mode.
struct ExpectedLists<'a> {
    run: &'a Run<'a>,
    row: CullSettings,
    /// What all-pairs finds in the plainest mode, a list a frame, by tier: flush-to-zero may decide
    /// otherwise.
    all_pairs: BTreeMap<&'static str, Vec<Vec<[u32; 2]>>>,
    /// Whether the margins explain an extra pair, by frame.
    explained: BTreeMap<(usize, [u32; 2]), bool>,
}

impl<'a> ExpectedLists<'a> {
    fn new(run: &'a Run<'a>, way: &CullSettings) -> Self {
        let row = CullSettings {
            pairs: Finder::AllPairs,
            ..way.clone()
        };
        Self {
            run,
            row,
            all_pairs: BTreeMap::new(),
            explained: BTreeMap::new(),
        }
    }

    /// The list of all-pairs in a frame.
    fn found(&mut self, frame: usize, tier: Tier) -> Result<&[[u32; 2]], RoundError> {
        let tier = match tier {
            Tier::SCALAR_FLUSH => tier,
            _ => Tier::SCALAR,
        };
        let lists = match self.all_pairs.entry(tier.name()) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => {
                let (shapes, frames) = (&self.run.shapes.built, self.run.frames);
                let mut culler = culler(shapes, &frames[0], &self.row, Mode::plain(tier))?;
                let lists = frames.iter().map(|frame| {
                    culler.cull(frame)?;
                    Ok(found(&culler, &self.row))
                });
                entry.insert(lists.collect::<Result<_, CullError>>()?)
            }
        };
        Ok(&lists[frame])
    }

    fn explained(&mut self, frame: usize, pair: [u32; 2]) -> Result<bool, RoundError> {
        if let Some(&known) = self.explained.get(&(frame, pair)) {
            return Ok(known);
        }
        let Run { shapes, frames, .. } = *self.run;
        let explained = explained_by_margins(shapes, &frames[frame], &self.row, pair)?;
        self.explained.insert((frame, pair), explained);
        Ok(explained)
    }
}

/// Judges runs of frames and culls them in every way; run number `n` takes turn `turn + n` of the
/// rotation.
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
        let run = Run {
            shapes,
            frames,
            answers: &answers,
        };
        run.check(variant, &rotation.turn(n), &mut ledger)?;
    }
    Ok(ledger)
}

/// What a seed draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A probe among partners that nearly touch it.
    Near,
    /// A crowd in a box, uniform.
    Random,
}

/// The random stream of given boxes; those of sources have lower numbers.
const BOXES: u64 = 8;

/// Given boxes of a seed, in every cell.
///
/// # Errors
/// Threads that the system refuses.
pub fn boxes(seed: u64, rotation: &Rotation) -> Result<Ledger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(BOXES);
    let frames = boxes::draw(&mut |n| rng.random_range(0..n));
    Ok(Ledger {
        boxes: boxes::judge(&frames, rotation)?,
        ..Ledger::default()
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
    source: Source,
    seed: u64,
    (k, axes): (DirectionSet, Axes),
    rotation: &Rotation,
) -> Result<Ledger, RoundError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(1 + source as u64);
    let shapes = forms::build(&pool(), 1, k, axes, &mut rng)?;
    let frame = match source {
        Source::Near => {
            let shape = seed as usize % shapes.built.len();
            probe(&shapes, &contacts(seed), shape, PROBE_PARTNERS, &mut rng)
        }
        // About a tenth of the pairs' spheres overlap.
        Source::Random => crowd(&shapes, CROWD, 6.5, &mut rng),
    };
    let volumes = &Predicate::ALL[..7];
    // Both sources of one seed take modes that are far apart.
    let turn = seed.wrapping_add(source as u64 * rotation.modes().len() as u64 / 2);
    judge_and_check(
        &shapes,
        &[vec![frame]],
        (k, axes),
        volumes,
        (rotation, turn),
    )
}

/// Every procedural shape, each with its own size, and two whose origins are not their balls'
/// centres.
fn pool() -> Vec<Form> {
    let mut forms: Vec<Form> = ProceduralShape::NAMES
        .iter()
        .map(|name| Form::of(name, [-1.0, 1.0]))
        .collect();
    for (name, offset) in [("l-shape", [0.7, -0.3, 0.4]), ("box", [13.1, 7.7, -5.3])] {
        forms.push(Form {
            radius: None,
            offset: Some(offset),
            ..Form::of(name, [0.0; 2])
        });
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
    group: &Group,
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
