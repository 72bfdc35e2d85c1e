//! Checks our reading of Table 1: what its rows can and cannot be.

use super::check::{ClaimCheck, PaperClaim};
use super::experiment::Results;
use super::readings::Reading;
use super::{Estimate, paper};
use sdop::settings::Strategy;

use Strategy::{OrDop, SDopBatch as All, SDopSequential as Seq, Sphere};

/// Where these claims come from.
const SOURCE: &str = "own study";
/// The additional tests per frame that reconcile the ALL row, as a multiple of N.
const EXTRA_TESTS: f64 = 0.28;

/// All of them.
#[must_use]
pub fn all(results: &Results) -> Vec<PaperClaim> {
    let claim = |claim, checks| PaperClaim { source: SOURCE, claim, checks };
    vec![
        claim("A fixed box can't show the sphere row's rise with N.", no_trend(results)),
        claim(
            "Sequential S-DOP is or-DOP hits over or-DOP tests: with sphere tests among the tests it can't exceed the sphere row.",
            sequential(results),
        ),
        claim(
            "ALL S-DOP counts list entries as tests, and up to .28·N tests a frame more.",
            list(results),
        ),
        claim(
            "The paper's or-DOP row contradicts its others: it should be sphere × sequential and can't exceed the sphere row.",
            ordop_row(),
        ),
        claim("Measured, or-DOP hits over tests are sphere × sequential.", product(results)),
    ]
}

/// The difference between the most and the fewest objects, and the chance of the paper's row in a
/// fixed box.
fn no_trend(results: &Results) -> Vec<ClaimCheck> {
    let scenes: Vec<&str> = results.paper_scenes().collect();
    let mut checks = Vec::new();
    if let (Some(first), Some(last)) = (scenes.first(), scenes.last().filter(|_| scenes.len() > 1))
    {
        let [few, many] =
            [first, last].map(|scene| results.percent(scene, Sphere, Reading::OwnTests));
        let rises: Vec<f64> = few.iter().zip(&many).map(|(few, many)| many - few).collect();
        let [first_paper, .., last_paper] = paper::TABLE_1[0].1;
        let quantity = format!(
            "Sphere, {last} − {first}, points (the paper: {:.2})",
            last_paper - first_paper
        );
        checks.push(ClaimCheck::equal(quantity, Estimate::of(&rises), 0.0, 1));
    }
    let (_, p, _) = paper::constant_row(&paper::TABLE_1[0].1, &paper::pairs());
    checks.push(ClaimCheck::computed(
        "probability of the paper's sphere row in a fixed box, single-frame counts".to_owned(),
        p,
        [0.0, 0.05],
    ));
    checks
}

fn sequential(results: &Results) -> Vec<ClaimCheck> {
    let mut checks = Vec::new();
    if let (Some(sphere), Some(sequential)) = (paper::row(Sphere), paper::row(Seq)) {
        for ((n, sphere), sequential) in paper::TABLE_1_BODIES.iter().zip(sphere).zip(sequential) {
            let quantity = format!("the paper's sequential over its sphere row, N = {n}");
            checks.push(ClaimCheck::computed(quantity, sequential / sphere, [1.0, f64::INFINITY]));
        }
    }
    checks.extend(results.scenes().map(|scene| {
        let [all, sphere] = [(Seq, Reading::AllTests), (Sphere, Reading::OwnTests)]
            .map(|(strategy, reading)| results.percent(scene, strategy, reading));
        let ratios: Vec<f64> = all.iter().zip(&sphere).map(|(all, sphere)| all / sphere).collect();
        let quantity = format!("Seq by hits/all tests over Sphere, {scene}");
        ClaimCheck::between(quantity, Estimate::of(&ratios), [f64::NEG_INFINITY, 1.0])
    }));
    checks
}

/// The ALL row from the paper's other rows, and ours with the additional tests.
fn list(results: &Results) -> Vec<ClaimCheck> {
    let extra = paper::extra_tests_of_all().unwrap_or_default();
    let check = |(n, extra): (&usize, f64)| {
        ClaimCheck::computed(
            format!("additional tests a frame over N in the paper's ALL row, N = {n}"),
            extra,
            [0.0, 0.3],
        )
    };
    let mut checks: Vec<ClaimCheck> = paper::TABLE_1_BODIES.iter().zip(extra).map(check).collect();
    for scene in results.paper_scenes() {
        let Some(paper) = results.example(scene).and_then(|run| paper::percentage(All, run.bodies))
        else {
            continue;
        };
        let values = results.by_seed(scene, All, |run| {
            let extra = EXTRA_TESTS * run.bodies as f64 * f64::from(run.frames);
            let tests = (run.counters.ordop.tests + run.counters.sphere.hits) as f64;
            100.0 * run.counters.ordop.hits as f64 / (tests + extra)
        });
        let quantity =
            format!("ALL with list entries and .28·N more tests, {scene}, % (the paper: {paper})");
        checks.push(ClaimCheck::between(
            quantity,
            Estimate::of(&values),
            [0.9 * paper, 1.1 * paper],
        ));
    }
    checks
}

fn ordop_row() -> Vec<ClaimCheck> {
    let [Some(sphere), Some(sequential), Some(ordop)] = [Sphere, Seq, OrDop].map(paper::row) else {
        return Vec::new();
    };
    let mut checks = Vec::new();
    for (i, n) in paper::TABLE_1_BODIES.iter().enumerate() {
        let product = 0.01 * sphere[i] * sequential[i];
        let quantity = format!(
            "the paper's or-DOP percentage over its sphere × sequential ({product:.2} %), N = {n}"
        );
        checks.push(ClaimCheck::computed(quantity, ordop[i] / product, [1.1, f64::INFINITY]));
    }
    let exceeds = |i: &usize| ordop[*i] > sphere[*i];
    let columns = (0..4).filter(exceeds).count() as f64;
    checks.push(ClaimCheck::computed(
        "columns in which the paper's or-DOP row exceeds its sphere row".to_owned(),
        columns,
        [1.0, 4.0],
    ));
    checks
}

fn product(results: &Results) -> Vec<ClaimCheck> {
    let mut checks = Vec::new();
    for scene in results.scenes() {
        let [ordop, sphere, sequential] = [OrDop, Sphere, Seq]
            .map(|strategy| results.percent(scene, strategy, Reading::OwnTests));
        let ratios: Vec<f64> =
            (0..ordop.len()).map(|i| ordop[i] / (0.01 * sphere[i] * sequential[i])).collect();
        let quantity = format!("or-DOPs over Sphere × Seq, {scene}");
        checks.push(ClaimCheck::between(quantity, Estimate::of(&ratios), [0.95, 1.05]));
        let below: Vec<f64> =
            ordop.iter().zip(&sphere).map(|(ordop, sphere)| ordop / sphere).collect();
        checks.push(ClaimCheck::between(
            format!("or-DOPs over Sphere, {scene}"),
            Estimate::of(&below),
            [f64::NEG_INFINITY, 1.0],
        ));
    }
    checks
}
