//! The sphere test and the skin test, every input of a format.
//!
//! Their operands are too many for raw enumeration, but they enter through few rounded numbers. Of
//! each rounded difference of coordinates the extreme true difference is kept, of each rounded sum
//! (or rest of a skin) the extreme true one, and then all tuples of rounded numbers are tried.

use std::collections::BTreeSet;

use super::format::{Format, exp2, extremes};

/// The constants of `rounding::sphere`, in units of the format.
#[derive(Clone, Copy, Debug)]
pub struct Inflation {
    pub factor: f64,
    pub floor: f64,
}

impl Inflation {
    /// 1 + 8u and the floor that is to 2^least and u as 2⁻⁷⁰ is to those of f32: its square is 2¹⁰
    /// times the least number.
    pub fn of(format: &Format) -> Self {
        let floor = exp2((format.least - format.precision + 10).div_euclid(2));
        Self { factor: 1.0 + 8.0 * format.u(), floor }
    }

    /// `inflate_radius`
    pub fn inflate(&self, format: &Format, r: f64) -> f64 {
        format.add(format.mul(r, self.factor), self.floor)
    }
}

/// d², as `sphere::apart` and `skin::stays` add it up.
pub fn square_of(format: &Format, [x, y, z]: [f64; 3]) -> f64 {
    let square = |x| format.mul(x, x);
    format.add(format.add(square(x), square(y)), square(z))
}

/// `Spheres::apart` of balls (x, y, z, r).
pub fn rejects(format: &Format, inflation: &Inflation, a: [f64; 4], b: [f64; 4]) -> bool {
    let way = [0, 1, 2].map(|i| format.sub(b[i], a[i]));
    let [r, s] = [a[3], b[3]].map(|r| inflation.inflate(format, r));
    let sum = format.add(r, s);
    format.gt(square_of(format, way), format.mul(sum, sum))
}

/// Calls `wrong` with the true squared distance (of the nearest or farthest centres that give it)
/// and the rounded one of every tuple of rounded differences, |x| ≥ |y|.
fn each_distance(format: &Format, differences: &[(f64, f64)], mut see: impl FnMut(f64, f64)) {
    let squares: Vec<f64> = differences.iter().map(|&(d, _)| format.mul(d, d)).collect();
    for (i, &(_, x)) in differences.iter().enumerate() {
        for (j, &(_, y)) in differences[..=i].iter().enumerate() {
            let flat = format.add(squares[i], squares[j]);
            for (&square, &(_, z)) in squares.iter().zip(differences) {
                see(x * x + y * y + z * z, format.add(flat, square));
            }
        }
    }
}

/// Each |fl(b − a)| with the extreme |b − a|.
fn differences(format: &Format, top: i32, further: fn(f64, f64) -> f64) -> Vec<(f64, f64)> {
    let numbers = format.numbers(top);
    let pairs = numbers.iter().flat_map(|&a| numbers.iter().map(move |&b| (a, b)));
    let pairs = pairs.filter(|(a, b)| a <= b);
    extremes(pairs.map(|(a, b)| (format.sub(b, a), b - a)), further)
}

/// How many tuples of rounded differences and the sum that rejects most are wrong: rejected, though
/// some balls that give them touch.
pub fn wrong_spheres(format: &Format, inflation: &Inflation, top: i32) -> u64 {
    let sizes = format.sizes(top);
    let radii: Vec<(f64, f64)> = sizes.iter().map(|&r| (inflation.inflate(format, r), r)).collect();
    let sums = radii.iter().flat_map(|a| radii.iter().map(move |b| (a, b)));
    let sums = extremes(sums.map(|(a, b)| (format.add(a.0, b.0), a.1 + b.1)), f64::max);
    // Squared, and the farthest that balls with no larger sum may be apart and touch.
    let mut most = 0.0f64;
    let squared: Vec<(f64, f64)> = sums
        .iter()
        .map(|&(sum, exact)| {
            most = most.max(exact);
            (format.mul(sum, sum), most * most)
        })
        .collect();
    let mut wrong = 0;
    each_distance(format, &differences(format, top, f64::min), |exact, rounded| {
        let rejecting = squared.partition_point(|&(square, _)| format.gt(rounded, square));
        wrong += u64::from(rejecting > 0 && exact <= squared[rejecting - 1].1);
    });
    wrong
}

/// The same by trying all balls: how many tuples of rounded differences come of some that touch and
/// are rejected.
pub fn wrong_raw(format: &Format, inflation: &Inflation, top: i32) -> u64 {
    let (numbers, sizes) = (format.numbers(top), format.sizes(top));
    let n = numbers.len();
    let mut wrong = BTreeSet::new();
    for code in 0..n.pow(6) {
        let digit = |place: u32| numbers[code / n.pow(place) % n];
        let [a, b] = [0, 3].map(|from| [digit(from), digit(from + 1), digit(from + 2)]);
        let way = [0, 1, 2].map(|i| format.sub(b[i], a[i]).abs());
        let exact: f64 = (0..3).map(|i| (b[i] - a[i]) * (b[i] - a[i])).sum();
        for &r in &sizes {
            for &s in &sizes {
                let touch = exact <= (r + s) * (r + s);
                if touch && rejects(format, inflation, [a[0], a[1], a[2], r], [b[0], b[1], b[2], s])
                {
                    let [x, y, z] = way;
                    wrong.insert([x.max(y), x.min(y), z].map(f64::to_bits));
                }
            }
        }
    }
    wrong.len() as u64
}

/// The constants of a skin test: finders' factor, the budget's factor and floor.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    pub widening: f64,
    pub factor: f64,
    pub floor: f64,
}

impl Budget {
    /// 1 + 16u, 1 + 32u, and the floor that is to 2^least and u as 2⁻⁶⁰ is to those of f32: its
    /// square is 2³⁰ times the least number. A format of few bits has no room for that: 2¹⁰.
    pub fn of(format: &Format) -> Self {
        let u = format.u();
        let floor = exp2((format.least - format.precision + 10).div_euclid(2));
        Self { widening: 1.0 + 16.0 * u, factor: 1.0 + 32.0 * u, floor }
    }
}

/// `skin::stays`, of what is left of the skin.
pub fn left_of(format: &Format, skin: f64, now: f64, before: f64) -> f64 {
    let grown = format.max(format.sub(now, before), 0.0);
    format.max(format.sub(skin, grown), 0.0)
}

/// `Skin::of`
pub fn skin_of(format: &Format, share: f64, least: f64, radius: f64) -> f64 {
    format.max(format.mul(radius, share), least)
}

/// How many tuples of rounded differences stay within some skin, though some ball that gives them
/// has drifted farther than its budget. Skins are all numbers from the floor on, whatever share and
/// radius they come from.
pub fn wrong_skins(format: &Format, budget: &Budget, top: i32) -> u64 {
    let sizes = format.sizes(top);
    let skins: Vec<f64> = sizes.iter().copied().filter(|&skin| skin >= budget.floor).collect();
    let mut rests = Vec::new();
    for &skin in &skins {
        let allowed = skin * budget.factor + budget.floor;
        for &before in &sizes {
            for &now in &sizes {
                let growth = (now - before).max(0.0) * budget.widening;
                rests.push((left_of(format, skin, now, before), allowed - growth));
            }
        }
    }
    let rests = extremes(rests.into_iter(), f64::min);
    // From the largest rest down, the least distance that is allowed.
    let mut least = f64::INFINITY;
    let mut allowed: Vec<(f64, f64)> = rests
        .iter()
        .rev()
        .map(|&(left, rest)| {
            least = least.min(rest);
            (format.mul(left, left), least)
        })
        .collect();
    allowed.reverse();
    let mut wrong = 0;
    each_distance(format, &differences(format, top, f64::max), |exact, rounded| {
        let first = allowed.partition_point(|&(square, _)| !format.gt(square, rounded));
        let beyond = |rest: f64| rest < 0.0 || exact > rest * rest;
        wrong += u64::from(first < allowed.len() && beyond(allowed[first].1));
    });
    wrong
}
