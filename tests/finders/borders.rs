//! Scenes on the borders between cells, to a unit in the last place of f64: three that once lost a
//! pair or panicked, and a short search for others. `cargo bench --bench finder_borders` runs a
//! long search.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::settings::{Finder, Strategy};
use sdop::simd::Tier;
use sdop_judge::draw::borders::{Borders, bar};

use super::scenes::Scene;
use super::{compare, run, settings};

const NO_TURN: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A bar whose ends lie so far from its middle, for each reach; of the bodies, `(shape, moves,
/// centre)`.
fn scene(reaches: &[f32], bodies: impl IntoIterator<Item = (u32, bool, [f32; 3])>) -> Scene {
    let mut columns = Bodies::default();
    for (shape, moves, centre) in bodies {
        columns.push(shape, moves, NO_TURN, centre);
    }
    Scene {
        name: "borders",
        shapes: reaches.iter().map(|r| bar(r.next_up()).unwrap()).collect(),
        bodies: columns,
        step: 0.0,
    }
}

/// The sorted pairs of one frame.
fn pairs(scene: &Scene, strategy: Strategy, finder: Finder, tier: Tier) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    run(scene, &settings(strategy, finder), tier, 1, 1, |culler| {
        found = culler.pairs().sorted();
    });
    found
}

/// Every finder in every tier and strategy against all pairs.
fn judge(scene: &Scene, strategies: &[Strategy], what: &str) {
    for &strategy in strategies {
        let wanted = [pairs(scene, strategy, Finder::AllPairs, Tier::SCALAR)];
        for &finder in Finder::ALL {
            for tier in Tier::available() {
                let found = [pairs(scene, strategy, finder, tier)];
                compare(&found, &wanted, &format!("{what}, {strategy}, {finder}, {tier}"));
            }
        }
    }
}

/// The extent between these two, 10.494775749…, lies one unit in the last place of f64 below 5½
/// cells of the bars below: the division gave six cells, 0 to 5, and the farthest bar fell in
/// number 6.
#[allow(clippy::excessive_precision, reason = "as the culler got them")]
const ENDS: [f32; 2] = [2.255_456_088_562_368_7e-8, 10.494_775_772_094_727];
#[allow(clippy::excessive_precision, reason = "as the culler got it")]
const REACH: f32 = 0.954_054_474_830_627_4;

fn between(n: usize) -> impl Iterator<Item = f32> {
    (1..=n).map(move |i| ENDS[1] * i as f32 / (n + 1) as f32)
}

/// Two bars whose extent is just below a border have their cells.
#[test]
fn bars_below_a_border_have_cells() {
    let bars = ENDS.map(|x| (0, true, [x, 0.0, 0.0]));
    judge(&scene(&[REACH], bars), Strategy::ALL, "two bars");
}

/// A moving bar meets the farthest static one.
#[test]
fn moving_bar_meets_farthest_static() {
    let fixed = ENDS.into_iter().chain(between(100));
    let bars = fixed.map(|x| (0, false, [x, 0.0, 0.0]));
    #[allow(clippy::excessive_precision, reason = "as the culler got it")]
    let moving = (0, true, [11.494_775_772_094_727, 0.0, 0.0]);
    let scene = scene(&[REACH], bars.chain([moving]));
    let wanted = pairs(&scene, Strategy::Sphere, Finder::AllPairs, Tier::SCALAR);
    assert!(wanted.contains(&[1, 102]));
    judge(&scene, Strategy::ALL, "static bars");
}

/// A giant bar meets the farthest small one.
#[test]
fn giant_bar_meets_farthest_small() {
    // In three dimensions a cell beyond the box is in its table still: nothing panics, and the
    // giant doesn't look there.
    let small = ENDS.into_iter().chain(between(1998)).zip(0..);
    let bars = small.map(|(x, i)| (0, true, [x, 2.0 * (i / 2 % 4) as f32, (i / 8 % 5) as f32]));
    let giant = (1, true, [ENDS[1] + 8.0 + 0.95, 0.0, 0.0]);
    let scene = scene(&[REACH, 8.0], bars.chain([giant]));
    let wanted = pairs(&scene, Strategy::Sphere, Finder::AllPairs, Tier::SCALAR);
    assert!(wanted.contains(&[1, 2000]));
    judge(&scene, &[Strategy::Sphere], "a giant bar");
}

/// How many scenes the short search draws, and how many of them at least a division must count
/// otherwise than the grid.
const SCENES: usize = 6000;
const DIVIDED: usize = 100;

/// No pair is lost on a border between cells.
#[test]
fn borders_lose_no_pair() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (settings, tiers) = (Borders::settings(), Tier::available());
    let (mut divided, mut pairs) = (0, 0);
    for n in 0..SCENES {
        let scene = Borders::draw(&mut |below| rng.random_range(0..below));
        let shapes = scene.radii.map(|r| bar(r).unwrap());
        assert_eq!(shapes[0].ball.radius, scene.radii[0]);
        let frames = if n % 16 == 0 { 6 } else { 1 };
        let tier = tiers[n % tiers.len()];
        let (found, difference) = scene.judge(&shapes, &settings, tier, frames).unwrap();
        assert_eq!(difference, None, "scene {n}, {tier}");
        pairs += found;
        divided += usize::from(scene.divides);
    }
    assert!(pairs > 10 * SCENES, "{pairs} pairs");
    assert!(divided > DIVIDED, "{divided} of {SCENES}");
}
