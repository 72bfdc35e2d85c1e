//! Counts, causes and outcomes on a few cubes, known by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::volume::{Shape, ShapeSpec};

use super::*;

/// Five unit cubes on a line, at these places along x in each frame; the last two are static.
fn cubes(frames: &[[f32; 5]]) -> Case {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let frame = |places: &[f32; 5]| {
        let mut bodies = Bodies::default();
        for (number, &x) in places.iter().enumerate() {
            bodies.push(0, number < 3, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
        }
        let boxes = places.map(|x| [x, 0.0, 0.0, x + 1.0, 1.0, 1.0]).to_vec();
        Frame { bodies, boxes, ..Frame::default() }
    };
    Case {
        name: "own/cubes/0000".to_owned(),
        flag: String::new(),
        source: String::new(),
        claim: Claim::Aabb,
        claims: vec![Claim::Aabb],
        shapes: vec![Shape::build(&mesh, &ShapeSpec::default()).unwrap()],
        frames: frames.iter().map(frame).collect(),
    }
}

fn answers(pairs: &[&[[u32; 2]]]) -> Vec<Answer> {
    let answer = |pairs: &&[[u32; 2]]| Answer { pairs: pairs.to_vec(), ..Answer::default() };
    pairs.iter().map(answer).collect()
}

/// Pairs that are required: 01 and 12 (touching); all but 34 of the first four; none, 01 by
/// 2⁻²⁰.
const PLACES: [[f32; 5]; 3] = [
    [0.0, 0.5, 1.5, 10.0, 20.0],
    [0.0, 0.0, 0.0, 0.0, 20.0],
    [0.0, 1.0 + 1.0 / (1 << 20) as f32, 100.0, 200.0, 300.0],
];

#[test]
fn extra_pairs_count_by_cause() {
    let case = cubes(&PLACES);
    // Extra: 02 by its volume, 34 static, 04 for no reason; then 01 by rounding.
    let first: &[[u32; 2]] = &[[0, 1], [0, 2], [0, 4], [3, 4]];
    let given = answers(&[first, &[[0, 3]], &[[0, 1]]]);
    let judged = judge_answers(&case, &given).unwrap();
    let count = PairCounts {
        judged: 3 * 9,
        required: 2 + 6,
        missed: 1 + 5,
        extra: 4,
        by_rounding: 1,
        by_looseness: 1,
        both_static: 1,
    };
    assert_eq!((judged.count, judged.count.unexplained()), (count, 1));
    let (frame, pair) = (0, [1, 2]);
    assert_eq!(judged.miss, Some(Miss { frame, pair }));
    let why = "misses 6 of 8 pairs, first bodies 1 and 2 in frame 0".to_owned();
    assert_eq!(judged.outcome, Outcome::Fail { why });
    let mut twice = count;
    twice.add(&count);
    assert_eq!([twice.judged, twice.required, twice.missed], [54, 16, 12]);
    let causes = [twice.by_rounding, twice.by_looseness, twice.both_static];
    assert_eq!((twice.extra, causes), (8, [2; 3]));
}

#[test]
fn exact_answers_pass() {
    let case = cubes(&PLACES);
    let all: &[[u32; 2]] = &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let given = answers(&[&[[0, 1], [1, 2]], all, &[]]);
    let judged = judge_answers(&case, &given).unwrap();
    assert_eq!((judged.outcome, judged.miss), (Outcome::Pass, None));
    assert_eq!((judged.count.required, judged.count.extra), (8, 0));
}

/// Answers some frames, and skips the rest.
struct Skips(Vec<Answer>);

impl Subject for Skips {
    fn answer(&self, _: &Case) -> Result<Vec<Answer>, StopReason> {
        let (why, answered) = ("enough".to_owned(), self.0.clone());
        Err(StopReason::Skipped { why, answered })
    }
}

#[test]
fn misses_before_a_skip_count() {
    let case = cubes(&PLACES);
    let judge = |given: &[&[[u32; 2]]]| judge_case(&Skips(answers(given)), &case, false).unwrap();
    for right in [&[][..], &[&[[0, 1], [1, 2]][..]]] {
        let judged = judge(right);
        assert!(matches!(judged.outcome, Outcome::Skipped { why } if why == "enough"));
        assert_eq!(judged.count, PairCounts::default());
    }
    let judged = judge(&[&[[0, 1], [1, 2]], &[]]);
    assert!(matches!(judged.outcome, Outcome::Fail { .. }));
    assert_eq!((judged.count.missed, judged.count.judged), (6, 18));
}
