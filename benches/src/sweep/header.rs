//! [`Header`]: which work units belong to. Results with different code, settings or input can't be
//! merged.

use std::collections::BTreeMap;
use std::fmt::{self, Debug, Write as _};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest as _, Sha256};

use super::Shard;
use crate::hash::hex;

/// The form of a header and the lines after it.
const FORMAT: &str = "sdop units 1";

/// What work is: all that decides the results of its units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The form of the file.
    pub form: String,
    /// The command.
    pub command: String,
    /// The version of the code, and a digest of its sources.
    pub code: String,
    /// The request: the command's arguments.
    pub settings: Map<String, Value>,
    /// Digests of what it reads, by name.
    pub inputs: BTreeMap<String, String>,
    /// How many units there are.
    pub units: usize,
    /// The command as a reader types it, for pages. Other paths of files do not make it different
    /// work.
    pub line: String,
    /// The part that this file is of, if it is one.
    pub shard: Option<Shard>,
}

/// The version of this code, and a digest of its sources.
#[must_use]
pub fn code() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), env!("SDOP_SOURCES"))
}

/// A digest of all that a value holds: of its debug text, which gives every number to the bit.
#[must_use]
pub fn digest(value: &impl Debug) -> String {
    struct DebugHash(Sha256);
    impl fmt::Write for DebugHash {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text);
            Ok(())
        }
    }
    let mut text = DebugHash(Sha256::new());
    // Adding to a hash can't fail.
    let _ = write!(text, "{value:?}");
    hex(&text.0.finalize())
}

impl Header {
    /// The header of a command's work. Settings are those of a struct.
    ///
    /// # Errors
    /// Settings that JSON has no form for.
    pub fn new(
        command: &str,
        settings: &impl Serialize,
        inputs: BTreeMap<String, String>,
        units: usize,
    ) -> serde_json::Result<Self> {
        Ok(Self {
            form: FORMAT.to_owned(),
            command: command.to_owned(),
            code: code(),
            settings: serde_json::from_value(serde_json::to_value(settings)?)?,
            inputs,
            units,
            line: String::new(),
            shard: None,
        })
    }

    /// The settings, as the command knows them.
    ///
    /// # Errors
    /// Those of another command.
    pub fn settings<T: serde::de::DeserializeOwned>(&self) -> serde_json::Result<T> {
        serde_json::from_value(Value::Object(self.settings.clone()))
    }

    /// The first thing in which the work differs from another, in words: what it is here, and what
    /// there. Parts of one work don't differ.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let words = |what: &str, here: &str, there: &str| {
            (here != there).then(|| format!("the {what} is {here} here and {there} there"))
        };
        let none = || "none".to_owned();
        let keys = |one: Vec<String>, two: Vec<String>| {
            let mut keys = [one, two].concat();
            keys.sort();
            keys.dedup();
            keys
        };
        let settings = |header: &Self| header.settings.keys().cloned().collect();
        let inputs = |header: &Self| header.inputs.keys().cloned().collect();
        let setting = |key: &String| {
            let [here, there] = [self, other].map(|header| {
                let value = header.settings.get(key);
                value.map_or_else(none, Value::to_string)
            });
            words(&format!("setting `{key}`"), &here, &there)
        };
        let input = |key: &String| {
            let [here, there] =
                [self, other].map(|header| header.inputs.get(key).cloned().unwrap_or_else(none));
            words(&format!("input {key}"), &here, &there)
        };
        let count = |header: &Self| header.units.to_string();
        words("form", &self.form, &other.form)
            .or_else(|| words("command", &self.command, &other.command))
            .or_else(|| words("code", &self.code, &other.code))
            .or_else(|| keys(settings(self), settings(other)).iter().find_map(setting))
            .or_else(|| keys(inputs(self), inputs(other)).iter().find_map(input))
            .or_else(|| words("number of units", &count(self), &count(other)))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    #[derive(Clone, Serialize)]
    struct Settings {
        seeds: u64,
    }

    #[test]
    fn whatever_differs_is_named() {
        let header = |inputs: &[(&str, &str)], seeds| {
            let inputs = inputs.iter().map(|(a, b)| ((*a).into(), (*b).into()));
            Header::new("verify", &Settings { seeds }, inputs.collect(), 9).unwrap()
        };
        let one = header(&[("a.toml", "12")], 2);
        assert_eq!(one.difference(&one), None);
        let part = Header { shard: Some(Shard { index: 1, of: 2 }), ..one.clone() };
        assert_eq!(one.difference(&part), None);
        let change = |change: fn(&mut Header)| {
            let mut other = one.clone();
            change(&mut other);
            one.difference(&other).unwrap()
        };
        for (told, expected) in [
            (change(|h| h.command = "x".into()), "command is verify here"),
            (change(|h| h.code = "x".into()), "and x there"),
            (change(|h| h.units = 8), "units is 9 here and 8 there"),
            (change(|h| h.form = "x".into()), "form is sdop units"),
        ] {
            assert!(told.contains(expected), "{told}");
        }
        let seeds = one.difference(&header(&[("a.toml", "12")], 3)).unwrap();
        assert_eq!(seeds, "the setting `seeds` is 2 here and 3 there");
        let digest = one.difference(&header(&[("a.toml", "13")], 2)).unwrap();
        assert_eq!(digest, "the input a.toml is 12 here and 13 there");
        let more = one.difference(&header(&[("a.toml", "12"), ("b", "1")], 2));
        assert_eq!(more.unwrap(), "the input b is none here and 1 there");
    }
}
