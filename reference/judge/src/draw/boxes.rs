//! Draws boxes that barely meet or barely miss each other.

use sdop::bodies::Aabb;

/// Sides of boxes, in halves of a unit: cubes, of any aspect, of many sizes, without a length on an
/// axis or two.
const SIDES: [&[[f32; 3]]; 4] = [
    &[[2.0, 2.0, 2.0]],
    &[[0.25, 2.0, 16.0], [16.0, 0.25, 2.0], [2.0, 16.0, 0.25]],
    &[[0.002, 0.002, 0.002], [1.0, 1.5, 1.25], [900.0, 700.0, 900.0]],
    &[[0.0, 3.0, 3.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
];

/// Exponents of units: of the least, where nothing underflows, up to the greatest.
const UNITS: [i32; 4] = [-70, 0, 0, 100];

/// Frames of boxes that barely meet or miss: each begins where another ends, or a few last
/// places before or after, or lies anywhere; then all move, and some begin at another one's end
/// again. `below(n)` draws a number below n.
pub fn draw(below: &mut impl FnMut(u32) -> u32) -> Vec<Vec<Aabb>> {
    let unit = 2.0_f32.powi(UNITS[below(UNITS.len() as u32) as usize]);
    let sides = SIDES[below(SIDES.len() as u32) as usize];
    let sides = |below: &mut dyn FnMut(u32) -> u32| {
        sides[below(sides.len() as u32) as usize].map(|side| side * unit)
    };
    // In the narrowest space each meets most others.
    let space = unit * [4.0, 12.0, 30.0, 4000.0][below(4) as usize];
    let count = 2 + below(230) as usize;
    let mut boxes: Vec<Aabb> = Vec::with_capacity(count);
    for _ in 0..count {
        let sides = sides(below);
        let free = Aabb::new([0, 1, 2].map(|_| space * share(below)), [0.0; 3]);
        let placed = Aabb::new(free.min, [0, 1, 2].map(|axis| free.min[axis] + sides[axis]));
        let partner =
            (!boxes.is_empty() && below(2) == 0).then(|| boxes[below(boxes.len() as u32) as usize]);
        boxes.push(partner.map_or(placed, |partner| beside(&partner, sides, below)));
    }
    let frames = [1, 2, 12][below(3) as usize];
    let step = unit * [0.0, 0.01, 0.3, 5.0][below(4) as usize];
    let mut all = vec![boxes.clone()];
    for _ in 1..frames {
        for aabb in &mut boxes {
            for axis in 0..3 {
                let by = step * (share(below) - 0.5);
                (aabb.min[axis], aabb.max[axis]) = (aabb.min[axis] + by, aabb.max[axis] + by);
            }
        }
        for _ in 0..below(4) {
            let [one, other] = [0, 1].map(|_| below(count as u32) as usize);
            boxes[one] = beside(&boxes[other].clone(), sides(below), below);
        }
        all.push(boxes.clone());
    }
    all
}

/// A number from 0 to 1.
fn share(below: &mut impl FnMut(u32) -> u32) -> f32 {
    below(1 << 16) as f32 / (1 << 16) as f32
}

/// A box that begins where another one ends on some axis, or ends where that begins, give or take
/// three last places.
pub(crate) fn beside(other: &Aabb, sides: [f32; 3], below: &mut impl FnMut(u32) -> u32) -> Aabb {
    let (mut min, at) = (other.min, below(3) as usize);
    let off = below(7) as i32 - 3;
    let shifted = |end: f32| {
        let step = if off < 0 { f32::next_down } else { f32::next_up };
        (0..off.abs()).fold(end, |end, _| step(end))
    };
    let is_behind = below(2) == 0;
    if is_behind {
        min[at] = shifted(other.max[at]);
    }
    let mut max = [0, 1, 2].map(|axis| min[axis] + sides[axis]);
    if !is_behind {
        max[at] = shifted(other.min[at]);
        min[at] = max[at] - sides[at];
    }
    Aabb::new(min, max)
}
