//! Triangles that their planes cannot decide: coplanar ones, segments and points. All numbers are
//! integers.
//!
//! Two such convex sets meet iff an edge of one pierces the other's interior, or two edges share a
//! point, or one contains the other in its plane; for the last, testing a single corner is enough.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::orientation::{Known, Side, Triangle, pierces};
use crate::linear::{Vector, cross, dot, sub};

type Point = Vector<IBig>;

/// Whether two triangles of any kind share a point.
pub fn meet(a: &Triangle<Point>, b: &Triangle<Point>) -> bool {
    let touching = || edges(a).any(|e| edges(b).any(|f| segments_meet(e, f)));
    pierced(a, b) || pierced(b, a) || touching() || contains(a, &b[0]) || contains(b, &a[0])
}

fn edges(t: &Triangle<Point>) -> impl Iterator<Item = [&Point; 2]> {
    [(0, 1), (1, 2), (2, 0)].into_iter().map(|(i, j)| [&t[i], &t[j]])
}

fn side(abc: [&Point; 3], d: &Point) -> Ordering {
    Known::<IBig>::stage().side(abc, d).unwrap_or_else(|| unreachable!("integers know every sign"))
}

fn is_zero(v: &Point) -> bool {
    v.iter().all(IBig::is_zero)
}

fn normal([a, b, c]: [&Point; 3]) -> Point {
    cross(&sub(b, a), &sub(c, a))
}

/// Does an edge of `t` cross the plane of the proper triangle `of` inside it?
fn pierced(t: &Triangle<Point>, of: &Triangle<Point>) -> bool {
    edges(t).any(|[p, q]| {
        let (from, to) = (side(of.each_ref(), p), side(of.each_ref(), q));
        from != to && pierces(&Known::<IBig>::stage(), [p, q], of) == Some(true)
    })
}

/// Do two closed segments share a point?
fn segments_meet([p, q]: [&Point; 2], [a, b]: [&Point; 2]) -> bool {
    if side([p, q, a], b) != Ordering::Equal {
        return false;
    }
    let across = cross(&sub(q, p), &sub(b, a));
    if is_zero(&across) {
        // Parallel, or one is a point: an end of one lies on the other or they are apart.
        return on_segment([a, b], p)
            || on_segment([a, b], q)
            || on_segment([p, q], a)
            || on_segment([p, q], b);
    }
    // In the plane that both span, each has its ends on either side of the other's line, or one of
    // them on it; both are not, as the lines are not parallel.
    let turn = |from: &Point, to: &Point, x: &Point| {
        dot(&across, &cross(&sub(to, from), &sub(x, from))).cmp(&IBig::ZERO)
    };
    turn(p, q, a) != turn(p, q, b) && turn(a, b, p) != turn(a, b, q)
}

/// Is x on the closed segment ab, which may be a point?
fn on_segment([a, b]: [&Point; 2], x: &Point) -> bool {
    let between = |i: usize| (a[i] <= x[i] && x[i] <= b[i]) || (b[i] <= x[i] && x[i] <= a[i]);
    is_zero(&normal([a, b, x])) && (0..3).all(between)
}

/// Is x in the proper triangle `t`, in its plane? No degenerate triangle contains more than its
/// edges do.
fn contains(t: &Triangle<Point>, x: &Point) -> bool {
    let normal = normal(t.each_ref());
    if is_zero(&normal) || side(t.each_ref(), x) != Ordering::Equal {
        return false;
    }
    edges(t).all(|[a, b]| dot(&normal, &cross(&sub(b, a), &sub(x, a))) >= IBig::ZERO)
}
