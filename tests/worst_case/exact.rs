//! The results that the arithmetic should give: in double-double for the f64 pose, in plain f64 for
//! errors of f32 (2⁻²⁹ of a u).

use std::ops::{Add, Mul};

/// An unevaluated sum hi + lo, about 106 bits.
#[derive(Clone, Copy, Debug)]
pub struct Double {
    hi: f64,
    lo: f64,
}

impl Double {
    pub fn of(x: f64) -> Self {
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
    pub fn minus(self, x: f64) -> f64 {
        (self + Self::of(-x)).hi
    }
    pub fn negative(self) -> Self {
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
pub fn transform(q: [f32; 4], x: [f32; 3], t: [f32; 3]) -> [Double; 3] {
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

/// The rotation matrix of an f64 quaternion.
pub fn rotation([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    let n = x * x + y * y + z * z + w * w;
    let twice = |a: f64, b: f64| 2.0 * (a + b) / n;
    [
        [(w * w + x * x - y * y - z * z) / n, twice(x * y, -w * z), twice(x * z, w * y)],
        [twice(x * y, w * z), (w * w + y * y - x * x - z * z) / n, twice(y * z, -w * x)],
        [twice(x * z, -w * y), twice(y * z, w * x), (w * w + z * z - x * x - y * y) / n],
    ]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

pub fn apply(m: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    m.map(|row| dot(row, x))
}

pub fn apply_transposed(m: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|j| m[0][j] * x[0] + m[1][j] * x[1] + m[2][j] * x[2])
}
