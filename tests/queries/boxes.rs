//! Given boxes: boxes exactly, balls and lines to 2⁻⁵⁰.

use sdop::query::QueryError;
use sdop::{Aabb, BodyId, BoxWorld, Line, QueryIndex, QueryVolume};
use sdop_reference::exact::query::{ExactLine, ball_meets_box, is_no_later, line_meets_box};

use crate::queries::scenes::{Kind, boxes};
use crate::queries::tiers;
use sdop_judge::draw::random::Random;

/// Closer than that, relative to the coordinates, rounding may report what only nearly touches.
const NEAR: f64 = 1e-12;

fn index_of(boxes: &[Aabb]) -> (QueryIndex, Vec<BodyId>) {
    let mut world = BoxWorld::new();
    let ids = boxes.iter().map(|&aabb| world.insert(aabb).unwrap());
    let ids = ids.collect();
    let mut index = QueryIndex::new();
    index.update(&world);
    (index, ids)
}

fn ends(aabb: &Aabb) -> [[f64; 3]; 2] {
    [aabb.min, aabb.max].map(|corner| corner.map(f64::from))
}

fn grown(aabb: &Aabb) -> [[f64; 3]; 2] {
    grown_for(aabb, &[])
}

/// The box, grown by a small share of its coordinates and of those of some points.
fn grown_for(aabb: &Aabb, points: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let [lo, hi] = ends(aabb);
    let size = |axis: usize| {
        let points = points.iter().map(|point| point[axis].abs());
        NEAR * (lo[axis].abs() + hi[axis].abs() + points.sum::<f64>() + 1.0)
    };
    [
        std::array::from_fn(|axis| lo[axis] - size(axis)),
        std::array::from_fn(|axis| hi[axis] + size(axis)),
    ]
}

/// A corner of some box, or a point near one.
fn point(boxes: &[Aabb], random: &mut Random) -> [f64; 3] {
    let aabb = &boxes[random.below(boxes.len())];
    let [lo, hi] = ends(aabb);
    let is_corner = random.below(2) == 0;
    std::array::from_fn(|axis| {
        let end = [lo, hi][random.below(2)][axis];
        let off = (hi[axis] - lo[axis] + 1.0) * f64::from(random.within(2.0));
        let limit = 2.0f64.powi(60);
        (if is_corner { end } else { end + off }).clamp(-limit, limit)
    })
}

/// Boxes that meet a box are found exactly.
#[test]
fn box_finds_boxes_exactly() {
    let random = &mut Random::new(1);
    for kind in Kind::ALL {
        let all = boxes(kind, 300, random);
        let (index, ids) = index_of(&all);
        let indices = tiers(&index);
        for _ in 0..60 {
            let [a, b] = [point(&all, random), point(&all, random)];
            // Ends of boxes, and the f64 next to them.
            let nudge = |x: f64, up: bool| [x, if up { x.next_up() } else { x.next_down() }];
            let pick = random.below(2);
            let min = std::array::from_fn(|axis| nudge(a[axis].min(b[axis]), true)[pick]);
            let max: [f64; 3] =
                std::array::from_fn(|axis| nudge(a[axis].max(b[axis]), false)[pick]);
            if (0..3).any(|axis| min[axis] > max[axis]) {
                continue;
            }
            let meets = |aabb: &Aabb| {
                let [lo, hi] = ends(aabb);
                (0..3).all(|axis| lo[axis] <= max[axis] && min[axis] <= hi[axis])
            };
            let wanted = ids.iter().zip(&all).filter(|(_, aabb)| meets(aabb));
            let wanted: Vec<BodyId> = wanted.map(|(&id, _)| id).collect();
            for index in &indices {
                let found = index.touching(&QueryVolume::Box { min, max }).unwrap();
                assert_eq!(found, wanted, "{kind:?}: {min:?} {max:?}");
            }
        }
    }
}

/// Boxes that meet a ball are found.
#[test]
fn ball_finds_boxes() {
    let random = &mut Random::new(2);
    let (mut met, mut touched) = (0, 0);
    for kind in Kind::ALL {
        let all = boxes(kind, 200, random);
        let (index, ids) = index_of(&all);
        for _ in 0..40 {
            let [centre, other] = [point(&all, random), point(&all, random)];
            // Through a point of some box, to what f64 makes of that.
            let square: f64 = (0..3).map(|axis| (centre[axis] - other[axis]).powi(2)).sum();
            let radius = square.sqrt().min(2.0f64.powi(60));
            let found = index.touching(&QueryVolume::Ball { centre, radius }).unwrap();
            for (id, aabb) in ids.iter().zip(&all) {
                let is_found = found.binary_search(id).is_ok();
                let meets = ball_meets_box(centre, radius, ends(aabb));
                assert!(is_found || !meets, "{kind:?}: {centre:?} {radius:e} {aabb:?}");
                let wide = radius * (1.0 + NEAR) + 2.0f64.powi(-300);
                let is_near = !is_found || meets || ball_meets_box(centre, wide, grown(aabb));
                assert!(is_near, "{kind:?}: {centre:?} {radius:e} {aabb:?}");
                met += u32::from(meets);
                touched += u32::from(is_found && !meets);
            }
        }
    }
    assert!(met > 1000, "{met} of them meet, {touched} nearly");
}

/// Boxes along a line are found in order.
#[test]
fn line_finds_boxes_in_order() {
    let random = &mut Random::new(3);
    let mut met = 0;
    for kind in Kind::ALL {
        let all = boxes(kind, 200, random);
        let (index, ids) = index_of(&all);
        for round in 0..40 {
            let [from, to] = [point(&all, random), point(&all, random)];
            let direction: [f64; 3] = std::array::from_fn(|_| f64::from(random.within(1.0)));
            let (line, exact) = if round % 2 == 0 {
                (Line::Segment { from, to }, ExactLine::segment(from, to))
            } else {
                let origin = from;
                (Line::Ray { origin, direction }, ExactLine::ray(from, direction))
            };
            let found = index.along(&line).unwrap();
            assert!(found.is_sorted_by(|a, b| (a.at, a.body) < (b.at, b.body)));
            let first = index.first(&line).unwrap();
            assert_eq!(first, found.first().copied(), "{kind:?}: {line:?}");
            for (id, aabb) in ids.iter().zip(&all) {
                let hit = found.iter().find(|hit| hit.body == *id);
                let wanted = line_meets_box(&exact, ends(aabb));
                match (&wanted, hit) {
                    (Some(at), Some(hit)) => assert!(is_no_later(hit.at, at)),
                    (Some(_), None) => panic!("{kind:?}: {line:?} misses {aabb:?}"),
                    (None, Some(_)) => {
                        let near = grown_for(aabb, &[from, to]);
                        let is_near = line_meets_box(&exact, near).is_some();
                        assert!(is_near, "{kind:?}: {line:?} {aabb:?}");
                    }
                    (None, None) => {}
                }
                met += u32::from(wanted.is_some());
            }
        }
    }
    assert!(met > 1000, "{met}");
}

/// Lines that have one point with a box, a corner or one of an edge, at a parameter that no f64
/// is.
#[test]
fn lines_that_graze_are_not_lost() {
    let random = &mut Random::new(4);
    let aabb = Aabb::new([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
    let (index, ids) = index_of(&[aabb]);
    let mut inexact = 0;
    for _ in 0..4000 {
        let whole = |random: &mut Random| f64::from(1 + random.below(1 << 20) as u32);
        // Through a corner, away from the box on both sides of it along some axis.
        let corner = [0, 1, 2].map(|axis| [aabb.min, aabb.max][random.below(2)][axis]);
        let outward =
            [0, 1, 2].map(|axis| if corner[axis] < 2.0 + axis as f32 + 0.5 { -1.0 } else { 1.0 });
        let mut d = [whole(random), whole(random), whole(random)];
        d[0] *= outward[0];
        d[1] *= -outward[1];
        d[2] *= [-1.0, 0.0, 1.0][random.below(3)];
        let [before, after] = [whole(random), whole(random)];
        let corner = corner.map(f64::from);
        let from = [0, 1, 2].map(|axis| corner[axis] - before * d[axis]);
        let to = [0, 1, 2].map(|axis| corner[axis] + after * d[axis]);
        let exact = line_meets_box(&ExactLine::segment(from, to), ends(&aabb));
        let exact = exact.expect("it has a corner");
        let line = Line::Segment { from, to };
        let found = index.along(&line).unwrap();
        assert_eq!(found.len(), 1, "{line:?}");
        assert!(found[0].body == ids[0] && is_no_later(found[0].at, &exact));
        assert!((found[0].at - before / (before + after)).abs() < 1e-12);
        inexact += u32::from(!is_no_later(before / (before + after), &exact));
        let ray = Line::Ray { origin: from, direction: d };
        assert_eq!(index.along(&ray).unwrap().len(), 1, "{ray:?}");
        // An eighth farther out, and it misses.
        let off = [0, 1, 2].map(|axis| if axis < 2 { 0.125 * outward[axis] } else { 0.0 });
        let away = |p: [f64; 3]| [0, 1, 2].map(|axis| p[axis] + off[axis]);
        let [from, to] = [away(from), away(to)];
        assert_eq!(index.along(&Line::Segment { from, to }).unwrap(), []);
    }
    assert!(inexact > 500, "{inexact}");
}

/// Balls that touch a corner in exact arithmetic, where the squares are no f64.
#[test]
fn exactly_touching_balls_are_found() {
    let random = &mut Random::new(5);
    let aabb = Aabb::new([0.0; 3], [1.0; 3]);
    let (index, _) = index_of(&[aabb]);
    for _ in 0..4000 {
        let size = f64::from((1 << 30 | random.below(1 << 30)) as u32) + 0.5;
        // (2, 3, 6) has the length 7, (1, 4, 8) 9, and (2, 10, 11) 15.
        let (d, length) =
            [([2.0, 3.0, 6.0], 7.0), ([1.0, 4.0, 8.0], 9.0), ([2.0, 10.0, 11.0], 15.0)]
                [random.below(3)];
        let centre = d.map(|x| 1.0 + size * x);
        let radius = size * length;
        assert!(ball_meets_box(centre, radius, ends(&aabb)));
        let found = |radius| index.touching(&QueryVolume::Ball { centre, radius }).unwrap();
        assert_eq!(found(radius).len(), 1, "{centre:?} {radius}");
        assert_eq!(found(radius * (1.0 - NEAR)).len(), 0);
    }
}

/// Lines from within and points are at zero.
#[test]
fn inner_lines_start_at_zero() {
    let aabb = Aabb::new([0.0; 3], [1.0; 3]);
    let (index, ids) = index_of(&[aabb, Aabb::new([5.0; 3], [6.0; 3])]);
    for (from, to) in [
        ([0.5; 3], [0.5; 3]),
        ([1.0; 3], [1.0; 3]),
        ([0.5; 3], [0.75; 3]),
        ([1.0, 0.5, 0.5], [9.0, 0.5, 0.5]),
    ] {
        let found = index.along(&Line::Segment { from, to }).unwrap();
        let [hit] = found[..] else {
            panic!("{from:?}: {found:?}");
        };
        assert!(hit.body == ids[0] && hit.at == 0.0, "{hit:?}");
    }
    let [from, to] = [[1.0, 1.0, 1.0f64.next_up()]; 2];
    assert_eq!(index.along(&Line::Segment { from, to }).unwrap(), []);
}

/// The caller's judgement decides, and is asked about no box beyond the first.
#[test]
fn caller_judges_the_first() {
    let row: Vec<Aabb> = (0..300)
        .map(|i| [3.0 * i as f32, 3.0 * i as f32 + 1.0])
        .map(|[from, to]| Aabb::new([from, 0.0, 0.0], [to, 1.0, 1.0]))
        .collect();
    let (index, ids) = index_of(&row);
    let line = Line::Ray { origin: [-1.0, 0.5, 0.5], direction: [1.0, 0.0, 0.0] };
    let mut asked = 0;
    let first = index.first_judged(&line, |hit| {
        asked += 1;
        // Four are passed by; each is met in its middle.
        (hit.body >= ids[4]).then_some(hit.at + 0.5)
    });
    let first = first.unwrap().unwrap();
    assert_eq!(first.body, ids[4]);
    assert!((first.at - 13.5).abs() < 1e-9, "{first:?}");
    assert!(asked < 40, "{asked}");
    let nothing = index.first_judged(&line, |_| None);
    assert_eq!(nothing.unwrap(), None);
}

/// Batches are the queries one by one.
#[test]
fn batches_equal_single_queries() {
    let random = &mut Random::new(6);
    let all = boxes(Kind::Needles, 500, random);
    let mut world = BoxWorld::new();
    for aabb in &all {
        world.insert(*aabb).unwrap();
    }
    let volumes: Vec<QueryVolume<'_>> = (0..200)
        .map(|n| match n % 2 {
            0 => QueryVolume::from(all[random.below(500)]),
            _ => QueryVolume::Ball { centre: point(&all, random), radius: 3.0 },
        })
        .collect();
    let lines: Vec<Line> = (0..200)
        .map(|_| Line::Segment { from: point(&all, random), to: point(&all, random) })
        .collect();
    for threads in [1, 3] {
        let mut index = QueryIndex::with_threads(threads).unwrap();
        index.update(&world);
        let (touching, along) =
            (index.touching_all(&volumes).unwrap(), index.along_all(&lines).unwrap());
        let first = index.first_all(&lines).unwrap();
        assert_eq!((touching.len(), along.len(), first.len()), (200, 200, 200));
        for (volume, found) in volumes.iter().zip(touching.iter()) {
            assert_eq!(index.touching(volume).unwrap(), found);
        }
        for (query, line) in lines.iter().enumerate() {
            assert_eq!(index.along(line).unwrap(), along.of(query));
            assert_eq!(index.first(line).unwrap().as_slice(), first.of(query));
        }
    }
}

/// Queries outside of the contract are refused.
#[test]
fn invalid_queries_are_rejected() {
    let (index, _) = index_of(&[Aabb::new([0.0; 3], [1.0; 3])]);
    let far = 2.0f64.powi(60).next_up();
    let ball = |centre, radius| QueryVolume::Ball { centre, radius };
    let of_box = |min, max| QueryVolume::Box { min, max };
    let refused = |error: QueryError| {
        assert!(!error.help().is_empty());
        error.problem()
    };
    for (volume, message) in [
        (ball([0.0, f64::NAN, 0.0], 1.0), "query 1: centre [0.0, NaN, 0.0]"),
        (ball([0.0; 3], -1.0), "query 1: radius -1.0"),
        (ball([0.0; 3], f64::INFINITY), "query 1: radius inf"),
        (of_box([far; 3], [far; 3]), "query 1: min "),
        (of_box([0.0; 3], [1.0, -1.0, 1.0]), "query 1: box "),
    ] {
        let good = ball([0.0; 3], 1.0);
        let found = refused(index.touching_all(&[good, volume]).unwrap_err());
        assert!(found.starts_with(message), "{found}");
        assert!(refused(index.touching(&volume).unwrap_err()).starts_with("query 0: "));
    }
    let ray = |direction| Line::Ray { origin: [0.0; 3], direction };
    for (line, message) in [
        (ray([0.0; 3]), "query 0: direction [0.0, 0.0, 0.0]"),
        (ray([2.0f64.powi(-61); 3]), "query 0: direction "),
        (Line::Segment { from: [0.0; 3], to: [f64::NAN; 3] }, "query 0: to [NaN, NaN, NaN]"),
    ] {
        let found = refused(index.along(&line).unwrap_err());
        assert!(found.starts_with(message), "{found}");
        assert!(index.first(&line).is_err() && index.first_all(&[line]).is_err());
        assert!(index.along_all(&[line]).is_err());
    }
    assert!(index.along(&ray([2.0f64.powi(-60); 3])).is_ok());
}

#[test]
fn an_empty_index_answers() {
    let mut index = QueryIndex::new();
    index.update(&BoxWorld::new());
    assert!(index.is_empty());
    assert_eq!(index.touching(&Aabb::new([0.0; 3], [1.0; 3]).into()).unwrap(), []);
    let line = Line::Segment { from: [0.0; 3], to: [1.0; 3] };
    assert_eq!(index.along(&line).unwrap(), []);
    assert_eq!(index.first(&line).unwrap(), None);
    assert_eq!(index.pairs_with(&index).unwrap(), Vec::<[BodyId; 2]>::new());
    assert!(index.touching_all(&[]).unwrap().is_empty());
}
