//! Bodies of several parts: the groups of the claim `parts` catch cullers with one flaw each and
//! pass ours, and cullers of single shapes never get parts without an error.

use sdop::bodies::Bodies;
use sdop::rounding::pose::rotation;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::catalogue::select;
use sdop_judge::every_way::subject::EveryWay;
use sdop_judge::ours::configurations::Rotation;
use sdop_judge::run::examine_given;
use sdop_judge::subject::CullFunction;
use sdop_judge::truth::Truth;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{
    BodyPart, Case, Claim, Conclusion, Contestant, Frame, JudgeError, Options, Scene, Verdict,
    examine, judge, judge_function,
};

/// What is wrong with a culler that tests all pairs of parts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flaw {
    None,
    /// Leaves out the rotation of a part in its body.
    OwnRotation,
    /// Tests the first part of a body alone.
    FirstPart,
    /// Adds the offset of a part without turning it with the body.
    UnturnedOffset,
    /// Forgets the offsets of parts once the pose of their body has changed.
    LostOffset,
    /// Moves parts with their body, but keeps the rotation that the body had at first.
    FirstRotation,
    /// Keeps the parts that a body had at first.
    FirstParts,
    /// Keeps the poses that bodies had at first.
    FirstPoses,
}

/// A box on the axes of the world: its centre and how far it reaches.
type PartBox = [[f64; 3]; 2];

struct Twin {
    flaw: Flaw,
    /// Half sides of each shape.
    halves: Vec<[f64; 3]>,
    parts: Vec<Vec<BodyPart>>,
    first: Option<Bodies>,
    pairs: Vec<[u32; 2]>,
}

fn half(shape: &Shape) -> [f64; 3] {
    let vertices = shape.vertices.iter();
    vertices.fold([0.0; 3], |most: [f64; 3], vertex| {
        [0, 1, 2].map(|axis| most[axis].max(f64::from(vertex[axis].abs())))
    })
}

/// The matrix of a rotation by multiples of a quarter turn.
fn quarter_turns(q: [f32; 4]) -> [[f64; 3]; 3] {
    rotation(q).map(|row| row.map(f64::round))
}

fn turned(turn: [[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    turn.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}

fn meet(a: &PartBox, b: &PartBox) -> bool {
    (0..3).all(|axis| (a[0][axis] - b[0][axis]).abs() <= a[1][axis] + b[1][axis])
}

impl Twin {
    fn part_boxes(&self, bodies: &Bodies, i: usize) -> Vec<PartBox> {
        let first = self.first.as_ref().unwrap();
        let has_moved = (bodies.rotation[i], bodies.translation[i])
            != (first.rotation[i], first.translation[i]);
        let (q, t) = match self.flaw {
            Flaw::FirstRotation => (first.rotation[i], bodies.translation[i]),
            Flaw::FirstPoses => (first.rotation[i], first.translation[i]),
            _ => (bodies.rotation[i], bodies.translation[i]),
        };
        let turn = quarter_turns(q);
        let alone = BodyPart { shape: bodies.shape[i], pose: [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0] };
        let mut parts = self.parts[i].clone();
        if parts.is_empty() {
            parts.push(alone);
        }
        if self.flaw == Flaw::FirstPart {
            parts.truncate(1);
        }
        let boxed = |part: &BodyPart| {
            let (own, offset) = part.rotation_and_translation();
            let offset = match self.flaw {
                Flaw::UnturnedOffset => offset,
                Flaw::LostOffset if has_moved => [0.0; 3],
                _ => turned(turn, offset),
            };
            let half = self.halves[part.shape as usize];
            let reach = match self.flaw {
                Flaw::OwnRotation => half,
                _ => turned(quarter_turns(own), half),
            };
            // Signs don't matter: a quarter turn permutes half sides.
            let reach = turned(turn, reach).map(f64::abs);
            [[0, 1, 2].map(|axis| f64::from(t[axis]) + offset[axis]), reach]
        };
        parts.iter().map(boxed).collect()
    }
}

impl Contestant for Twin {
    fn frame(&mut self, bodies: &Bodies) {
        self.first.get_or_insert_with(|| bodies.clone());
        let count = bodies.len();
        let boxes: Vec<Vec<PartBox>> = (0..count).map(|i| self.part_boxes(bodies, i)).collect();
        self.pairs.clear();
        for j in 0..count {
            for i in (0..j).filter(|&i| bodies.dynamic[i] || bodies.dynamic[j]) {
                if boxes[i].iter().any(|a| boxes[j].iter().any(|b| meet(a, b))) {
                    self.pairs.push([i as u32, j as u32]);
                }
            }
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }

    fn change(&mut self, _: &Bodies, _: &[Option<u32>]) -> bool {
        true
    }

    fn body_parts(&mut self, parts: &[Vec<BodyPart>]) -> bool {
        if self.parts.is_empty() || self.flaw != Flaw::FirstParts {
            self.parts = parts.to_vec();
        }
        true
    }
}

fn run(group: &str, flaw: Flaw) -> Verdict {
    let make = move |scene: &Scene<'_>| Twin {
        flaw,
        halves: scene.shapes.iter().map(half).collect(),
        parts: Vec::new(),
        first: None,
        pairs: Vec::new(),
    };
    let trial = judge(make).claims(Claim::Parts).cases(&format!("{group}/*"));
    trial.seed(3).run().unwrap()
}

#[test]
fn groups_catch_flaws_of_parts() {
    let always = [Flaw::OwnRotation, Flaw::FirstPart, Flaw::UnturnedOffset];
    for (group, flaws) in [
        ("parts/touch", &[][..]),
        ("parts/move", &[Flaw::LostOffset, Flaw::FirstRotation, Flaw::FirstPoses]),
        ("parts/reframe", &[Flaw::LostOffset, Flaw::FirstParts, Flaw::FirstPoses]),
    ] {
        let right = run(group, Flaw::None);
        assert_eq!(right.conclusion(), Conclusion::Pass, "{group}: {right}");
        assert_eq!(right.pairs().extra, 0, "{group}: {right}");
        for flaw in always.iter().chain(flaws) {
            let wrong = run(group, *flaw);
            let word = wrong.conclusion();
            assert_eq!(word, Conclusion::NotPassed, "{group}, {flaw:?}: {wrong}");
            let smallest = wrong.smallest.unwrap();
            let Some(parts) = &smallest.case.frames[0].parts else {
                panic!("{group}, {flaw:?}: no parts")
            };
            assert!(smallest.witness.is_some(), "{group}, {flaw:?}");
            assert_eq!(parts.len(), 2, "{group}, {flaw:?}");
        }
    }
}

/// Every way to cull, with each tier and several threads.
#[test]
fn our_compounds_pass() {
    let tiers = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
    let options = Options { claim: Claim::Parts, seed: Some(5), ..Options::default() };
    let ours = EveryWay::new(Rotation::new(&tiers));
    let verdict = examine(&ours, &options, |_, _| {}).unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Pass, "{verdict}");
    assert!(verdict.pairs().required > 300, "{verdict}");
    assert!(verdict.pairs().extra < verdict.pairs().required / 2, "{verdict}");
}

fn one_case(pattern: &str) -> Case {
    select(Claim::Parts, pattern, None).unwrap()[0].case().unwrap()
}

/// Other claims refuse parts, and cullers of single shapes skip the cases.
#[test]
fn parts_are_never_dropped() {
    let case = one_case("parts/touch/0000");
    let silent = CullFunction(|_: &[Shape], _: &Frame| Vec::new());
    for &claim in Claim::ALL.iter().filter(|claim| **claim != Claim::Parts) {
        let options = Options { claim, ..Options::default() };
        let error = examine_given(&silent, &options, case.clone()).unwrap_err();
        assert!(matches!(error, JudgeError::Parts { .. }), "{claim}: {error}");
    }
    let single = judge(|_: &Scene<'_>| crate::judge::cullers::Boxes::default());
    let verdict = single.claims(Claim::Parts).run().unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Incomplete);
    assert!(verdict.to_string().contains("its bodies are single shapes"));
    // Who culls frames alone sees the parts.
    let all = judge_function(|_, frame: &Frame| {
        let n = frame.parts.as_ref().unwrap().len() as u32;
        (0..n).flat_map(|j| (0..j).map(move |i| [i, j])).collect()
    });
    assert!(all.claims(Claim::Parts).run().unwrap().passed());
}

/// Invalid parts in a file are refused, and the message names them.
#[test]
fn invalid_parts_are_refused() {
    let text = String::from_utf8(Wire::Ndjson.encode(&one_case("parts/touch/0000")).unwrap());
    let text = text.unwrap();
    let read = |text: &str| ndjson::read(text.as_bytes(), u64::MAX);
    assert_eq!(read(&text).unwrap_or_else(|e| panic!("{e}")).case.claim, Claim::Parts);
    let body = r#"{"static":false,"parts":[{"shape":"#;
    assert!(text.contains(body), "{text}");
    for (found, put, says) in [
        (body, r#"{"static":false,"shape":0,"parts":[{"shape":"#, "either `shape` or `parts`"),
        (body, r#"{"static":false},{"static":false,"parts":[{"shape":"#, "poses for"),
        (body, r#"{"static":false,"parts":[{"shape":7"#, "of 2"),
    ] {
        let error = read(&text.replacen(found, put, 1)).err().unwrap_or_default();
        assert!(error.contains(says), "{says}: {error}");
    }
    let with_pose = |pose: [f32; 7]| {
        let mut case = one_case("parts/touch/0000");
        case.frames[0].parts.as_mut().unwrap()[0] = vec![BodyPart { shape: 0, pose }];
        case.frames[0].bodies.rotation[0] = [0.0, 0.0, 1.0, 2.0];
        let text = Wire::Ndjson.encode(&case).unwrap();
        read(&String::from_utf8(text).unwrap()).err().unwrap_or_default()
    };
    let identity = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    assert_eq!(with_pose(identity), "");
    assert!(with_pose([0.0; 7]).contains("body 0, part 0: "), "{}", with_pose([0.0; 7]));
    // A fifth of one step is in no f64.
    let mut inexact = identity;
    inexact[4] = 1.0;
    assert!(with_pose(inexact).contains("exact pose of a part"), "{}", with_pose(inexact));
}

/// The words of a case have all parts, each under its body.
#[test]
fn words_have_all_parts() {
    for name in ["parts/touch/0001", "parts/reframe/0000"] {
        let case = one_case(name);
        let text = String::from_utf8(Wire::Text.encode(&case).unwrap()).unwrap();
        let (mut under, mut seen, mut bodies) = (0, 0, 0);
        for line in text.lines().skip_while(|line| !line.starts_with("bodies")) {
            let words: Vec<&str> = line.split(' ').collect();
            match words[0] {
                "part" => (under, seen) = (under - 1, seen + 1),
                "bodies" | "change" | "frame" | "p" => assert_eq!(under, 0, "{line}"),
                shape => {
                    assert_eq!(under, 0, "{line}");
                    under = words.last().unwrap().parse::<i32>().unwrap();
                    assert_eq!(shape == "-1", under > 0, "{line}");
                    bodies += 1;
                }
            }
        }
        let sets = case.frames.iter().filter(|frame| frame.was.is_some());
        let sets: Vec<&Frame> = case.frames.iter().take(1).chain(sets).collect();
        let parts = sets.iter().flat_map(|frame| frame.parts.iter().flatten());
        assert_eq!((seen, bodies), (parts.flatten().count(), 24 * sets.len()));
    }
}

/// Parts that share one face meet, an ulp apart they don't. A part counts wherever it is, and parts
/// of one body are no pair.
#[test]
fn truth_is_exact_for_composed_poses() {
    let case = one_case("parts/touch/0000");
    let cube = &case.shapes[1];
    let size = half(cube)[0] as f32;
    let far = 16_384.0;
    let frame = |x: f32| {
        let mut bodies = Bodies::default();
        // A quarter turn about z takes the offset (0, −far) to (far, 0).
        bodies.push(0, true, [0.0, 0.0, 1.0, 1.0], [0.0; 3]);
        bodies.push(1, true, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
        let part = |y: f32| BodyPart { shape: 1, pose: [1.0, 0.0, 0.0, 1.0, 0.0, y, 0.0] };
        let parts = vec![vec![part(0.0), part(0.0), part(-far)], Vec::new()];
        Frame::of_parts(bodies, parts, &case.shapes).unwrap()
    };
    let truth = Truth::new(Claim::Parts, &case.shapes).unwrap();
    let touching = far + 2.0 * size;
    assert_eq!(truth.pairs(&frame(touching)), Ok(vec![[0, 1]]));
    assert_eq!(truth.pairs(&frame(touching.next_up())), Ok(vec![]));
    let point = truth.common_point(&frame(touching), [0, 1]).unwrap();
    assert_eq!(point.decimals()[0], f64::from(far + size));
}
