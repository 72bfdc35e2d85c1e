//! The thread's floating-point mode: how results are rounded, and what becomes of subnormal
//! numbers.
//!
//! Rust assumes the default mode: rounding to nearest, subnormal numbers as they are, no traps.
//! Audio and game engines set others. All arithmetic that decides runs in the default mode.
//! Afterwards the caller's mode is restored, also after a panic.

use std::marker::PhantomData;

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod control {
    use std::arch::asm;

    pub const DEFAULT: u64 = 0x1f80;
    /// Denormals are zero, and flush to zero.
    pub const FLUSH: u64 = DEFAULT | 1 << 15 | 1 << 6;
    /// Down, up, toward zero.
    pub const ROUNDINGS: [u64; 3] = [DEFAULT | 1 << 13, DEFAULT | 2 << 13, DEFAULT | 3 << 13];
    /// All bits of MXCSR but the six that remember exceptions.
    const CONTROL: u64 = 0xffc0;

    pub fn get() -> u64 {
        let mut word = 0_u32;
        // SAFETY: every CPU with SSE, which this crate's floats need, has MXCSR; it is written to
        // `word`.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
        u64::from(word) & CONTROL
    }

    pub fn set(word: u64) {
        let word = word as u32;
        // SAFETY: `word` has been read from MXCSR or is one of the above, whose reserved bits are
        // zero. Callers return to the mode that was before they return (`FormerMode`).
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, preserves_flags)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod control {
    use std::arch::asm;

    pub const DEFAULT: u64 = 0;
    /// Flush to zero, operands and results.
    pub const FLUSH: u64 = 1 << 24;
    /// Down, up, toward zero.
    pub const ROUNDINGS: [u64; 3] = [2 << 22, 1 << 22, 3 << 22];

    pub fn get() -> u64 {
        let word: u64;
        // SAFETY: every CPU of this architecture lets programs read FPCR.
        unsafe { asm!("mrs {}, fpcr", out(reg) word, options(nostack, preserves_flags)) };
        word
    }

    pub fn set(word: u64) {
        // SAFETY: `word` has been read from FPCR or is one of the above. Callers return to the mode
        // that was before they return (`FormerMode`).
        unsafe { asm!("msr fpcr, {}", in(reg) word, options(nostack, preserves_flags)) };
    }
}

/// Elsewhere the mode is taken to be the default one.
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
mod control {
    pub const DEFAULT: u64 = 0;
    pub const FLUSH: u64 = 0;
    pub const ROUNDINGS: [u64; 3] = [0; 3];

    pub fn get() -> u64 {
        DEFAULT
    }

    pub fn set(_word: u64) {}
}

/// A floating-point mode of a thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FpMode(u64);

impl FpMode {
    /// What Rust assumes.
    pub const DEFAULT: Self = Self(control::DEFAULT);

    /// Other modes that hosts may have set, for tests: subnormal numbers are zero; results are
    /// rounded down, up, toward zero.
    pub const OTHERS: [Self; 4] = [
        Self(control::FLUSH),
        Self(control::ROUNDINGS[0]),
        Self(control::ROUNDINGS[1]),
        Self(control::ROUNDINGS[2]),
    ];

    /// The calling thread's.
    #[must_use]
    pub fn current() -> Self {
        Self(control::get())
    }

    /// Calls `work` in this mode; afterwards, and if `work` panics, the thread has its former mode
    /// again.
    #[inline]
    pub fn run<R>(self, work: impl FnOnce() -> R) -> R {
        let _former = FormerMode::before(self);
        apart(work)
    }
}

/// Calls `work` in the mode that Rust assumes.
#[inline]
pub fn in_default_mode<R>(work: impl FnOnce() -> R) -> R {
    FpMode::DEFAULT.run(work)
}

/// A call that isn't inlined: the compiler takes the mode to be constant, and would be free to move
/// arithmetic across its change.
#[inline(never)]
fn apart<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// The mode to return to, if it is another one; of this thread, so it stays there.
struct FormerMode(Option<FpMode>, PhantomData<*const ()>);

impl FormerMode {
    fn before(mode: FpMode) -> Self {
        let former = FpMode::current();
        let differs = former != mode;
        if differs {
            control::set(mode.0);
        }
        Self(differs.then_some(former), PhantomData)
    }
}

impl Drop for FormerMode {
    fn drop(&mut self) {
        if let Some(former) = self.0 {
            control::set(former.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::hint::black_box;
    use std::panic::catch_unwind;

    use super::*;

    /// Half of the least normal number, a third and minus a third, in bits.
    fn results() -> [u32; 3] {
        let [one, three] = black_box([1.0_f32, 3.0]);
        let [least, half] = black_box([f32::MIN_POSITIVE, 0.5]);
        [least * half, one / three, -one / three].map(f32::to_bits)
    }

    #[test]
    fn modes_are_those_of_their_names() {
        let half = f32::from_bits(0x0040_0000);
        let up = f32::from_bits(0x3eaa_aaab);
        let down = up.next_down();
        assert_eq!(FpMode::current(), FpMode::DEFAULT);
        assert_eq!(results(), [half, up, -up].map(f32::to_bits));
        let wanted = [[0.0, up, -up], [half, down, -up], [half, up, -down], [half, down, -down]];
        for (mode, wanted) in FpMode::OTHERS.into_iter().zip(wanted) {
            // Nothing is known of other architectures' modes.
            if mode != FpMode::DEFAULT {
                assert_eq!(mode.run(results), wanted.map(f32::to_bits), "{mode:?}");
            }
        }
    }

    /// The former mode returns after a panic.
    #[test]
    fn panic_restores_the_mode() {
        for mode in FpMode::OTHERS {
            mode.run(|| {
                assert_eq!(in_default_mode(FpMode::current), FpMode::DEFAULT);
                assert_eq!(FpMode::current(), mode);
                let outcome = catch_unwind(|| in_default_mode(|| assert!(black_box(false))));
                assert!(outcome.is_err() && FpMode::current() == mode);
            });
            assert_eq!(FpMode::current(), FpMode::DEFAULT);
        }
    }
}
