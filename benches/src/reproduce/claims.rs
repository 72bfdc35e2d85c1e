//! The claims of the paper's sections 6 and 7, sentence by sentence, with our numbers.
//!
//! Frame rates are compared as ratios, seed by seed, for its 500 objects in the small and in the
//! usual box and for both F.

use super::check::{ClaimCheck, PaperClaim};
use super::experiment::Results;
use super::immediate::{Handing, HandingTimes};
use super::plan::{PaperScene, STRATEGIES};
use super::rates::{OTHER_FRAME_SECONDS, ratio};
use super::readings::{Reading, TABLE_1_STRATEGIES};
use super::{Estimate, paper_name};
use sdop::settings::Strategy;

use Strategy::{
    None as Control, OrDop, SDopBatch as All, SDopObjectOfInterest as Ooi, SDopSequential as Seq,
    Sphere,
};

/// "Almost" and "similar" are taken as within five percent.
const SIMILAR_RATIO: [f64; 2] = [0.95, 1.05];

/// All claims, in the paper's order.
#[must_use]
pub fn all(results: &Results) -> Vec<PaperClaim> {
    let mut claims = frame_rates(results);
    claims.extend(percentages(results));
    claims.extend(conclusion(results));
    claims
}

fn frame_rates(results: &Results) -> Vec<PaperClaim> {
    let faster = |pairs: &[[Strategy; 2]]| {
        let check = |pair: &[Strategy; 2]| rate_checks(results, *pair, [1.0, f64::INFINITY]);
        pairs.iter().flat_map(check).collect::<Vec<_>>()
    };
    let over = |one: Strategy, others: &[Strategy]| {
        faster(&others.iter().map(|&other| [one, other]).collect::<Vec<_>>())
    };
    let mut order = faster(&[[Control, Sphere], [Ooi, Seq], [Seq, All], [All, OrDop]]);
    order.extend(rate_checks(results, [Ooi, Sphere], SIMILAR_RATIO));
    let claim = |claim, checks| PaperClaim { source: "6.1", claim, checks };
    vec![
        claim(
            "The control, without bounding volumes, has the highest frame rate.",
            over(Control, &STRATEGIES[1..]),
        ),
        claim("Spheres alone come next.", over(Sphere, &[Ooi, Seq, All, OrDop])),
        claim("S-DOP on all objects lowers the frame rate.", over(Sphere, &[All])),
        claim("S-DOP on all objects still outperforms homogeneous or-DOPs.", over(All, &[OrDop])),
        claim(
            "Sequential S-DOP improves on S-DOP by list (fps: in blocks of 256 pairs; t: truly at once).",
            over(Seq, &[All]).into_iter().chain(at_once(results)).collect(),
        ),
        claim(
            "With an object of interest the frame rate almost reaches the control's.",
            rate_checks(results, [Ooi, Control], [SIMILAR_RATIO[0], f64::INFINITY]),
        ),
        claim(
            "With an object of interest the frame rate is similar to spheres'.",
            rate_checks(results, [Ooi, Sphere], SIMILAR_RATIO),
        ),
        claim("The object of interest stands out among the others.", over(Ooi, &[Seq, All, OrDop])),
        claim(
            "Altogether: control > sphere ≈ object of interest > sequential > list > or-DOPs.",
            order,
        ),
    ]
}

/// Testing at once against listing first, all else equal: the paper's algorithm to the letter.
fn at_once(results: &Results) -> Vec<ClaimCheck> {
    let mut checks = Vec::new();
    for scene in largest(results) {
        for [list, once] in
            [[Handing::ScalarList, Handing::EachPair], [Handing::List, Handing::Sixteen]]
        {
            let of = |run: &HandingTimes| {
                let [list, once] = [list, once].map(|way| {
                    let place = Handing::ALL.iter().position(|&other| other == way);
                    place.map_or(f64::NAN, |place| run.seconds[place])
                });
                list / once
            };
            let found = results.units.iter().filter_map(|unit| unit.immediacy.as_ref());
            let runs = found.filter(|run| run.scene == scene);
            let ratios: Vec<f64> = runs.map(of).collect();
            let quantity = format!("t of {list} / {once}, {scene}");
            checks.push(ClaimCheck::above(quantity, Estimate::in_order(&ratios), 1.0));
        }
    }
    checks
}

fn percentages(results: &Results) -> Vec<PaperClaim> {
    let claim = |claim, checks| PaperClaim { source: "6.2", claim, checks };
    let mut highest = Vec::new();
    for reading in Reading::ALL {
        for scene in results.scenes() {
            let others = TABLE_1_STRATEGIES.into_iter().filter(|&other| other != Seq);
            highest.extend(others.map(|other| {
                let [one, other_values] =
                    [Seq, other].map(|strategy| results.percent(scene, strategy, *reading));
                let differences: Vec<f64> =
                    one.iter().zip(&other_values).map(|(a, b)| a - b).collect();
                let quantity = format!("Seq − {}, {reading}, {scene}, points", paper_name(other));
                ClaimCheck::above(quantity, Estimate::of(&differences), 0.0)
            }));
        }
    }
    let mut useful = Vec::new();
    for reading in [Reading::OwnTests, Reading::AllTests] {
        useful.extend(results.scenes().map(|scene| {
            let values = Estimate::of(&results.percent(scene, Seq, reading));
            ClaimCheck::above(format!("Seq, {reading}, {scene}, %"), values, 50.0)
        }));
    }
    vec![
        claim("Sequential S-DOP has the highest percentage in all experiments.", highest),
        claim("So most of its tests are useful ones.", useful),
    ]
}

fn conclusion(results: &Results) -> Vec<PaperClaim> {
    let claim = |claim, checks| PaperClaim { source: "7", claim, checks };
    let largest = largest(results);
    let faster = |pair| rate_checks(results, pair, [1.0, f64::INFINITY]);
    let crowded: Vec<PaperScene> =
        largest.iter().copied().filter(|scene| scene.crowded()).collect();
    let mut interest = faster([Ooi, Seq]);
    interest.extend(faster([Ooi, All]));
    vec![
        claim(
            "S-DOP culls better than the homogeneous bounding volumes.",
            advantage(results, &largest),
        ),
        claim("The crowded environment supports this further.", advantage(results, &crowded)),
        claim("An object of interest is the option for higher frame rates.", interest),
    ]
}

/// What S-DOP gains over homogeneous volumes in some scenes: frame rates, and the pairs that it
/// passes on.
fn advantage(results: &Results, scenes: &[PaperScene]) -> Vec<ClaimCheck> {
    let faster = |pair| rate_checks_in(results, scenes, pair, [1.0, f64::INFINITY]);
    let pairs = [[Seq, OrDop], [All, OrDop], [Seq, Sphere]];
    let mut checks: Vec<ClaimCheck> = pairs.into_iter().flat_map(faster).collect();
    for scene in scenes {
        let [kept, spheres] = [Seq, Sphere].map(|strategy| {
            results.by_seed(scene.name(), strategy, |run| run.counters.reported as f64)
        });
        let ratios: Vec<f64> = kept.iter().zip(&spheres).map(|(a, b)| a / b).collect();
        let quantity = format!("pairs passed on, Seq/Sphere, {scene}");
        checks.push(ClaimCheck::between(quantity, Estimate::of(&ratios), [f64::NEG_INFINITY, 1.0]));
    }
    checks
}

/// Frame rate of one strategy over another's in every scene of the most objects and for every F.
fn rate_checks(results: &Results, of: [Strategy; 2], claimed: [f64; 2]) -> Vec<ClaimCheck> {
    rate_checks_in(results, &largest(results), of, claimed)
}

fn rate_checks_in(
    results: &Results,
    scenes: &[PaperScene],
    of: [Strategy; 2],
    claimed: [f64; 2],
) -> Vec<ClaimCheck> {
    let mut checks = Vec::new();
    for scene in scenes {
        for elsewhere in OTHER_FRAME_SECONDS {
            let [one, other] = of.map(paper_name);
            let quantity = format!("fps {one}/{other}, {scene}, F = {} ms", 1e3 * elsewhere);
            checks.push(ClaimCheck::between(
                quantity,
                ratio(results, scene.name(), of, elsewhere),
                claimed,
            ));
        }
    }
    checks
}

/// The scenes with the most objects.
fn largest(results: &Results) -> Vec<PaperScene> {
    let bodies = |scene: &PaperScene| results.example(scene.name()).map_or(0, |run| run.bodies);
    let names = &results.plan.names;
    let most = names.iter().map(bodies).max().unwrap_or(0);
    let of_most = names.iter().filter(|scene| bodies(scene) == most);
    of_most.copied().collect()
}
