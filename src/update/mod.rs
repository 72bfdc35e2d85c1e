//! The update stage (the paper's Nu): poses in, world-space volumes out.
//!
//! Spheres and or-DOPs move with the body and are never fitted again. Updating a sphere copies the
//! translation (for ball-centred shapes) or transforms one point; updating an or-DOP rotates the
//! basis. Only world-aligned volumes are fitted in each frame, to hull vertices.

mod aligned_rows;
mod f64_lanes;
mod f64x8;
mod frame;
mod intervals;
pub(crate) mod offset;
pub mod row;
mod rows;
mod rows_by_number;
mod spheres;
mod window;

pub use frame::{ShapeFrame, ShapeFrames};
pub use intervals::Intervals;
pub use rows::{OrDopRows, UpdateInputs};
pub use rows_by_number::RowsByNumber;
pub use window::{MOST_ROWS, RowWindow};

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use self::spheres::EccentricSpheres;
use crate::bodies::contract::{balls_are_within_limit, is_within_limit};
use crate::bodies::{Bodies, Places, read_ahead};
use crate::simd::{dispatch, prefetch_ends};
use crate::threads::Executor;

/// How many places ahead a pose is prefetched. Neighbours in space may be anywhere in the user's
/// columns, and a cache miss takes as long as about ten updates.
const PREFETCH_DISTANCE: usize = 64;

/// The most bytes of translations that are read ahead. With more, the first ones are no longer in
/// the second-level cache when the last are read, and perhaps not in a shared third-level cache
/// either.
const MOST_READ_AHEAD_BYTES: usize = 4 << 20;

/// Bodies whose spheres one thread updates at a time: about ten microseconds.
const BODIES_PER_TASK: usize = 4096;

/// Updates the spheres (x, y, z, R) of the bodies in a range of places. Returns whether all
/// translations, and the centres that depend on a rotation, are within the contract. Checking it
/// here, where they have just been computed, costs few instructions per body
/// (`paper/results/kernels.md`).
pub fn update_spheres(
    executor: Executor<'_>,
    spheres: &mut [[f32; 4]],
    frames: &ShapeFrames,
    bodies: &Bodies,
    places: &Places,
    range: Range<usize>,
) -> bool {
    let Executor { tier, pool } = executor;
    let (first, is_sound) = (range.start, AtomicBool::new(true));
    let is_near =
        read_ahead(pool, &bodies.translation, range.len(), MOST_READ_AHEAD_BYTES, |t| t[0]);
    let ahead = if is_near { &[] } else { &*places.body };
    pool.pieces(&mut spheres[range], BODIES_PER_TASK, |start, spheres| {
        let first = first + start;
        let mut sound = true;
        if frames.are_centred() {
            let who = places.body[first..].iter().zip(&places.shape[first..]);
            for (place, (sphere, (&body, &shape))) in (first..).zip(spheres.iter_mut().zip(who)) {
                if let Some(&later) = ahead.get(place + PREFETCH_DISTANCE) {
                    prefetch_ends(&bodies.translation[later as usize]);
                }
                // The rotation is elsewhere in memory. Reading it without need doubles the time for
                // a million bodies.
                let [x, y, z] = bodies.translation[body as usize];
                // All balls are centred, so each radius is there.
                let radius = frames[shape as usize].inflated.unwrap_or(f32::NAN);
                *sphere = [x, y, z, radius];
            }
        } else {
            let kernel = EccentricSpheres { frames, bodies, places, ahead, first, spheres };
            sound = dispatch(tier, kernel);
        }
        // A centre other than the body's origin may be a little farther out than the translation.
        if !balls_are_within_limit(tier, spheres) {
            sound &= !frames.are_centred()
                && centred_within_limit(spheres, frames, &places.shape[first..]);
        }
        if !sound {
            is_sound.store(false, Ordering::Relaxed);
        }
    });
    is_sound.into_inner()
}

/// Whether the balls whose centres are translations are within the contract.
fn centred_within_limit(balls: &[[f32; 4]], frames: &[ShapeFrame], shapes: &[u32]) -> bool {
    let mut balls = balls.iter().zip(shapes);
    balls.all(|([x, y, z, radius], &shape)| {
        frames[shape as usize].inflated.is_none()
            || is_within_limit(&[*x, *y, *z]) && radius.is_finite()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use glam::Vec3;

    use super::*;
    use crate::mesh::ProceduralShape;
    use crate::rounding::LIMIT;
    use crate::rounding::pose::{rotate, rotation};
    use crate::rounding::sphere::inflate_radius;
    use crate::simd::Tier;
    use crate::threads::Threads;
    use crate::volume::{Origin, Shape, ShapeSpec};

    /// A box whose ball's centre is there.
    fn boxed(centre: [f32; 3]) -> Shape {
        let (x, y, z) = (1.0, 2.5, 0.75);
        let mut mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
        mesh.vertices
            .iter_mut()
            .for_each(|v| *v = (Vec3::from(*v) + Vec3::from(centre)).to_array());
        let spec = ShapeSpec { origin: Origin::File, ..ShapeSpec::default() };
        Shape::build(&mesh, &spec).unwrap()
    }

    /// A sum, rounded up: by [`up`] to the next f32 or the one above that.
    fn is_just_above(size: f32, sum: f64) -> bool {
        f64::from(size) >= sum && f64::from(size.next_down().next_down()) <= sum
    }

    /// A frame has the sizes of its shape and grows by the margin to the ulp.
    #[test]
    fn shape_frame_grows_by_margin() {
        for centre in [[0.0; 3], [0.5, -3.0, 0.125]] {
            let shape = boxed(centre);
            let frame = ShapeFrame::new(&shape, &shape.ordop.basis);
            let [radius, reach] = [shape.ball.radius, shape.reach];
            assert_eq!((frame.radius(), frame.reach()), (radius, reach));
            assert_eq!(frame.centre(), shape.ball.centre);
            for margin in [1e-6, 0.3, 7000.0] {
                let grown = frame.grown(margin);
                let sum = |size: f32| f64::from(size) + f64::from(margin);
                assert!(is_just_above(grown.radius(), sum(radius)), "{margin}");
                assert!(is_just_above(grown.reach(), sum(reach)), "{margin}");
                assert_eq!(grown.centre(), frame.centre());
                let (q, t) = ([0.5, -0.25, 1.0, 0.125], [3.0, -7.0, 0.5]);
                let [x, y, z, inflated] = grown.sphere(q, t);
                let offset = rotate(&rotation(q), frame.centre());
                let there: [f64; 3] = std::array::from_fn(|i| offset[i] + f64::from(t[i]));
                assert_eq!([x, y, z], there.map(|x| x as f32));
                let least = f64::from(inflate_radius(grown.radius()));
                let most = least * (1.0 + 1e-6) + 1e-6;
                assert!((least..most).contains(&f64::from(inflated)), "{inflated}");
            }
        }
    }

    /// Whether bodies with these shapes, rotations and places are within the contract.
    fn are_sound(shapes: &[Shape], bodies: &[(u32, [f32; 4], [f32; 3])]) -> bool {
        let frame = |shape: &Shape| ShapeFrame::new(shape, &shape.ordop.basis);
        let frames: ShapeFrames = shapes.iter().map(frame).collect();
        let mut columns = Bodies::default();
        for &(shape, rotation, translation) in bodies {
            columns.push(shape, true, rotation, translation);
        }
        let places = Places::new(&columns);
        let answers = Tier::available().into_iter().map(|tier| {
            let (pool, all) = (Threads::default(), 0..bodies.len());
            let executor = pool.executor(tier);
            let mut spheres = vec![[0.0; 4]; bodies.len()];
            update_spheres(executor, &mut spheres, &frames, &columns, &places, all)
        });
        let answers: Vec<bool> = answers.collect();
        assert_eq!(answers, vec![answers[0]; answers.len()]);
        answers[0]
    }

    /// A body off its ball's centre is judged by its pose and others by their ball.
    #[test]
    fn eccentric_bodies_are_checked_by_pose() {
        let shapes = [boxed([0.0; 3]), boxed([LIMIT / 4.0, 0.0, 0.0])];
        let (still, no_turn, at) = ([0.0, 0.0, 0.0, 1.0], [0.0; 4], [3.0, -7.0, 0.5]);
        let [near, edge, beyond] = [LIMIT / 2.0, LIMIT, LIMIT.next_up()].map(|x| [x, 0.0, 0.0]);
        let back = [-LIMIT.next_up(), 0.0, 0.0];
        let (plain, off) = (0, 1);
        for (bodies, sound) in [
            (vec![(plain, still, edge)], true),
            (vec![(plain, still, beyond)], false),
            (vec![(off, still, near)], true),
            // Only its ball's centre is beyond the limit.
            (vec![(off, still, edge)], true),
            // Its ball's centre alone is within.
            (vec![(off, still, back)], false),
            (vec![(off, no_turn, at)], false),
            (vec![(off, still, edge), (plain, still, edge)], true),
            (vec![(off, still, edge), (plain, still, beyond)], false),
            (vec![(plain, still, back), (off, still, edge)], false),
        ] {
            assert_eq!(are_sound(&shapes, &bodies), sound, "{bodies:?}");
        }
    }
}
