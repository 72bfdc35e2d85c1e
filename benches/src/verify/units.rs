//! A verification run divided into units: a group of hard cases for one or-DOP, a seed's rounds for
//! one or-DOP, or a block of a scene's frames. Ledgers are passed as text, without the failed
//! frames, because a unit with failures can be repeated.

use std::collections::BTreeMap;
use std::time::Instant;

use miette::{IntoDiagnostic as _, miette};
use sdop_reference::exact::Tally;
use serde::{Deserialize, Serialize};

use super::scenes::{block, blocks, frames_of};
use crate::scene::Scene;
use crate::sweep::{Header, Sweep, digest};
use sdop::settings::{Axes, DirectionSet, Overlap, Strategy};
use sdop::simd::Tier;
use sdop_judge::configuration::coverage::{Cell, Coverage, ListLedger};
use sdop_judge::configuration::{Rotation, variants};
use sdop_judge::draw::hard::{FILES, HardCaseGroup};
use sdop_judge::truth::answers::Predicate;
use sdop_judge::truth::compare::ListCount;
use sdop_judge::verify::rounds::{SeedSource, boxes, group, histories, round};
use sdop_judge::verify::{Ledger, LedgerKey};

/// The name in its files.
pub const NAME: &str = "verify";

/// The settings of a verification run: enough to read its results, not to make them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Groups of hard cases, by name.
    pub groups: Vec<String>,
    /// The first seed.
    pub first_seed: u64,
    /// Number of seeds.
    pub seeds: u64,
    /// The names of scenes in the report.
    pub scenes: Vec<String>,
    /// Frames of each scene.
    pub frames: usize,
    /// The SIMD tiers.
    pub tiers: Vec<String>,
}

/// A verification run.
pub struct Verification {
    settings: Settings,
    groups: Vec<(usize, HardCaseGroup)>,
    scenes: Vec<Scene>,
    variants: Vec<(DirectionSet, Axes)>,
    rotation: Rotation,
    cells: Vec<Cell>,
    places: BTreeMap<Cell, usize>,
    /// No round starts after this time.
    deadline: Option<Instant>,
}

/// One unit.
enum VerifyUnit {
    /// A group of hard cases, by its index among the chosen ones.
    Hard(usize, (DirectionSet, Axes)),
    /// A seed's rounds.
    Rounds(u64, (DirectionSet, Axes)),
    /// A scene's block of frames.
    Frames(usize, usize),
}

/// The origin of judged pairs, which reports distinguish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum UnitOrigin {
    /// Hard cases.
    Hard,
    /// Rounds of near pairs.
    Near,
    /// Rounds of random pairs.
    Random,
    /// Given boxes.
    Boxes,
    /// Long-lived worlds.
    Histories,
    /// A scene, by its number.
    Scene(usize),
}

impl Verification {
    /// A run with these settings.
    ///
    /// # Errors
    /// A group doesn't exist, or this CPU lacks a tier.
    pub fn new(settings: Settings) -> miette::Result<Self> {
        let tier = |name: &String| {
            let known = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
            known.into_iter().find(|tier| tier.name() == name).ok_or_else(|| {
                miette!(
                    help = "merge on a CPU that has it, as those had that made the shards",
                    "this CPU has no {name}"
                )
            })
        };
        let tiers = settings.tiers.iter().map(tier);
        let rotation = Rotation::new(&tiers.collect::<miette::Result<Vec<Tier>>>()?);
        let group = |name: &String| {
            let place = FILES.iter().position(|file| file.0 == name);
            let place = place.ok_or_else(|| miette!("there is no group `{name}` of hard cases"))?;
            Ok((place, HardCaseGroup::parse(FILES[place].1).into_diagnostic()?))
        };
        let groups = settings.groups.iter().map(group);
        let cells = Cell::all(&rotation);
        Ok(Self {
            groups: groups.collect::<miette::Result<_>>()?,
            scenes: Vec::new(),
            variants: variants().collect(),
            places: cells.iter().copied().zip(0..).collect(),
            cells,
            rotation,
            settings,
            deadline: None,
        })
    }

    /// Adds the scenes that the settings name, so that units can be run, and a time after which no
    /// round starts.
    #[must_use]
    pub fn with_scenes(self, scenes: Vec<Scene>, deadline: Option<Instant>) -> Self {
        Self { scenes, deadline, ..self }
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The modes of the rotation.
    #[must_use]
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// Number of units.
    #[must_use]
    pub fn units(&self) -> usize {
        let (variants, scenes) = (self.variants.len(), self.settings.scenes.len());
        let rounds = self.settings.seeds as usize * variants;
        self.groups.len() * variants + rounds + scenes * blocks(self.settings.frames)
    }

    fn unit(&self, unit: usize) -> VerifyUnit {
        let variants = self.variants.len();
        let hard = self.groups.len() * variants;
        let rounds = hard + self.settings.seeds as usize * variants;
        if unit < hard {
            return VerifyUnit::Hard(unit / variants, self.variants[unit % variants]);
        }
        if unit < rounds {
            let (n, variant) = ((unit - hard) / variants, (unit - hard) % variants);
            let seed = self.settings.first_seed.wrapping_add(n as u64);
            return VerifyUnit::Rounds(seed, self.variants[variant]);
        }
        let (n, blocks) = (unit - rounds, blocks(self.settings.frames));
        VerifyUnit::Frames(n / blocks, n % blocks)
    }

    /// Runs a unit and returns its ledgers by origin.
    ///
    /// # Errors
    /// Culling or the reference fails, or its scene is missing.
    pub fn judge(&self, unit: usize) -> miette::Result<Vec<(UnitOrigin, Ledger)>> {
        let rotation = &self.rotation;
        match self.unit(unit) {
            VerifyUnit::Hard(n, variant) => {
                let (number, cases) = &self.groups[n];
                let judged = group(*number, cases, variant, rotation).into_diagnostic()?;
                let boxes = boxes(!(unit as u64), rotation).into_diagnostic()?;
                Ok(vec![(UnitOrigin::Hard, judged), (UnitOrigin::Boxes, boxes)])
            }
            VerifyUnit::Rounds(seed, variant) => {
                let judge = |source| round(source, seed, variant, rotation).into_diagnostic();
                let number = self.variants.iter().position(|&known| known == variant);
                let number = number.unwrap_or(0);
                let draw = seed.wrapping_mul(64).wrapping_add(number as u64);
                let lived = histories(seed, number, variant, rotation).into_diagnostic()?;
                Ok(vec![
                    (UnitOrigin::Near, judge(SeedSource::Near)?),
                    (UnitOrigin::Random, judge(SeedSource::Random)?),
                    (UnitOrigin::Boxes, boxes(draw, rotation).into_diagnostic()?),
                    (UnitOrigin::Histories, lived),
                ])
            }
            VerifyUnit::Frames(n, number) => {
                let scene = self.scenes.get(n);
                let scene = scene.ok_or_else(|| miette!("its scene was not read"))?;
                let judged = block(scene, self.settings.frames, number, rotation)?;
                Ok(vec![(UnitOrigin::Scene(n), judged)])
            }
        }
    }

    /// Reads a unit's result: ledgers without failures, and whether each had some.
    ///
    /// # Errors
    /// The text is not a result of this unit.
    pub fn take(
        &self,
        unit: usize,
        result: &str,
    ) -> miette::Result<Vec<(UnitOrigin, Ledger, bool)>> {
        let texts: Vec<LedgerText> = serde_json::from_str(result).into_diagnostic()?;
        let origins = match self.unit(unit) {
            VerifyUnit::Hard(..) => vec![UnitOrigin::Hard, UnitOrigin::Boxes],
            VerifyUnit::Rounds(..) => {
                vec![UnitOrigin::Near, UnitOrigin::Random, UnitOrigin::Boxes, UnitOrigin::Histories]
            }
            VerifyUnit::Frames(n, _) => vec![UnitOrigin::Scene(n)],
        };
        let wrong = || miette!("the result of unit {unit} was not written by `sdop verify`");
        if texts.len() != origins.len() {
            return Err(wrong());
        }
        let ledgers = origins.into_iter().zip(texts).map(|(origin, text)| {
            let failed = text.failures > 0;
            Some((origin, self.ledger(text)?, failed))
        });
        ledgers.collect::<Option<_>>().ok_or_else(wrong)
    }

    fn text(&self, ledger: &Ledger) -> LedgerText {
        let filled = |all: &Coverage| -> Vec<(usize, u64)> {
            all.filled().map(|(cell, lists)| (self.places[cell], lists)).collect()
        };
        let lists = |lists: &ListLedger| {
            let sums = [lists.lists, lists.required, lists.missed, lists.differ];
            (filled(&lists.coverage), sums)
        };
        let (boxes, histories) = (&ledger.boxes, &ledger.histories);
        LedgerText {
            predicates: ledger
                .predicates
                .map(|(overlaps, tally)| [overlaps, tally.filter, tally.interval, tally.exact]),
            rows: (ledger.rows.iter())
                .map(|(row, count)| (row.strategy, row.overlap, *count))
                .collect(),
            cells: filled(&ledger.coverage),
            boxes: lists(boxes),
            histories: lists(histories),
            failures: ledger.failures.len()
                + usize::from(boxes.failure.is_some())
                + usize::from(histories.failure.is_some()),
        }
    }

    fn ledger(&self, text: LedgerText) -> Option<Ledger> {
        let mut ledger = Ledger::default();
        let predicates = ledger.predicates.iter_mut().zip(text.predicates);
        for (mine, [overlaps, filter, interval, exact]) in predicates {
            *mine = (overlaps, Tally { filter, interval, exact });
        }
        for (strategy, overlap, count) in text.rows {
            ledger.rows.insert(LedgerKey { strategy, overlap }, count);
        }
        let covered = |filled: Vec<(usize, u64)>| {
            let mut coverage = Coverage::default();
            for (place, lists) in filled {
                coverage.count(*self.cells.get(place)?, lists);
            }
            Some(coverage)
        };
        let of_lists = |(filled, sums): LedgerLists| {
            let [lists, required, missed, differ] = sums;
            let coverage = covered(filled)?;
            Some(ListLedger { coverage, lists, required, missed, differ, failure: None })
        };
        ledger.coverage = covered(text.cells)?;
        (ledger.boxes, ledger.histories) = (of_lists(text.boxes)?, of_lists(text.histories)?);
        Some(ledger)
    }
}

/// Lists by the index of their cell, all lists, and pairs required, missed and different.
type LedgerLists = (Vec<(usize, u64)>, [u64; 4]);

/// A ledger as a unit's result.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LedgerText {
    /// Number of pairs that overlap, and of those that each stage decided.
    predicates: [[u64; 4]; Predicate::ALL.len()],
    rows: Vec<(Strategy, Option<Overlap>, ListCount)>,
    /// Lists judged, by the index of their cell.
    cells: Vec<(usize, u64)>,
    /// Those of given boxes.
    boxes: LedgerLists,
    /// Those of long-lived worlds.
    histories: LedgerLists,
    /// Number of failures, which only the process that ran the unit has in full.
    failures: usize,
}

impl Sweep for Verification {
    fn header(&self) -> miette::Result<Header> {
        let inputs = self.settings.scenes.iter().zip(&self.scenes);
        let inputs = inputs.zip(1..).map(|((name, scene), number)| {
            let untimed = Scene { construct_seconds: 0.0, ..scene.clone() };
            (format!("scene {number} ({name})"), digest(&untimed))
        });
        Header::new(NAME, &self.settings, inputs.collect(), self.units()).into_diagnostic()
    }

    fn name(&self, unit: usize) -> String {
        let variant = |(k, axes): (DirectionSet, Axes)| format!("k = {k}, {axes} axes");
        match self.unit(unit) {
            VerifyUnit::Hard(n, or_dop) => {
                let name = &self.settings.groups[n];
                format!("hard cases {name}, {}", variant(or_dop))
            }
            VerifyUnit::Rounds(seed, or_dop) => format!("seed {seed}, {}", variant(or_dop)),
            VerifyUnit::Frames(scene, block) => {
                let frames = frames_of(block, self.settings.frames);
                let name = &self.settings.scenes[scene];
                format!("{name}: frames {} to {}", frames.start, frames.end - 1)
            }
        }
    }

    fn run(&self, unit: usize) -> miette::Result<String> {
        let judged = self.judge(unit)?;
        let texts = judged.iter().map(|(_, ledger)| self.text(ledger));
        serde_json::to_string(&texts.collect::<Vec<_>>()).into_diagnostic()
    }

    /// A block's frames are judged on all threads, since the answers of several blocks would take
    /// too much memory.
    fn alone(&self, unit: usize) -> bool {
        matches!(self.unit(unit), VerifyUnit::Frames(..))
    }

    fn starts(&self, unit: usize) -> bool {
        let rounds = matches!(self.unit(unit), VerifyUnit::Rounds(..));
        !rounds || self.deadline.is_none_or(|end| Instant::now() < end)
    }
}
