//! The code's functions, each on inputs that are drawn for it.

use sdop::Aabb;
use sdop::boxes::CubeTest;
use sdop::broad_phase::{BallBounds, BallTest, Cells, SlotBodies, SlotTest, TableLayout};
use sdop::overlap::ordop::slabs::LaneSlabs;
use sdop::overlap::ordop::support::support;
use sdop::overlap::ordop::table::members_of;
use sdop::overlap::sphere::Spheres;
use sdop::rounding::cube::{Cube, less_than_sure};
use sdop::rounding::pose::{refit, rotation, transform, world_axes};
use sdop::rounding::skin::{Reach, Skin, stays};
use sdop::rounding::slab::inflate_slab;
use sdop::rounding::sphere::{inflate_radius, world_ball};
use sdop::rounding::{down, exp2, up, widen};
use sdop::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch};

use super::case::Case;
use super::inputs::Inputs;

pub const FUNCTIONS: [fn(Tier, &mut Inputs) -> Case; 16] = [
    |_, inputs| outward(inputs),
    |_, inputs| {
        let radius = inputs.size();
        Case::of("widen").f32s(&[radius]).gives().f32s(&[widen(radius)])
    },
    |_, inputs| {
        let radius = inputs.size();
        Case::of("inflate").f32s(&[radius]).gives().f32s(&[inflate_radius(radius)])
    },
    spheres,
    |_, inputs| {
        let q = inputs.quaternion();
        Case::of("rotation").f32s(&q).gives().f64s(rotation(q).as_flattened())
    },
    |_, inputs| {
        let (q, [x, t]) = (inputs.quaternion(), [(); 2].map(|()| inputs.vector()));
        let found = transform(&rotation(q), x, t);
        Case::of("transform").f32s(&q).f32s(&x).f32s(&t).gives().f64s(&found)
    },
    |_, inputs| posed_ball(inputs),
    |_, inputs| {
        let (q, basis) = (inputs.quaternion(), [(); 3].map(|()| inputs.vector()));
        let axes = world_axes(&rotation(q), basis);
        Case::of("axes").f32s(&q).f32s(basis.as_flattened()).gives().f32s(axes.as_flattened())
    },
    |_, inputs| {
        let ends = [(); 2].map(|()| f64::from(inputs.number()) + f64::from(inputs.number()));
        let (reach, t) = (inputs.size(), inputs.vector());
        let (lo, hi) = refit(ends[0], ends[1], reach, t);
        Case::of("refit").f64s(&ends).f32s(&[reach]).f32s(&t).gives().f32s(&[lo, hi])
    },
    |_, inputs| slab(inputs),
    |_, inputs| cells(inputs),
    drift,
    |_, inputs| {
        let (skin, numbers) = skin(inputs);
        let radius = inputs.size();
        let case = Case::of("reach").f32s(&numbers).f32s(&[radius]).gives();
        case.f32s(&[Reach::with_skin(skin).of(radius)])
    },
    cube,
    cubes,
    supports,
];

/// The numbers on either side of an f64, which may lie next to or midway between two f32.
fn outward(inputs: &mut Inputs) -> Case {
    let x = f64::from(inputs.number());
    let next = f64::from((x as f32).next_up());
    let x = match inputs.below(4) {
        0 => x,
        1 => x.midpoint(next),
        2 => x.midpoint(next).next_up(),
        _ => x + f64::from(inputs.number()) * inputs.share(),
    };
    Case::of("outward").f64s(&[x]).gives().f32s(&[down(x), up(x)])
}

/// Whether a slot's ball hits the next one.
struct Hit<T>(T);

impl<T: BallTest> Kernel for Hit<T> {
    type Output = bool;
    fn run<L: Lanes>(self, l: L) -> bool {
        let mut hits = [0; 1 + MAX_WIDTH];
        SlotTest::run(&self.0, l, 0, 1..2, &mut hits) == 1
    }
}

/// Two balls in slots, and a vector of others after them.
fn in_slots(pair: [[f32; 4]; 2]) -> [[f32; 4]; 2 + MAX_WIDTH] {
    let mut balls = [[0.0; 4]; 2 + MAX_WIDTH];
    balls[..2].copy_from_slice(&pair);
    balls
}

const NAMES: [u32; 2] = [0, 1];
const NO_COLUMNS: [Vec<f32>; 4] = [const { Vec::new() }; 4];

/// Two balls about to touch.
fn near_balls(inputs: &mut Inputs) -> [[f32; 4]; 2] {
    let scale = inputs.scale();
    let away = if inputs.below(2) == 0 { 0.0 } else { 8.0 };
    let one = [(); 3].map(|()| (inputs.signed() * away * scale) as f32);
    let radii = [(); 2].map(|()| (inputs.share() * scale) as f32);
    let distance = inputs.nearly(f64::from(radii[0]) + f64::from(radii[1]));
    let way = inputs.direction();
    let other = [0, 1, 2].map(|i| (f64::from(one[i]) + way[i] * distance) as f32);
    [[one[0], one[1], one[2], radii[0]], [other[0], other[1], other[2], radii[1]]]
}

fn spheres(tier: Tier, inputs: &mut Inputs) -> Case {
    let pair = if inputs.below(4) == 0 {
        [(); 2].map(|()| {
            let [x, y, z] = inputs.vector();
            [x, y, z, inputs.size()]
        })
    } else {
        near_balls(inputs)
    };
    let balls = in_slots(pair.map(|[x, y, z, r]| [x, y, z, inflate_radius(r)]));
    let slots = SlotBodies { balls: &balls, columns: &NO_COLUMNS, names: &NAMES };
    let apart = !dispatch(tier, Hit(Spheres(slots)));
    Case::of("spheres").f32s(pair.as_flattened()).gives().bit(apart)
}

fn posed_ball(inputs: &mut Inputs) -> Case {
    let (q, t) = (inputs.quaternion(), inputs.vector());
    let centre = match inputs.below(5) {
        0 => [0.0, -0.0, 0.0],
        _ => inputs.vector(),
    };
    let radius = inputs.size();
    let (place, world_radius) = world_ball(&rotation(q), t, centre, radius);
    let case = Case::of("world_ball").f32s(&q).f32s(&t).f32s(&centre).f32s(&[radius]);
    case.gives().f32s(&place).f32s(&[inflate_radius(world_radius)])
}

fn slab(inputs: &mut Inputs) -> Case {
    let scale = inputs.scale();
    let ends = [(); 2].map(|()| (inputs.signed() * scale) as f32);
    let direction = [(); 3].map(|()| inputs.below(5) as f32 - 2.0);
    let size = 0.5 + inputs.share();
    let centre = [(); 3].map(|()| (inputs.signed() * scale) as f32);
    let reach = (inputs.share() * scale) as f32;
    let (lo, hi) = inflate_slab(ends[0], ends[1], direction, size, centre, reach);
    let case = Case::of("slab").f32s(&ends).f32s(&direction).f64s(&[size]);
    case.f32s(&centre).f32s(&[reach]).gives().f32s(&[lo, hi])
}

/// Cells of a wrapped table, whose size takes no search.
fn cells(inputs: &mut Inputs) -> Case {
    let scale = inputs.scale();
    let mut point = || [(); 3].map(|()| (inputs.signed() * scale) as f32);
    let [a, b] = [point(), point()];
    let [lo, hi] = [[0, 1, 2].map(|i| a[i].min(b[i])), [0, 1, 2].map(|i| a[i].max(b[i]))];
    let widest = match inputs.below(3) {
        0 => inputs.size(),
        1 => (inputs.share() * scale) as f32,
        _ => (inputs.share() * scale * exp2(-(inputs.below(40) as i32))) as f32,
    };
    let cells = Cells::fit(&BallBounds { lo, hi, widest }, 100, TableLayout::Wrapped);
    // A centre on a border between cells, or any.
    let share = match inputs.below(2) {
        0 => inputs.share(),
        _ => {
            let cell = cells.size() * (f64::from(inputs.below(cells.count()[0])) + 0.5);
            cell / (f64::from(hi[0]) - f64::from(lo[0])).max(f64::MIN_POSITIVE)
        }
    };
    let centre = [0, 1, 2].map(|i| {
        let [lo, hi] = [lo[i], hi[i]].map(f64::from);
        ((lo + (hi - lo) * share) as f32).clamp(lo as f32, hi as f32)
    });
    let reach = match inputs.below(3) {
        0 => 0.0,
        1 => f64::from(inputs.size()),
        _ => cells.size() * 3.0 * inputs.share(),
    };
    let [x, y, z] = centre;
    let case = Case::of("cells").f32s(&lo).f32s(&hi).f32s(&[widest]).f32s(&centre);
    let mut case = case.f64s(&[reach]).gives();
    for count in cells.count() {
        case = case.number(u64::from(count));
    }
    for cell in cells.around(&[x, y, z, 0.0], reach).iter().flatten().flatten() {
        case = case.number(u64::from(*cell));
    }
    case
}

/// A skin, and the share and the least length that it is made of.
fn skin(inputs: &mut Inputs) -> (Skin, [f32; 2]) {
    let least = exp2(-60) as f32;
    if inputs.below(2) == 0 {
        let share = [0.0, 0.0625, 0.25, 0.375][inputs.below(4) as usize];
        (Skin::share(share), [share, least])
    } else {
        let length = (inputs.share() * inputs.scale()) as f32;
        (Skin::length(length), [0.0, length.max(least)])
    }
}

struct CompareDrift(Skin, [[f32; 4]; 2]);

impl Kernel for CompareDrift {
    type Output = bool;
    fn run<L: Lanes>(self, l: L) -> bool {
        let [now, before] = self.1.map(|ball| ball.map(|x| l.splat(x)));
        l.bits(stays(l, self.0, now, before)) & 1 == 1
    }
}

/// A ball that drifts about as far as its skin.
fn drift(tier: Tier, inputs: &mut Inputs) -> Case {
    let (skin, numbers) = skin(inputs);
    let scale = inputs.scale();
    let before = [(); 4].map(|()| (inputs.signed() * scale) as f32);
    let radius = before[3].abs();
    let most = f64::from(skin.of(radius));
    let growth = if inputs.below(2) == 0 { 0.0 } else { most * inputs.signed() };
    let left = inputs.nearly(most - growth.max(0.0));
    let way = inputs.direction();
    let [x, y, z] = [0, 1, 2].map(|i| (f64::from(before[i]) + way[i] * left) as f32);
    let now = [x, y, z, (f64::from(radius) + growth) as f32];
    let before = [before[0], before[1], before[2], radius];
    let stays = dispatch(tier, CompareDrift(skin, [now, before]));
    let case = Case::of("stays").f32s(&numbers).f32s(&now).f32s(&before);
    case.gives().bit(stays)
}

struct MakeCube([[f32; 3]; 2]);

impl Kernel for MakeCube {
    type Output = [f32; 5];
    fn run<L: Lanes>(self, l: L) -> [f32; 5] {
        let [lower, upper] = self.0.map(|ends| ends.map(|end| l.splat(end)));
        let cube = Cube::about(l, lower, upper);
        let [x, y, z, half] = cube.outer;
        [x, y, z, half, cube.gap].map(|lanes| first_of(l, lanes))
    }
}

fn first_of<L: Lanes>(l: L, lanes: L::F) -> f32 {
    let mut numbers = [0.0; MAX_WIDTH];
    l.store(lanes, &mut numbers);
    numbers[0]
}

fn cube(tier: Tier, inputs: &mut Inputs) -> Case {
    let [a, b] = [(); 2].map(|()| inputs.vector());
    let ends = [[0, 1, 2].map(|i| a[i].min(b[i])), [0, 1, 2].map(|i| a[i].max(b[i]))];
    let found = dispatch(tier, MakeCube(ends));
    Case::of("cube").f32s(ends.as_flattened()).gives().f32s(&found)
}

/// Two cubes about to touch along an axis: whether they are apart, and whether boxes within them
/// surely meet, so that nobody compares their ends.
fn cubes(tier: Tier, inputs: &mut Inputs) -> Case {
    let scale = inputs.scale();
    let halves = [(); 2].map(|()| (inputs.share() * scale) as f32);
    let gap = match inputs.below(3) {
        0 => 0.0,
        _ => (inputs.share() * scale * exp2(-20)) as f32,
    };
    let sum = f64::from(halves[0]) + f64::from(halves[1]);
    let mut one = [(); 3].map(|()| (inputs.signed() * scale) as f32);
    one[0] = [0.0, one[0]][inputs.below(2) as usize];
    let mut other = [0, 1, 2].map(|i| (f64::from(one[i]) + inputs.signed() * sum / 2.0) as f32);
    let less = [0.0, 2.0][inputs.below(2) as usize] * f64::from(gap);
    let distance = inputs.nearly(sum - less);
    other[0] = (f64::from(one[0]) + distance) as f32;
    let pair = [[one[0], one[1], one[2], halves[0]], [other[0], other[1], other[2], halves[1]]];
    let balls = in_slots(pair);
    let slots = SlotBodies { balls: &balls, columns: &NO_COLUMNS, names: &NAMES };
    let [low, high] = [0.0, 2.0].map(|at| Aabb::new([at; 3], [at + 1.0; 3]));
    let less = less_than_sure(gap);
    let hit = |boxes: &[Aabb]| dispatch(tier, Hit(CubeTest { slots, boxes, less }));
    // The boxes' own ends are asked only where the cubes don't decide.
    let (apart, surely) = (!hit(&[low, low]), hit(&[low, high]));
    let case = Case::of("cubes").f32s(pair.as_flattened()).f32s(&[gap]).gives();
    // Of cubes that are apart nobody asks whether they surely meet.
    case.bit(apart).bit(surely)
}

struct Support {
    k: usize,
    ends: [[f32; 2]; 13],
    e: [f32; 3],
}

impl Kernel for Support {
    type Output = f32;
    fn run<L: Lanes>(self, l: L) -> f32 {
        let e = self.e.map(|x| l.splat(x));
        let ends = self.ends.map(|ends| ends.map(|end| l.splat(end)));
        let slabs = LaneSlabs { ends };
        let found = match self.k {
            6 => support::<L, 6>(l, &slabs, e),
            14 => support::<L, 14>(l, &slabs, e),
            18 => support::<L, 18>(l, &slabs, e),
            _ => support::<L, 26>(l, &slabs, e),
        };
        first_of(l, found)
    }
}

fn supports(tier: Tier, inputs: &mut Inputs) -> Case {
    let k = [6, 14, 18, 26][inputs.below(4) as usize];
    let scale = inputs.scale();
    let mut ends = [[0.0; 2]; 13];
    for &member in members_of(k) {
        ends[member] = [(); 2].map(|()| (inputs.share() * scale) as f32);
    }
    let mut e = inputs.vector();
    if inputs.below(4) == 0 {
        e[inputs.below(3) as usize] = e[0]; // ties take other branches
    }
    let found = dispatch(tier, Support { k, ends, e });
    let case = Case::of("support").number(k as u64).f32s(&e);
    case.f32s(ends.as_flattened()).gives().f32s(&[found])
}
