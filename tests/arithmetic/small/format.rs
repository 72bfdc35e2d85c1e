//! Binary formats of a few bits, and arithmetic in them. Numbers are f64, which holds sums and
//! products of two exactly, so that each operation rounds once. There is no greatest exponent.

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Underflow {
    /// As IEEE 754 has it.
    Gradual,
    /// Results below the least normal number are zero, as x86 does: after rounding.
    Flushed,
    /// The same before rounding, as Arm does, and operands are read so too.
    ReadAsZero,
}

pub const UNDERFLOWS: [Underflow; 3] =
    [Underflow::Gradual, Underflow::Flushed, Underflow::ReadAsZero];

#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Bits of the significand.
    pub precision: i32,
    /// Exponent of the least normal number.
    pub least: i32,
    pub underflow: Underflow,
}

/// 2ᵉ
pub fn exp2(e: i32) -> f64 {
    2.0f64.powi(e)
}

impl Format {
    pub const F32: Self = Self { precision: 24, least: -126, underflow: Underflow::Gradual };
    pub const F64: Self = Self { precision: 53, least: -1022, underflow: Underflow::Gradual };

    /// Unit roundoff.
    pub fn u(&self) -> f64 {
        exp2(-self.precision)
    }

    /// The distance of the numbers next to `x`, on the side away from zero.
    fn quantum(&self, x: f64) -> f64 {
        let exponent = ((x.to_bits() >> 52 & 0x7ff) as i32 - 1023).max(self.least);
        exp2(exponent - self.precision + 1)
    }

    /// Rounded to nearest even, and flushed.
    pub fn fl(&self, x: f64) -> f64 {
        if self.precision == 53 || !x.is_finite() {
            return x;
        }
        let tiny = exp2(self.least);
        if self.underflow == Underflow::ReadAsZero && x.abs() < tiny {
            return 0.0;
        }
        let quantum = self.quantum(x);
        let rounded = (x / quantum).round_ties_even() * quantum;
        if self.underflow == Underflow::Flushed && rounded.abs() < tiny { 0.0 } else { rounded }
    }

    pub fn read(&self, x: f64) -> f64 {
        let zero = self.underflow == Underflow::ReadAsZero && x.abs() < exp2(self.least);
        if zero { 0.0 } else { x }
    }

    pub fn add(&self, a: f64, b: f64) -> f64 {
        self.fl(self.read(a) + self.read(b))
    }
    pub fn sub(&self, a: f64, b: f64) -> f64 {
        self.fl(self.read(a) - self.read(b))
    }
    pub fn mul(&self, a: f64, b: f64) -> f64 {
        self.fl(self.read(a) * self.read(b))
    }
    pub fn div(&self, a: f64, b: f64) -> f64 {
        self.fl(self.read(a) / self.read(b))
    }
    pub fn gt(&self, a: f64, b: f64) -> bool {
        self.read(a) > self.read(b)
    }
    pub fn max(&self, a: f64, b: f64) -> f64 {
        if self.gt(a, b) { a } else { b }
    }
    pub fn min(&self, a: f64, b: f64) -> f64 {
        if self.gt(b, a) { a } else { b }
    }

    /// The number above the nearest one, and its mirror.
    pub fn up(&self, x: f64) -> f64 {
        let x = self.fl(x);
        // Below a power of two numbers lie half as far apart.
        let step = if x < 0.0 { self.quantum(x.next_up()) } else { self.quantum(x) };
        x + step
    }
    pub fn down(&self, x: f64) -> f64 {
        -self.up(-x)
    }

    /// All numbers from zero up to 2ᵗᵒᵖ.
    pub fn sizes(&self, top: i32) -> Vec<f64> {
        let mut sizes = vec![0.0];
        while let Some(&last) = sizes.last()
            && last < exp2(top)
        {
            sizes.push(last + self.quantum(last));
        }
        sizes
    }

    /// The same and their opposites, ascending.
    pub fn numbers(&self, top: i32) -> Vec<f64> {
        let sizes = self.sizes(top);
        let negative = sizes.iter().rev().map(|x| -x);
        negative.chain(sizes[1..].iter().copied()).collect()
    }
}

/// For each value that `of` gives, the extreme of what it gives with it, by value.
pub fn extremes(
    pairs: impl Iterator<Item = (f64, f64)>,
    further: impl Fn(f64, f64) -> f64,
) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = pairs.collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 = further(kept.1, next.1);
        }
        same
    });
    all
}
