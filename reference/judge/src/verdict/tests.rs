#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::*;
use crate::answer::AnswerError;

/// A case of a name that ended so, with as many pairs judged, required, missed and extra.
fn case(name: &str, outcome: Outcome, pairs: [u64; 4]) -> CaseVerdict {
    let [judged, required, missed, extra] = pairs;
    CaseVerdict {
        name: name.to_owned(),
        flag: "a bug".to_owned(),
        outcome,
        pairs: PairCounts { judged, required, missed, extra, ..PairCounts::default() },
        miss: None,
        known: false,
    }
}

fn passed(name: &str) -> CaseVerdict {
    case(name, Outcome::Pass, [10, 4, 0, 2])
}

fn failed(name: &str) -> CaseVerdict {
    let why = "misses 3 of 5 pairs".to_owned();
    case(name, Outcome::Fail { why }, [20, 5, 3, 1])
}

fn skipped(name: &str) -> CaseVerdict {
    let why = "no swaps".to_owned();
    case(name, Outcome::Skipped { why }, [0; 4])
}

fn erred(name: &str) -> CaseVerdict {
    let trouble = AnswerError::SelfPair { frame: 0, body: 3 };
    case(name, Outcome::Error { trouble }, [0; 4])
}

fn known(case: CaseVerdict) -> CaseVerdict {
    CaseVerdict { known: true, ..case }
}

fn verdict(cases: Vec<CaseVerdict>) -> Verdict {
    Verdict {
        claim: Claim::Aabb,
        seed: None,
        cases,
        not_run: 0,
        large_not_judged: 0,
        stale: Vec::new(),
        extra_limit: None,
        smallest: None,
    }
}

/// Checks the word, the numbers of judged and requested cases, and the reason.
fn assert_concludes(verdict: &Verdict, word: &str, counts: [usize; 2], why: Option<&str>) {
    assert_eq!(verdict.conclusion().to_string(), word);
    assert_eq!(verdict.passed(), word == "PASS");
    assert_eq!([verdict.judged(), verdict.asked()], counts);
    assert_eq!(verdict.why().as_deref(), why);
    let [judged, asked] = counts;
    let first = format!("claim aabb: {word}, {judged} of {asked} cases judged\n");
    assert!(verdict.to_string().starts_with(&first), "{verdict}");
}

#[test]
fn all_that_passes_is_a_pass() {
    let all = verdict(vec![passed("a/0"), known(failed("a/1")), passed("b/0")]);
    assert_concludes(&all, "PASS", [3, 3], None);
}

#[test]
fn less_than_asked_is_incomplete() {
    let mut some = verdict(vec![passed("a/0"), skipped("a/1"), skipped("b/0")]);
    let why = "1 of 3 cases were judged: 2 skipped, 0 not run";
    assert_concludes(&some, "INCOMPLETE", [1, 3], Some(why));
    some.not_run = 109;
    let why = "1 of 112 cases were judged: 2 skipped, 109 not run";
    assert_concludes(&some, "INCOMPLETE", [1, 112], Some(why));
    let mut late = verdict(vec![passed("a/0")]);
    late.not_run = 1;
    let why = "1 of 2 cases were judged: 0 skipped, 1 not run";
    assert_concludes(&late, "INCOMPLETE", [1, 2], Some(why));
    let known_only = verdict(vec![known(failed("a/0")), skipped("a/1")]);
    let why = "1 of 2 cases were judged: 1 skipped, 0 not run";
    assert_concludes(&known_only, "INCOMPLETE", [1, 2], Some(why));
}

/// Busy is not wrong, and no pass: the reason names the option.
#[test]
fn late_cases_are_incomplete() {
    let late = |name| {
        let trouble = AnswerError::Timeout { frame: 0, seconds: crate::answer::Seconds(1.0) };
        case(name, Outcome::Error { trouble }, [0; 4])
    };
    let some = verdict(vec![passed("a/0"), late("b/0")]);
    let why =
        "1 of 2 cases were judged: 0 skipped, 0 not run, 1 out of time: give a longer --timeout";
    assert_concludes(&some, "INCOMPLETE", [1, 2], Some(why));
    let hanging = verdict(vec![late("b/0")]);
    assert!(hanging.why().unwrap().contains("it hangs, or needs"), "{hanging}");
    let wrong = verdict(vec![failed("a/0"), late("b/0")]);
    assert_eq!(wrong.conclusion(), Conclusion::NotPassed);
}

#[test]
fn what_fails_is_no_pass() {
    let mut some = verdict(vec![skipped("a/0"), failed("a/1"), erred("b/0")]);
    some.not_run = 2;
    let why = "2 of 5 cases failed, first a/1 misses 3 of 5 pairs";
    assert_concludes(&some, "NOT PASSED", [2, 5], Some(why));
    // What a case looks for is no diagnosis.
    let line =
        "\na/1 misses 3 of 5 pairs\n  this case is also meant to catch: a bug\nb/0 frame 0: ";
    assert!(some.to_string().contains(line), "{some}");
    let erring = verdict(vec![passed("a/0"), erred("b/0")]);
    let why = "1 of 2 cases failed, first b/0 frame 0: body 3 is paired with itself";
    assert_concludes(&erring, "NOT PASSED", [2, 2], Some(why));
    let nothing_right = verdict(vec![known(failed("a/0"))]);
    let why = "no case passed: all are known failures";
    assert_concludes(&nothing_right, "NOT PASSED", [1, 1], Some(why));
    let mut stale = verdict(vec![known(passed("a/0"))]);
    stale.stale = vec!["a/0".to_owned()];
    let why = "the known failure a/0 passes: take it off the list";
    assert_concludes(&stale, "NOT PASSED", [1, 1], Some(why));
}

#[test]
fn extra_pairs_have_a_limit() {
    // Four extra of eight required.
    let mut wide = verdict(vec![passed("a/0"), passed("a/1")]);
    wide.extra_limit = Some(0.5);
    assert_concludes(&wide, "PASS", [2, 2], None);
    wide.extra_limit = Some(0.49);
    let why = "more extra pairs than 0.49 for each required one";
    assert_concludes(&wide, "NOT PASSED", [2, 2], Some(why));
}

#[test]
fn groups_add_up() {
    let cases = vec![
        passed("touch/b/0"),
        failed("touch/a/0"),
        passed("touch/b/1"),
        skipped("touch/b/2"),
        erred("touch/a/1"),
        failed("touch/a/2"),
    ];
    let verdict = verdict(cases);
    let groups = verdict.groups();
    let rows: Vec<_> = groups
        .iter()
        .map(|group| {
            let pairs = group.pairs;
            (
                group.name.as_str(),
                [group.passed, group.failed, group.skipped, group.errors],
                [pairs.judged, pairs.required, pairs.missed, pairs.extra],
            )
        })
        .collect();
    let expected =
        [("touch/b", [2, 0, 1, 0], [20, 8, 0, 4]), ("touch/a", [0, 2, 0, 1], [40, 10, 6, 2])];
    assert_eq!(rows, expected);
    assert_eq!(verdict.pairs().missed, 6);
    let text = verdict.to_string();
    for line in [
        "cases: 2 passed, 2 failed, 1 errors, 1 skipped, 0 not run",
        "pairs: 60 judged, 18 required, 6 missed; 6 extra",
        "skipped, for one: touch/b/2 (no swaps)",
    ] {
        assert!(text.contains(line), "{text}");
    }
}
