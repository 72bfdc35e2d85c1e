//! When culling pays: the full cost T + Np·Cp (Gottschalk, Lin & Manocha 1996), where Np are the
//! pairs passed to a narrow phase.
//!
//! As a function of Cp, each variant's cost is a line with the intercept T and the slope Np, so the
//! cheapest variants are their lower envelope. All break-evens are between neighbours on it. Two
//! variants differ only in false pairs, so Cp is the price of a pair that doesn't meet.

use serde::{Deserialize, Serialize};

use super::truth::NarrowPhase;
use crate::measure::estimate::Estimate;
use sdop::choice::choices;

/// One variant's cost per frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The variant.
    pub name: String,
    /// T, seconds per warm frame, of each pass in the order of time.
    pub times: Vec<f64>,
    /// Np, pairs per frame.
    pub pairs: f64,
}

impl Line {
    /// T, seconds per frame.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.times.iter().sum::<f64>() / self.times.len() as f64
    }

    /// The difference of both costs per frame, pass by pass so that common disturbances cancel, if
    /// a narrow-phase check takes `cp` seconds.
    #[must_use]
    pub fn beyond(&self, other: &Self, cp: f64) -> Estimate {
        let checks = cp * (self.pairs - other.pairs);
        let passes = self.times.iter().zip(&other.times);
        let differences = passes.map(|(own, other)| own - other + checks);
        Estimate::in_order(&differences.collect::<Vec<_>>())
    }
}

/// Prices of a narrow-phase check, in seconds, for which variants are chosen.
pub const CHECKS: [f64; 4] = [10e-9, 100e-9, 1e-6, 10e-6];

/// The cheapest of some variants.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Its name.
    pub best: String,
    /// T + Np·Cp, seconds per frame.
    pub total: f64,
    /// The names of the variants tied with it: the interval of the difference contains zero.
    pub tied: Vec<String>,
}

/// Chooses the variant with the cheapest total if a check takes `check` seconds. `None` without
/// variants.
#[must_use]
pub fn choose(lines: &[Line], check: f64) -> Option<Choice> {
    let total = |line: &Line| line.time() + check * line.pairs;
    let best = lines.iter().min_by(|a, b| total(a).total_cmp(&total(b)))?;
    let is_tied =
        |line: &&Line| line.name != best.name && line.beyond(best, check).interval()[0] <= 0.0;
    Some(Choice {
        best: best.name.clone(),
        total: total(best),
        tied: lines.iter().filter(is_tied).map(|line| line.name.clone()).collect(),
    })
}

/// A range of Cp in which one variant is the cheapest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheapestRange {
    /// The cheapest variant.
    pub name: String,
    /// The start of the range, in seconds per pair; it ends at the start of the next.
    pub from: f64,
}

/// The lower envelope of the lines over Cp ≥ 0, by rising Cp.
#[must_use]
pub fn envelope(lines: &[Line]) -> Vec<CheapestRange> {
    let cheapest = |at: f64| {
        let cost = |line: &&Line| (line.time() + at * line.pairs, line.pairs);
        lines.iter().min_by(|a, b| {
            let (a, b) = (cost(a), cost(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    };
    let mut stretches = Vec::new();
    let (mut current, mut from) = (cheapest(0.0), 0.0);
    while let Some(line) = current {
        stretches.push(CheapestRange { name: line.name.clone(), from });
        // The next cheapest is the flatter line that it meets first; of several, the flattest.
        let next = lines
            .iter()
            .filter(|other| other.pairs < line.pairs)
            .map(|other| (break_even(line, other), other))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.pairs.total_cmp(&b.1.pairs)));
        current = next.map(|(_, other)| other);
        from = next.map_or(from, |(at, _)| at);
    }
    stretches
}

/// The Cp above which `flat`, which leaves fewer pairs, is the cheaper one.
#[must_use]
pub fn break_even(steep: &Line, flat: &Line) -> f64 {
    ((flat.time() - steep.time()) / (steep.pairs - flat.pairs)).max(0.0)
}

/// One line that says which variant to use, by the price of a narrow-phase check.
#[must_use]
pub fn advice(cheapest: &[CheapestRange], narrow_phase: &NarrowPhase) -> String {
    let parts: Vec<String> = cheapest
        .iter()
        .map(|stretch| match stretch.from {
            0.0 => stretch.name.clone(),
            from => format!("{} above {:.0} ns", stretch.name, 1e9 * from),
        })
        .collect();
    let own = cheapest.iter().rfind(|s| s.from <= narrow_phase.miss);
    format!(
        "Cheapest at this density, by the price of a narrow-phase check: {}. Our exact reference takes {:.0} ns \
         for two meshes that are apart; if it is your narrow phase, {} is cheapest.",
        parts.join("; "),
        1e9 * narrow_phase.miss,
        own.map_or("nothing", |s| s.name.as_str())
    )
}

choices! {
    /// The relation of a variant to the Pareto front of time and precision.
    Standing, "standing", {
        /// No variant is as precise in less time, or more precise in the same time.
        Front = "front",
        /// Another one is better in the mean, but within the interval of the difference.
        Tied = "tied",
        /// Another one is better by more than the interval of the difference.
        Beaten = "beaten",
    }
}

/// One variant's times, pass by pass, and precisions, seed by seed.
#[derive(Clone, Debug)]
pub struct Point {
    /// Seconds per frame.
    pub times: Vec<f64>,
    /// True pairs / reported pairs.
    pub precisions: Vec<f64>,
}

/// The standing of each variant.
#[must_use]
pub fn standings(points: &[Point]) -> Vec<Standing> {
    let differences = |a: &[f64], b: &[f64]| {
        let differences = a.iter().zip(b).map(|(a, b)| a - b);
        Estimate::in_order(&differences.collect::<Vec<_>>())
    };
    let standing = |own: &Point| {
        let mut standing = Standing::Front;
        for other in points {
            let slower = differences(&own.times, &other.times);
            let finer = differences(&other.precisions, &own.precisions);
            let by_mean = slower.mean >= 0.0 && finer.mean >= 0.0 && slower.mean + finer.mean > 0.0;
            if by_mean {
                let [least_slower, least_finer] = [slower, finer].map(|d| d.interval()[0]);
                let surely = (least_slower > 0.0 && least_finer >= 0.0)
                    || (least_slower >= 0.0 && least_finer > 0.0);
                standing = standing.max(if surely { Standing::Beaten } else { Standing::Tied });
            }
        }
        standing
    };
    points.iter().map(standing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, time: f64, pairs: f64) -> Line {
        Line { name: name.into(), times: vec![time], pairs }
    }

    /// The cheapest total wins, and variants within its interval are tied.
    #[test]
    fn cheapest_total_wins() {
        let timed = |name: &str, times: [f64; 3], pairs| Line {
            times: times.to_vec(),
            ..line(name, 0.0, pairs)
        };
        let lines = [
            timed("coarse", [1.0, 1.1, 0.9], 10.0),
            timed("same", [1.1, 1.0, 1.0], 10.0),
            timed("fine", [5.0, 5.1, 4.9], 2.0),
        ];
        let at = |check| choose(&lines, check).map(|c| (c.best, c.tied));
        assert_eq!(at(0.1), Some(("coarse".into(), vec!["same".into()])));
        assert_eq!(at(1.0), Some(("fine".into(), vec![])));
        assert!(choose(&[], 1.0).is_none());
    }

    /// The envelope is the cheapest at every price.
    #[test]
    fn envelope_is_cheapest() {
        let lines = [
            line("coarse", 1.0, 10.0),
            line("dominated", 4.0, 9.0),
            line("middle", 3.0, 6.0),
            line("fine", 9.0, 4.0),
            line("useless", 20.0, 5.0),
        ];
        let stretches = envelope(&lines);
        let names: Vec<_> = stretches.iter().map(|s| (s.name.as_str(), s.from)).collect();
        assert_eq!(names, [("coarse", 0.0), ("middle", 0.5), ("fine", 3.0)]);
        for step in 0..100 {
            let price = f64::from(step) * 0.05;
            let least = lines.iter().map(|l| l.time() + price * l.pairs);
            let least = least.fold(f64::INFINITY, f64::min);
            let chosen = stretches.iter().rfind(|s| s.from <= price);
            let chosen = chosen.and_then(|s| lines.iter().find(|l| l.name == s.name));
            let cost = chosen.map_or(f64::NAN, |l| l.time() + price * l.pairs);
            assert!((cost - least).abs() < 1e-12, "at {price}");
        }
    }

    #[test]
    fn the_front_needs_intervals() {
        let point = |times: [f64; 3], precision: f64| Point {
            times: times.to_vec(),
            precisions: vec![precision; 3],
        };
        let points = [
            point([1.00, 1.01, 0.99], 0.1),
            // Slower and not more precise, beyond the interval.
            point([2.00, 2.01, 1.99], 0.1),
            // Slower only in the mean: it is faster in the second pass.
            point([1.10, 0.90, 1.15], 0.1),
            point([3.00, 3.01, 2.99], 0.5),
        ];
        let expected = [Standing::Front, Standing::Beaten, Standing::Tied, Standing::Front];
        assert_eq!(standings(&points), expected);
        let alike = point([1.0, 1.1, 0.9], 0.1);
        assert_eq!(standings(&[alike.clone(), alike]), [Standing::Front; 2]);
    }
}
