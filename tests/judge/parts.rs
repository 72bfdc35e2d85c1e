//! Bodies of several parts: cullers of single shapes never get parts without an error, and truth is
//! exact.

use sdop::bodies::Bodies;
use sdop::volume::Shape;
use sdop_judge::catalogue::select;
use sdop_judge::run::examine_given;
use sdop_judge::subject::CullFunction;
use sdop_judge::truth::Truth;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{
    BodyPart, Case, Claim, Conclusion, Frame, JudgeError, Options, Scene, judge, judge_function,
};

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
    let verdict = single.claims(Claim::Parts).cases("parts/*").run().unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Incomplete);
    assert!(verdict.to_string().contains("its bodies are single shapes"));
    // Who culls frames alone sees the parts.
    let all = judge_function(|_, frame: &Frame| {
        let n = frame.parts.as_ref().unwrap().len() as u32;
        (0..n).flat_map(|j| (0..j).map(move |i| [i, j])).collect()
    });
    assert!(all.claims(Claim::Parts).cases("parts/*").run().unwrap().passed());
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
    let size = cube.vertices.iter().flatten().fold(0.0, |most: f32, x| most.max(x.abs()));
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
