//! The corpus of hard cases: groups stored by recipe and seed, each with its exact answers.
//!
//! A group's file says what is drawn and, for every or-DOP (k, axes), which pairs overlap by each
//! predicate: one bit per pair, hexadecimal, in the order of runs, frames and sorted pairs. The
//! exact reference computed the answers when they were recorded, and tests still compare them with
//! it.

use std::collections::BTreeMap;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::configuration::variants;
use crate::draw::bodies::ContactSpec;
use crate::draw::forms::{Form, FormError};
use crate::truth::naive::NaiveMisses;
use crate::truth::reference_shapes::InvalidInput;
use crate::truth::{Answers, Predicate};
use sdop::volume::{Axes, DirectionSet};

mod readme;
pub mod recipe;

pub use readme::page;
pub use recipe::{HardCases, Recipe};

/// The text of each group's file, by name.
pub use sdop_data::HARD_CASES as FILES;

/// One group of hard cases.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HardCaseGroup {
    /// What breaks here.
    pub why: String,
    /// Where all draws start.
    pub seed: u64,
    /// Predicates that hold for every pair of a dynamic and a static body by construction, whatever
    /// the reference says.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<String>,
    /// How bodies are arranged.
    pub recipe: Recipe,
    /// How they touch.
    #[serde(default)]
    pub contacts: ContactSpec,
    /// What they look like.
    pub forms: Vec<Form>,
    /// The answers by or-DOP ("18 principal") and by predicate: one bit per pair.
    #[serde(default)]
    pub answers: BTreeMap<String, BTreeMap<String, String>>,
}

/// A group that can't be made.
#[derive(Debug, thiserror::Error)]
pub enum HardCaseError {
    /// The file.
    #[error("{0}")]
    File(#[from] toml::de::Error),
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// Numbers that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
}

impl HardCaseGroup {
    /// Reads a group's file.
    ///
    /// # Errors
    /// Text that is no group.
    pub fn parse(text: &str) -> Result<Self, HardCaseError> {
        Ok(toml::from_str(text)?)
    }

    /// Makes the cases for one or-DOP.
    ///
    /// # Errors
    /// A form can't be built.
    pub fn cases(&self, k: DirectionSet, axes: Axes) -> Result<HardCases, HardCaseError> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        Ok(self.recipe.cases(&self.forms, &self.contacts, (k, axes), &mut rng)?)
    }

    /// The exact answers for one or-DOP, one per frame, run by run.
    ///
    /// # Errors
    /// Poses outside the contract.
    pub fn judge(
        &self,
        cases: &HardCases,
        k: DirectionSet,
    ) -> Result<Vec<Vec<Answers>>, HardCaseError> {
        let judge = |frame| Answers::judge(&cases.shapes, frame, k, &Predicate::ALL);
        let runs = cases.runs.iter();
        let judged = runs.map(|run| run.iter().map(judge).collect::<Result<_, _>>());
        Ok(judged.collect::<Result<_, _>>()?)
    }

    /// Recomputes the answers.
    ///
    /// # Errors
    /// As [`HardCaseGroup::cases`] and [`HardCaseGroup::judge`].
    pub fn record(&mut self) -> Result<(), HardCaseError> {
        self.answers.clear();
        for (k, axes) in variants() {
            let judged = self.judge(&self.cases(k, axes)?, k)?;
            self.answers.insert(variant_name(k, axes), spell(&judged));
        }
        Ok(())
    }

    /// The answers as the end of the group's file.
    #[must_use]
    pub fn answers_toml(&self) -> String {
        let mut text = String::new();
        for (variant, answers) in &self.answers {
            text += &format!("\n[answers.{variant:?}]\n");
            for (predicate, bits) in answers {
                text += &format!("{predicate} = {bits:?}\n");
            }
        }
        text
    }
}

/// What naive f32 tests miss in a group, with k = 18 along principal axes, and of how many pairs.
///
/// # Errors
/// As [`HardCaseGroup::cases`] and [`HardCaseGroup::judge`].
pub fn naive_misses(group: &HardCaseGroup) -> Result<(NaiveMisses, u64), HardCaseError> {
    let (mut misses, mut pairs) = (NaiveMisses::default(), 0);
    let cases = group.cases(DirectionSet::K18, Axes::Principal)?;
    let judged = group.judge(&cases, DirectionSet::K18)?;
    for (frame, answers) in cases.runs.iter().flatten().zip(judged.iter().flatten()) {
        misses.add(&NaiveMisses::count(&cases.shapes, frame, answers)?);
        pairs += answers.pairs.len() as u64;
    }
    Ok((misses, pairs))
}

/// How files name an or-DOP.
#[must_use]
pub fn variant_name(k: DirectionSet, axes: Axes) -> String {
    format!("{k} {axes}")
}

/// The answers as a file spells them.
#[must_use]
pub fn spell(judged: &[Vec<Answers>]) -> BTreeMap<String, String> {
    let bits = |predicate: Predicate| {
        let all = judged.iter().flatten().flat_map(|a| a.of(predicate));
        hexadecimal(all.copied())
    };
    let spelled = |p: &Predicate| (p.name().replace("or-dop ", ""), bits(*p));
    Predicate::ALL.iter().map(spelled).collect()
}

/// Four bits per digit, the highest first. The last digit is padded with zeros.
fn hexadecimal(bits: impl Iterator<Item = bool>) -> String {
    let bits: Vec<bool> = bits.collect();
    let digit = |four: &[bool]| {
        let bit = |i: usize| u32::from(four.get(i) == Some(&true)) << (3 - i);
        char::from_digit((0..4).map(bit).sum(), 16).unwrap_or('0')
    };
    bits.chunks(4).map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spelled_from_the_left() {
        let bits = [true, false, false, true, false, true];
        assert_eq!(hexadecimal(bits.into_iter()), "94");
    }
}
