//! Periodic boxes: exactly the pairs of the definition, in exact fractions.

use sdop::periodic::PeriodicError;
use sdop_reference::exact::period::meeting_images;

use super::*;
use crate::histories::{HistoryKind, live};

/// Where the ends of boxes are.
#[derive(Clone, Copy, Debug)]
pub enum Ends {
    /// At eighths of the period, so that many touch, within it.
    Eighths,
    /// The same, many periods away, where f64 rounds them.
    Far,
    /// Next to eighths, by a few steps of an f64.
    Ulps,
    /// Boxes of nearly half of the period.
    Wide,
    Anywhere,
}

pub const ENDS: [Ends; 5] = [Ends::Eighths, Ends::Far, Ends::Ulps, Ends::Wide, Ends::Anywhere];

fn moved_by_ulps(x: f64, random: &mut Random) -> f64 {
    let steps = random.below(5);
    let step = if random.below(2) == 0 { f64::next_up } else { f64::next_down };
    (0..steps).fold(x, |x, _| step(x))
}

/// The ends of a box along an axis.
pub fn ends(kind: Ends, period: f64, random: &mut Random) -> [f64; 2] {
    let mut eighths = |most: usize| random.below(most + 1) as f64 / 8.0;
    let (at, size) = (period * (eighths(16) - 1.0), period * eighths(3));
    let [lo, hi] = [at, at + size];
    let [lo, hi] = match kind {
        Ends::Eighths => [lo, hi],
        Ends::Far => {
            let way = (random.below(1 << 20) as f64 - f64::from(1 << 19)) * period;
            [lo + way, hi + way]
        }
        Ends::Ulps => [lo, hi].map(|end| moved_by_ulps(end, random)),
        Ends::Wide => [lo, lo + period * (0.5 - 0.5_f64.powi(2 + random.below(48)))],
        Ends::Anywhere => {
            let lo = period * (4.0 * unit(random) - 2.0);
            [lo, lo + 0.4 * period * unit(random)]
        }
    };
    [lo, lo.max(hi)]
}

pub fn random_box(kind: Ends, periods: [Option<f64>; 3], random: &mut Random) -> PeriodicBox {
    let ends = periods.map(|period| ends(kind, period.unwrap_or(1.0), random));
    PeriodicBox {
        motion: motion(random),
        groups: groups(random),
        ..PeriodicBox::new(ends.map(|[lo, _]| lo), ends.map(|[_, hi]| hi))
    }
}

/// The pairs that the definition asks for.
fn expected(boxes: &PeriodicBoxes) -> Vec<PeriodicPair> {
    let all: Vec<_> = boxes.ids().map(|id| (id, boxes.body(id).unwrap())).collect();
    let mut pairs = Vec::new();
    for (number, &(id, a)) in all.iter().enumerate() {
        for &(other, b) in &all[number + 1..] {
            let are_fixed = a.motion == Motion::Fixed && b.motion == Motion::Fixed;
            if are_fixed || !a.groups.collide(b.groups) || boxes.is_excluded(id, other) {
                continue;
            }
            let images = meeting_images([a.min, a.max], [b.min, b.max], boxes.periods());
            assert!(images.len() <= 1, "{a:?} {b:?}");
            pairs.extend(images.into_iter().map(|image| PeriodicPair {
                bodies: [id, other],
                image: image.map(|n| i32::try_from(n).unwrap()),
            }));
        }
    }
    pairs
}

/// A box moved by less than its size, and by a period to one side.
fn moved(body: PeriodicBox, periods: [Option<f64>; 3], random: &mut Random) -> PeriodicBox {
    let way = periods.map(|period| {
        let length = period.unwrap_or(1.0);
        let periods = if random.below(4) == 0 { 1.0 } else { 0.0 };
        length * (0.2 * unit(random) - 0.1 + periods)
    });
    let [min, max] = [body.min, body.max].map(|ends| [0, 1, 2].map(|axis| ends[axis] + way[axis]));
    PeriodicBox { min, max, ..body }
}

/// A random change of the boxes.
pub fn change(boxes: &mut PeriodicBoxes, ids: &mut Vec<BodyId>, kind: Ends, random: &mut Random) {
    let body = random_box(kind, boxes.periods(), random);
    let id = (!ids.is_empty()).then(|| ids[random.below(ids.len())]);
    match (random.below(8), id) {
        (0, Some(id)) if ids.len() > 16 => {
            boxes.remove(id).unwrap();
            ids.retain(|other| *other != id);
        }
        (1, Some(id)) => {
            boxes.exclude(id, ids[random.below(ids.len())]).unwrap();
        }
        (2, Some(id)) => {
            boxes.include(id, ids[random.below(ids.len())]).unwrap();
        }
        (3, Some(id)) => boxes.set(id, body).unwrap_or_else(allow_half),
        (4..7, Some(id)) => {
            let body = moved(boxes.body(id).unwrap(), boxes.periods(), random);
            boxes.set(id, body).unwrap_or_else(allow_half);
        }
        _ => match boxes.insert(body) {
            Ok(id) => ids.push(id),
            Err(error) => allow_half(error),
        },
    }
}

/// Boxes of half a period are refused, which rounding makes of some.
fn allow_half(error: PeriodicError) {
    match error {
        PeriodicError::Size { size, period, .. } => assert!(size >= 0.4999 * period),
        other => panic!("{other}"),
    }
}

#[test]
fn histories_in_periodic_space() {
    live(HistoryKind::Periodic, 2..4);
}

/// Other periods are other pairs, and where a box is too large for them nothing changes.
#[test]
fn periods_can_change() {
    let mut random = Random::new(2);
    let (mut refused, mut changed) = (0, 0);
    let mut boxes = PeriodicBoxes::new([Some(4.0), Some(4.0), None]).unwrap();
    for _ in 0..20 {
        let body = random_box(Ends::Eighths, boxes.periods(), &mut random);
        boxes.insert(body).unwrap();
    }
    for _ in 0..60 {
        let former = boxes.cull().unwrap().to_vec();
        let mut length = || Some(2.5 + 2.0 * unit(&mut random));
        let periods = [length(), length(), length()];
        match boxes.set_periods(periods) {
            Ok(()) => {
                let expected = expected(&boxes);
                assert_eq!(boxes.cull().unwrap(), expected, "{periods:?}");
                changed += usize::from(former != expected);
            }
            Err(error) => {
                assert!(matches!(error, PeriodicError::Size { .. }), "{error}");
                assert_eq!(boxes.cull().unwrap(), former);
                refused += 1;
            }
        }
    }
    assert!(refused > 5 && changed > 5, "{refused} {changed}");
}

/// A body far from all borders has no other image, one at a border one more, one at a corner seven.
#[test]
fn images_are_few() {
    let mut boxes = PeriodicBoxes::new([Some(10.0), Some(20.0), Some(30.0)]).unwrap();
    let mut images = |corner: [f64; 3]| {
        let id = boxes.insert(PeriodicBox::new(corner, corner.map(|x| x + 1.0))).unwrap();
        boxes.cull().unwrap();
        let images = boxes.images().len();
        boxes.remove(id).unwrap();
        boxes.cull().unwrap();
        assert_eq!(boxes.images().len(), 0);
        images
    };
    assert_eq!(images([0.0; 3]), 1);
    // The middle of the period is the origin, so its lower borders are at −5, −10 and −15.
    assert_eq!(images([-5.0, 0.0, 0.0]), 2);
    assert_eq!(images([4.75, 0.0, 0.0]), 2, "its middle is beyond the upper one");
    assert_eq!(images([4.5, 0.0, 0.0]), 1, "others have an image there");
    assert_eq!(images([-5.5, 0.0, 0.0]), 1, "the same place");
    assert_eq!(images([-3.9, 0.0, 0.0]), 1);
    assert_eq!(images([-5.0, 10.0, 0.0]), 4);
    assert_eq!(images([-5.0, 10.0, 45.0]), 8);
}

/// Boxes that move slowly are wrapped, and get and lose images, in few frames, so that lists of
/// neighbours serve in the others; also if the user keeps them within the period.
#[test]
fn slow_boxes_seldom_jump() {
    let mut random = Random::new(4);
    let periods = [Some(10.0), Some(8.0), None];
    for is_wrapped in [false, true] {
        let mut boxes = PeriodicBoxes::new(periods).unwrap();
        let mut moving: Vec<_> = (0..200)
            .map(|_| {
                let corner = [10.0, 8.0, 4.0].map(|length| length * unit(&mut random));
                let body = PeriodicBox::new(corner, corner.map(|x| x + 1.0));
                let speed = [(); 3].map(|()| 0.02 * unit(&mut random) - 0.01);
                (boxes.insert(body).unwrap(), corner, speed)
            })
            .collect();
        boxes.cull().unwrap();
        let (mut images, mut changes) = (boxes.images().len(), 0);
        for frame in 0..200 {
            for (id, corner, speed) in &mut moving {
                for axis in 0..3 {
                    corner[axis] += speed[axis];
                    if let Some(period) = periods[axis].filter(|_| is_wrapped) {
                        corner[axis] = corner[axis].rem_euclid(period);
                    }
                }
                let body = PeriodicBox::new(*corner, corner.map(|x| x + 1.0));
                boxes.set(*id, body).unwrap();
            }
            boxes.cull().unwrap();
            let former = std::mem::replace(&mut images, boxes.images().len());
            changes += u32::from(former != images);
            if frame % 20 == 0 {
                assert_eq!(boxes.pairs(), expected(&boxes), "frame {frame}");
            }
        }
        // The slack is a quarter of the side, at a hundredth of it per frame.
        assert!((4..=10).contains(&changes), "{changes} {is_wrapped}");
    }
}

/// A giant meets small boxes across the border, of which neither had an image there before it came:
/// by its own image, and by theirs.
#[test]
fn giants_come_late() {
    for (ends, most) in [([28.25, 60.0], 2 + 27), ([15.0, 46.5], 15 + 13)] {
        let mut boxes = PeriodicBoxes::new([Some(64.0), None, None]).unwrap();
        for x in -30..30 {
            let corner = [f64::from(x), 0.0, 0.0];
            boxes.insert(PeriodicBox::new(corner, corner.map(|x| x + 0.5))).unwrap();
        }
        assert_eq!(boxes.cull().unwrap(), []);
        let [lo, hi] = ends;
        boxes.insert(PeriodicBox::new([lo, 0.0, 0.0], [hi, 1.0, 1.0])).unwrap();
        let wanted = expected(&boxes);
        assert_eq!(wanted.len(), most);
        assert_eq!(boxes.cull().unwrap(), wanted);
    }
}
