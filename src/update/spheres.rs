//! [`EccentricSpheres`]: spheres whose centre is not their body's origin, eight at a time.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane or axis is an index into several columns at once"
)]

use super::f64x8::{F64x8, LANES};
use super::{PREFETCH_DISTANCE, ShapeFrame};
use crate::bodies::contract::is_within_limit;
use crate::bodies::{Bodies, Places};
use crate::rounding::pose::{rotate_of, rotation_of};
use crate::rounding::sphere::{inflate_radius, rounded_ball};
use crate::simd::{Kernel, Lanes, prefetch, prefetch_ends};

/// Updates the spheres of consecutive places, of which some may have their centre at their body's
/// origin. The bits are those of [`ShapeFrame::sphere`]. Returns whether all poses and spheres that
/// depend on a rotation are within the contract.
pub struct EccentricSpheres<'a> {
    pub frames: &'a [ShapeFrame],
    pub bodies: &'a Bodies,
    pub places: &'a Places,
    /// The bodies by place whose poses are read ahead; empty if none are.
    pub ahead: &'a [u32],
    /// The place of the first sphere.
    pub first: usize,
    pub spheres: &'a mut [[f32; 4]],
}

impl Kernel for EccentricSpheres<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> bool {
        let mut sound = true;
        let mut first = self.first;
        for spheres in self.spheres.chunks_mut(LANES) {
            for place in first..first + spheres.len() {
                if let Some(&later) = self.ahead.get(place + PREFETCH_DISTANCE) {
                    prefetch_ends(&self.bodies.translation[later as usize]);
                    prefetch(&self.bodies.rotation[later as usize]);
                }
            }
            let (bodies, shapes) = (&self.places.body[first..], &self.places.shape[first..]);
            sound &= update_eight(self.frames, self.bodies, (bodies, shapes), spheres);
            first += spheres.len();
        }
        sound
    }
}

/// Updates up to eight spheres of these bodies and shapes.
#[inline(always)]
fn update_eight(
    frames: &[ShapeFrame],
    bodies: &Bodies,
    (who, shapes): (&[u32], &[u32]),
    spheres: &mut [[f32; 4]],
) -> bool {
    let (mut q, mut c) = ([F64x8::splat(0.0); 4], [F64x8::splat(0.0); 3]);
    let mut some_eccentric = false;
    for lane in 0..spheres.len() {
        let (body, frame) = (who[lane] as usize, &frames[shapes[lane] as usize]);
        if frame.inflated.is_some() {
            continue; // its rotation is elsewhere in memory, and not needed
        }
        some_eccentric = true;
        for number in 0..4 {
            q[number].0[lane] = f64::from(bodies.rotation[body][number]);
        }
        for axis in 0..3 {
            c[axis].0[lane] = f64::from(frame.centre[axis]);
        }
    }
    let turned = if some_eccentric { rotate_of(&rotation_of(q), c) } else { c };
    let mut sound = true;
    for (lane, sphere) in spheres.iter_mut().enumerate() {
        let t = bodies.translation[who[lane] as usize];
        let frame = &frames[shapes[lane] as usize];
        *sphere = match frame.inflated {
            Some(inflated) => [t[0], t[1], t[2], inflated],
            None => {
                let mut exact = [0.0; 3];
                for axis in 0..3 {
                    exact[axis] = turned[axis].0[lane] + f64::from(t[axis]);
                }
                let ([x, y, z], radius) = rounded_ball(exact, t, frame.centre, frame.radius);
                let sphere = [x, y, z, inflate_radius(radius)];
                sound &= is_within_limit(&t) && sphere.iter().all(|x| x.is_finite());
                sphere
            }
        };
    }
    sound
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::mesh::ProceduralShape;
    use crate::simd::{Tier, dispatch};
    use crate::volume::{Shape, ShapeSpec};

    /// In every tier a sphere has the bits that its body alone has, in any number of lanes and
    /// whatever its neighbours are.
    #[test]
    fn eccentric_spheres_are_those_of_single_bodies() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut number = |size: f32| size * ((random.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0);
        let (x, y, z) = (1.0, 2.5, 0.75);
        let mesh = ProceduralShape::Box { x, y, z }.build().expect("a box");
        let frames = [0.0, 0.25, 1e5].map(|by| {
            let mut moved = mesh.clone();
            moved.vertices.as_flattened_mut().iter_mut().for_each(|x| *x += by);
            let shape = Shape::build(&moved, &ShapeSpec::default()).expect("a shape");
            ShapeFrame::new(&shape, &shape.ordop.basis)
        });
        assert_eq!(frames.iter().filter(|frame| frame.inflated.is_none()).count(), 2);
        let mut bodies = Bodies::default();
        for body in 0..29 {
            let q = [(); 4].map(|()| number(2.0));
            bodies.push(body * 7 % 3, true, q, [(); 3].map(|()| number(1e3)));
        }
        let all = Places::new(&bodies);
        for tier in Tier::available() {
            for (first, len) in [(0, 29), (3, 1), (5, 8), (9, 17)] {
                let mut spheres = vec![[0.0; 4]; len];
                let kernel = EccentricSpheres {
                    frames: &frames,
                    bodies: &bodies,
                    places: &all,
                    ahead: &all.body,
                    first,
                    spheres: &mut spheres,
                };
                assert!(dispatch(tier, kernel), "{tier:?}");
                for (place, sphere) in (first..).zip(&spheres) {
                    let (body, shape) = (all.body[place] as usize, all.shape[place] as usize);
                    let alone =
                        frames[shape].sphere(bodies.rotation[body], bodies.translation[body]);
                    assert_eq!(
                        sphere.map(f32::to_bits),
                        alone.map(f32::to_bits),
                        "{tier:?} {place}"
                    );
                }
            }
        }
    }
}
