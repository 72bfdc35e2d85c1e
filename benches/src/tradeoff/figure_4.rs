//! The paper's Fig. 4, "simplicity versus accuracy", as a claim: sphere, AABB, OBB, k-DOP, or-DOP, each slower and more
//! precise than the one before it.

use super::result::VariantResult;
use crate::measure::estimate::Estimate;
use crate::reproduce::check::{Check, Claim};
use sdop::settings::{Overlap, Strategy};

/// The figure's order: a volume alone, without another before it.
const ORDER: [Strategy; 5] = [
    Strategy::Sphere,
    Strategy::Aabb,
    Strategy::Obb,
    Strategy::KDop,
    Strategy::OrDop,
];
/// Half-spaces of the k-DOP and the or-DOP that are compared.
const K: usize = 18;

/// The claim with a number for each step of the order: time, then precision.
#[must_use]
pub fn claim(rows: &[VariantResult]) -> Claim {
    let mut checks = Vec::new();
    for step in ORDER.windows(2) {
        let [Some(simple), Some(accurate)] = [step[0], step[1]].map(|of| find(rows, of)) else {
            continue;
        };
        let ratio = |values: fn(&VariantResult) -> &[f64]| {
            let pairs = values(accurate).iter().zip(values(simple));
            Estimate::in_order(
                &pairs
                    .map(|(accurate, simple)| accurate / simple)
                    .collect::<Vec<_>>(),
            )
        };
        for (what, ratio) in [
            ("time", ratio(|row| &row.times)),
            ("precision", ratio(|row| &row.precisions)),
        ] {
            let quantity = format!("{what} of {} / {}", accurate.name, simple.name);
            checks.push(Check::above(quantity, ratio, 1.0));
        }
    }
    Claim {
        source: "Fig. 4",
        claim: "Sphere, AABB, OBB, k-DOP, or-DOP: each slower and more precise than the one before it.",
        checks,
    }
}

/// The row of a volume alone.
fn find(rows: &[VariantResult], strategy: Strategy) -> Option<&VariantResult> {
    let fits = |row: &&VariantResult| {
        let k = row.k.is_none_or(|k| k == K) || strategy == Strategy::Obb;
        let test = row
            .overlap
            .is_none_or(|overlap| overlap == Overlap::TwoSided);
        row.strategy == strategy && !row.hulls && k && test
    };
    rows.iter().find(fits)
}
