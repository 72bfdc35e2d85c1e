//! Shards: parts of the units, for schedulers that start independent processes.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// One of n parts: part i has every n-th unit, beginning with the i-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Shard {
    /// Counted from 1.
    pub index: usize,
    /// The number of parts.
    pub of: usize,
}

/// Text that names no part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ShardError {
    /// Not two numbers.
    #[error("expected i/n, as in 1/4")]
    Form,
    /// No such part.
    #[error("there is no part {0}: i counts from 1 to n")]
    Range(Shard),
}

impl Shard {
    /// The units of this part, among `units` in total.
    #[must_use]
    pub fn units(self, all: usize) -> Vec<usize> {
        (self.index - 1..all).step_by(self.of).collect()
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let parts = text
            .split_once('/')
            .and_then(|(index, of)| Some((index.parse().ok()?, of.parse().ok()?)));
        let (index, of) = parts.ok_or(ShardError::Form)?;
        let shard = Self { index, of };
        if (1..=of).contains(&index) { Ok(shard) } else { Err(ShardError::Range(shard)) }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    #[test]
    fn the_parts_have_every_unit_once() {
        for (all, of) in [(0, 1), (7, 3), (2, 5), (12, 4)] {
            let parts = (1..=of).flat_map(|index| Shard { index, of }.units(all));
            let mut units: Vec<usize> = parts.collect();
            units.sort_unstable();
            assert_eq!(units, (0..all).collect::<Vec<_>>());
        }
    }

    /// A part is read as it is written and none that is not there.
    #[test]
    fn shard_argument_round_trips() {
        assert_eq!("2/3".parse::<Shard>().unwrap().to_string(), "2/3");
        for text in ["0/3", "4/3", "0/0"] {
            assert!(matches!(text.parse::<Shard>(), Err(ShardError::Range(_))));
        }
        for text in ["", "1", "1/", "/2", "a/b", "-1/2", "1/2/3"] {
            assert_eq!(text.parse::<Shard>(), Err(ShardError::Form), "{text}");
        }
    }
}
