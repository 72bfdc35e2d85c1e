//! Our cullers, worlds and indexes keep every claim, in each of their configurations.

use sdop::simd::Tier;
use sdop_judge::configuration::Rotation;
use sdop_judge::verify::subject::OwnCullers;
use sdop_judge::{Claim, Conclusion, JudgeError, Options, PairCounts, examine};

/// `sdop verify --claims X` runs all cases; here are those in which most of them differ.
#[test]
fn our_configurations_pass_every_claim() {
    let tiers = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
    let ours = OwnCullers::new(Rotation::new(&tiers));
    for &claim in Claim::ALL {
        let own = format!("{claim}/*");
        let patterns: &[&str] = match claim {
            Claim::Parts => &[&own],
            _ if claim.is_of_boxes() => {
                &[&own, "long/*", "churn/*", "box/*", "oblique/*", "hard/counts/0000"]
            }
            _ => &[
                "long/sets/0000",
                "churn/*/0000",
                "oblique/*/0000",
                "exact/*/0000",
                "hard/counts/0000",
            ],
        };
        let mut pairs = PairCounts::default();
        for pattern in patterns {
            let pattern = (*pattern).to_owned();
            let options = Options { claim, pattern, seed: Some(5), ..Options::default() };
            match examine(&ours, &options, |_, _| {}) {
                Err(JudgeError::NoCase { .. }) => {}
                judged => {
                    let verdict = judged.unwrap();
                    assert_eq!(verdict.conclusion(), Conclusion::Pass, "{verdict}");
                    pairs.add(&verdict.pairs());
                }
            }
        }
        assert!(pairs.required > 300, "{claim}: {pairs:?}");
        let is_exact = claim.is_of_boxes() && claim != Claim::Margin;
        assert!(!is_exact || pairs.extra == 0, "{claim}: {pairs:?}");
    }
}
