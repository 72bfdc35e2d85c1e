//! Compares a culler's list with the exact answers: required pairs, additional pairs, and their
//! causes.

use super::answers::{Answers, Predicate};
use super::configurations::Mode;
use sdop::bodies::Bodies;
use sdop::culler::{CullError, Culler};
use sdop::settings::{Budget, CullSettings, Interest, Strategy};
use sdop::volume::Shape;

/// What a comparison counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ListCount {
    /// Pairs judged.
    pub judged: u64,
    /// Pairs that had to be reported.
    pub required: u64,
    /// Pairs reported.
    pub reported: u64,
    /// Required and not reported: the promise broken.
    pub missed: u64,
    /// Pairs that are in this list and not in that of all-pairs, or the other way round.
    pub differ: u64,
    /// Reported although the exact volumes don't overlap, but volumes wider by the stated margins
    /// do: the price of rounding.
    pub margin: u64,
    /// Reported although not even those overlap: an or-DOP's support is bounded from its slabs, not
    /// from its corners (and, with `s-dop-time-critical`, what the budget left untested).
    pub bound: u64,
    /// Reported and required although the meshes don't meet: the volumes' looseness. Of
    /// `meshes_judged` pairs.
    pub loose: u64,
    /// Pairs of which the meshes were judged too.
    pub meshes_judged: u64,
}

impl ListCount {
    /// Adds another count.
    pub fn add(&mut self, other: &Self) {
        self.judged += other.judged;
        self.required += other.required;
        self.reported += other.reported;
        self.missed += other.missed;
        self.differ += other.differ;
        self.margin += other.margin;
        self.bound += other.bound;
        self.loose += other.loose;
        self.meshes_judged += other.meshes_judged;
    }
}

/// The culling settings that a strategy needs to run on any frame: interest in every seventh body,
/// a budget of three tests.
#[must_use]
pub fn settings(strategy: Strategy, base: &CullSettings, bodies: usize) -> CullSettings {
    CullSettings {
        strategy,
        interest: Some(Interest::Bodies((0..bodies as u32).step_by(7).collect())),
        budget: Some(Budget::Tests(3)),
        ..base.clone()
    }
}

/// A culler of these settings in this mode.
///
/// # Errors
/// Settings that the bodies can't have, threads that the system refuses.
pub fn culler(
    shapes: &[Shape],
    bodies: &Bodies,
    settings: &CullSettings,
    mode: Mode,
) -> Result<Culler, CullError> {
    let mode = Culler::builder()
        .settings(settings)
        .updates(mode.updates)
        .tier(mode.tier)
        .threads(mode.threads)
        .worth_waking(0);
    mode.build(shapes, bodies)
}

/// What the finder led to in the culler's last frame, sorted: the list, which every finder must
/// give. What a budget leaves untested depends on the order in which pairs were found, so
/// time-critical culling shows the potentially colliding set.
#[must_use]
pub fn found(culler: &Culler, settings: &CullSettings) -> Vec<[u32; 2]> {
    if !settings.strategy.scheme().has_budget() {
        return culler.pairs().sorted();
    }
    let mut pairs: Vec<[u32; 2]> = culler.potentially_colliding().collect();
    pairs.sort_unstable();
    pairs
}

/// The pairs that one of two sorted lists has more often than the other.
#[must_use]
pub fn difference<P: Copy + Ord>(one: &[P], other: &[P]) -> Vec<P> {
    let mut differing = Vec::new();
    let (mut one, mut other) = (one.iter().peekable(), other.iter().peekable());
    while let Some(&next) = one.peek().into_iter().chain(other.peek()).min() {
        match (one.next_if_eq(&next), other.next_if_eq(&next)) {
            (Some(_), Some(_)) => {}
            _ => differing.push(*next),
        }
    }
    differing
}

/// Compares a sorted list with the answers. Returns the count, in which all that is reported and
/// not required is `bound`, the missed pairs (a strategy's predicate, and the mesh intersections
/// themselves where they were judged), and those reported and not required.
///
/// A pair that the list holds twice or that isn't among the judged pairs (i ≥ j, static–static)
/// counts as missed.
#[must_use]
pub fn compare(
    answers: &Answers,
    settings: &CullSettings,
    sorted: &[[u32; 2]],
) -> (ListCount, Vec<[u32; 2]>, Vec<[u32; 2]>) {
    let interest: &[u32] = match &settings.interest {
        Some(Interest::Bodies(list)) => list,
        _ => &[],
    };
    let culls = settings.strategy.scheme().culls();
    let meshes = answers.of(Predicate::Mesh);
    let mut count = ListCount {
        judged: answers.pairs.len() as u64,
        reported: sorted.len() as u64,
        ..ListCount::default()
    };
    let (mut missed, mut extra) = (Vec::new(), Vec::new());
    let mut rest = sorted.iter().peekable();
    for (n, pair) in answers.pairs.iter().enumerate() {
        let reported = rest.next_if_eq(&pair).is_some();
        let required = answers.required(settings.strategy, settings.overlap, interest, n);
        let meet = meshes.get(n).copied();
        count.required += u64::from(required);
        count.meshes_judged += u64::from(meet.is_some());
        if reported && !required {
            extra.push(*pair);
        }
        count.loose += u64::from(reported && required && meet == Some(false));
        if !reported && (required || (culls && meet == Some(true))) {
            missed.push(*pair);
        }
    }
    missed.extend(rest);
    count.missed = missed.len() as u64;
    count.bound = extra.len() as u64;
    (count, missed, extra)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lists differ in the pairs that one has more often than the other.
    #[test]
    fn repeated_pairs_are_differences() {
        let (a, b, c) = ([0, 1], [0, 2], [3, 4]);
        assert!(difference(&[a, b, c], &[a, b, c]).is_empty());
        assert_eq!(difference(&[a, b, b], &[a, b]), vec![b]);
        assert_eq!(difference(&[b], &[a, c]), vec![a, b, c]);
        assert_eq!(difference(&[], &[a]), vec![a]);
    }

    /// A list with a pair twice, or with a pair that cannot exist, does not pass.
    #[test]
    fn invalid_lists_do_not_pass() {
        let answers = Answers { pairs: vec![[0, 1], [0, 2]], ..Answers::default() };
        let none = CullSettings { strategy: Strategy::None, ..CullSettings::all_pairs() };
        for (list, missed) in
            [(vec![], 0), (vec![[0, 1]], 0), (vec![[0, 1], [0, 1]], 1), (vec![[0, 2], [2, 0]], 1)]
        {
            assert_eq!(compare(&answers, &none, &list).0.missed, missed, "{list:?}");
        }
    }
}
