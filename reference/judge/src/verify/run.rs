//! Culls the same frames in each configuration, and compares each list with the exact answers and
//! with that of all-pairs.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::time::Duration;

use super::ledger::{Failure, Ledger, MOST_FAILURES};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::configuration::coverage::Cell;
use crate::configuration::cullers::{culler, found, settings};
use crate::configuration::{Mode, rows};
use crate::draw::forms::FormError;
use crate::draw::hard::HardCaseError;
use crate::history::HistoryError;
use crate::score::Miss;
use crate::shrink::{Lists, SmallestCase, shrink_while};
use crate::truth::answers::{Answers, Predicate, explained_by_margins};
use crate::truth::compare::{compare, difference};
use crate::truth::reference_shapes::{InvalidInput, Shapes};
use sdop::bodies::Bodies;
use sdop::culler::CullError;
use sdop::settings::{CullSettings, Finder};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};

/// The error of a round that can't be run.
#[derive(Debug, thiserror::Error)]
pub enum RoundError {
    /// A culler that can't be made, or bodies that it refuses.
    #[error(transparent)]
    Cull(#[from] CullError),
    /// A history that a world refuses.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// Numbers that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A group of hard cases.
    #[error(transparent)]
    Group(#[from] HardCaseError),
}

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
    /// Culls the frames in each configuration, number `w` in the mode numbered `w` modulo their
    /// number, and compares each list with the answers and with that of all-pairs.
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
            let way = CullSettings { pairs, updates: mode.updates, ..row.clone() };
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
        let mut culler = culler(way, mode).build(&self.shapes.built, &self.frames[0])?;
        let mut lists = Vec::new();
        ledger.coverage.count(Cell::of_meshes(way, mode), self.frames.len() as u64);
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

/// The lists with which those of one strategy and overlap test are compared, for every finder and
/// mode.
struct ExpectedLists<'a> {
    run: &'a Run<'a>,
    row: CullSettings,
    /// The pairs that all-pairs finds in the simplest mode, one list per frame, by tier:
    /// flush-to-zero may decide otherwise.
    all_pairs: BTreeMap<&'static str, Vec<Vec<[u32; 2]>>>,
    /// Whether the margins explain an extra pair, by frame.
    explained: BTreeMap<(usize, [u32; 2]), bool>,
}

impl<'a> ExpectedLists<'a> {
    fn new(run: &'a Run<'a>, way: &CullSettings) -> Self {
        let row = CullSettings { pairs: Finder::AllPairs, ..way.clone() };
        Self { run, row, all_pairs: BTreeMap::new(), explained: BTreeMap::new() }
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
                let mut culler = culler(&self.row, Mode::plain(tier)).build(shapes, &frames[0])?;
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

impl Failure {
    /// The smallest case that fails by these settings; `None` when it doesn't fail again.
    #[must_use]
    pub fn smallest(&self, time: Duration) -> Option<SmallestCase> {
        shrink_while(&self.case, time, &|case| self.again(case).ok().flatten())
    }

    /// The first pair of a case that is wrong by these settings, and the lists.
    fn again(&self, case: &Case) -> Result<Option<(Miss, Lists)>, RoundError> {
        let shapes = Shapes::new(case.shapes.clone())?;
        let frames: Vec<Bodies> = case.frames.iter().map(|f| f.bodies.clone()).collect();
        let k = self.settings.k;
        let judge = |frame| Answers::judge(&shapes, frame, k, &Predicate::ALL);
        let answers: Vec<Answers> = frames.iter().map(judge).collect::<Result<_, _>>()?;
        let run = Run { shapes: &shapes, frames: &frames, answers: &answers };
        let Some(first) = frames.first() else {
            return Ok(None);
        };
        let way = settings(self.settings.strategy, &self.settings, first.len());
        let mut ledger = Ledger::default();
        let lists =
            run.check_way(&way, self.mode, &mut ExpectedLists::new(&run, &way), &mut ledger)?;
        Ok(ledger.failures.first().map(|failure| {
            let (frame, pair) = (failure.case.frames.len() - 1, failure.pair);
            (Miss { frame, pair }, lists)
        }))
    }
}
