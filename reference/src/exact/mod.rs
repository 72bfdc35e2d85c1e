//! The same predicates decided in exact real arithmetic.
//!
//! Each decision is the sign of polynomials in the f32 input and runs down a cascade until the sign
//! is certain:
//!
//! 1. **filter**: f64 with a bound on the rounding error from the magnitudes at hand (Shewchuk
//!    1997),
//! 2. **interval**: the generic formula in outward-rounded intervals,
//! 3. **exact**: the same generic formula in big integers.
//!
//! [`Path`] says which stage decided. A stage that is not certain returns nothing, so after an
//! overflow, an underflow or a NaN the next stage decides.

pub mod axes;
pub mod common;
pub mod flat;
pub mod interval;
pub mod judge;
pub mod meeting;
pub mod mesh;
pub mod ordop;
pub mod orientation;
pub mod parity;
pub mod period;
pub mod polytope;
pub mod query;
pub mod relative;
pub mod simplex;
pub mod sphere;
pub mod tree;
pub mod triangle;
pub mod view;
pub mod world;

pub use interval::Interval;

/// Which stage of the cascade was certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Path {
    /// f64 with an error bound.
    Filter,
    /// Intervals.
    Interval,
    /// Big integers.
    Exact,
}

/// What was decided, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision<T> {
    /// The answer, true in exact arithmetic.
    pub value: T,
    /// The stage that gave it.
    pub path: Path,
}

impl<T> Decision<T> {
    /// The same stage, another answer.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Decision<U> {
        Decision { value: f(self.value), path: self.path }
    }
}

/// Decisions counted by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Decided by the filter.
    pub filter: u64,
    /// Decided by intervals.
    pub interval: u64,
    /// Decided by integers.
    pub exact: u64,
}

impl Tally {
    /// Counts one decision.
    pub fn count(&mut self, path: Path) {
        match path {
            Path::Filter => self.filter += 1,
            Path::Interval => self.interval += 1,
            Path::Exact => self.exact += 1,
        }
    }

    /// Adds another count.
    pub fn add(&mut self, other: &Self) {
        self.filter += other.filter;
        self.interval += other.interval;
        self.exact += other.exact;
    }

    /// All decisions.
    pub fn total(&self) -> u64 {
        self.filter + self.interval + self.exact
    }
}

/// What a decision made of many took.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// The parts by stage.
    pub tally: Tally,
    /// The deepest stage of any part.
    pub deepest: Path,
}

impl Default for Record {
    fn default() -> Self {
        Self { tally: Tally::default(), deepest: Path::Filter }
    }
}

impl Record {
    /// Counts a part and hands on its answer.
    fn note<T>(&mut self, decision: Decision<T>) -> T {
        self.tally.count(decision.path);
        self.deepest = self.deepest.max(decision.path);
        decision.value
    }
}

/// The first certain answer. Integers know every sign, so the last stage always has one.
pub(crate) fn cascade<T>(
    filter: impl FnOnce() -> Option<T>,
    interval: impl FnOnce() -> Option<T>,
    exact: impl FnOnce() -> Option<T>,
) -> Decision<T> {
    if let Some(value) = filter() {
        return Decision { value, path: Path::Filter };
    }
    if let Some(value) = interval() {
        return Decision { value, path: Path::Interval };
    }
    let value = exact().unwrap_or_else(|| unreachable!("integers know every sign"));
    Decision { value, path: Path::Exact }
}

/// p ∨ q where either may be unknown.
pub(crate) fn either(p: Option<bool>, q: impl FnOnce() -> Option<bool>) -> Option<bool> {
    match p {
        Some(true) => p,
        Some(false) => q(),
        None => q().filter(|q| *q),
    }
}

/// Whether any is true, as far as it is known. The rest is not evaluated after one that is true.
pub(crate) fn any(answers: impl IntoIterator<Item = Option<bool>>) -> Option<bool> {
    let mut found = Some(false);
    for answer in answers {
        found = either(found, || answer);
        if found == Some(true) {
            break;
        }
    }
    found
}
