//! Queries of periodic worlds: every image of a body that shares a point with a volume.

use sdop::periodic::{PeriodicHit, PeriodicIndex};
use sdop::query::QueryShape;
use sdop::{QueryVolume, Tier};
use sdop_reference::exact::period::meeting_images;

use super::borders::cube;
use super::boxes::{ENDS, Ends, change, ends};
use super::*;

/// Every image of every box that meets a box, by the definition.
fn expected(boxes: &PeriodicBoxes, [min, max]: [[f64; 3]; 2]) -> Vec<PeriodicHit> {
    let images = |id: BodyId| {
        let body = boxes.body(id).unwrap();
        let images = meeting_images([min, max], [body.min, body.max], boxes.periods());
        let hits = images.into_iter().map(move |image| PeriodicHit {
            body: id,
            image: image.map(|n| i32::try_from(n).unwrap()),
        });
        hits.collect::<Vec<_>>()
    };
    let mut all: Vec<_> = boxes.ids().flat_map(images).collect();
    all.sort_unstable();
    all
}

/// The ends of a volume: one like those of the boxes, or a long one.
fn volume(kind: Ends, periods: [Option<f64>; 3], random: &mut Random) -> [[f64; 3]; 2] {
    let long = random.below(4) == 0;
    let ends = periods.map(|period| {
        let length = period.unwrap_or(1.0);
        let [lo, hi] = ends(kind, length, random);
        let more = if long { random.below(3) as f64 } else { 0.0 };
        [lo, hi + more * length]
    });
    [ends.map(|[lo, _]| lo), ends.map(|[_, hi]| hi)]
}

/// Boxes in boxes, exactly, while they come, move and go, with and without a cull before.
#[test]
fn boxes_are_found_exactly() {
    let mut random = Random::new(11);
    let (mut found, mut across) = (0, 0);
    for lengths in [[3.0, 5.0, 8.0], [0.1, 7.3, 1.0 / 3.0]] {
        for periods in subsets(lengths) {
            for kind in ENDS {
                let mut boxes = PeriodicBoxes::new(periods).unwrap();
                let (mut ids, mut index) = (Vec::new(), PeriodicIndex::with_threads(2).unwrap());
                let tiers = Tier::available();
                for round in 0..8 {
                    for _ in 0..24 / (round + 1) {
                        change(&mut boxes, &mut ids, kind, &mut random);
                    }
                    if random.below(2) == 0 {
                        boxes.cull().unwrap();
                    }
                    index = index.on_tier(tiers[random.below(tiers.len())]);
                    index.update(&boxes);
                    let volumes = [(); 6].map(|()| volume(kind, periods, &mut random));
                    let asked = volumes.map(|[min, max]| QueryVolume::Box { min, max });
                    let answers = index.touching_all(&asked).unwrap();
                    for (number, ends) in volumes.into_iter().enumerate() {
                        let wanted = expected(&boxes, ends);
                        assert_eq!(answers.of(number), wanted, "{periods:?} {kind:?} {ends:?}");
                        assert_eq!(index.touching(&asked[number]).unwrap(), wanted);
                        found += wanted.len();
                        across += wanted.iter().filter(|hit| hit.image != [0; 3]).count();
                    }
                }
            }
        }
    }
    assert!(found > 10_000 && 2 * across > found, "{across} of {found}");
}

/// The images of unit boxes and cubes at whole places that are within a distance of a point, a
/// whole number or an f64 above it.
fn near(
    at: &[(BodyId, [f64; 3])],
    periods: [f64; 3],
    point: [f64; 3],
    out: f64,
) -> Vec<PeriodicHit> {
    let mut hits = Vec::new();
    for &(body, place) in at {
        for number in 0..7_i32.pow(3) {
            let steps = [number / 49, number / 7 % 7, number % 7].map(|n| n - 3);
            // Whole numbers, so exact.
            let gaps = [0, 1, 2].map(|axis| {
                let apart = point[axis] - (place[axis] + f64::from(steps[axis]) * periods[axis]);
                (apart.abs() - 1.0).max(0.0)
            });
            if out >= 0.0 && gaps.iter().map(|gap| gap * gap).sum::<f64>() <= out * out {
                hits.push(PeriodicHit { body, image: steps });
            }
        }
    }
    hits.sort_unstable();
    hits
}

/// Every body that a ball touches is found, to the bit, and no box that is clearly apart: of boxes
/// and of cubes of side 2.
#[test]
fn balls_miss_nothing() {
    let mut random = Random::new(12);
    let lengths = [8.0, 12.0, 16.0];
    let mut boxes = PeriodicBoxes::new(lengths.map(Some)).unwrap();
    let mut cubes = PeriodicWorld::new(vec![cube(2.0)], lengths.map(Some)).unwrap();
    let (mut of_boxes, mut of_cubes) = (PeriodicIndex::new(), PeriodicIndex::new());
    let (mut at_boxes, mut at_cubes) = (Vec::new(), Vec::new());
    for _ in 0..40 {
        let place = lengths.map(|length| random.below(3 * length as usize) as f64 - length);
        let body = PeriodicBox::new(place.map(|x| x - 1.0), place.map(|x| x + 1.0));
        at_boxes.push((boxes.insert(body).unwrap(), place));
        at_cubes.push((cubes.insert(Body::at(0, UNTURNED, place)).unwrap(), place));
    }
    of_boxes.update(&boxes);
    of_cubes.update(&cubes);
    let (mut touching, mut all) = (0, 0);
    for _ in 0..240 {
        let centre = lengths.map(|length| random.below(2 * length as usize) as f64 - length);
        let radius = random.below(6) as f64;
        let ball = QueryVolume::Ball { centre, radius };
        let near = |places, out| near(places, lengths, centre, out);
        let found = of_boxes.touching(&ball).unwrap();
        let wanted = near(&at_boxes, radius);
        assert!(wanted.iter().all(|hit| found.contains(hit)), "{ball:?}");
        let allowed = near(&at_boxes, radius + 1.0e-5);
        assert!(found.iter().all(|hit| allowed.contains(hit)), "{ball:?}");
        touching += wanted.len() - near(&at_boxes, radius - 1.0e-9).len();
        all += wanted.len();
        let found = of_cubes.touching(&ball).unwrap();
        let wanted = near(&at_cubes, radius);
        assert!(wanted.iter().all(|hit| found.contains(hit)), "{ball:?}");
    }
    assert!(touching > 300 && all > 2000, "{touching} of {all}");
}

/// A posed shape finds what a box of the same ends finds, and no more where faces decide.
#[test]
fn posed_shapes_find_what_boxes_find() {
    let mut random = Random::new(13);
    let cube = cube(2.0);
    let (shape, margin) = (QueryShape::new(&cube), 0.0);
    let periods = [Some(12.0), None, Some(0.1 * 128.0)];
    let mut cubes = PeriodicWorld::new(vec![cube], periods).unwrap();
    let mut boxes = PeriodicBoxes::new(periods).unwrap();
    for _ in 0..100 {
        let place = [(); 3].map(|()| random.below(96) as f64 / 4.0);
        cubes.insert(Body::at(0, UNTURNED, place)).unwrap();
        let body = PeriodicBox::new(place.map(|x| x - 1.0), place.map(|x| x + 1.0));
        boxes.insert(body).unwrap();
    }
    let mut index = PeriodicIndex::new();
    index.update(&cubes);
    let (mut found, mut loose) = (0, 0);
    for _ in 0..300 {
        let [x, y, z] = [400, 96, 400].map(|steps| random.below(steps) as f64 / 4.0);
        let translation = [x - 50.0, y, z - 50.0];
        let posed = QueryVolume::Shape { shape: &shape, rotation: UNTURNED, translation, margin };
        let ends = [translation.map(|x| x - 1.0), translation.map(|x| x + 1.0)];
        let wanted = expected(&boxes, ends);
        let hits = index.touching(&posed).unwrap();
        assert!(wanted.iter().all(|hit| hits.contains(hit)), "{translation:?}");
        loose += hits.len() - wanted.len();
        found += wanted.len();
    }
    assert!(found > 500 && loose * 20 < found, "{loose} of {found}");
}

#[test]
fn long_and_far_volumes_are_refused() {
    let mut boxes = PeriodicBoxes::new([Some(2.0), None, None]).unwrap();
    let id = boxes.insert(PeriodicBox::new([0.0; 3], [0.5; 3])).unwrap();
    let mut index = PeriodicIndex::new();
    index.update(&boxes);
    let ball = |x: f64, radius| QueryVolume::Ball { centre: [x, 0.0, 0.0], radius };
    let hits = index.touching(&ball(0.25, 15.75)).unwrap();
    assert_eq!(hits.len(), 17, "those moved by -8 to 8 periods");
    assert!(hits.iter().all(|hit| hit.body == id));
    for volume in [ball(0.0, 16.5), ball(1.0e9, 0.0), ball(0.0, 1.0e15)] {
        let error = index.touching_all(&[ball(0.0, 1.0), volume]).unwrap_err();
        assert_eq!((error.query, error.quantity), (1, "volume"), "{error}");
        assert!(error.help().contains("16 periods"));
    }
    let error = index.touching(&ball(f64::NAN, 1.0)).unwrap_err();
    assert_eq!(error.quantity, "centre");
}
