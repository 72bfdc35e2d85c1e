//! Space that repeats: cullers without periods never get such cases without an error.

use sdop::volume::Shape;
use sdop_judge::catalogue::select;
use sdop_judge::run::examine_given;
use sdop_judge::subject::CullFunction;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{Case, Claim, Conclusion, Frame, Options, Scene, WorldBox, judge};

fn one_case(pattern: &str) -> Case {
    let case = select(Claim::Periodic, pattern, None).unwrap()[0].case();
    case.unwrap()
}

/// Cullers without periods skip the cases.
#[test]
fn periods_are_never_dropped() {
    let plain = judge(|_: &Scene<'_>| crate::judge::cullers::Boxes::default());
    let verdict = plain.claims(Claim::Periodic).cases("periodic/*").run().unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Incomplete);
    assert!(verdict.to_string().contains("its space has no periods"));
}

/// Periods and boxes outside of the contract are refused in files and in cases, and the message
/// says where and how to mend it.
#[test]
fn invalid_periods_are_refused() {
    let with = |change: &dyn Fn(&mut Frame)| {
        let mut case = one_case("periodic/changed/0000");
        change(&mut case.frames[2]);
        let text = Wire::Ndjson.encode(&case).unwrap();
        let read = ndjson::read(text.as_slice(), u64::MAX).err();
        let silent = CullFunction(|_: &[Shape], _: &Frame| Vec::new());
        let options = Options { claim: Claim::Periodic, ..Options::default() };
        let given = examine_given(&silent, &options, case).err();
        [read.unwrap_or_default(), given.map_or_else(String::new, |error| error.to_string())]
    };
    assert_eq!(with(&|_| {}), ["", ""]);
    let half = |ends: &mut WorldBox| ends[3] = ends[0] + 16.0;
    for (change, says, remedy) in [
        (
            (&|frame: &mut Frame| {
                frame.periods = Some([Some(32.0), None, None]);
                half(&mut frame.boxes[3]);
            }) as &dyn Fn(&mut Frame),
            "body 3 measures 16 along x, but less than 16 is allowed",
            "make the body",
        ),
        (
            &|frame| frame.periods = Some([None, Some(-1.0), None]),
            "the period along y is -1",
            "give a length",
        ),
        (
            &|frame| {
                frame.periods = Some([Some(8.0), None, None]);
                (frame.boxes[5][0], frame.boxes[5][3]) = (4e9, 4e9);
            },
            "body 5 is at 4000000000 along x",
            "whole number of periods",
        ),
    ] {
        let [read, given] = with(change);
        assert!(read.contains(&format!("line 4: {says}")), "{read}");
        assert!(given.contains(&format!("changed/0000, frame 2: {says}")), "{given}");
        assert!([&read, &given].iter().all(|text| text.contains(remedy)), "{read}");
    }
    // Each names a missing period as it is written there.
    let [read, given] = with(&|frame| frame.periods = Some([None, Some(0.0), None]));
    assert!(read.contains("or `null` for an axis"), "{read}");
    assert!(given.contains("or `None` for an axis"), "{given}");
}

/// The words of a case have the periods of each frame before it, as the bits of an f64.
#[test]
fn words_have_the_periods_of_each_frame() {
    let case = one_case("periodic/changed/0000");
    let text = String::from_utf8(Wire::Text.encode(&case).unwrap()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let words = lines.windows(2).filter(|two| two[1].starts_with("frame "));
    let words: Vec<Vec<f64>> = words
        .map(|two| {
            let bits = two[0].strip_prefix("periods ").unwrap().split(' ');
            let bits = bits.map(|word| u64::from_str_radix(word, 16).unwrap());
            bits.map(f64::from_bits).collect()
        })
        .collect();
    let periods = case.frames.iter().map(|frame| frame.periods.unwrap());
    let periods = periods.map(|all| all.map(|period| period.unwrap_or(0.0)).to_vec());
    assert_eq!(words, periods.collect::<Vec<_>>());
    assert!(words[0] != words[1] && words[3] == [0.0; 3], "{words:?}");
}
