//! When a cull pays: the full cost T + Np·Cp (Gottschalk, Lin & Manocha 1996), Np the pairs handed to a narrow phase.
//!
//! In Cp each variant's cost is a line with the intercept T and the slope Np, so the cheapest variant as Cp grows is their
//! lower envelope. All break-evens lie between neighbours on it. The pairs by which two variants differ are false ones:
//! the Cp that counts is that of a pair that doesn't meet.

use serde::{Deserialize, Serialize};

use super::truth::NarrowPhase;

/// One variant's cost a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The variant.
    pub name: String,
    /// T, seconds a frame.
    pub time: f64,
    /// Np, pairs a frame.
    pub pairs: f64,
}

/// A stretch of Cp in which one variant is the cheapest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretch {
    /// The cheapest variant.
    pub name: String,
    /// Where the stretch begins, seconds a pair; it ends where the next begins.
    pub from: f64,
}

/// The lower envelope of the lines over Cp ≥ 0, by rising Cp.
#[must_use]
pub fn envelope(lines: &[Line]) -> Vec<Stretch> {
    let cheapest = |at: f64| {
        let cost = |line: &&Line| (line.time + at * line.pairs, line.pairs);
        lines.iter().min_by(|a, b| {
            let (a, b) = (cost(a), cost(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    };
    let mut stretches = Vec::new();
    let (mut current, mut from) = (cheapest(0.0), 0.0);
    while let Some(line) = current {
        stretches.push(Stretch {
            name: line.name.clone(),
            from,
        });
        // The next to undercut it is the flatter line that it meets first; of those, the flattest.
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
    ((flat.time - steep.time) / (steep.pairs - flat.pairs)).max(0.0)
}

/// One line: which variant to take, by what a narrow-phase check costs.
#[must_use]
pub fn advice(cheapest: &[Stretch], narrow_phase: &NarrowPhase) -> String {
    let parts: Vec<String> = cheapest
        .iter()
        .map(|stretch| match stretch.from {
            0.0 => stretch.name.clone(),
            from => format!("{} above {:.0} ns", stretch.name, 1e9 * from),
        })
        .collect();
    let own = cheapest.iter().rfind(|s| s.from <= narrow_phase.miss);
    format!(
        "Cheapest at this density, by the price of a narrow-phase check: {}. The exact reference takes {:.0} ns to find two \
         meshes apart: with it, take {}.",
        parts.join("; "),
        1e9 * narrow_phase.miss,
        own.map_or("nothing", |s| s.name.as_str())
    )
}

/// Whether nothing is both faster and as precise, or as fast and more precise: the Pareto front over (time, precision).
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beaten = |&(time, precision): &(f64, f64)| {
        points
            .iter()
            .any(|&(t, p)| t <= time && p >= precision && (t < time || p > precision))
    };
    points.iter().map(|point| !beaten(point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, time: f64, pairs: f64) -> Line {
        Line {
            name: name.into(),
            time,
            pairs,
        }
    }

    #[test]
    fn the_envelope_is_the_cheapest_at_every_price() {
        let lines = [
            line("coarse", 1.0, 10.0),
            line("dominated", 4.0, 9.0),
            line("middle", 3.0, 6.0),
            line("fine", 9.0, 4.0),
            line("useless", 20.0, 5.0),
        ];
        let stretches = envelope(&lines);
        let names: Vec<_> = stretches
            .iter()
            .map(|s| (s.name.as_str(), s.from))
            .collect();
        assert_eq!(names, [("coarse", 0.0), ("middle", 0.5), ("fine", 3.0)]);
        for step in 0..100 {
            let price = f64::from(step) * 0.05;
            let least = lines.iter().map(|l| l.time + price * l.pairs);
            let least = least.fold(f64::INFINITY, f64::min);
            let chosen = stretches.iter().rfind(|s| s.from <= price);
            let chosen = chosen.and_then(|s| lines.iter().find(|l| l.name == s.name));
            let cost = chosen.map_or(f64::NAN, |l| l.time + price * l.pairs);
            assert!((cost - least).abs() < 1e-12, "at {price}");
        }
    }

    #[test]
    fn the_front_keeps_what_nothing_beats() {
        let points = [(1.0, 0.1), (2.0, 0.3), (2.0, 0.2), (3.0, 0.3), (4.0, 0.9)];
        assert_eq!(front(&points), [true, true, false, false, true]);
        assert_eq!(front(&[(1.0, 0.5), (1.0, 0.5)]), [true, true]);
    }
}
