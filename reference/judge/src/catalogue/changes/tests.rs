//! A culler that keeps a body's old box along one axis is caught by every group of changes,
//! whatever the axis.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::truth::boxes_meet;
use crate::{Claim, Contestant, Scene, WorldBox, judge};
use sdop::bodies::Bodies;

/// What is kept when a frame changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum KeptBound {
    /// Nothing: the control.
    Nothing,
    /// A body's ends of the frame before.
    Body,
    /// The ends of the body that had the same number in the frame before.
    Number,
    /// A body's ends of the first frame in which it was there.
    First,
}

/// All pairs of boxes, of which one end or both along an axis are stale.
struct StaleCuller {
    keeps: KeptBound,
    ends: Vec<usize>,
    given: Vec<WorldBox>,
    kept: Vec<WorldBox>,
    was: Option<Vec<Option<u32>>>,
    pairs: Vec<[u32; 2]>,
}

impl StaleCuller {
    /// The stale box of a body, if there is one.
    fn old(&self, body: usize) -> Option<WorldBox> {
        let number = match (&self.was, self.keeps) {
            (_, KeptBound::Nothing) => return None,
            (Some(was), KeptBound::Body | KeptBound::First) => was[body]? as usize,
            _ => body,
        };
        self.kept.get(number).copied()
    }
}

impl Contestant for StaleCuller {
    fn boxes(&mut self, boxes: &[WorldBox]) {
        self.given = boxes.to_vec();
    }

    fn frame(&mut self, bodies: &Bodies) {
        let old: Vec<Option<WorldBox>> = (0..bodies.len()).map(|body| self.old(body)).collect();
        let mut seen = self.given.clone();
        for (seen, old) in seen.iter_mut().zip(&old) {
            for &end in old.iter().flat_map(|_| &self.ends) {
                seen[end] = old.unwrap()[end];
            }
        }
        self.pairs.clear();
        for j in 0..seen.len() {
            for i in 0..j {
                let moves = bodies.dynamic[i] || bodies.dynamic[j];
                if moves && boxes_meet(&seen[i], &seen[j]) {
                    self.pairs.push([i as u32, j as u32]);
                }
            }
        }
        self.kept = match self.keeps {
            KeptBound::First => {
                old.iter().zip(&self.given).map(|(old, given)| old.unwrap_or(*given)).collect()
            }
            _ => self.given.clone(),
        };
        self.was = None;
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }

    fn change(&mut self, _bodies: &Bodies, was: &[Option<u32>]) -> bool {
        self.was = Some(was.to_vec());
        true
    }
}

/// Whether the published cases of a group pass a culler with these stale ends: 0 to 2 lower ones, 3
/// to 5 upper ones.
fn passes(group: &str, keeps: KeptBound, ends: &[usize]) -> bool {
    let make = |_: &Scene<'_>| StaleCuller {
        keeps,
        ends: ends.to_vec(),
        given: Vec::new(),
        kept: Vec::new(),
        was: None,
        pairs: Vec::new(),
    };
    let verdict = judge(make).claims(Claim::Aabb).cases(&format!("{group}/*"));
    verdict.run().unwrap().passed()
}

#[test]
fn stale_ends_are_caught() {
    for group in [
        "churn/swap",
        "churn/teleport",
        "churn/move",
        "churn/turn",
        "churn/insert-remove",
        "stale/reshape",
        "stale/reorder",
        "stale/rebase",
        "stale/all-at-once",
    ] {
        assert!(passes(group, KeptBound::Nothing, &[0, 1, 2, 3, 4, 5]), "{group}");
        for axis in 0..3 {
            for ends in [vec![axis], vec![axis + 3], vec![axis, axis + 3]] {
                for keeps in [KeptBound::Body, KeptBound::Number, KeptBound::First] {
                    assert!(!passes(group, keeps, &ends), "{group} {keeps:?} {ends:?}");
                }
            }
        }
    }
}
