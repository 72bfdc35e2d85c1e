//! Compares a culler's list with the exact answers: required pairs, additional pairs, and their
//! causes.

use super::answers::{Answers, Predicate};
use sdop::bodies::Aabb;
use sdop::settings::{CullSettings, Interest};

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

/// The pairs that have a point in common, by the definition.
#[must_use]
pub fn meeting(boxes: &[Aabb]) -> Vec<[u32; 2]> {
    let on =
        |a: &Aabb, b: &Aabb, axis: usize| a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis];
    let mut pairs = Vec::new();
    for (i, a) in boxes.iter().enumerate() {
        for (j, b) in boxes.iter().enumerate().skip(i + 1) {
            if (0..3).all(|axis| on(a, b, axis)) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::settings::Strategy;

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
