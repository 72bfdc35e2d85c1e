//! The table of flaws and claims: a culler with any of these flaws passes no claim that the flaw
//! breaks. A second table has the groups of cases with the flaws that each of them finds alone.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sdop_judge::case::matches;
use sdop_judge::catalogue::{CaseId, select};
use sdop_judge::score::KnownCase;
use sdop_judge::shrink::SmallestCase;
use sdop_judge::{Claim, Options, Outcome, WorldBox, examine};

use crate::judge::flawed::{Flaw, Flawed, Input, Knowing, Renewal, Volume};

const BOXES: &[Claim] =
    &[Claim::Aabb, Claim::Filter, Claim::Order, Claim::Restore, Claim::Margin, Claim::Periodic];
const MESHES: &[Claim] = &[Claim::Hull, Claim::Mesh, Claim::Parts];

/// Flaws, the claims that they break, and the cases that may show it.
const CELLS: &[(Flaw, &[Claim], &str)] = &[
    (Flaw::FrameBefore, Claim::ALL, "*"),
    (Flaw::FirstFrame, Claim::ALL, "*"),
    (Flaw::LastFrame, Claim::ALL, "*"),
    (Flaw::BothFrames, Claim::ALL, "*"),
    (Flaw::EmptyAfter(5), Claim::ALL, "*"),
    (Flaw::EmptyAfter(40), Claim::ALL, "l*"),
    (Flaw::EmptyAfter(256), Claim::ALL, "large/*"),
    (Flaw::LateNew, Claim::ALL, "*"),
    (Flaw::OneAsleep, Claim::ALL, "*"),
    (Flaw::LostOnWaking, Claim::ALL, "*"),
    (Flaw::Bits16, Claim::ALL, "large/bodies/0001"),
    (Flaw::Once(Input::Poses), Claim::ALL, "*"),
    (Flaw::SameBodies, Claim::ALL, "*"),
    (Flaw::SamePose, Claim::ALL, "*"),
    (Flaw::SameNumber, Claim::ALL, "*"),
    (Flaw::Static, Claim::ALL, "*"),
    (Flaw::FirstMove, Claim::ALL, "*"),
    (Flaw::Strict, Claim::ALL, "*"),
    (Flaw::ByGroup, Claim::ALL, "*"),
    (Flaw::ByFirstPose, Claim::ALL, "*"),
    (Flaw::ByCount, Claim::ALL, "*"),
    (Flaw::List(Renewal::Skin), BOXES, "list/*"),
    (Flaw::List(Renewal::Eighth), BOXES, "list/*"),
    (Flaw::Points, BOXES, "*"),
    (Flaw::HalfOpen, BOXES, "*"),
    (Flaw::Room(1 << 18), &[Claim::Aabb, Claim::Sphere], "crowd/*"),
    (Flaw::Naive(Volume::Ball), BOXES, "*"),
    (Flaw::Naive(Volume::Box), BOXES, "*"),
    (Flaw::Naive(Volume::Ball), &[Claim::Sphere], "*"),
    (Flaw::Naive(Volume::OrDop), &[Claim::OrDop], "*"),
    (Flaw::Naive(Volume::Ball), MESHES, "oblique/*"),
    (Flaw::Naive(Volume::Box), MESHES, "*"),
    (Flaw::Naive(Volume::OrDop), MESHES, "*"),
    (Flaw::Naive(Volume::Hull), MESHES, "oblique/*"),
    (Flaw::Naive(Volume::Mesh), &[Claim::Mesh, Claim::Parts], "oblique/*"),
    (Flaw::Once(Input::Filter), &[Claim::Filter], "*"),
    (Flaw::OneMask, &[Claim::Filter], "*"),
    (Flaw::EightGroups, &[Claim::Filter], "*"),
    (Flaw::NothingExcluded, &[Claim::Filter], "*"),
    (Flaw::Grown, &[Claim::Order], "*"),
    (Flaw::GrownNeighbours, &[Claim::Order], "*"),
    (Flaw::Unsaved, &[Claim::Restore], "*"),
    (Flaw::Once(Input::Margins), &[Claim::Margin], "*"),
    (Flaw::NoMargin, &[Claim::Margin], "*"),
    (Flaw::LargerMargin, &[Claim::Margin], "*"),
    (Flaw::RoundedMargins, &[Claim::Margin], "*"),
    (Flaw::Once(Input::Parts), &[Claim::Parts], "*"),
    (Flaw::OwnRotation, &[Claim::Parts], "*"),
    (Flaw::FirstPart, &[Claim::Parts], "*"),
    (Flaw::UnturnedOffset, &[Claim::Parts], "*"),
    (Flaw::LostOffset, &[Claim::Parts], "*"),
    (Flaw::FirstRotation, &[Claim::Parts], "*"),
    (Flaw::Once(Input::Periods), &[Claim::Periodic], "*"),
    (Flaw::NoImages, &[Claim::Periodic], "*"),
    (Flaw::FirstAxis, &[Claim::Periodic], "*"),
    (Flaw::NextImages, &[Claim::Periodic], "*"),
    (Flaw::RoundedProduct, &[Claim::Periodic], "*"),
    (Flaw::FormerImage, &[Claim::Periodic], "*"),
];

/// Groups, and the flaws that each of them finds by its published cases and those of a seed.
const GROUPS: &[(Claim, &str, &[Flaw])] = &[
    (Claim::Aabb, "crowd/new-pairs", &[Flaw::Room(1 << 18)]),
    (Claim::Aabb, "crowd/partners", &[Flaw::Room(4096)]),
    (Claim::Aabb, "stale/reshape", &[Flaw::SamePose, Flaw::SameNumber]),
    (Claim::Aabb, "stale/reorder", &[Flaw::SameNumber]),
    (Claim::Aabb, "stale/rebase", &[Flaw::Static, Flaw::SameNumber]),
    (Claim::Aabb, "stale/all-at-once", &[Flaw::LateNew, Flaw::SamePose, Flaw::SameNumber]),
    (Claim::Aabb, "stale/sleep", &[Flaw::OneAsleep, Flaw::LostOnWaking, Flaw::FirstMove]),
    (Claim::Filter, "filter/groups", &[Flaw::OneMask, Flaw::EightGroups]),
    (Claim::Filter, "filter/excluded", &[Flaw::NothingExcluded]),
    (Claim::Filter, "filter/at-rest", &[Flaw::Once(Input::Filter)]),
    (Claim::Filter, "long/filters", &[Flaw::Once(Input::Filter), Flaw::EmptyAfter(40)]),
    (Claim::Order, "order/insertion", &[Flaw::Grown]),
    (Claim::Restore, "restore/replay", &[Flaw::Unsaved]),
    (Claim::Restore, "long/states", &[Flaw::Unsaved, Flaw::EmptyAfter(40)]),
    (Claim::Margin, "margin/global", &[Flaw::NoMargin, Flaw::LargerMargin]),
    (Claim::Margin, "margin/by-body", &[Flaw::NoMargin, Flaw::LargerMargin, Flaw::RoundedMargins]),
    (Claim::Margin, "long/margins", &[Flaw::Once(Input::Margins), Flaw::LargerMargin]),
    (Claim::Parts, "parts/touch", PARTS),
    (Claim::Parts, "parts/move", PARTS),
    (
        Claim::Parts,
        "parts/move",
        &[Flaw::LostOffset, Flaw::FirstRotation, Flaw::Once(Input::Poses)],
    ),
    (Claim::Parts, "parts/reframe", PARTS),
    (
        Claim::Parts,
        "parts/reframe",
        &[Flaw::LostOffset, Flaw::Once(Input::Parts), Flaw::Once(Input::Poses)],
    ),
    (Claim::Parts, "long/parts", &[Flaw::Once(Input::Parts), Flaw::FirstRotation]),
    (Claim::Periodic, "periodic/face", &[Flaw::NoImages, Flaw::Strict]),
    (Claim::Periodic, "periodic/edge", &[Flaw::NoImages, Flaw::Strict, Flaw::FirstAxis]),
    (Claim::Periodic, "periodic/corner", &[Flaw::NoImages, Flaw::Strict, Flaw::FirstAxis]),
    (Claim::Periodic, "periodic/far", &[Flaw::NoImages, Flaw::NextImages, Flaw::RoundedProduct]),
    (Claim::Periodic, "periodic/rounded", &[Flaw::NoImages, Flaw::Strict]),
    (
        Claim::Periodic,
        "periodic/changed",
        &[Flaw::NoImages, Flaw::Strict, Flaw::Once(Input::Periods)],
    ),
    (Claim::Periodic, "periodic/crossing", &[Flaw::NoImages, Flaw::Strict, Flaw::FormerImage]),
    (Claim::Periodic, "long/periods", &[Flaw::NoImages, Flaw::Once(Input::Periods)]),
    (Claim::Aabb, "list/both", &[Flaw::List(Renewal::Skin), Flaw::List(Renewal::FrameToFrame)]),
    (Claim::Aabb, "list/one", &[Flaw::List(Renewal::Eighth), Flaw::List(Renewal::FrameToFrame)]),
    (Claim::Aabb, "list/return", &[Flaw::List(Renewal::FrameToFrame), Flaw::List(Renewal::Eighth)]),
    (Claim::Aabb, "churn/swap", STALE),
    (Claim::Sphere, "churn/swap", STALE),
    (Claim::Mesh, "churn/swap", STALE),
    (Claim::Aabb, "churn/teleport", STALE),
    (Claim::Mesh, "churn/move", STALE),
    (Claim::Mesh, "churn/turn", STALE),
    (Claim::Mesh, "churn/insert-remove", STALE),
    (Claim::Mesh, "churn/insert-remove", &[Flaw::SameBodies]),
];

const PARTS: &[Flaw] = &[Flaw::OwnRotation, Flaw::FirstPart, Flaw::UnturnedOffset];
const STALE: &[Flaw] = &[
    Flaw::FrameBefore,
    Flaw::FirstFrame,
    Flaw::LastFrame,
    Flaw::BothFrames,
    Flaw::ByGroup,
    Flaw::EmptyAfter(3),
];

/// The cases that may show a flaw. Parts take long to judge, so that only some groups of them run.
fn cases(flaw: Flaw, claim: Claim, pattern: &str) -> &str {
    match flaw {
        _ if claim != Claim::Parts || pattern != "*" => pattern,
        Flaw::Naive(_) | Flaw::Strict | Flaw::ByGroup => pattern,
        Flaw::LateNew | Flaw::SameBodies => "long/sets/*",
        Flaw::SamePose
        | Flaw::ByFirstPose
        | Flaw::Static
        | Flaw::FirstMove
        | Flaw::LostOnWaking
        | Flaw::EmptyAfter(_) => "long/*",
        _ => "parts/*",
    }
}

/// A flaw, the cases that may show it, and whether one has.
type Cell = (Flawed, String, AtomicBool);

fn cell(flaw: Flaw, pattern: &str) -> Cell {
    (Flawed::new(flaw), pattern.to_owned(), AtomicBool::new(false))
}

/// Judges by a case each flaw that has not shown yet. Truth is found once for all of them.
fn judge(cells: &[Cell], id: &CaseId) {
    let is_asked = |(_, pattern, is_found): &&Cell| {
        !is_found.load(Ordering::Relaxed) && matches(pattern, &id.name())
    };
    if !cells.iter().any(|cell| is_asked(&cell)) {
        return;
    }
    let case = id.case().unwrap();
    let known = KnownCase::new(&case);
    let right = known.required().unwrap().to_vec();
    for (flawed, _, is_found) in cells.iter().filter(is_asked) {
        let score = known.judge(&Knowing(flawed, &case, &right), id.number == 0).unwrap();
        is_found.fetch_or(score.outcome != Outcome::Pass, Ordering::Relaxed);
        assert!(flawed.flaw != Flaw::None || score.count.extra == 0, "{}", case.name);
    }
}

/// Judges by all of these cases, and returns the flaws that none of them shows.
fn unseen(cells: &[Cell], ids: &[CaseId]) -> Vec<Flaw> {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, NonZero::get) {
            scope.spawn(|| {
                while let Some(id) = ids.get(next.fetch_add(1, Ordering::Relaxed)) {
                    judge(cells, id);
                }
            });
        }
    });
    let waiting = cells.iter().filter(|(.., is_found)| !is_found.load(Ordering::Relaxed));
    waiting.map(|(flawed, ..)| flawed.flaw).collect()
}

#[test]
fn no_flaw_passes_a_claim() {
    for &claim in Claim::ALL {
        let of_claim = CELLS.iter().filter(|(_, claims, _)| claims.contains(&claim));
        let cells: Vec<Cell> =
            of_claim.map(|(flaw, _, pattern)| cell(*flaw, cases(*flaw, claim, pattern))).collect();
        let passed = unseen(&cells, &select(claim, "*", None).unwrap());
        assert!(passed.is_empty(), "{claim}: {passed:#?}");
    }
}

/// Each group finds its flaws, and passes the right culler without an extra pair.
#[test]
fn groups_find_their_flaws() {
    for (claim, group, flaws) in GROUPS {
        let pattern = format!("{group}/*");
        let in_time: &[Flaw] =
            if group.starts_with("list/") { &[Flaw::List(Renewal::HalfSkin)] } else { &[] };
        let right = [&[Flaw::None], in_time].concat();
        let cells: Vec<Cell> =
            right.iter().chain(*flaws).map(|&flaw| cell(flaw, &pattern)).collect();
        let seeds = [None, Some(3)].map(|seed| select(*claim, &pattern, seed).unwrap());
        assert_eq!(unseen(&cells, &seeds.concat()), right, "{claim} by {group}");
    }
}

fn reduced(flaw: Flaw, claim: Claim, pattern: &str) -> SmallestCase {
    let pattern = pattern.to_owned();
    let options = Options { claim, pattern, seed: Some(3), fail_fast: true, ..Options::default() };
    examine(&Flawed::new(flaw), &options, |_, _| {}).unwrap().smallest.unwrap()
}

/// The smallest case has the two bodies of the miss, a point that they share, and a former frame
/// only if that is a part of what goes wrong.
#[test]
fn smallest_cases_keep_what_matters() {
    for (claim, group, flaw, has_former) in [
        (Claim::Parts, "parts/touch", Flaw::OwnRotation, false),
        (Claim::Parts, "parts/reframe", Flaw::Once(Input::Parts), true),
        (Claim::Periodic, "periodic/edge", Flaw::FirstAxis, false),
        (Claim::Periodic, "periodic/changed", Flaw::Once(Input::Periods), true),
        (Claim::Periodic, "periodic/crossing", Flaw::FormerImage, true),
    ] {
        let smallest = reduced(flaw, claim, &format!("{group}/*"));
        let frames = &smallest.case.frames;
        assert!(frames.iter().all(|frame| frame.bodies.len() == 2), "{group}, {flaw:?}");
        assert_eq!(frames.len() > 1, has_former, "{group}, {flaw:?}");
        assert!(smallest.witness.is_some(), "{group}, {flaw:?}");
        let has_parts = frames[0].parts.is_some();
        assert_eq!(has_parts, claim == Claim::Parts, "{group}, {flaw:?}");
    }
    // It says in which image the boxes meet, and has no period that doesn't matter.
    let smallest = reduced(Flaw::NoImages, Claim::Periodic, "periodic/face/*");
    let periods = smallest.case.frames[0].periods.unwrap();
    assert_eq!(periods.iter().flatten().count(), 1, "{periods:?}");
    let text = smallest.to_string();
    assert!(text.contains("meets it when moved by ("), "{text}");
    // It says where boxes were before, and none has become a point.
    let smallest = reduced(Flaw::FirstFrame, Claim::Aabb, "churn/swap/*");
    let [first, .., last] = smallest.case.frames.as_slice() else {
        panic!("{smallest}");
    };
    let sides = |ends: &WorldBox| (0..3).all(|axis| ends[axis + 3] - ends[axis] >= 1.0);
    assert!(first.boxes.iter().chain(&last.boxes).all(sides), "{smallest}");
    let text = smallest.to_string();
    assert!(text.contains("frame 0, box 0: (") && text.contains(", since frame 0\n"), "{text}");
}
