//! Lists of long boxes, for which a finder's balls (the cubes around the boxes) are a bad
//! approximation.

use super::TrackedBodies;
use crate::bodies::Aabb;
use crate::broad_phase::GivenBoxes;
use crate::broad_phase::ends::grown;
use crate::broad_phase::neighbours::{ListState, Neighbours, Volume};
use crate::rounding::cube::{Cube, SCALE};
use crate::simd::{Kernel, Lanes, Tier, dispatch};

/// The cube about a box, as a ball.
struct CubeAbout(Aabb);

impl Kernel for CubeAbout {
    type Output = [f32; 4];
    fn run<L: Lanes>(self, l: L) -> [f32; 4] {
        let [min, max] = [self.0.min, self.0.max].map(|corner| corner.map(|end| l.splat(end)));
        Cube::about(l, min, max).outer.map(|number| {
            let mut lanes = [0.0; crate::simd::MAX_WIDTH];
            l.store(number, &mut lanes);
            lanes[0]
        })
    }
}

/// Boxes with sides 1 : 8 : 64 in any order, the last ones of which stand still.
struct Needles {
    bodies: TrackedBodies,
    boxes: Vec<Aabb>,
    are_long: bool,
}

impl Needles {
    /// In a cube of that side.
    fn within(side: f32) -> Self {
        let around = |i: u32| {
            let centre = [7919, 104_729, 1_299_709].map(|p| (i * p % 1000) as f32 / 1000.0 * side);
            let mut half = [0.125, 1.0, 8.0];
            half.rotate_left(i as usize % 3);
            if i.is_multiple_of(2) {
                half.swap(0, 1);
            }
            let end = |sign: f32| std::array::from_fn(|k| centre[k] + sign * half[k]);
            Aabb::new(end(-1.0), end(1.0))
        };
        let boxes: Vec<Aabb> = (0..620).map(around).collect();
        let mut bodies = TrackedBodies::new(500, vec![[0.0; 4]; 620]);
        bodies.finder = Neighbours::new(Volume::Cube);
        Self { bodies, boxes, are_long: true }
    }

    fn step(&mut self) {
        let Self { bodies, boxes, .. } = self;
        for (ball, &aabb) in bodies.balls.iter_mut().zip(&*boxes) {
            *ball = dispatch(Tier::SCALAR, CubeAbout(aabb));
        }
        let all = boxes.as_slice();
        let are_long = self.are_long;
        bodies.step_with(Some(GivenBoxes { all, are_long }));
    }

    fn state(&self) -> ListState {
        self.bodies.finder.state
    }

    /// The boxes as they are listed now, grown where they move.
    fn grown(&self) -> Vec<Aabb> {
        let skin = self.bodies.finder.policy.skin();
        let each = self.boxes.iter().zip(&self.bodies.balls).enumerate();
        each.map(|(name, (&aabb, cube))| match name < self.bodies.moving {
            true => grown(aabb, SCALE * skin.of(cube[3])),
            false => aabb,
        })
        .collect()
    }
}

/// A list of long boxes holds the pairs whose grown ones meet and each once.
#[test]
fn long_box_list_has_each_pair() {
    let mut needles = Needles::within(40.0);
    for _ in 0..2 {
        needles.step();
    }
    assert_eq!(needles.state(), ListState::Made);
    assert!(needles.bodies.finder.policy.is_by_boxes());
    let (listed, grown) = (needles.bodies.candidates(true), needles.grown());
    let moving = needles.bodies.moving;
    let meets = |a: usize, b: usize| a < moving && grown[a].meets(&grown[b]);
    let wanted: Vec<[u32; 2]> = (0..620)
        .flat_map(|a| (a + 1..620).map(move |b| (a, b)))
        .filter(|&(a, b)| meets(a, b))
        .map(|(a, b)| [a as u32, b as u32])
        .collect();
    assert!(listed.values().all(|&times| times == 1));
    assert!(listed.into_keys().eq(wanted.iter().copied()));
    assert!(wanted.len() > 600, "{}", wanted.len());
}

/// One of the ends of a box.
fn end(aabb: &mut Aabb, axis: usize, is_upper: bool) -> &mut f32 {
    let Aabb { min, max } = aabb;
    if is_upper { &mut max[axis] } else { &mut min[axis] }
}

/// The cube about a box stays as it is when a short side grows.
#[test]
fn long_list_lasts_until_end_leaves() {
    for (body, axis, is_upper) in [0, 1, 17, 499]
        .into_iter()
        .flat_map(|body| [0, 1, 2].map(|axis| (body, axis)))
        .flat_map(|(body, axis)| [false, true].map(|is_upper| (body, axis, is_upper)))
    {
        let mut needles = Needles::within(40.0);
        for _ in 0..2 {
            needles.step();
        }
        let to = *end(&mut needles.grown()[body], axis, is_upper);
        let beyond = if is_upper { to.next_up() } else { to.next_down() };
        for (to, state) in [(to, ListState::Followed), (beyond, ListState::Made)] {
            needles.step();
            *end(&mut needles.boxes[body], axis, is_upper) = to;
            needles.step();
            assert_eq!(needles.state(), state, "{body}, {axis}, {is_upper}");
        }
    }
}

/// A list of boxes serves while cubes decide, and one of cubes while they don't; the next one is
/// made as the frame has it.
#[test]
fn only_long_boxes_make_box_lists() {
    let mut needles = Needles::within(200.0); // or cubes had too many neighbours
    for (are_long, jumps, by_boxes) in [
        (true, false, true),
        (false, false, true),
        (false, true, false),
        (true, false, false),
        (true, true, true),
    ] {
        needles.are_long = are_long;
        if jumps {
            let Aabb { min, max } = &mut needles.boxes[3];
            (min[1], max[1]) = (min[1] + 30.0, max[1] + 30.0);
        }
        for _ in 0..3 {
            needles.step();
        }
        let finder = &needles.bodies.finder;
        let found = (finder.state, finder.policy.is_by_boxes());
        assert_eq!(found, (ListState::Followed, by_boxes), "{are_long}, {jumps}");
    }
}
