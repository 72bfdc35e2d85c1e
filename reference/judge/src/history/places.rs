//! Where bodies of histories are: in regions that are so far apart that bodies of two never meet.

use sdop::rounding::pose::rotation;
use sdop::volume::Shape;
use sdop::world::Body;

/// The origins of regions.
pub(super) const REGIONS: [[f64; 3]; 3] =
    [[0.0; 3], [1_073_741_824.0, -536_870_912.0, 0.0], [-1_073_741_824.0, 0.0, 268_435_456.0]];
/// Places within a region other than the first are multiples of this, so that f64 holds
/// translations.
const STEP: f64 = 1.0 / (1 << 22) as f64;
/// Nothing of a region is so far from its origin.
const RADIUS: f64 = 1.0e8;

/// The region of a body's vertices, and the place in it about which they are, exactly: a body whose
/// shape is far from its own origin has a quarter turn.
pub(super) fn place(shapes: &[Shape], body: &Body) -> (usize, [f64; 3]) {
    let offset = turned_offset(shapes, body);
    let at = [0, 1, 2].map(|axis| body.translation[axis] + offset[axis]);
    let within = |base: [f64; 3]| [0, 1, 2].map(|axis| at[axis] - base[axis]);
    let is_in = |base: &[f64; 3]| within(*base).iter().all(|x| x.abs() < RADIUS);
    let number = REGIONS.iter().position(is_in).unwrap_or(0);
    (number, within(REGIONS[number]))
}

/// The body with its vertices about such a place.
pub(super) fn placed(shapes: &[Shape], body: Body, (number, within): (usize, [f64; 3])) -> Body {
    let offset = turned_offset(shapes, &body);
    let translation = [0, 1, 2].map(|axis| {
        let in_steps =
            if number == 0 { within[axis] } else { (within[axis] / STEP).round() * STEP };
        REGIONS[number][axis] + in_steps - offset[axis]
    });
    Body { translation, ..body }
}

/// Where a shape's vertices are about, from the origin of its body.
fn turned_offset(shapes: &[Shape], body: &Body) -> [f64; 3] {
    match shapes[body.shape as usize].pose_offset {
        [0.0, 0.0, 0.0] => [0.0; 3],
        offset => {
            let turn = rotation(body.rotation);
            turn.map(|row| (0..3).map(|axis| row[axis] * offset[axis]).sum())
        }
    }
}

/// A coordinate after a step. One that f32 holds stays such a one.
pub(super) fn drifted(x: f64, by: f32) -> f64 {
    let sum = x + f64::from(by);
    if f64::from(x as f32) == x { f64::from(sum as f32) } else { sum }
}
