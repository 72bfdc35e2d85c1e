//! Histories that seeds draw, by the judge's harness: whatever has happened, pairs, events and
//! answers are those of the present bodies.

use std::ops::Range;

use sdop::Tier;
use sdop_judge::configuration::{Rotation, variants};
use sdop_judge::verify::rounds::history;

pub use sdop_judge::verify::rounds::HistoryKind;

/// Long-lived sets of a kind live through the histories of each seed, for each or-DOP.
pub fn live(kind: HistoryKind, seeds: Range<u64>) {
    let rotation = Rotation::new(&[Tier::available(), vec![Tier::SCALAR_FLUSH]].concat());
    for seed in seeds {
        for (number, variant) in variants().enumerate() {
            let judged = history(kind, seed, number, variant, &rotation);
            let judged = judged.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(judged.failure, None, "seed {seed}, or-DOP {number}");
            assert!(judged.required > judged.lists, "bodies are near each other");
        }
    }
}
