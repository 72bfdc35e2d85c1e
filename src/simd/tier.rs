//! Which tiers the CPU has, and forcing one.

use std::fmt;
use std::str::FromStr;

#[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
use super::avx2;
#[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
use super::avx512;
#[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
use super::neon;
#[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
use super::sse2;

/// A SIMD level of this CPU. It comes from [`Tier::detect`], [`Tier::available`] or a parsed name,
/// which check that the CPU has it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Tier(Isa);

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Isa {
    Scalar,
    #[cfg(not(omits = "scalar-flush"))]
    ScalarFlush,
    #[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
    Sse2(sse2::Sse2),
    #[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
    Avx2(avx2::Avx2),
    #[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
    Avx512(avx512::Avx512),
    #[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
    Neon(neon::Neon),
}

/// A tier's name that can't be used here.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TierError {
    /// No tier has this name.
    #[error("unknown SIMD level `{0}`; known are scalar, sse2, avx2, avx512, neon")]
    Unknown(String),
    /// The tier exists but this CPU lacks it.
    #[error("this CPU or build has no {missing}; it has {have}")]
    Unavailable {
        /// The requested tier.
        missing: String,
        /// The available tiers, separated by commas.
        have: String,
    },
}

impl Tier {
    /// Every tier's name, whether this CPU has it or not. Tests check that each is covered.
    pub const NAMES: [&'static str; 5] = ["scalar", "sse2", "avx2", "avx512", "neon"];

    /// The plain scalar tier, which every CPU has.
    pub const SCALAR: Self = Self(Isa::Scalar);

    /// The scalar tier with denormal operands and results replaced by zero, as a CPU does in
    /// flush-to-zero mode. For tests alone: decisions stay sound there, but need not equal the
    /// other tiers'.
    #[cfg(not(omits = "scalar-flush"))]
    pub const SCALAR_FLUSH: Self = Self(Isa::ScalarFlush);
    /// Without that tier, the plain one.
    #[cfg(omits = "scalar-flush")]
    pub const SCALAR_FLUSH: Self = Self::SCALAR;

    /// The fastest tier of this CPU.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().last().copied().unwrap_or(Self::SCALAR)
    }

    /// All tiers of this CPU, slowest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut, reason = "a target may have no other tier")]
        let mut tiers = vec![Self::SCALAR];
        #[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
        tiers.extend(sse2::Sse2::new().map(|token| Self(Isa::Sse2(token))));
        #[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
        tiers.extend(avx2::Avx2::new().map(|token| Self(Isa::Avx2(token))));
        #[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
        tiers.extend(avx512::Avx512::new().map(|token| Self(Isa::Avx512(token))));
        #[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
        tiers.extend(neon::Neon::new().map(|token| Self(Isa::Neon(token))));
        tiers
    }

    /// The tier's name, as `--simd` takes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Isa::Scalar => "scalar",
            #[cfg(not(omits = "scalar-flush"))]
            Isa::ScalarFlush => "scalar-flush",
            #[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
            Isa::Sse2(_) => "sse2",
            #[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
            Isa::Avx2(_) => "avx2",
            #[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
            Isa::Avx512(_) => "avx512",
            #[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
            Isa::Neon(_) => "neon",
        }
    }

    pub(super) fn tier(self) -> Isa {
        self.0
    }
}

impl FromStr for Tier {
    type Err = TierError;

    fn from_str(name: &str) -> Result<Self, TierError> {
        let available = Self::available();
        if let Some(tier) = available.iter().find(|tier| tier.name() == name) {
            return Ok(*tier);
        }
        if !Self::NAMES.contains(&name) {
            return Err(TierError::Unknown(name.to_owned()));
        }
        let have: Vec<_> = available.iter().map(|tier| tier.name()).collect();
        Err(TierError::Unavailable { missing: name.to_owned(), have: have.join(", ") })
    }
}

impl fmt::Display for Tier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Debug for Tier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Tier({})", self.name())
    }
}
