//! The outline of points in one plane, exact: Andrew's monotone chain (1979) on Shewchuk's
//! predicate.
//!
//! Coplanar points keep their outline when they are projected onto a coordinate plane in which they
//! are not collinear. Therefore the outline is computed in all three, and the one with most corners
//! is the right one. Collinear points have two corners in each, or one.

use robust::{Coord, Coord3D, orient2d};

/// The corners of the convex hull of coplanar points: indices, ascending.
pub(super) fn corners(points: &[Coord3D<f64>]) -> Vec<u32> {
    type Projection = fn(&Coord3D<f64>) -> Coord<f64>;
    let planes: [Projection; 3] =
        [|p| Coord { x: p.x, y: p.y }, |p| Coord { x: p.y, y: p.z }, |p| Coord { x: p.z, y: p.x }];
    let outlines = planes.map(|plane| outline(&points.iter().map(plane).collect::<Vec<_>>()));
    let mut corners = outlines.into_iter().max_by_key(Vec::len).unwrap_or_default();
    corners.sort_unstable();
    corners
}

fn outline(points: &[Coord<f64>]) -> Vec<u32> {
    // x + 0.0 turns −0 into 0; the total order of floats would sort −0 before 0.
    let key = |&i: &u32| [points[i as usize].x + 0.0, points[i as usize].y + 0.0];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by(|a, b| {
        let ([ax, ay], [bx, by]) = (key(a), key(b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by))
    });
    order.dedup_by_key(|i| key(i));
    if order.len() < 2 {
        return order;
    }
    let mut corners = half(points, order.iter().copied());
    corners.extend(half(points, order.iter().rev().copied()));
    corners
}

/// One side of the outline, without its last corner, which is the first of the other side.
fn half(points: &[Coord<f64>], order: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut side: Vec<u32> = Vec::new();
    for next in order {
        while let [.., before, last] = side[..] {
            let [a, b, c] = [before, last, next].map(|i| points[i as usize]);
            if orient2d(a, b, c) > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(next);
    }
    side.pop();
    side
}
