//! The tests of boxes by cubes, and one axis of an or-DOP, every input of a format.

use std::collections::BTreeMap;

use super::format::{Format, exp2};

/// The constants of `rounding::cube`.
#[derive(Clone, Copy, Debug)]
pub struct Margins {
    pub wider: f64,
    pub narrower: f64,
    pub floor: f64,
}

impl Margins {
    /// 1 ± 16u, and more than what underflow takes.
    pub fn of(format: &Format) -> Self {
        let margin = 16.0 * format.u();
        let floor = exp2(format.least + 5);
        Self { wider: 1.0 + margin, narrower: 1.0 - margin, floor }
    }
}

/// An axis of `Cube::about`: the centre, and how far the ends are from it, an eighth in size.
pub fn axis_of(format: &Format, lo: f64, hi: f64) -> (f64, [f64; 2]) {
    let [lo, hi] = [lo, hi].map(|end| format.mul(end, 1.0 / 16.0));
    let centre = format.add(lo, hi);
    let below = format.sub(centre, format.add(lo, lo));
    (centre, [below, format.sub(format.add(hi, hi), centre)])
}

/// The cube's half side.
pub fn half_of(format: &Format, margins: &Margins, widest: f64) -> f64 {
    format.add(format.mul(widest, margins.wider), margins.floor)
}

/// `less_than_sure`
pub fn less_than_sure(format: &Format, margins: &Margins, gap: f64) -> f64 {
    let twice = |x| format.mul(2.0, x);
    format.add(format.mul(twice(gap), margins.wider), twice(margins.floor))
}

/// `sure`
pub fn sure(format: &Format, margins: &Margins, reach: f64, less: f64) -> f64 {
    format.sub(format.mul(reach, margins.narrower), less)
}

/// By bits of an axis' rounded numbers, the extreme ends of the boxes that give them.
type Classes = BTreeMap<[u64; 3], [f64; 2]>;

fn join(
    classes: &mut Classes,
    key: [f64; 3],
    ends: [f64; 2],
    keep: impl Fn([f64; 2], [f64; 2]) -> [f64; 2],
) {
    let kept = classes.entry(key.map(f64::to_bits)).or_insert(ends);
    *kept = keep(*kept, ends);
}

/// How many pairs of classes are wrong: parted by the cubes along an axis on which some of their
/// boxes meet. Other axes can only widen a cube.
pub fn wrong_apart(format: &Format, margins: &Margins, top: i32) -> u64 {
    let numbers = format.numbers(top);
    let mut classes = Classes::new();
    for (i, &lo) in numbers.iter().enumerate() {
        for &hi in &numbers[i..] {
            let (centre, [below, above]) = axis_of(format, lo, hi);
            let half = half_of(format, margins, format.max(format.max(below, above), 0.0));
            join(&mut classes, [centre, half, 0.0], [lo, hi], |a, b| {
                [a[0].min(b[0]), a[1].max(b[1])]
            });
        }
    }
    count_pairs(&classes, |[c, h, _], [lo, hi], [d, i, _], [other_lo, other_hi]| {
        let distance = format.sub(d, c).abs();
        let meet = lo <= other_hi && other_lo <= hi;
        format.gt(distance, format.add(h, i)) && meet
    })
}

/// How many pairs of classes are wrong: taken to meet without a look, though on this axis some of
/// their boxes don't. A cube may be wider for the sake of another axis; the gap is the least that
/// this axis leaves.
pub fn wrong_sure(format: &Format, margins: &Margins, top: i32) -> u64 {
    let numbers = format.numbers(top);
    let widths = format.sizes(top - 3);
    let mut classes = Classes::new();
    for (i, &lo) in numbers.iter().enumerate() {
        for &hi in &numbers[i..] {
            let (centre, [below, above]) = axis_of(format, lo, hi);
            let widest = format.max(format.max(below, above), 0.0);
            for &width in widths.iter().filter(|&&width| width >= widest) {
                let half = half_of(format, margins, width);
                let gap = format.sub(half, format.min(below, above));
                // The rightmost lower end and the leftmost upper end.
                join(&mut classes, [centre, half, gap], [lo, hi], |a, b| {
                    [a[0].max(b[0]), a[1].min(b[1])]
                });
            }
        }
    }
    count_pairs(&classes, |[c, h, g], [_, hi], [d, i, k], [lo, _]| {
        let distance = format.sub(d, c).abs();
        let less = less_than_sure(format, margins, g.max(k));
        let meets = !format.gt(distance, sure(format, margins, format.add(h, i), less));
        meets && hi < lo
    })
}

fn count_pairs(
    classes: &Classes,
    wrong: impl Fn([f64; 3], [f64; 2], [f64; 3], [f64; 2]) -> bool,
) -> u64 {
    let classes: Vec<_> =
        classes.iter().map(|(key, &ends)| (key.map(f64::from_bits), ends)).collect();
    let mut count = 0;
    for &(a, ends) in &classes {
        for &(b, other) in &classes {
            count += u64::from(b[0] >= a[0] && wrong(a, ends, b, other));
        }
    }
    count
}

/// One end of `inflate_slab` along an axis of the body: about the centre, outward, in arithmetic of
/// `wide`. The margin is a share of ρ and a floor.
pub fn slab_end(
    [narrow, wide]: [&Format; 2],
    [share, floor]: [f64; 2],
    [end, centre, reach]: [f64; 3],
) -> f64 {
    let offset = wide.sub(end, centre);
    let reach = wide.add(reach, centre.abs());
    let margin = wide.add(wide.mul(share, reach), floor);
    narrow.up(wide.add(offset.max(0.0), margin))
}

/// How many pairs of classes are wrong: separated along a common axis of two bodies that aren't
/// turned, though some of them meet there. A body has a translation t and a slab whose upper end
/// (of the second the lower one, mirrored) is `end` about `centre`; τ = (t_B − t_A) + (c_B − c_A).
pub fn wrong_slabs([narrow, wide]: [&Format; 2], margin: [f64; 2], top: i32) -> u64 {
    let numbers = narrow.numbers(top);
    let mut ends = BTreeMap::<[u64; 2], f64>::new();
    for &centre in &numbers {
        for &end in &numbers {
            let half = slab_end([narrow, wide], margin, [end, centre, end.abs()]);
            let true_half = (end - centre).max(0.0);
            let most = ends.entry([centre, half].map(f64::to_bits)).or_insert(true_half);
            *most = most.max(true_half);
        }
    }
    // By the rounded difference of the centres and the rounded sum of the ends, how far apart the
    // translations may be for the bodies to meet.
    let mut pairs = BTreeMap::<[u64; 2], f64>::new();
    for (&[c, h], a) in &ends {
        for (&[d, i], b) in &ends {
            // The second body is mirrored: its centre is −d.
            let [c, h, d, i] = [c, h, d, i].map(f64::from_bits);
            let key = [narrow.sub(-d, c), narrow.add(h, i)].map(f64::to_bits);
            let apart = a + b - (-d - c);
            let most = pairs.entry(key).or_insert(apart);
            *most = most.max(apart);
        }
    }
    let mut wrong = 0;
    for &a in &numbers {
        for &b in numbers.iter() {
            let translation = narrow.sub(b, a);
            for (&[offset, reach], &most) in &pairs {
                let [offset, reach] = [offset, reach].map(f64::from_bits);
                let tau = narrow.add(translation, offset);
                wrong += u64::from(narrow.gt(tau, reach) && b - a <= most);
            }
        }
    }
    wrong
}
