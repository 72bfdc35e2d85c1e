//! Bodies that touch in one point or face across a border, where f64 rounds their images.

use sdop::{ProceduralShape, Shape, ShapeSpec};

use super::*;

/// A cube of this side, whose faces are exact.
pub fn cube(side: f32) -> Shape {
    let [x, y, z] = [side; 3];
    let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
    let spec = ShapeSpec { axes: sdop::Axes::Model, ..ShapeSpec::default() };
    Shape::build(&mesh, &spec).unwrap()
}

/// Two cubes at these places, in either order; the pairs as the first in the order of `at` has
/// them.
fn pairs_of(shape: &Shape, at: [[f64; 3]; 2], periods: [Option<f64>; 3]) -> Vec<[i32; 3]> {
    let found = [[0, 1], [1, 0]].map(|order| {
        let mut world = PeriodicWorld::new(vec![shape.clone()], periods).unwrap();
        for which in order {
            world.insert(Body::at(0, UNTURNED, at[which])).unwrap();
        }
        let sign = if order == [0, 1] { 1 } else { -1 };
        let images = world.cull().unwrap().iter().map(|pair| pair.image.map(|n| sign * n));
        images.collect::<Vec<_>>()
    });
    let [found, turned] = found;
    assert_eq!(found, turned, "{at:?}");
    found
}

/// Cubes a few steps of an f64 in size touch across a border at which these steps double. Moving
/// one by the period rounds its place by a part of its size, away from the other or toward it.
#[test]
fn rounded_images_touch() {
    let mut random = Random::new(7);
    let (mut rounded, mut missed) = (0, 0);
    for _ in 0..2000 {
        // Steps at half of the period are 2⁻²⁴ below it and 2⁻²³ above.
        let step = 0.5_f64.powi(24);
        let half = f64::from(1 << 29) - (1 + random.below(40)) as f64 * step;
        let period = 2.0 * half;
        let side = 16.0 * step;
        let shape = cube(side as f32);
        let offset = (random.below(81) as f64 - 40.0) * step;
        let low = -half + offset;
        let high = half + (offset - side);
        let exact = (low + half == offset) && (high - half == offset - side);
        if !exact {
            continue;
        }
        let axis = random.below(3);
        let place = |x: f64| [0, 1, 2].map(|i| if i == axis { x } else { 0.0 });
        let periods = [0, 1, 2].map(|i| (i == axis).then_some(period));
        let image = [0, 1, 2].map(|i| if i == axis { -1 } else { 0 });
        let at = [place(low), place(high)];
        assert_eq!(pairs_of(&shape, at, periods), [image], "{offset} {half}");
        rounded += usize::from((low + period) - period != low);
        // And far enough apart they are not reported.
        let apart = [place(low), place(high - side)];
        missed += usize::from(pairs_of(&shape, apart, periods).is_empty());
    }
    assert!(rounded > 60 && missed > 300, "{rounded} {missed}");
}

/// Unit cubes touch in a face, an edge or a corner across one, two or three borders in any
/// directions, so that the images of both are needed.
#[test]
fn faces_edges_and_corners_touch() {
    let shape = cube(1.0);
    let lengths = [4.0, 8.0, 16.0];
    let periods = lengths.map(Some);
    let mut seen = 0;
    for signs in 0..27 {
        let signs = [signs % 3 - 1, signs / 3 % 3 - 1, signs / 9 - 1];
        for offset in [-0.5, -0.25, 0.0, 0.25, 0.5] {
            // The first is near the border that the sign names, the second on its other side.
            let border = |axis: usize| 0.5 * lengths[axis] * f64::from(signs[axis]);
            let first = [0, 1, 2].map(|axis| border(axis) + offset - 0.5 * f64::from(signs[axis]));
            for away in 0..3 {
                let away = f64::from(away - 1);
                let second = [0, 1, 2].map(|axis| {
                    let sign = f64::from(signs[axis]);
                    first[axis] + sign + 3.0 * away * lengths[axis] - sign * lengths[axis]
                });
                let image = signs.map(|sign| sign - 3 * away as i32);
                let found = pairs_of(&shape, [first, second], periods);
                assert_eq!(found, [image], "{signs:?} {offset} {away}");
                let beyond = [0, 1, 2].map(|axis| second[axis] + 0.125 * f64::from(signs[axis]));
                let found = pairs_of(&shape, [first, beyond], periods);
                assert_eq!(found.is_empty(), signs != [0; 3], "{signs:?} {offset}");
                seen += 1;
            }
        }
    }
    assert_eq!(seen, 27 * 5 * 3);
}

/// The same for boxes of nearly half a period, in every image.
#[test]
fn wide_boxes_touch_in_one_image() {
    const NONE: [i32; 0] = [];
    let period = 1.0;
    let side = 0.5_f64.next_down();
    let mut boxes = PeriodicBoxes::new([Some(period), None, None]).unwrap();
    let along_x = |lo: f64, hi: f64| PeriodicBox::new([lo, 0.0, 0.0], [hi, 1.0, 1.0]);
    let first = boxes.insert(along_x(0.0, side)).unwrap();
    let second = boxes.insert(along_x(0.5, 0.5 + 0.25)).unwrap();
    let image = |boxes: &mut PeriodicBoxes, lo: f64, hi: f64| {
        boxes.set(second, along_x(lo, hi)).unwrap();
        let pairs = boxes.cull().unwrap();
        assert!(pairs.iter().all(|pair| pair.bodies == [first, second]));
        pairs.iter().map(|pair| pair.image[0]).collect::<Vec<_>>()
    };
    assert_eq!(image(&mut boxes, 0.5, 0.75), NONE);
    assert_eq!(image(&mut boxes, side, 0.75), [0]);
    assert_eq!(image(&mut boxes, 0.75, 1.0), [-1]);
    assert_eq!(image(&mut boxes, 0.75, 1.0_f64.next_down()), NONE);
    assert_eq!(image(&mut boxes, 1.0e6 + 0.5, 1.0e6 + 0.875), NONE);
    assert_eq!(image(&mut boxes, -1.0e6 - 0.25, -1.0e6), [1_000_000]);
    assert_eq!(image(&mut boxes, -1.0e6 - 0.25, (-1.0e6_f64).next_down()), NONE);
}

/// Boxes about turned balls meet in two images, although the balls can meet in one at most.
#[test]
fn loose_volumes_meet_once() {
    let ball = ProceduralShape::default_of("icosphere").unwrap().build();
    let spec = ShapeSpec { radius: Some(0.24), axes: sdop::Axes::Model, ..ShapeSpec::default() };
    let shape = Shape::build(&ball.unwrap(), &spec).unwrap();
    let turned = [0.0, 0.0, 0.375, 1.0]; // by some 41 degrees, so that edges face each other
    let builder = sdop::Culler::builder().strategy(sdop::Strategy::Obb);
    for (distance, most) in [(0.47, 1), (0.5, 0)] {
        let periods = [Some(1.0), None, None];
        let mut world = PeriodicWorld::with(vec![shape.clone()], &builder, periods).unwrap();
        for x in [-0.5 * distance, 0.5 * distance] {
            world.insert(Body::at(0, turned, [x, 0.0, 0.0])).unwrap();
        }
        assert_eq!(world.cull().unwrap().len(), most, "{distance}");
        // The world below has both images.
        assert_eq!(world.images().pairs().len(), 2, "{distance}");
    }
}
