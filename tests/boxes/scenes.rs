//! Boxes for which it is hard to decide whether they meet, and the pairs that do by the definition.

use sdop::{Aabb, Groups};

use sdop_judge::draw::random::Random;

/// What boxes are like.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Cubes of one size.
    Cubes,
    /// On a lattice: they share ends, and cells of any grid have theirs on borders.
    Lattice,
    /// Each begins where another ends, or a step of an f32 before or after.
    Ulps,
    /// Sides 1 : 8 : 64 in any order.
    Needles,
    /// Without a length on one axis, two or all.
    Flat,
    /// Giants around one another, a million times as large as what lies within.
    Nested,
    /// All alike in one place, but for a few.
    Crowd,
    /// Ends up to the greatest f32.
    Greatest,
    /// Ends of the least.
    Least,
    /// Small ones far from the origin.
    Far,
    /// One wall among cubes.
    Wall,
}

impl Kind {
    pub const ALL: [Self; 11] = [
        Self::Cubes,
        Self::Lattice,
        Self::Ulps,
        Self::Needles,
        Self::Flat,
        Self::Nested,
        Self::Crowd,
        Self::Greatest,
        Self::Least,
        Self::Far,
        Self::Wall,
    ];
}

/// So many boxes of a kind.
pub fn boxes(kind: Kind, count: usize, random: &mut Random) -> Vec<Aabb> {
    let mut boxes: Vec<Aabb> = Vec::new();
    let side = (count as f32).cbrt() * 1.5;
    for n in 0..count {
        let about = |random: &mut Random, reach: f32, half: [f32; 3]| {
            let centre: [f32; 3] = std::array::from_fn(|_| random.within(reach));
            around(centre, half)
        };
        let aabb = match kind {
            Kind::Cubes => about(random, side, [1.0; 3]),
            Kind::Lattice => {
                let ends = [0; 3].map(|_| {
                    let lo = random.below(2 * side as usize + 2) as f32;
                    [lo, lo + random.below(3) as f32]
                });
                from_ends(ends)
            }
            Kind::Ulps if n % 2 == 1 => beside(&boxes[n - 1], random),
            Kind::Ulps => {
                let half = [0.1 + random.unit(); 3];
                about(random, side, half)
            }
            Kind::Needles => {
                let mut half = [0.25, 2.0, 16.0];
                half.rotate_left(random.below(3));
                if random.below(2) == 0 {
                    half.swap(0, 1);
                }
                about(random, 4.0 * side, half)
            }
            Kind::Flat => {
                let half = [0; 3].map(|_| [0.0, 0.0, 1.0][random.below(3)]);
                let centre = [0; 3].map(|_| random.below(side as usize + 1) as f32);
                around(centre, half)
            }
            Kind::Nested => {
                let half = 10.0_f32.powi(random.below(7)) * 1e-3;
                about(random, 2.0 * half + 1.0, [half; 3])
            }
            Kind::Crowd if n % 16 < 13 => around([0.5, 7.0, -3.0], [1.0, 2.0, 3.0]),
            Kind::Crowd => about(random, 12.0, [1.0; 3]),
            Kind::Greatest => {
                let ends = [0; 3].map(|_| {
                    let end = |random: &mut Random| match random.below(6) {
                        0 => f32::MIN,
                        1 => f32::MAX,
                        2 => f32::MAX.next_down(),
                        3 => random.within(1.0),
                        _ => random.within(f32::MAX),
                    };
                    [end(random), end(random)]
                });
                from_ends(ends)
            }
            Kind::Least => {
                let end = |random: &mut Random| {
                    f32::from_bits(random.below(40) as u32) * [1.0, -1.0][random.below(2)]
                };
                from_ends([0; 3].map(|_| [end(random), end(random)]))
            }
            Kind::Far => {
                let centre = [1e6, -3e5, 7.0_f32].map(|far| far + random.within(side));
                around(centre, [random.unit(); 3])
            }
            Kind::Wall if n == count / 2 => around([0.0; 3], [side, 0.05, side]),
            Kind::Wall => about(random, side, [0.8; 3]),
        };
        boxes.push(aabb);
    }
    boxes
}

fn around(centre: [f32; 3], half: [f32; 3]) -> Aabb {
    let end = |sign: f32| std::array::from_fn::<f32, 3, _>(|axis| centre[axis] + sign * half[axis]);
    Aabb::new(end(-1.0), end(1.0))
}

fn from_ends(ends: [[f32; 2]; 3]) -> Aabb {
    Aabb::new(ends.map(|[a, b]| a.min(b)), ends.map(|[a, b]| a.max(b)))
}

/// A box that begins where another ends on one axis, or ends where it begins, within a step either
/// way.
fn beside(other: &Aabb, random: &mut Random) -> Aabb {
    let (mut next, axis) = (*other, random.below(3));
    let length = random.unit();
    let step = |x: f32, random: &mut Random| [x, x.next_up(), x.next_down()][random.below(3)];
    if random.below(2) == 0 {
        next.min[axis] = step(other.max[axis], random);
        next.max[axis] = next.min[axis] + length;
    } else {
        next.max[axis] = step(other.min[axis], random);
        next.min[axis] = next.max[axis] - length;
    }
    next
}

/// The next frame: some boxes stay, most move a little, some grow, a few jump.
pub fn moved(boxes: &mut [Aabb], step: f32, random: &mut Random) {
    for at in 0..boxes.len() {
        let other = boxes[random.below(boxes.len())];
        let aabb = &mut boxes[at];
        match random.below(40) {
            0..8 => {}
            8..10 => aabb.max = aabb.max.map(|x| (x + step).min(f32::MAX)),
            10 if step > 0.1 => *aabb = other,
            _ => {
                for axis in 0..3 {
                    let by = random.within(step);
                    let end = |x: f32| (x + by).clamp(f32::MIN, f32::MAX);
                    (aabb.min[axis], aabb.max[axis]) = (end(aabb.min[axis]), end(aabb.max[axis]));
                }
            }
        }
    }
}

/// The pairs that the definition asks for, sorted: a point in common, one of the two dynamic,
/// groups that collide.
pub fn expected(
    boxes: &[Aabb],
    dynamic: impl Fn(usize) -> bool,
    groups: impl Fn(usize) -> Groups,
) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, a) in boxes.iter().enumerate() {
        for (j, b) in boxes.iter().enumerate().skip(i + 1) {
            let apart = (0..3).any(|k| a.min[k] > b.max[k] || b.min[k] > a.max[k]);
            if !apart && (dynamic(i) || dynamic(j)) && groups(i).collide(groups(j)) {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}
