//! On which side of a plane does a point lie? Triangles, segments and rays are decided by this one
//! predicate.
//!
//! orient3d(a, b, c, d) = (d − a)·((b − a) × (c − a)), degree 3 in the coordinates. [`Side`] is its
//! sign at one stage of the cascade. The code that uses it ([`super::triangle`], [`super::parity`])
//! is written once for all stages.

use std::cmp::Ordering;
use std::marker::PhantomData;

use crate::linear::{Vector, cross, dot, largest, sub};
use crate::number::Number;

/// Positive on the side of the plane abc from which abc turns counter-clockwise.
pub fn orient3d<N: Number>(a: &Vector<N>, b: &Vector<N>, c: &Vector<N>, d: &Vector<N>) -> N {
    dot(&sub(d, a), &cross(&sub(b, a), &sub(c, a)))
}

/// The sign of orient3d at one stage, `None` when it cannot tell.
pub trait Side {
    /// What a point is at this stage.
    type Point;
    /// The side of d on the plane abc.
    fn side(&self, abc: [&Self::Point; 3], d: &Self::Point) -> Option<Ordering>;
}

/// Corners of a triangle.
pub type Triangle<P> = [P; 3];

/// Intervals and integers know by themselves.
pub struct Known<N>(PhantomData<N>);

impl<N> Known<N> {
    /// The stage of this number.
    pub fn stage() -> Self {
        Self(PhantomData)
    }
}

impl<N: Number> Side for Known<N> {
    type Point = Vector<N>;

    fn side(&self, [a, b, c]: [&Self::Point; 3], d: &Self::Point) -> Option<Ordering> {
        orient3d(a, b, c, d).sign()
    }
}

/// f64 with one error bound for all planes and points of a small group.
///
/// Let every coordinate be off by at most δ and lie within m of the group's origin, m' = m + 2δ, u
/// = 2⁻⁵³. A difference is at most 2m' and off by η = 2δ + 2um'. The determinant's six products
/// then move by less than 18η(2m')² = 144δm'² + 144um'³, and its own rounding is below 28u(2m')³ =
/// 224um'³. The bound takes 160 and 512.
pub struct Bounded {
    bound: f64,
}

impl Bounded {
    /// A bound for points whose coordinates are off by at most `error`.
    pub fn new<'a>(
        origin: &Vector<f64>,
        points: impl IntoIterator<Item = &'a Vector<f64>>,
        error: f64,
    ) -> Self {
        let reach = points.into_iter().map(|p| largest(&sub(p, origin))).fold(0.0, f64::max);
        let m = reach + 2.0 * error;
        Self { bound: (160.0 * error + 256.0 * f64::EPSILON * m) * m * m }
    }
}

impl Side for Bounded {
    type Point = Vector<f64>;

    fn side(&self, [a, b, c]: [&Self::Point; 3], d: &Self::Point) -> Option<Ordering> {
        match orient3d(a, b, c, d) {
            volume if volume > self.bound => Some(Ordering::Greater),
            volume if volume < -self.bound => Some(Ordering::Less),
            _ => None,
        }
    }
}

/// Three signs, if the stage can tell all of them.
pub fn known(signs: [Option<Ordering>; 3]) -> Option<[Ordering; 3]> {
    Some([signs[0]?, signs[1]?, signs[2]?])
}

/// Does the line pq, which crosses the triangle's plane in one point, cross it inside? It does when
/// it passes all three edges on the same side, touching included.
pub fn pierces<S: Side>(sides: &S, [p, q]: [&S::Point; 2], t: &Triangle<S::Point>) -> Option<bool> {
    let signs = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| sides.side([p, q, &t[i]], &t[j]));
    let any = |side: Ordering| signs.contains(&Some(side));
    if any(Ordering::Greater) && any(Ordering::Less) {
        return Some(false);
    }
    known(signs).map(|_| true)
}
