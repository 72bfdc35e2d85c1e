//! Do two closed triangles share a point? They may be degenerate: a segment or a point.
//!
//! Two triangles in different planes meet iff an edge of one pierces the other (Guigue & Devillers
//! 2003 order the same signs). If all three corners of A are on B's plane, the two are coplanar or
//! B is degenerate. [`super::flat`] decides that case in integers, because no rounded number can.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::flat;
use super::orientation::{Bounded, Known, Side, Triangle, known, pierces};
use super::{Decision, Interval, cascade};
use crate::linear::Vector;

/// Whether two triangles meet: `rounded` ones whose second is off by at most `error` in each
/// coordinate (the first is exact), and the same two in intervals and integers.
pub fn meet(
    rounded: [&Triangle<Vector<f64>>; 2],
    error: f64,
    interval: impl FnOnce() -> [Triangle<Vector<Interval>>; 2],
    exact: impl FnOnce() -> [Triangle<Vector<IBig>>; 2],
) -> Decision<bool> {
    cascade(|| filter(rounded, error), || enclosed(&interval()), || integral(&exact()))
}

/// f64: boxes apart, then the signs.
pub(crate) fn filter([a, b]: [&Triangle<Vector<f64>>; 2], error: f64) -> Option<bool> {
    let low = |t: &Triangle<Vector<f64>>, i: usize| t[0][i].min(t[1][i]).min(t[2][i]);
    let high = |t: &Triangle<Vector<f64>>, i: usize| t[0][i].max(t[1][i]).max(t[2][i]);
    let gap = |i: usize| (low(b, i) - high(a, i)).max(low(a, i) - high(b, i));
    if (0..3).any(|i| gap(i) > 2.0 * error) {
        return Some(false);
    }
    let sides = Bounded::new(&a[0], a.iter().chain(b), error);
    contact(&sides, a, b)?.certain()
}

/// Intervals: the signs alone.
pub(crate) fn enclosed([a, b]: &[Triangle<Vector<Interval>>; 2]) -> Option<bool> {
    contact(&Known::stage(), a, b)?.certain()
}

/// Integers: the signs, and what they leave open.
pub(crate) fn integral([a, b]: &[Triangle<Vector<IBig>>; 2]) -> Option<bool> {
    let contact = contact(&Known::stage(), a, b)?;
    contact.certain().or_else(|| Some(flat::meet(a, b)))
}

/// How two triangles lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Contact {
    Apart,
    Meet,
    /// A lies in B's plane, or B has none.
    Flat,
}

impl Contact {
    fn certain(self) -> Option<bool> {
        match self {
            Self::Apart => Some(false),
            Self::Meet => Some(true),
            Self::Flat => None,
        }
    }
}

fn contact<S: Side>(sides: &S, a: &Triangle<S::Point>, b: &Triangle<S::Point>) -> Option<Contact> {
    let of = |plane: &Triangle<S::Point>, t: &Triangle<S::Point>| {
        let plane = plane.each_ref();
        t.each_ref().map(|corner| sides.side(plane, corner))
    };
    let corners_a = of(b, a);
    if one_side(&corners_a) {
        return Some(Contact::Apart);
    }
    let corners_b = of(a, b);
    if one_side(&corners_b) {
        return Some(Contact::Apart);
    }
    let (corners_a, corners_b) = (known(corners_a)?, known(corners_b)?);
    // With B proper, a degenerate A is its edges, which the loop looks at.
    if corners_a == [Ordering::Equal; 3] {
        return Some(Contact::Flat);
    }
    for (t, signs, plane) in [(a, corners_a, b), (b, corners_b, a)] {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            if signs[i] != signs[j] && pierces(sides, [&t[i], &t[j]], plane)? {
                return Some(Contact::Meet);
            }
        }
    }
    Some(Contact::Apart)
}

fn one_side(signs: &[Option<Ordering>; 3]) -> bool {
    [Ordering::Greater, Ordering::Less]
        .iter()
        .any(|side| signs.iter().all(|sign| *sign == Some(*side)))
}

/// Does the segment pq cross the triangle's interior? The inner `None` means that it touches the
/// border or runs in the plane; the outer one that the stage cannot tell.
pub fn crossing<S: Side>(
    sides: &S,
    [p, q]: [&S::Point; 2],
    t: &Triangle<S::Point>,
) -> Option<Option<bool>> {
    let ends = [p, q].map(|end| sides.side(t.each_ref(), end));
    if ends[0] == ends[1] && matches!(ends[0], Some(Ordering::Greater | Ordering::Less)) {
        return Some(Some(false));
    }
    let passes = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| sides.side([p, q, &t[i]], &t[j]));
    if passes.contains(&Some(Ordering::Greater)) && passes.contains(&Some(Ordering::Less)) {
        return Some(Some(false));
    }
    let signs = [ends[0]?, ends[1]?, passes[0]?, passes[1]?, passes[2]?];
    Some(if signs.contains(&Ordering::Equal) { None } else { Some(true) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Segments that touch the border do not count.
    #[test]
    fn border_touching_segments_are_undecided() {
        let point = |p: [i32; 3]| p.map(IBig::from);
        let t = [[0, 0, 0], [4, 0, 0], [0, 4, 0]].map(point);
        let crossing = |p, q| crossing(&Known::stage(), [&point(p), &point(q)], &t);
        assert_eq!(crossing([1, 1, -1], [1, 1, 1]), Some(Some(true)));
        assert_eq!(crossing([1, 1, 1], [1, 1, 2]), Some(Some(false)), "one side");
        assert_eq!(crossing([5, 5, -1], [5, 5, 1]), Some(Some(false)), "beside");
        assert_eq!(crossing([5, 5, 0], [5, 5, 1]), Some(Some(false)), "beside, from the plane");
        assert_eq!(crossing([2, 0, -1], [2, 0, 1]), Some(None), "an edge");
        assert_eq!(crossing([4, 0, -1], [4, 0, 1]), Some(None), "a corner");
        assert_eq!(crossing([-1, 1, 0], [5, 1, 0]), Some(None), "in the plane");
        assert_eq!(crossing([1, 1, 0], [1, 1, 3]), Some(None), "from the surface");
    }
}
