//! Reads `benches/field/engines.toml`: every other engine and library, how it is used, what it
//! claims and can do, and its known verdict.

use std::collections::BTreeMap;

use sdop_judge::Claim;
use sdop_judge::case::matches;
use serde::{Deserialize, Serialize};

/// All engines.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Roster {
    /// The command of an engine by its language; `{name}` and `{folder}` are the engine's.
    pub run: BTreeMap<String, String>,
    /// The engines, in the board's order.
    pub engine: Vec<RosterRow>,
    /// Libraries that were not run.
    #[serde(default)]
    pub not_run: Vec<NotRun>,
}

/// What an engine can be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Workload {
    /// The pairs of boxes that all move.
    Boxes,
    /// The pairs of boxes, given those that have changed.
    Movers,
    /// Which boxes meet a box, a ball or a segment.
    Queries,
    /// The pairs of bodies of several shapes.
    Parts,
    /// Pairs in space that repeats.
    Periodic,
}

/// The one case for which an engine is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OnlyCase {
    /// Bodies that leave while others come.
    Replacement,
    /// Meshes instead of boxes.
    Meshes,
    /// All pairs are read, too: at one per cent of movers.
    ReadPairs,
}

/// One engine or library with one way of use and one claim.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RosterRow {
    /// Its name in tables.
    pub name: String,
    /// Its folder in `benches/adapters/`, or the name of its program.
    #[serde(default)]
    pub folder: String,
    /// Arguments of its program.
    #[serde(default)]
    pub arguments: String,
    /// Its language, which selects the command in `run`; `linked` is linked into `sdop-field`.
    pub language: String,
    /// The library's package.
    pub package: String,
    /// The version that the verdict is about.
    pub version: String,
    /// The library's licence.
    pub licence: String,
    /// What it can be used for.
    pub can: Vec<Workload>,
    /// The property by which it is judged.
    pub claim: Claim,
    /// The library's documentation of that property.
    pub says: String,
    /// How it is used.
    pub settings: String,
    /// Whether it documents that touching pairs are reported.
    #[serde(default = "yes")]
    pub touching: bool,
    /// Cases outside of its claim.
    #[serde(default)]
    pub unclaimed: Vec<UnclaimedCases>,
    /// Its known verdict; empty for a way of use that the board doesn't judge.
    #[serde(default)]
    pub verdict: String,
    /// Links to what is known of its failures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<String>,
    /// Whether it is part of the short run.
    #[serde(default)]
    pub quick: bool,
    /// Other properties of the same use, each of which becomes a separate row.
    #[serde(default, skip_serializing)]
    pub also: Vec<FurtherClaim>,
    /// The name of the row whose further claim this is, or its own.
    #[serde(skip_deserializing)]
    pub base: String,
    /// How it is timed.
    #[serde(default, skip_serializing)]
    pub timed: TimedUse,
}

/// How an engine that is linked in is timed.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TimedUse {
    /// Whether it can use several threads.
    pub threads: bool,
    /// Whether it keeps state other than buffers between frames. An engine that starts from nothing
    /// in each frame only joins for the last warm-up frames.
    pub ages: bool,
    /// The length by which it grows each box.
    pub margin: f64,
    /// The distance up to which it may report pairs of boxes that are apart.
    pub within: f32,
    /// Whether it may report pairs that met once, because it drops pairs late.
    pub late: bool,
    /// The most bodies with which it runs: building the slowest ones for more takes minutes.
    pub most_bodies: Option<usize>,
    /// The one case for which it is there.
    pub only: Option<OnlyCase>,
    /// Kinds of questions that it has no query for.
    pub lacks: Vec<String>,
}

impl Default for TimedUse {
    fn default() -> Self {
        Self {
            threads: false,
            ages: true,
            margin: 0.0,
            within: 0.0,
            late: false,
            most_bodies: None,
            only: None,
            lacks: Vec::new(),
        }
    }
}

/// A further claim of a row; what is left out is as for its first one.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FurtherClaim {
    /// The property by which it is judged.
    pub claim: Claim,
    /// The library's documentation of that property.
    pub says: Option<String>,
    /// How it is used.
    pub settings: Option<String>,
    /// Arguments of its program.
    pub arguments: Option<String>,
    /// Whether it documents that touching pairs are reported.
    pub touching: Option<bool>,
    /// Its known verdict.
    pub verdict: String,
    /// Whether it is part of the short run.
    pub quick: Option<bool>,
}

/// Cases for which a library makes no claim.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct UnclaimedCases {
    /// A pattern of their names.
    pub cases: String,
    /// The library's statement.
    pub why: String,
}

/// A library without a row.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct NotRun {
    /// The library.
    pub name: String,
    /// Why it was not run.
    pub why: String,
}

fn yes() -> bool {
    true
}

impl Roster {
    /// Reads the table.
    ///
    /// # Errors
    /// The text is not such a table (with line and column), or an engine's language has no
    /// command.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut roster: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        roster.engine = roster.engine.into_iter().flat_map(RosterRow::split).collect();
        let is_unknown = |row: &&RosterRow| !roster.run.contains_key(&row.language);
        match roster.engine.iter().find(is_unknown) {
            None => Ok(roster),
            Some(RosterRow { name, language, .. }) => Err(format!(
                "the engine {name} has the language {language}, and [run] has no command for it"
            )),
        }
    }

    /// The command that runs an engine as a program that speaks the judge's format.
    #[must_use]
    pub fn command(&self, row: &RosterRow) -> String {
        let line = self.run[&row.language].replace("{folder}", &row.folder);
        format!("{} {}", line.replace("{name}", &row.base), row.arguments).trim_end().to_owned()
    }
}

impl RosterRow {
    /// The row of its first claim, then one for each further claim, named after both.
    fn split(mut self) -> Vec<Self> {
        self.base.clone_from(&self.name);
        let also = std::mem::take(&mut self.also);
        let first = std::iter::once(self.clone());
        let further = also.into_iter().map(|it| Self {
            name: format!("{}-{}", self.name, it.claim),
            claim: it.claim,
            says: it.says.unwrap_or_else(|| self.says.clone()),
            settings: it.settings.unwrap_or_else(|| self.settings.clone()),
            arguments: it.arguments.unwrap_or_else(|| self.arguments.clone()),
            touching: it.touching.unwrap_or(self.touching),
            verdict: it.verdict,
            quick: it.quick.unwrap_or(self.quick),
            ..self.clone()
        });
        first.chain(further).collect()
    }

    /// The reason why a case is outside of the library's claim, if it is.
    #[must_use]
    pub fn disclaims(&self, case: &str) -> Option<&str> {
        let is_about = |unclaimed: &&UnclaimedCases| matches(&unclaimed.cases, case);
        self.unclaimed.iter().find(is_about).map(|it| it.why.as_str())
    }
}
