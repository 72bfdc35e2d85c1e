//! Claims and the numbers that decide them. Verdicts are computed, never written by hand.

use serde::Serialize;

use super::Estimate;
use sdop::choice::choices;

choices! {
    /// What the numbers say.
    Verdict, "verdict", {
        /// The whole interval is where the claim puts it.
        Supported = "supported",
        /// The whole interval is elsewhere.
        Contradicted = "contradicted",
        /// The interval reaches across, or there is one seed only.
        Undecided = "undecided",
        /// Some numbers support the claim and others contradict it.
        InPart = "in part",
    }
}

/// One number that bears on a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClaimCheck {
    /// What was measured or computed, with its unit.
    pub quantity: String,
    /// Its value.
    pub value: f64,
    /// Half the width of its interval; 0 for what is computed from the paper's numbers.
    pub half_width: f64,
    /// Where the claim puts it.
    pub expected: String,
    /// What follows.
    pub verdict: Verdict,
}

/// A claim with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PaperClaim {
    /// Where it is: a section of the paper, or our own study.
    pub source: &'static str,
    /// What it says, in our words.
    pub claim: &'static str,
    /// The numbers.
    pub checks: Vec<ClaimCheck>,
}

impl PaperClaim {
    /// All checks together.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let any = |verdict| self.checks.iter().any(|check| check.verdict == verdict);
        match (any(Verdict::Supported), any(Verdict::Contradicted)) {
            (true, true) => Verdict::InPart,
            (false, true) => Verdict::Contradicted,
            (true, false) if !any(Verdict::Undecided) => Verdict::Supported,
            _ => Verdict::Undecided,
        }
    }
}

impl ClaimCheck {
    /// Claimed to lie strictly between `lo` and `hi`, either of which may be infinite.
    #[must_use]
    pub fn between(quantity: String, value: Estimate, [lo, hi]: [f64; 2]) -> Self {
        let [low, high] = value.interval();
        let verdict = if low > lo && high < hi {
            Verdict::Supported
        } else if high <= lo || low >= hi {
            Verdict::Contradicted
        } else {
            Verdict::Undecided
        };
        let expected = match (lo == f64::NEG_INFINITY, hi == f64::INFINITY) {
            (_, true) => format!("> {lo}"),
            (true, false) => format!("< {hi}"),
            (false, false) => format!("{lo} to {hi}"),
        };
        Self { quantity, value: value.mean, half_width: value.half_width, expected, verdict }
    }

    /// Claimed to lie above `bound`.
    #[must_use]
    pub fn above(quantity: String, value: Estimate, bound: f64) -> Self {
        Self::between(quantity, value, [bound, f64::INFINITY])
    }

    /// Claimed to be `truth`, as one of `family` such claims: contradicted when the family as a
    /// whole has less than one chance in twenty of a value so far off (Bonferroni), supported when
    /// the value's own interval covers it.
    #[must_use]
    pub fn equal(quantity: String, value: Estimate, truth: f64, family: usize) -> Self {
        let verdict = if family as f64 * value.p_value(truth) < 0.05 {
            Verdict::Contradicted
        } else if value.covers(truth) && value.half_width.is_finite() {
            Verdict::Supported
        } else {
            Verdict::Undecided
        };
        Self {
            quantity,
            value: value.mean,
            half_width: value.half_width,
            expected: format!("= {truth:.4}"),
            verdict,
        }
    }

    /// A number computed from the paper's, claimed to lie in a closed range.
    #[must_use]
    pub fn computed(quantity: String, value: f64, [lo, hi]: [f64; 2]) -> Self {
        let verdict =
            if (lo..=hi).contains(&value) { Verdict::Supported } else { Verdict::Contradicted };
        let exact = Estimate { mean: value, half_width: 0.0, seeds: 0 };
        Self { verdict, ..Self::between(quantity, exact, [lo, hi]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(mean: f64, half_width: f64) -> Estimate {
        Estimate { mean, half_width, seeds: 9 }
    }

    #[test]
    fn verdicts_follow_the_interval() {
        let above =
            |mean, half| ClaimCheck::above(String::new(), estimate(mean, half), 1.0).verdict;
        assert_eq!(above(1.2, 0.1), Verdict::Supported);
        assert_eq!(above(1.2, 0.3), Verdict::Undecided);
        assert_eq!(above(0.8, 0.1), Verdict::Contradicted);
        assert_eq!(above(1.0, 0.0), Verdict::Contradicted, "equal is not above");
        assert_eq!(above(5.0, f64::INFINITY), Verdict::Undecided);
        let near = ClaimCheck::between(String::new(), estimate(0.97, 0.01), [0.95, 1.05]);
        assert_eq!((near.verdict, near.expected.as_str()), (Verdict::Supported, "0.95 to 1.05"));
    }

    /// Equality allows for the size of the family.
    #[test]
    fn equality_corrects_for_family_size() {
        // 1.2 half-widths off: p ≈ .03 with eight degrees of freedom.
        let check =
            |family| ClaimCheck::equal(String::new(), estimate(1.0, 0.1), 1.12, family).verdict;
        assert_eq!(check(1), Verdict::Contradicted);
        assert_eq!(check(6), Verdict::Undecided);
        assert_eq!(
            ClaimCheck::equal(String::new(), estimate(1.0, 0.1), 1.05, 6).verdict,
            Verdict::Supported
        );
    }

    /// A claim is as good as its checks.
    #[test]
    fn claim_follows_its_checks() {
        let claim = |verdicts: &[Verdict]| {
            let check = |&verdict: &Verdict| ClaimCheck {
                verdict,
                ..ClaimCheck::computed(String::new(), 0.0, [0.0, 1.0])
            };
            let checks = verdicts.iter().map(check).collect();
            PaperClaim { source: "", claim: "", checks }.verdict()
        };
        use Verdict::{Contradicted, InPart, Supported, Undecided};
        assert_eq!(claim(&[Supported, Supported]), Supported);
        assert_eq!(claim(&[Supported, Undecided]), Undecided);
        assert_eq!(claim(&[Supported, Contradicted]), InPart);
        assert_eq!(claim(&[Undecided, Contradicted]), Contradicted);
        assert_eq!(claim(&[]), Undecided);
    }
}
