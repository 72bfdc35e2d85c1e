//! `benches/adapters/claims.toml`: the adapters, what each library says of itself, and the verdict
//! that it is known to get.

use std::collections::BTreeMap;

use sdop_judge::Claim;
use sdop_judge::case::matches;
use serde::{Deserialize, Serialize};

/// All adapters.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claims {
    /// The command of an adapter by its language; `{folder}` stands for the adapter's.
    pub run: BTreeMap<String, String>,
    /// The adapters, in the board's order.
    pub adapter: Vec<Adapter>,
    /// Libraries that nobody has run here.
    #[serde(default)]
    pub not_run: Vec<NotRun>,
}

/// One adapter: a library with one way of use and one claim.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Adapter {
    /// What the board calls it.
    pub name: String,
    /// Its folder in `benches/adapters/`.
    pub folder: String,
    /// Arguments of its program.
    #[serde(default)]
    pub arguments: String,
    /// Which of the commands in `run` it takes.
    pub language: String,
    /// The library's package.
    pub package: String,
    /// The version that the verdict is about.
    pub version: String,
    /// The property that it is judged by.
    pub claim: Claim,
    /// What the library's documentation says.
    pub says: String,
    /// How it is used.
    pub settings: String,
    /// Whether it says that pairs that only touch count.
    #[serde(default = "yes")]
    pub touching: bool,
    /// Cases that are outside of its claim.
    #[serde(default)]
    pub unclaimed: Vec<Unclaimed>,
    /// The verdict that it is known to get.
    pub verdict: String,
    /// Whether it is part of the short run.
    #[serde(default)]
    pub quick: bool,
}

/// Cases that a library does not claim to get right.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Unclaimed {
    /// Their names, as a pattern.
    pub cases: String,
    /// Where the library says so.
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
    /// Text that is no such table, with line and column; an adapter whose language has no command.
    pub fn parse(text: &str) -> Result<Self, String> {
        let claims: Self = toml::from_str(text).map_err(|error| error.to_string())?;
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
        format!("{line} {}", adapter.arguments)
            .trim_end()
            .to_owned()
    }
}

impl Adapter {
    /// Why the library does not claim to get a case right, if it says so.
    #[must_use]
    pub fn disclaims(&self, case: &str) -> Option<&str> {
        let is_about = |unclaimed: &&Unclaimed| matches(&unclaimed.cases, case);
        self.unclaimed
            .iter()
            .find(is_about)
            .map(|it| it.why.as_str())
    }
}
