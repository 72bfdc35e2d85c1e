//! Programs that know the exact answers to another frame or another case: none of them passes.

use std::collections::HashMap;
use std::sync::Mutex;

use sdop_judge::answer::{Answer, StopReason};
use sdop_judge::truth::Truth;
use sdop_judge::{Case, Claim, Conclusion, Frame, Options, Subject, Verdict, examine};

/// Pairs by frame.
type Lists = Vec<Vec<[u32; 2]>>;

/// What is answered in place of the frame that is asked about.
#[derive(Clone, Copy, Debug)]
enum Cheat {
    /// Nothing else: the right answer.
    None,
    /// The last frame of the case.
    LastFrame,
    /// The first frame.
    FirstFrame,
    /// The frame before.
    FrameBefore,
    /// This frame, with the shapes of the bodies that the first one had.
    FirstBodies,
    /// Only what was so in the frame before, too.
    BothFrames,
}

const CHEATS: [Cheat; 5] = [
    Cheat::LastFrame,
    Cheat::FirstFrame,
    Cheat::FrameBefore,
    Cheat::FirstBodies,
    Cheat::BothFrames,
];

fn exact(case: &Case) -> Lists {
    let truth = Truth::new(case.claim, &case.shapes).unwrap();
    let pairs = |frame: &Frame| truth.pairs(frame).unwrap();
    case.frames.iter().map(pairs).collect()
}

/// The case as it is to somebody who does not notice that its bodies change.
fn with_first_bodies(case: &Case) -> Case {
    let mut case = case.clone();
    let first = case.frames[0].bodies.clone();
    for frame in &mut case.frames {
        let known = first.len().min(frame.bodies.len());
        frame.bodies.shape[..known].copy_from_slice(&first.shape[..known]);
        frame.bodies.dynamic[..known].copy_from_slice(&first.dynamic[..known]);
        // Who takes the boxes by former numbers has those of other bodies.
        frame.boxes[..known].rotate_right(usize::from(frame.was.is_some()));
    }
    case
}

impl Subject for Cheat {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let right = exact(case);
        let Some(last) = right.len().checked_sub(1) else {
            return Ok(Vec::new()); // so small are the scenes that shrinking tries
        };
        let lists: Lists = match self {
            Self::None => right,
            Self::LastFrame => vec![right[last].clone(); right.len()],
            Self::FirstFrame => vec![right[0].clone(); right.len()],
            Self::FrameBefore => {
                (0..=last).map(|n: usize| right[n.saturating_sub(1)].clone()).collect()
            }
            Self::FirstBodies => exact(&with_first_bodies(case)),
            Self::BothFrames => (0..=last)
                .map(|n| {
                    let before = &right[n.saturating_sub(1)];
                    let stays = |pair: &&[u32; 2]| before.contains(pair);
                    right[n].iter().filter(stays).copied().collect()
                })
                .collect(),
        };
        Ok(answers(case, lists))
    }
}

/// Leaves out pairs of bodies that the frame does not have: they would be noticed at once.
fn answers(case: &Case, lists: Lists) -> Vec<Answer> {
    let frames = case.frames.iter().zip(lists);
    frames
        .map(|(frame, mut pairs)| {
            pairs.retain(|pair| (pair[1] as usize) < frame.bodies.len());
            Answer { pairs, ns: None }
        })
        .collect()
}

/// Answers each group's cases with the answers to the first of them that it meets.
#[derive(Default)]
struct OtherCase(Mutex<HashMap<String, Lists>>);

impl Subject for OtherCase {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let mut seen = self.0.lock().unwrap();
        let known = seen.entry(case.group().to_owned());
        let mut lists = known.or_insert_with(|| exact(case)).clone();
        lists.resize(case.frames.len(), Vec::new());
        Ok(answers(case, lists))
    }
}

fn run(subject: &dyn Subject, claim: Claim, pattern: &str) -> Verdict {
    let options = Options { claim, pattern: pattern.to_owned(), ..Options::default() };
    examine(subject, &options, |_, _| {}).unwrap()
}

/// Groups of which no case fails.
fn unnoticed(verdict: &Verdict) -> Vec<String> {
    let groups = verdict.groups().into_iter();
    let passing = groups.filter(|group| group.failed + group.errors == 0);
    passing.map(|group| group.name).collect()
}

/// Groups whose frames all have the same answer: a ball stays the same however its body turns.
fn unchanged(claim: Claim) -> &'static [&'static str] {
    match claim {
        Claim::Sphere => &["churn/turn"],
        _ => &[],
    }
}

#[test]
fn answers_to_other_frames_fail() {
    for claim in [Claim::Aabb, Claim::Sphere, Claim::Mesh] {
        let right = run(&Cheat::None, claim, "churn/*");
        assert_eq!(right.conclusion(), Conclusion::Pass, "{right}");
        for cheat in CHEATS {
            let verdict = run(&cheat, claim, "churn/*");
            assert_eq!(verdict.conclusion(), Conclusion::NotPassed, "{cheat:?}");
            let unnoticed = unnoticed(&verdict);
            // Only one group has bodies that come and go.
            let wanted: &[&str] = match cheat {
                Cheat::FirstBodies => &["churn/swap", "churn/teleport", "churn/move", "churn/turn"],
                _ => unchanged(claim),
            };
            assert_eq!(unnoticed, wanted, "{cheat:?}, {claim}: {verdict}");
        }
    }
}

#[test]
fn answers_to_other_cases_fail() {
    for claim in [Claim::Aabb, Claim::Sphere] {
        for group in ["churn/*", "random/*"] {
            let verdict = run(&OtherCase::default(), claim, group);
            assert_eq!(verdict.conclusion(), Conclusion::NotPassed, "{verdict}");
            let wanted: &[&str] = match group {
                "churn/*" => unchanged(claim),
                _ => &[],
            };
            assert_eq!(unnoticed(&verdict), wanted, "{claim}: {verdict}");
        }
    }
}
