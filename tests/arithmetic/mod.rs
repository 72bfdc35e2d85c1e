//! What the code computes, number by number, for comparison with the functions that Coq's theorems
//! speak of (`paper/proofs/coq/Run.v`, `RunOrDop.v`).
//!
//! A case is a function's name, the bits of its inputs and the bits of what the code makes of them.
//! `.ci/proofs` writes cases with `write_cases` and runs Coq's functions on them. The hash of some
//! cases that Coq has confirmed is kept, so that a change shows on a machine without Coq too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod case;
mod functions;
mod inputs;
mod ordops;
mod small;

use crate::limit;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};

use sdop::simd::Tier;
use sha2::{Digest, Sha256};

use case::Case;
use functions::FUNCTIONS;
use inputs::Inputs;

/// So many cases of each function.
const CASES: usize = 600;

/// The hash of these cases, as `.ci/proofs` has last confirmed them.
const CONFIRMED: &str = "6ef16122a2062591";

/// Hands over cases of each function in turn.
fn for_each_case(tier: Tier, of_each: usize, mut take: impl FnMut(Case)) {
    let mut inputs = Inputs::new(1);
    let mut pairs = ordops::Pairs::new(2);
    for _ in 0..of_each {
        for function in FUNCTIONS {
            take(function(tier, &mut inputs));
        }
        take(pairs.next(tier));
    }
}

/// One per line.
fn cases(tier: Tier, of_each: usize) -> String {
    let mut lines = String::new();
    for_each_case(tier, of_each, |case| writeln!(lines, "{case}").unwrap());
    lines
}

fn hash(text: &str) -> String {
    let hash = Sha256::digest(text);
    hash[..8].iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

#[test]
fn every_tier_computes_what_coq_confirmed() {
    for tier in Tier::available() {
        assert_eq!(
            hash(&cases(tier, CASES)),
            CONFIRMED,
            "{tier} computes other numbers than Coq has confirmed. If that is meant: run .ci/proofs, \
             which compares them with Coq's, and then keep the new hash."
        );
    }
}

/// Decisions go both ways often enough for a wrong one to show.
#[test]
fn cases_are_on_both_sides() {
    let lines = cases(Tier::SCALAR, CASES);
    for name in ["spheres", "stays", "cubes", "ordops"] {
        let outcomes = lines.lines().filter(|line| line.starts_with(name));
        let (mut yes, mut no) = (0, 0);
        for line in outcomes {
            *(if line.ends_with('1') { &mut yes } else { &mut no }) += 1;
        }
        assert!(yes > CASES / 10 && no > CASES / 10, "{name}: {yes} and {no}");
    }
}

/// Writes cases of the scalar tier to the file or pipe that `SDOP_CASES` names, as many of each
/// function as `SDOP_CASES_OF_EACH` says.
#[test]
#[ignore = "writes cases, for .ci/proofs"]
fn write_cases() {
    let value = |name| std::env::var(name).unwrap();
    let of_each = value("SDOP_CASES_OF_EACH").parse().unwrap();
    let mut out = BufWriter::new(File::create(value("SDOP_CASES")).unwrap());
    for_each_case(Tier::SCALAR, of_each, |case| {
        writeln!(out, "{case}").unwrap();
    });
    out.flush().unwrap();
}
