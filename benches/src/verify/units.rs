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
use sdop_judge::every_way::rounds::{SeedSource, boxes, group, histories, round};
use sdop_judge::every_way::{Ledger, LedgerKey};
use sdop_judge::ours::answers::Predicate;
use sdop_judge::ours::boxes::BoxCell;
use sdop_judge::ours::compare::ListCount;
use sdop_judge::ours::configurations::{Rotation, variants};
use sdop_judge::ours::hard::{FILES, HardCaseGroup};
use sdop_judge::ours::histories::HistoryCell;
use sdop_judge::ours::matrix::Cell;

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
    box_cells: Vec<BoxCell>,
    history_cells: Vec<HistoryCell>,
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
        let cells: Vec<Cell> = Cell::all(&rotation).collect();
        Ok(Self {
            groups: groups.collect::<miette::Result<_>>()?,
            scenes: Vec::new(),
            variants: variants().collect(),
            places: cells.iter().copied().zip(0..).collect(),
            box_cells: BoxCell::all(&rotation).map(|(cell, _)| cell).collect(),
            history_cells: HistoryCell::all(&rotation),
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
        let cells = ledger.matrix.filled();
        LedgerText {
            predicates: ledger
                .predicates
                .map(|(overlaps, tally)| [overlaps, tally.filter, tally.interval, tally.exact]),
            rows: (ledger.rows.iter())
                .map(|(row, count)| (row.strategy, row.overlap, *count))
                .collect(),
            cells: cells.map(|(cell, lists)| (self.places[cell], lists)).collect(),
            boxes: (self.box_cells.iter().enumerate())
                .filter_map(|(place, cell)| Some((place, *ledger.boxes.cells.get(cell)?)))
                .collect(),
            box_pairs: ledger.boxes.required,
            histories: (self.history_cells.iter().enumerate())
                .filter_map(|(place, cell)| Some((place, *ledger.histories.cells.get(cell)?)))
                .collect(),
            history_pairs: [
                ledger.histories.lists,
                ledger.histories.required,
                ledger.histories.missed,
                ledger.histories.differ,
            ],
            failures: ledger.failures.len()
                + usize::from(ledger.boxes.failure.is_some())
                + usize::from(ledger.histories.failure.is_some()),
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
        for (place, lists) in text.cells {
            ledger.matrix.fill(*self.cells.get(place)?, lists);
        }
        for (place, judged) in text.boxes {
            ledger.boxes.cells.insert(*self.box_cells.get(place)?, judged);
        }
        ledger.boxes.required = text.box_pairs;
        let histories = &mut ledger.histories;
        for (place, lists) in text.histories {
            let cell = *self.history_cells.get(place)?;
            histories.cells.insert(cell, lists);
        }
        [histories.lists, histories.required, histories.missed, histories.differ] =
            text.history_pairs;
        Some(ledger)
    }
}

/// A ledger as a unit's result.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LedgerText {
    /// Number of pairs that overlap, and of those that each stage decided.
    predicates: [[u64; 4]; Predicate::ALL.len()],
    rows: Vec<(Strategy, Option<Overlap>, ListCount)>,
    /// Lists judged, by the index of their cell.
    cells: Vec<(usize, u64)>,
    /// Lists of given boxes and wrong pairs in them, by the index of their cell.
    boxes: Vec<(usize, [u64; 2])>,
    /// Pairs of given boxes that meet.
    box_pairs: u64,
    /// Lists of long-lived worlds, by the index of their cell.
    histories: Vec<(usize, u64)>,
    /// Their lists, and pairs that had to be reported, were missed, or differ.
    history_pairs: [u64; 4],
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
