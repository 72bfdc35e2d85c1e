//! Rust cullers: right ones pass, and each flaw is found by the group that looks for it.

use std::sync::atomic::{AtomicUsize, Ordering};

use sdop::boxes::BoxWorld;
use sdop::settings::Strategy;
use sdop_judge::answer::AnswerError;
use sdop_judge::history::contestant::Living;
use sdop_judge::{Claim, Conclusion, Outcome, Scene, Verdict, judge, judge_pair_test};

use crate::judge::cullers::{All, Boxes, Flaw, Ours, balls_meet, balls_meet_without_margin};

fn all(flaw: Flaw) -> impl Fn(&Scene<'_>) -> All + Sync {
    move |_| All { flaw, bodies: 0, runs: 0 }
}

/// The cases that were judged and not passed.
fn failures(verdict: &Verdict) -> Vec<&str> {
    let against = verdict.cases.iter().filter(|case| case.counts_against());
    against.map(|case| case.name.as_str()).collect()
}

#[test]
fn our_strategies_pass_their_claims() {
    for (strategy, claim) in [
        (Strategy::Sphere, Claim::Sphere),
        (Strategy::OrDop, Claim::OrDop),
        (Strategy::Obb, Claim::Hull),
        (Strategy::SDopSequential, Claim::Mesh),
    ] {
        let verdict = judge(|scene: &Scene<'_>| Ours::new(scene, strategy))
            .claims(claim)
            .seed(5)
            .run()
            .unwrap();
        // Its bodies are those it was made for: such cases are skipped, with a reason.
        let skipped =
            |o: &Outcome| matches!(o, Outcome::Skipped { why } if why.contains("can't change"));
        assert_eq!(verdict.conclusion(), Conclusion::Incomplete, "{strategy}: {verdict}");
        assert!(verdict.cases.iter().all(|case| case.outcome == Outcome::Pass
            || (skipped(&case.outcome)
                && (["churn/insert-remove", "long/sets"].contains(&case.group())
                    || case.group().starts_with("stale/")))));
        assert!(verdict.pairs().required > 5_000, "{verdict}");
    }
}

/// Given boxes pass every case, without an extra pair.
#[test]
fn given_boxes_are_reported_exactly() {
    let culler = judge(|_: &Scene<'_>| Boxes::default()).claims(Claim::Aabb);
    let world = judge(|_: &Scene<'_>| Living::new(BoxWorld::new())).claims(Claim::Aabb);
    let [culler, world] = [culler.seed(5).run(), world.seed(5).run()].map(Result::unwrap);
    for verdict in [&culler, &world] {
        let mut cases = verdict.cases.iter();
        assert!(verdict.passed() && cases.all(|case| case.outcome == Outcome::Pass), "{verdict}");
        assert!(verdict.pairs().required > 5_000, "{verdict}");
    }
    assert_eq!(world.pairs().extra, 0, "{world}");
    assert_eq!(culler.pairs().extra, culler.pairs().both_static, "{culler}");
}

/// A culler that reports less than it claims fails.
#[test]
fn unmet_claims_are_caught() {
    let verdict = judge(|scene: &Scene<'_>| Ours::new(scene, Strategy::SDopSequential))
        .claims(Claim::Sphere)
        .run()
        .unwrap();
    assert!(!verdict.passed() && verdict.pairs().missed > 100, "{verdict}");
    let smallest = verdict.smallest.unwrap();
    assert_eq!(smallest.case.frames[0].bodies.len(), 2);
    assert!(smallest.witness.is_some());
}

/// Balls in f64 with a margin pass; in f32 without one they fail.
#[test]
fn balls_need_f64_and_a_margin() {
    let verdict = judge_pair_test(balls_meet)
        .cases("*-*")
        .claims(Claim::Sphere)
        .seed(7)
        .extra_limit(0.1)
        .run()
        .unwrap();
    assert!(verdict.passed(), "{verdict}");
    assert_eq!(verdict.pairs().extra, verdict.pairs().by_rounding, "{verdict}");
    let verdict = judge_pair_test(balls_meet_without_margin).claims(Claim::Sphere).run().unwrap();
    assert!(failures(&verdict).iter().any(|name| name.starts_with("touch/ball-ball")), "{verdict}");
    let smallest = verdict.smallest.as_ref().unwrap();
    let depth = smallest.witness.as_ref().unwrap().depth_ulps;
    assert!(depth.is_some_and(|ulps| ulps < 64), "{verdict}");
}

/// Full buffers and stale answers are caught by the groups that look for them.
#[test]
fn each_flaw_fails_its_group() {
    for (flaw, group) in [
        (Flaw::Buffer(4096), "buffer/growth"),
        (Flaw::Buffer(380), "buffer/hub"),
        (Flaw::Stale, "churn/insert-remove"),
    ] {
        let verdict = judge(all(flaw)).cases(&format!("{group}/*")).run().unwrap();
        assert!(!failures(&verdict).is_empty(), "{group}: {verdict}");
    }
    let verdict = judge(all(Flaw::None)).cases("churn/insert-remove/*").run().unwrap();
    assert!(verdict.passed(), "{verdict}");
}

/// A culler that answers differently when it runs again fails.
#[test]
fn unrepeatable_cullers_fail() {
    let runs = AtomicUsize::new(0);
    // Every second culler is fickle, and sees the case that the one before saw.
    let fickle = |_: &Scene<'_>| All {
        flaw: Flaw::Fickle,
        bodies: 0,
        runs: runs.fetch_add(1, Ordering::Relaxed),
    };
    let verdict = judge(fickle).claims(Claim::Aabb).cases("exact/tip-to-tip/0000").run().unwrap();
    let case = &verdict.cases[0];
    assert!(matches!(&case.outcome, Outcome::Fail { why } if why.contains("again")), "{verdict}");
}

/// Invalid answers are errors and never a pass.
#[test]
fn invalid_answers_are_errors() {
    let trouble = |flaw: Flaw| {
        let verdict = judge(all(flaw)).cases("exact/face-to-face/0000").run().unwrap();
        assert!(!verdict.passed());
        match verdict.cases[0].outcome.clone() {
            Outcome::Error { trouble } => trouble,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(trouble(Flaw::SelfPair), AnswerError::SelfPair { frame: 0, body: 0 });
    assert_eq!(trouble(Flaw::Twice), AnswerError::Twice { frame: 0, pair: [0, 1] });
    assert_eq!(trouble(Flaw::Reversed), AnswerError::Reversed { frame: 0, pair: [1, 0] });
    assert_eq!(trouble(Flaw::NoBody), AnswerError::NoBody { frame: 0, pair: [0, 9], bodies: 9 });
    assert!(
        matches!(trouble(Flaw::Panics), AnswerError::Crashed { how, .. } if how.contains("as planned"))
    );
}

#[test]
fn the_extra_limit_is_enforced() {
    let wide = judge(all(Flaw::None))
        .claims(Claim::Mesh)
        .cases("random/crowd/*")
        .extra_limit(0.5)
        .run()
        .unwrap();
    assert!(wide.is_beyond_limit() && !wide.passed(), "{wide}");
    assert!(wide.pairs().unexplained() > 0 && wide.pairs().both_static > 0, "{wide}");
}

mod stamped {
    use super::{Claim, Ours, Strategy};

    sdop_judge::judge_tests!(Claim::Mesh, |scene: &super::Scene<'_>| Ours::new(
        scene,
        Strategy::SDopBatch
    ));
}
