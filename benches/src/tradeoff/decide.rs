//! Decides which variant to use, by density, class of shapes and price of a narrow-phase check.
//!
//! T of a variant is measured at each density on the scene's own shapes. The number of pairs that
//! it leaves to the narrow phase is the number of sphere hits times the share that its or-DOP
//! doesn't separate. That share depends on the shape, so its mean over each class is used. The
//! cheapest total T + Np·Cp is recommended; variants whose difference from it has an interval that
//! contains zero are tied with it.

use serde::{Deserialize, Serialize};

use super::density::Density;
use super::pays::Line;
use super::shapes::ShapeSurvival;
use crate::measure::counts::Volume;
use sdop::choice::choices;

/// Prices of a narrow-phase check in seconds.
pub const CHECKS: [f64; 4] = [10e-9, 100e-9, 1e-6, 10e-6];
/// Shapes with at least this share of sphere hits whose hulls meet are round.
const LEAST_ROUND_SHARE: f64 = 0.7;
/// Shapes with less than this share are thin.
const LEAST_COMPACT_SHARE: f64 = 0.2;

choices! {
    /// How well a shape fills its bounding sphere, by the share of sphere hits whose hulls meet.
    ShapeClass, "class of shapes", {
        /// Balls and nearly round shapes.
        Round = "round",
        /// Most meshes.
        Compact = "compact",
        /// Needles, plates.
        Thin = "thin",
    }
}

impl ShapeClass {
    fn of(shape: &ShapeSurvival) -> Self {
        match shape.hull.mean {
            share if share >= LEAST_ROUND_SHARE => Self::Round,
            share if share < LEAST_COMPACT_SHARE => Self::Thin,
            _ => Self::Compact,
        }
    }
}

/// The recommendation for one density, one class of shapes and one price of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Mean sphere overlaps per body.
    pub partners: f64,
    /// The shapes.
    pub class: ShapeClass,
    /// Seconds of a narrow-phase check of a pair that doesn't meet.
    pub check: f64,
    /// The cheapest variant.
    pub best: String,
    /// Its total T + Np·Cp, seconds per frame.
    pub total: f64,
    /// The total of spheres alone, seconds per frame.
    pub spheres: f64,
    /// The variants tied with it.
    pub tied: Vec<String>,
}

/// Every density, class and price.
#[must_use]
pub fn table(densities: &[Density], shapes: &[ShapeSurvival]) -> Vec<Decision> {
    let mut decisions = Vec::new();
    for density in densities {
        for &class in ShapeClass::ALL {
            let of_class: Vec<&ShapeSurvival> =
                shapes.iter().filter(|shape| ShapeClass::of(shape) == class).collect();
            if of_class.is_empty() {
                continue;
            }
            for check in CHECKS {
                decisions.extend(decision(density, class, &of_class, check));
            }
        }
    }
    decisions
}

fn decision(
    density: &Density,
    class: ShapeClass,
    shapes: &[&ShapeSurvival],
    check: f64,
) -> Option<Decision> {
    let spheres = density.lines.first()?;
    let with_pairs = |line: &'_ Line| {
        let share = survivors(line, shapes)?;
        Some((line.clone(), share * spheres.pairs))
    };
    let lines: Vec<(Line, f64)> = density.lines.iter().filter_map(with_pairs).collect();
    let choice = choose(&lines, check)?;
    Some(Decision {
        partners: density.partners,
        class,
        check,
        best: choice.best,
        total: choice.total,
        spheres: spheres.time() + check * spheres.pairs,
        tied: choice.tied,
    })
}

/// The cheapest of some variants.
pub struct Choice {
    /// Its name.
    pub best: String,
    /// T + Np·Cp, seconds per frame.
    pub total: f64,
    /// The names of the variants tied with it.
    pub tied: Vec<String>,
}

/// Chooses among variants by the pairs that each left when it was timed, if a check takes `check`
/// seconds.
#[must_use]
pub fn choose_measured(lines: &[Line], check: f64) -> Option<Choice> {
    let own: Vec<(Line, f64)> = lines.iter().map(|line| (line.clone(), line.pairs)).collect();
    choose(&own, check)
}

/// Chooses among variants, each with the pairs that it leaves, if a check takes `check` seconds.
#[must_use]
fn choose(lines: &[(Line, f64)], check: f64) -> Option<Choice> {
    let total = |(line, pairs): &(Line, f64)| line.time() + check * pairs;
    let best = lines.iter().min_by(|a, b| total(a).total_cmp(&total(b)))?;
    let tied = |(line, pairs): &&(Line, f64)| {
        line.name != best.0.name
            && line.beyond(&best.0, check, [*pairs, best.1]).interval()[0] <= 0.0
    };
    Some(Choice {
        best: best.0.name.clone(),
        total: total(best),
        tied: lines.iter().filter(tied).map(|(line, _)| line.name.clone()).collect(),
    })
}

/// Pairs that a variant leaves, per sphere hit: the mean over some shapes. `None` if that wasn't
/// measured.
fn survivors(line: &Line, shapes: &[&ShapeSurvival]) -> Option<f64> {
    let of = |shape: &&ShapeSurvival| match (line.decides?, line.ordop) {
        (Volume::Sphere, _) => Some(1.0),
        (Volume::Hull, _) => Some(shape.hull.mean),
        (_, Some(kind)) => {
            let same = |s: &&super::shapes::Survival| {
                (s.k, s.axes, s.overlap) == (kind.k, kind.axes, kind.overlap)
            };
            shape.ordops.iter().find(same).map(|s| s.share.mean)
        }
        _ => None,
    };
    let shares = shapes.iter().map(of).collect::<Option<Vec<_>>>()?;
    Some(shares.iter().sum::<f64>() / shares.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, times: [f64; 3]) -> Line {
        Line {
            name: name.into(),
            decides: None,
            ordop: None,
            times: times.to_vec(),
            pairs: 0.0,
            construct: 0.0,
        }
    }

    /// The cheapest total wins, and variants within its interval are tied.
    #[test]
    fn cheapest_total_wins() {
        let lines = [
            (line("coarse", [1.0, 1.1, 0.9]), 10.0),
            (line("same", [1.1, 1.0, 1.0]), 10.0),
            (line("fine", [5.0, 5.1, 4.9]), 2.0),
        ];
        let at = |check| choose(&lines, check).map(|c| (c.best, c.tied));
        assert_eq!(at(0.1), Some(("coarse".into(), vec!["same".into()])));
        assert_eq!(at(1.0), Some(("fine".into(), vec![])));
        assert!(choose(&[], 1.0).is_none());
    }
}
