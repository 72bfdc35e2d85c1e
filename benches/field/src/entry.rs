//! An engine of the field: its row in `engines.toml`, and what builds it.
//!
//! A new engine is a row and a file in `engines/` with a `Contestant` of [`Frame`]s and its names.

use std::sync::LazyLock;

use miette::miette;
use sdop_bench::roster::{Roster, RosterRow, Workload};
use sdop_bench::scene::Scene;
use sdop_judge::Claim;
use sdop_judge::contestant::Contestant;

use crate::engines;
use crate::frame::Frame;

/// An engine with the bodies of one scene. The timed work is from the frame's boxes, or from what
/// has changed, to a complete answer in the engine's memory. A question's answers are pairs of the
/// question's number and a body.
pub type Engine = Box<dyn Contestant<Frame>>;

/// Builds an engine.
pub type New = fn(&Setup<'_>) -> miette::Result<Engine>;

/// What an engine is built for.
#[derive(Clone, Copy)]
pub struct Setup<'a> {
    /// The scene, for what culls by more than boxes.
    pub scene: &'a Scene,
    /// The first frame, with all bodies.
    pub first: &'a Frame,
    /// Threads to use.
    pub threads: usize,
    /// Whether frames will have few changed bodies.
    pub is_sparse: bool,
}

/// One engine, or one way to drive it.
#[derive(Clone, Copy)]
pub struct Entry {
    /// What `engines.toml` says of it.
    pub row: &'static RosterRow,
    /// Builds it.
    pub new: New,
}

/// The name of the engine with which the others are compared in a workload.
pub fn ours(workload: Workload) -> &'static str {
    match workload {
        Workload::Movers => "sdop BoxWorld",
        Workload::Queries => "sdop",
        _ => "sdop boxes",
    }
}

impl Entry {
    /// Its name in tables and on the command line.
    pub fn name(&self) -> &'static str {
        &self.row.name
    }

    /// Whether it is one of ours, which is never left out.
    pub fn is_ours(&self) -> bool {
        self.row.name.starts_with("sdop")
    }

    /// What it finds, by the claim by which it is judged.
    pub fn finds(&self) -> &'static str {
        match self.row.claim {
            Claim::Sphere => "spheres",
            Claim::Mesh => "s-dop",
            _ => "boxes",
        }
    }
}

/// Every engine that was compiled in, in the order of `engines.toml`.
pub fn roster() -> Vec<Entry> {
    static ROSTER: LazyLock<Roster> = LazyLock::new(|| {
        let roster = Roster::parse(include_str!("../engines.toml"));
        roster.unwrap_or_else(|problem| panic!("engines.toml: {problem}")) // a test reads it
    });
    let linked = engines::all();
    let entry = |row: &'static RosterRow| {
        let (_, new) = linked.iter().find(|(name, _)| *name == row.name)?;
        Some(Entry { row, new: *new })
    };
    ROSTER.engine.iter().filter_map(entry).collect()
}

/// The engines of a workload whose names begin as requested, and ours.
///
/// # Errors
/// A request that no name fits.
pub fn chosen(workload: Workload, wished: Option<&[String]>) -> miette::Result<Vec<Entry>> {
    let mut all = roster();
    let begins = |entry: &Entry, wish: &String| entry.name().starts_with(wish.as_str());
    for wish in wished.unwrap_or_default() {
        if !all.iter().any(|entry| begins(entry, wish)) {
            let known: Vec<_> = all.iter().map(Entry::name).collect();
            return Err(miette!(
                help = format!(
                    "compiled in: {}; others need --features physx,debian,box3d",
                    known.join(", ")
                ),
                "no engine's name begins with `{wish}`"
            ));
        }
    }
    all.retain(|entry| {
        let is_wished = |wished: &[String]| wished.iter().any(|wish| begins(entry, wish));
        entry.row.can.contains(&workload)
            && (entry.name() == ours(workload) || wished.is_none_or(is_wished))
    });
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each engine that is linked has a row, and each once.
    #[test]
    fn linked_engines_have_rows() {
        let (roster, linked) = (roster(), engines::all());
        for (name, _) in &linked {
            assert_eq!(roster.iter().filter(|entry| entry.name() == *name).count(), 1, "{name}");
        }
        assert_eq!(roster.len(), linked.len());
        assert!(roster.iter().all(|entry| entry.row.language == "linked"));
    }
}
