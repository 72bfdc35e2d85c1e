//! A missed pair is reduced to the smallest scene that shows it. The culler misses none, so here a
//! shape has a ball that is too small.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop_bench::scene::SceneFile;
use sdop_bench::verify::shrink::SmallestScene;
use sdop_judge::configuration::{Mode, Rotation};
use sdop_judge::draw::bodies::crowd;
use sdop_judge::draw::forms::{self, Form};
use sdop_judge::truth::{Predicate, Shapes};
use sdop_judge::verify::rounds::judge_and_check;
use sdop_judge::verify::{Failure, Ledger};
use sdop_judge::{Case, Frame};

fn lying_crowd() -> (Shapes, Ledger) {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let variant = (DirectionSet::K18, Axes::Principal);
    let forms = [Form::of("box", [0.0; 2]), Form::of("l-shape", [0.0; 2])];
    let mut shapes = forms::build(&forms, 1, variant.0, variant.1, &mut rng).unwrap();
    shapes.built[0].ball.radius = 0.01;
    let frame = crowd(&shapes, 24, 4.0, &mut rng);
    let ledger = judge_and_check(
        &shapes,
        &[vec![frame]],
        variant,
        &Predicate::ALL,
        (&Rotation::new(&[Tier::SCALAR]), 0),
    );
    (shapes, ledger.unwrap())
}

/// A ball that is too small is detected, and the scene shrinks to two bodies.
#[test]
fn wrong_ball_shrinks_to_two_bodies() {
    let (shapes, ledger) = lying_crowd();
    assert!(ledger.missed() > 0);
    for (row, count) in &ledger.rows {
        let uses_spheres = !matches!(
            row.strategy,
            Strategy::None | Strategy::OrDop | Strategy::Aabb | Strategy::KDop | Strategy::Obb
        );
        assert_eq!(count.missed > 0, uses_spheres, "{row:?}");
    }
    let smallest = SmallestScene::of(&ledger.failures[0]).unwrap();
    let bodies = &smallest.shrunk.case.frames[0].bodies;
    assert_eq!((smallest.shrunk.case.frames.len(), bodies.len()), (1, 2));
    assert!(smallest.shrunk.case.shapes.len() <= shapes.built.len());

    let directory = tempfile::tempdir().unwrap();
    let (path, shown) = smallest.write(directory.path()).unwrap();
    assert!(!shown, "built anew, the shape tells the truth");
    let scene = SceneFile::read(&path).unwrap().build().unwrap();
    assert_eq!(scene.bodies.translation, bodies.translation);
    assert_eq!(scene.bodies.rotation, bodies.rotation);
    assert_eq!(scene.cull, smallest.settings);
}

/// A scene without a miss is not shrunk.
#[test]
fn complete_scene_is_not_shrunk() {
    let (shapes, ledger) = lying_crowd();
    let honest = Failure {
        settings: CullSettings::all_pairs(),
        mode: Mode::plain(Tier::SCALAR),
        missed: true,
        case: Case {
            shapes: shapes.built[1..].to_vec(),
            frames: vec![Frame::fitted(Default::default(), &[])],
            ..ledger.failures[0].case.clone()
        },
        pair: ledger.failures[0].pair,
    };
    assert!(SmallestScene::of(&honest).is_none());
}
