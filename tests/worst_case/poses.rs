//! Attacks on the f64 pose: transformed coordinates, ball centres, re-fitted extents, and the f32
//! axes with their product.

use sdop::rounding::U;
use sdop::rounding::pose::{refit, rotation, transform, world_axes};
use sdop::rounding::sphere::world_ball;

use super::climb::{Random, climb};
use super::exact::{self, Double};
use super::machine::F;

/// 2⁻⁵³.
const EPSILON: f64 = f64::EPSILON / 2.0;

type Posed = ([f32; 4], [f32; 3], [f32; 3]);

fn start(random: &mut Random) -> [f32; 10] {
    std::array::from_fn(|_| random.signed())
}

fn split(p: &[f32; 10]) -> Posed {
    ([p[0], p[1], p[2], p[3]], [p[4], p[5], p[6]], [p[7], p[8], p[9]])
}

fn largest(vectors: &[[f32; 3]]) -> f64 {
    vectors.iter().flatten().fold(0.0, |m: f64, &x| m.max(f64::from(x.abs())))
}

/// Error of a transformed coordinate in 2⁻⁵³·max(|x|∞, |t|∞).
pub fn coordinate(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact::transform(q, x, t));
        let error = (0..3).map(|i| wanted[i].minus(got[i]).abs()).fold(0.0, f64::max);
        error / (EPSILON * largest(&[x, t]))
    })
    .0
}

/// How far the f64 image of a ball's centre is off, in 2⁻⁵³·max(|c|∞, |t|∞).
pub fn centre(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact::transform(q, x, t));
        exact::norm([0, 1, 2].map(|i| wanted[i].minus(got[i]))) / (EPSILON * largest(&[x, t]))
    })
    .0
}

/// How far the posed ball reaches out of its world ball, in u of the size: never.
pub fn ball_outside(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, c, t) = split(p);
        let radius = 0.001 + t[0].abs() * 0.01;
        let wanted = exact::transform(q, c, t);
        let (centre, r) = world_ball(&rotation(q), t, c, radius);
        let moved = exact::norm([0, 1, 2].map(|i| wanted[i].minus(f64::from(centre[i]))));
        (moved + f64::from(radius) - f64::from(r)) / (U * largest(&[c, t]))
    })
    .0
}

/// How far the computed d·p, d = (±1, ±1, ±1), is off before the margin, in 2⁻⁵³·max(ρ, |t|∞).
pub fn extent(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact::transform(q, x, t));
        let reach = exact::norm(x.map(f64::from)).max(largest(&[t]));
        let errors =
            [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]].map(|d| {
                let computed = (d[0] * got[0] + d[1] * got[1]) + d[2] * got[2];
                let sum = wanted[0] * d[0] + wanted[1] * d[1] + wanted[2] * d[2];
                sum.minus(computed).abs()
            });
        errors.into_iter().fold(0.0, f64::max) / (EPSILON * reach)
    })
    .0
}

/// How far the exact d·p reaches out of the re-fitted slab, in 2⁻⁵³ of the size: never.
pub fn extent_outside(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact::transform(q, x, t));
        let reach = (exact::norm(x.map(f64::from)) as f32).next_up();
        let computed = (got[0] + got[1]) + got[2];
        let (lo, hi) = refit(computed, computed, reach, t);
        let sum: Double = wanted[0] + wanted[1] + wanted[2];
        let out = sum.minus(f64::from(hi)).max(-sum.minus(f64::from(lo)));
        out / (EPSILON * largest(&[[reach; 3], t]))
    })
    .0
}

/// Error of an entry of M = Q_Bᵀ·Q_A in u.
pub fn product(seed: u64, evaluations: u64) -> f64 {
    let start = |random: &mut Random| std::array::from_fn(|_| random.signed());
    climb(seed, evaluations, start, |p: &[f32; 8]| {
        let [a, b] = [[p[0], p[1], p[2], p[3]], [p[4], p[5], p[6], p[7]]].map(rotation);
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (qa, qb) = (world_axes(&a, identity)[0], world_axes(&b, identity)[0]);
        let [x, y, z] = [0, 1, 2].map(|i| F::<false>::new(qa[i]) * F::new(qb[i]));
        let exact = exact::dot([a[0][0], a[1][0], a[2][0]], [b[0][0], b[1][0], b[2][0]]);
        (((x + y) + z).real() - exact).abs() / U
    })
    .0
}
