//! Space that repeats: the groups of the claim `periodic` catch cullers with one flaw each and pass
//! ours, and cullers without periods never get such cases without an error.

use sdop::bodies::Bodies;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::catalogue::select;
use sdop_judge::every_way::subject::EveryWay;
use sdop_judge::ours::configurations::Rotation;
use sdop_judge::run::examine_given;
use sdop_judge::subject::CullFunction;
use sdop_judge::truth::{boxes_meet, images};
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{
    Case, Claim, Conclusion, Contestant, Frame, Options, Scene, Verdict, WorldBox, examine, judge,
};

/// What is wrong with a culler that tests all pairs of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flaw {
    None,
    /// Compares boxes where they are given.
    NoImages,
    /// Knows the period of the first axis alone.
    FirstAxis,
    /// Compares with images one period away, and doesn't wrap positions.
    NextImages,
    /// Wraps positions by a product with the period that f64 rounds.
    RoundedProduct,
    /// Takes boxes that only touch for apart.
    Strict,
    /// Keeps the periods of the first frame.
    FormerPeriods,
    /// Compares two boxes in the image in which they were nearest in the first frame.
    FormerImage,
}

type Periods = [Option<f64>; 3];

struct Twin {
    flaw: Flaw,
    periods: Option<Periods>,
    first: Vec<WorldBox>,
    boxes: Vec<WorldBox>,
    pairs: Vec<[u32; 2]>,
}

fn interval(ends: &WorldBox, axis: usize) -> [f64; 2] {
    [ends[axis], ends[axis + 3]].map(f64::from)
}

/// Whether two intervals share a point when the second is moved.
fn overlap(a: [f64; 2], b: [f64; 2], by: f64, is_strict: bool) -> bool {
    let gaps = [a[0] - (b[1] + by), b[0] + by - a[1]];
    gaps.iter().all(|gap| *gap < 0.0 || *gap == 0.0 && !is_strict)
}

/// Moves an interval into the period about zero.
fn wrapped(ends: [f64; 2], period: f64) -> [f64; 2] {
    let by = (ends[0] / period).round() * period;
    ends.map(|end| end - by)
}

impl Twin {
    /// Whether two boxes meet, by a flawed comparison of single axes.
    fn meet_by_axes(&self, pair: [usize; 2], periods: Periods) -> bool {
        let [i, j] = pair;
        (0..3).all(|axis| {
            let [a, b] = pair.map(|body| interval(&self.boxes[body], axis));
            let is_strict = self.flaw == Flaw::Strict;
            let Some(period) = periods[axis] else {
                return overlap(a, b, 0.0, is_strict);
            };
            let in_any = |a, b| {
                let mut ways = [-period, 0.0, period].into_iter();
                ways.any(|by| overlap(a, b, by, is_strict))
            };
            match self.flaw {
                Flaw::NextImages => in_any(a, b),
                Flaw::FormerImage => {
                    let [a0, b0] = [i, j].map(|body| interval(&self.first[body], axis)[0]);
                    overlap(a, b, ((a0 - b0) / period).round() * period, false)
                }
                _ => in_any(wrapped(a, period), wrapped(b, period)),
            }
        })
    }

    fn reports(&self, pair: [usize; 2]) -> bool {
        let [a, b] = pair.map(|body| &self.boxes[body]);
        let periods = self.periods.unwrap();
        match self.flaw {
            Flaw::NoImages => boxes_meet(a, b),
            Flaw::FirstAxis => !images(a, b, [periods[0], None, None]).is_empty(),
            Flaw::None | Flaw::FormerPeriods => !images(a, b, periods).is_empty(),
            _ => self.meet_by_axes(pair, periods),
        }
    }
}

impl Contestant for Twin {
    fn boxes(&mut self, boxes: &[WorldBox]) {
        self.boxes = boxes.to_vec();
        if self.first.is_empty() {
            self.first.clone_from(&self.boxes);
        }
    }

    fn frame(&mut self, bodies: &Bodies) {
        self.pairs.clear();
        for j in 0..bodies.len() {
            for i in (0..j).filter(|&i| bodies.dynamic[i] || bodies.dynamic[j]) {
                if self.reports([i, j]) {
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

    fn periods(&mut self, periods: Periods) -> bool {
        if self.periods.is_none() || self.flaw != Flaw::FormerPeriods {
            self.periods = Some(periods);
        }
        true
    }
}

fn run(group: &str, flaw: Flaw) -> Verdict {
    let make = move |_: &Scene<'_>| Twin {
        flaw,
        periods: None,
        first: Vec::new(),
        boxes: Vec::new(),
        pairs: Vec::new(),
    };
    let trial = judge(make).claims(Claim::Periodic);
    trial.cases(&format!("{group}/*")).seed(3).run().unwrap()
}

#[test]
fn groups_catch_flaws_of_periods() {
    for (group, flaws) in [
        ("periodic/face", &[Flaw::Strict][..]),
        ("periodic/edge", &[Flaw::Strict, Flaw::FirstAxis]),
        ("periodic/corner", &[Flaw::Strict, Flaw::FirstAxis]),
        ("periodic/far", &[Flaw::NextImages, Flaw::RoundedProduct]),
        ("periodic/rounded", &[Flaw::Strict]),
        ("periodic/changed", &[Flaw::Strict, Flaw::FormerPeriods]),
        ("periodic/crossing", &[Flaw::Strict, Flaw::FormerImage]),
    ] {
        let right = run(group, Flaw::None);
        assert_eq!(right.conclusion(), Conclusion::Pass, "{group}: {right}");
        assert_eq!(right.pairs().extra, 0, "{group}: {right}");
        for &flaw in [Flaw::NoImages].iter().chain(flaws) {
            let wrong = run(group, flaw);
            let word = wrong.conclusion();
            assert_eq!(word, Conclusion::NotPassed, "{group}, {flaw:?}: {wrong}");
            let smallest = wrong.smallest.unwrap();
            let frames = &smallest.case.frames;
            assert!(frames.iter().all(|frame| frame.bodies.len() == 2));
            assert!(smallest.witness.is_some(), "{group}, {flaw:?}");
            // A former frame is a part of what goes wrong.
            let former = [Flaw::FormerPeriods, Flaw::FormerImage].contains(&flaw);
            assert_eq!(frames.len() > 1, former, "{group}, {flaw:?}");
        }
    }
}

/// A smallest case says in which image the boxes meet, and has no period that doesn't matter.
#[test]
fn smallest_cases_name_the_image() {
    let smallest = run("periodic/face", Flaw::NoImages).smallest.unwrap();
    let periods = smallest.case.frames[0].periods.unwrap();
    assert_eq!(periods.iter().flatten().count(), 1, "{periods:?}");
    let text = smallest.to_string();
    assert!(text.contains("meets it when moved by ("), "{text}");
}

/// Each finder, tier and number of threads reports exactly the pairs that meet.
#[test]
fn our_periodic_boxes_pass() {
    let tiers = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
    let options = Options { claim: Claim::Periodic, seed: Some(5), ..Options::default() };
    let ours = EveryWay::new(Rotation::new(&tiers));
    let verdict = examine(&ours, &options, |_, _| {}).unwrap();
    assert_eq!(verdict.conclusion(), Conclusion::Pass, "{verdict}");
    assert!(verdict.pairs().required > 500, "{verdict}");
    assert_eq!(verdict.pairs().extra, 0, "{verdict}");
}

fn one_case(pattern: &str) -> Case {
    let case = select(Claim::Periodic, pattern, None).unwrap()[0].case();
    case.unwrap()
}

/// Cullers without periods skip the cases.
#[test]
fn periods_are_never_dropped() {
    let plain = judge(|_: &Scene<'_>| crate::judge::cullers::Boxes::default());
    let verdict = plain.claims(Claim::Periodic).run().unwrap();
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
