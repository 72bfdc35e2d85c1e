//! The corpus's own page: what each group is for and what naive f32 tests miss there.

use std::fmt::Write as _;

use super::{HardCaseError, HardCaseGroup, naive_misses};

const HEAD: &str = "\
# Hard cases

For authors of a culler: scenes with exact answers in which a careless culler misses pairs. Each
file is a group: why it is hard, a recipe, a seed, and the exact answers for every or-DOP, one bit
per pair and predicate. `tests/hard_cases.rs` checks the answers against the exact reference, and
every strategy, finder, overlap test and tier against the answers. `refused.toml` has inputs that
must be rejected. This page and the files are written by

    cargo run --release -- verify --record-hard-cases data/hard_cases

The columns count overlapping pairs (or-DOP: k = 18, principal axes, two-sided) that a plain f32
test without margins misses. `surface` counts pairs of meshes that meet only because one contains
the other, which a test of surfaces misses.

| group | pairs | sphere | aabb | or-dop | surface | why |
|---|--:|--:|--:|--:|--:|---|
";

/// The page, computed from the groups' names and texts.
///
/// # Errors
/// Groups that can't be made.
pub fn page<'a>(
    groups: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Result<String, HardCaseError> {
    let mut page = HEAD.to_owned();
    for (name, text) in groups {
        let group = HardCaseGroup::parse(text)?;
        let (m, pairs) = naive_misses(&group)?;
        // Formatting into a String cannot fail.
        let _ = writeln!(
            page,
            "| {name} | {pairs} | {} | {} | {} | {} | {} |",
            m.sphere, m.aabb, m.ordop, m.surface, group.why
        );
    }
    Ok(page)
}
