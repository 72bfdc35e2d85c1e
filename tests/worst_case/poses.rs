//! Attacks on the f64 pose: transformed coordinates, ball centres, re-fitted extents. What they
//! should give is computed to some 100 bits.

use std::ops::{Add, Mul};

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use sdop::rounding::U;
use sdop::rounding::pose::{refit, rotation, transform};
use sdop::rounding::sphere::world_ball;

use super::climb::climb;

use super::EPSILON;

type Posed = ([f32; 4], [f32; 3], [f32; 3]);

fn start(random: &mut ChaCha8Rng) -> [f32; 10] {
    std::array::from_fn(|_| random.random_range(-1.0..1.0))
}

fn split(p: &[f32; 10]) -> Posed {
    ([p[0], p[1], p[2], p[3]], [p[4], p[5], p[6]], [p[7], p[8], p[9]])
}

fn largest(vectors: &[[f32; 3]]) -> f64 {
    vectors.iter().flatten().fold(0.0, |m: f64, &x| m.max(f64::from(x.abs())))
}

/// Error of a transformed coordinate in 2⁻⁵³·max(|x|∞, |t|∞).
pub fn coordinate(seed: u64, evaluations: u64) -> f64 {
    transformed(seed, evaluations, |errors| errors.into_iter().map(f64::abs).fold(0.0, f64::max))
}

/// How far the f64 image of a ball's centre is off, in 2⁻⁵³·max(|c|∞, |t|∞).
pub fn centre(seed: u64, evaluations: u64) -> f64 {
    transformed(seed, evaluations, norm)
}

fn transformed(seed: u64, evaluations: u64, size: fn([f64; 3]) -> f64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact_transform(q, x, t));
        size([0, 1, 2].map(|i| wanted[i].minus(got[i]))) / (EPSILON * largest(&[x, t]))
    })
    .0
}

/// How far the posed ball reaches out of its world ball, in u of the size: never.
pub fn ball_outside(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, c, t) = split(p);
        let radius = 0.001 + t[0].abs() * 0.01;
        let wanted = exact_transform(q, c, t);
        let (centre, r) = world_ball(&rotation(q), t, c, radius);
        let moved = norm([0, 1, 2].map(|i| wanted[i].minus(f64::from(centre[i]))));
        (moved + f64::from(radius) - f64::from(r)) / (U * largest(&[c, t]))
    })
    .0
}

/// How far the computed d·p, d = (±1, ±1, ±1), is off before the margin, in 2⁻⁵³·max(ρ, |t|∞).
pub fn extent(seed: u64, evaluations: u64) -> f64 {
    climb(seed, evaluations, start, |p| {
        let (q, x, t) = split(p);
        let (got, wanted) = (transform(&rotation(q), x, t), exact_transform(q, x, t));
        let reach = norm(x.map(f64::from)).max(largest(&[t]));
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
        let (got, wanted) = (transform(&rotation(q), x, t), exact_transform(q, x, t));
        let reach = (norm(x.map(f64::from)) as f32).next_up();
        let computed = (got[0] + got[1]) + got[2];
        let (lo, hi) = refit(computed, computed, reach, t);
        let sum: Double = wanted[0] + wanted[1] + wanted[2];
        let out = sum.minus(f64::from(hi)).max(-sum.minus(f64::from(lo)));
        out / (EPSILON * largest(&[[reach; 3], t]))
    })
    .0
}

/// An unevaluated sum hi + lo, about 106 bits.
#[derive(Clone, Copy, Debug)]
struct Double {
    hi: f64,
    lo: f64,
}

impl Double {
    fn of(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
    fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let of_b = hi - a;
        Self { hi, lo: (a - (hi - of_b)) + (b - of_b) }
    }
    fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self { hi, lo: a.mul_add(b, -hi) }
    }
    fn minus(self, x: f64) -> f64 {
        (self + Self::of(-x)).hi
    }
    fn negative(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
    fn over(self, other: Self) -> Self {
        let quotient = self.hi / other.hi;
        let rest = self + (other * quotient).negative();
        let next = rest.hi / other.hi;
        let rest = rest + (other * next).negative();
        Self::sum(quotient, next) + Self::of(rest.hi / other.hi)
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let s = Self::sum(self.hi, other.hi);
        Self::sum(s.hi, s.lo + self.lo + other.lo)
    }
}

impl Mul<f64> for Double {
    type Output = Self;
    fn mul(self, x: f64) -> Self {
        let p = Self::product(self.hi, x);
        Self::sum(p.hi, p.lo + self.lo * x)
    }
}

/// R(q)x/|q|² + t to some 100 bits.
fn exact_transform(q: [f32; 4], x: [f32; 3], t: [f32; 3]) -> [Double; 3] {
    let [qx, qy, qz, qw] = q.map(f64::from);
    // Products of two f32 are exact in f64.
    let sum = |terms: [f64; 4]| terms.iter().fold(Double::of(0.0), |s, &y| s + Double::of(y));
    let pair = |a: f64, b: f64| sum([2.0 * a, 2.0 * b, 0.0, 0.0]);
    let (xx, yy, zz, ww) = (qx * qx, qy * qy, qz * qz, qw * qw);
    let rows = [
        [sum([xx, ww, -yy, -zz]), pair(qx * qy, -(qw * qz)), pair(qx * qz, qw * qy)],
        [pair(qx * qy, qw * qz), sum([yy, ww, -xx, -zz]), pair(qy * qz, -(qw * qx))],
        [pair(qx * qz, -(qw * qy)), pair(qy * qz, qw * qx), sum([zz, ww, -xx, -yy])],
    ];
    let square = sum([xx, yy, zz, ww]);
    std::array::from_fn(|i| {
        let [a, b, c] = [0, 1, 2].map(|j| rows[i][j] * f64::from(x[j]));
        (a + b + c).over(square) + Double::of(f64::from(t[i]))
    })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
