//! Reads `benches/adapters/claims.toml`: the adapters, the claim of each library, and its known
//! verdict.

use std::collections::BTreeMap;

use sdop_judge::Claim;
use sdop_judge::case::matches;
use serde::{Deserialize, Serialize};

/// All adapters.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claims {
    /// The command of an adapter by its language; `{folder}` is the adapter's folder.
    pub run: BTreeMap<String, String>,
    /// The adapters, in the board's order.
    pub adapter: Vec<Adapter>,
    /// Libraries that were not run.
    #[serde(default)]
    pub not_run: Vec<NotRun>,
}

/// One adapter: a library with one way of use and one claim.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Adapter {
    /// Its name on the board.
    pub name: String,
    /// Its folder in `benches/adapters/`.
    pub folder: String,
    /// Arguments of its program.
    #[serde(default)]
    pub arguments: String,
    /// Its language, which selects the command in `run`.
    pub language: String,
    /// The library's package.
    pub package: String,
    /// The version that the verdict is about.
    pub version: String,
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
    /// Its known verdict.
    pub verdict: String,
    /// Whether it is part of the short run.
    #[serde(default)]
    pub quick: bool,
    /// Other properties of the same use, each of which becomes a separate adapter.
    #[serde(default, skip_serializing)]
    pub also: Vec<FurtherClaim>,
    /// The name of the adapter whose further claim this is, or its own.
    #[serde(skip_deserializing)]
    pub base: String,
}

/// A further claim of an adapter; what is left out is as for its first one.
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

impl Claims {
    /// Reads the table.
    ///
    /// # Errors
    /// The text is not such a table (with line and column), or an adapter's language has no
    /// command.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut claims: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        claims.adapter = claims.adapter.into_iter().flat_map(Adapter::split).collect();
        let is_unknown = |adapter: &&Adapter| !claims.run.contains_key(&adapter.language);
        match claims.adapter.iter().find(is_unknown) {
            None => Ok(claims),
            Some(Adapter { name, language, .. }) => Err(format!(
                "the adapter {name} has the language {language}, and [run] has no command for it"
            )),
        }
    }

    /// The command that runs an adapter.
    #[must_use]
    pub fn command(&self, adapter: &Adapter) -> String {
        let line = self.run[&adapter.language].replace("{folder}", &adapter.folder);
        format!("{line} {}", adapter.arguments).trim_end().to_owned()
    }
}

impl Adapter {
    /// The adapter of its first claim, then one for each further claim, named after both.
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
