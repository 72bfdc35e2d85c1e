//! Each sentence of the paper's sections 6 and 7 that claims something, with our numbers.
//!
//! Frame rates are compared as ratios, seed by seed, for its 500 objects in the small and in the usual box and for both F.

use super::check::{Check, Claim};
use super::experiment::{Results, STRATEGIES};
use super::rates::{ELSEWHERE, ratio};
use super::readings::{Reading, TABLE_1_STRATEGIES};
use super::{Estimate, paper_name};
use crate::settings::Strategy;

use Strategy::{
    None as Control, OrDop, SDopBatch as All, SDopObjectOfInterest as Ooi, SDopSequential as Seq,
    Sphere,
};

/// "Almost" and "similar" are taken as within five percent.
const SIMILAR: [f64; 2] = [0.95, 1.05];

/// All claims, in the paper's order.
#[must_use]
pub fn all(results: &Results) -> Vec<Claim> {
    let mut claims = frame_rates(results);
    claims.extend(percentages(results));
    claims.extend(conclusion(results));
    claims
}

fn frame_rates(results: &Results) -> Vec<Claim> {
    let faster = |pairs: &[[Strategy; 2]]| {
        let check = |pair: &[Strategy; 2]| rate_checks(results, *pair, [1.0, f64::INFINITY]);
        pairs.iter().flat_map(check).collect::<Vec<_>>()
    };
    let over = |one: Strategy, others: &[Strategy]| {
        faster(&others.iter().map(|&other| [one, other]).collect::<Vec<_>>())
    };
    let mut order = faster(&[[Control, Sphere], [Ooi, Seq], [Seq, All], [All, OrDop]]);
    order.extend(rate_checks(results, [Ooi, Sphere], SIMILAR));
    let claim = |claim, checks| Claim {
        source: "6.1",
        claim,
        checks,
    };
    vec![
        claim(
            "The control, without bounding volumes, has the highest frame rate.",
            over(Control, &STRATEGIES[1..]),
        ),
        claim(
            "Spheres alone come next.",
            over(Sphere, &[Ooi, Seq, All, OrDop]),
        ),
        claim(
            "S-DOP on all objects lowers the frame rate.",
            over(Sphere, &[All]),
        ),
        claim(
            "S-DOP on all objects still outperforms homogeneous or-DOPs.",
            over(All, &[OrDop]),
        ),
        claim(
            "Sequential S-DOP improves on S-DOP by list.",
            over(Seq, &[All]),
        ),
        claim(
            "With an object of interest the frame rate almost reaches the control's.",
            rate_checks(results, [Ooi, Control], [SIMILAR[0], f64::INFINITY]),
        ),
        claim(
            "With an object of interest the frame rate is similar to spheres'.",
            rate_checks(results, [Ooi, Sphere], SIMILAR),
        ),
        claim(
            "The object of interest stands out among the others.",
            over(Ooi, &[Seq, All, OrDop]),
        ),
        claim(
            "Altogether: control > sphere ≈ object of interest > sequential > list > or-DOPs.",
            order,
        ),
    ]
}

fn percentages(results: &Results) -> Vec<Claim> {
    let claim = |claim, checks| Claim {
        source: "6.2",
        claim,
        checks,
    };
    let mut highest = Vec::new();
    for reading in Reading::ALL {
        for scene in &results.plan.names {
            let others = TABLE_1_STRATEGIES.into_iter().filter(|&other| other != Seq);
            highest.extend(others.map(|other| {
                let [one, other_values] =
                    [Seq, other].map(|strategy| percent(results, scene, strategy, *reading));
                let differences: Vec<f64> =
                    one.iter().zip(&other_values).map(|(a, b)| a - b).collect();
                let quantity = format!("Seq − {}, {reading}, {scene}, points", paper_name(other));
                Check::above(quantity, Estimate::of(&differences), 0.0)
            }));
        }
    }
    let mut useful = Vec::new();
    for reading in [Reading::OwnTests, Reading::AllTests] {
        useful.extend(results.plan.names.iter().map(|scene| {
            let values = Estimate::of(&percent(results, scene, Seq, reading));
            Check::above(format!("Seq, {reading}, {scene}, %"), values, 50.0)
        }));
    }
    vec![
        claim(
            "Sequential S-DOP has the highest percentage in all experiments.",
            highest,
        ),
        claim("So most of its tests are useful ones.", useful),
    ]
}

fn conclusion(results: &Results) -> Vec<Claim> {
    let claim = |claim, checks| Claim {
        source: "7",
        claim,
        checks,
    };
    let faster = |pair| rate_checks(results, pair, [1.0, f64::INFINITY]);
    let mut advantage: Vec<Check> = [[Seq, OrDop], [All, OrDop], [Seq, Sphere]]
        .into_iter()
        .flat_map(faster)
        .collect();
    for scene in largest(results) {
        let [kept, spheres] = [Seq, Sphere]
            .map(|strategy| results.by_seed(scene, strategy, |run| run.counters.reported as f64));
        let ratios: Vec<f64> = kept.iter().zip(&spheres).map(|(a, b)| a / b).collect();
        let quantity = format!("pairs passed on, Seq/Sphere, {scene}");
        advantage.push(Check::between(
            quantity,
            Estimate::of(&ratios),
            [f64::NEG_INFINITY, 1.0],
        ));
    }
    let crowded = advantage
        .iter()
        .filter(|check| check.quantity.contains("crowded"));
    let crowded = crowded.cloned().collect();
    let mut interest = faster([Ooi, Seq]);
    interest.extend(faster([Ooi, All]));
    vec![
        claim(
            "S-DOP culls better than the homogeneous bounding volumes.",
            advantage,
        ),
        claim("The crowded environment supports this further.", crowded),
        claim(
            "An object of interest is the option for higher frame rates.",
            interest,
        ),
    ]
}

/// Frame rate of one strategy over another's in every scene of the most objects and for every F.
fn rate_checks(results: &Results, of: [Strategy; 2], claimed: [f64; 2]) -> Vec<Check> {
    let mut checks = Vec::new();
    for scene in largest(results) {
        for elsewhere in ELSEWHERE {
            let [one, other] = of.map(paper_name);
            let quantity = format!("fps {one}/{other}, {scene}, F = {} ms", 1e3 * elsewhere);
            checks.push(Check::between(
                quantity,
                ratio(results, scene, of, elsewhere),
                claimed,
            ));
        }
    }
    checks
}

/// The scenes with the most objects.
fn largest(results: &Results) -> Vec<&str> {
    let bodies = |name: &str| results.example(name).map_or(0, |run| run.bodies);
    let names = || results.plan.names.iter().map(String::as_str);
    let most = names().map(bodies).max().unwrap_or(0);
    names().filter(|name| bodies(name) == most).collect()
}

fn percent(results: &Results, scene: &str, strategy: Strategy, reading: Reading) -> Vec<f64> {
    results.by_seed(scene, strategy, |run| {
        reading.percentage(strategy, &run.counters, run.frames, run.bodies)
    })
}
