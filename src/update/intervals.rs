//! [`Intervals`]: updates of world-aligned volumes. Slabs are fitted to the posed hull vertices in
//! each frame and rounded outward.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane or axis is an index into several columns at once"
)]

use std::ops::Range;

use super::UpdateInputs;
use super::f64x8::{F64x8, LANES};
use crate::rounding::pose::{Rotation, norm, refit, rotate_of, rotation};
use crate::rounding::{down, up};
use crate::simd::{Kernel, Lanes, dispatch};
use crate::threads::Executor;
use crate::volume::{DirectionSet, Hull, Shape};

/// Bodies that one thread updates at a time.
const BODIES_PER_TASK: usize = 32;

/// World-aligned slabs by place, fitted to the posed hull vertices in each frame and rounded
/// outward.
#[derive(Clone, Debug)]
pub struct Intervals {
    directions: DirectionSet,
    /// Hull vertices of each shape in the body frame, eight at a time. The last group is padded
    /// with its first vertex.
    hulls: Vec<Vec<[F64x8; 3]>>,
    /// `ends[place·slabs + slab]` = [lo, hi].
    pub ends: Vec<[f32; 2]>,
}

impl Intervals {
    /// Slabs for `bodies` bodies of `shapes`.
    #[must_use]
    pub fn new(directions: DirectionSet, shapes: &[Shape], bodies: usize) -> Self {
        Self {
            directions,
            hulls: shapes.iter().map(hull_in_eights).collect(),
            ends: vec![[0.0; 2]; bodies * directions.slabs()],
        }
    }

    /// Sets the hull of this number to that of a shape: replaces one, or appends the next.
    pub(crate) fn set(&mut self, hull: usize, shape: &Shape) {
        self.hulls.resize_with(self.hulls.len().max(hull + 1), Vec::new);
        self.hulls[hull] = hull_in_eights(shape);
    }

    /// Removes the hull of this number.
    pub(crate) fn clear(&mut self, hull: usize) {
        self.hulls[hull] = Vec::new();
    }

    /// Keeps the first `hulls` hulls, and frees other memory.
    pub(crate) fn shrink_to(&mut self, hulls: usize) {
        self.hulls.truncate(hulls);
        self.hulls.shrink_to_fit();
    }

    /// Room for another number of bodies.
    pub(crate) fn resize(&mut self, bodies: usize) {
        let slabs = self.directions.slabs();
        self.ends.resize(bodies * slabs, [0.0; 2]);
    }

    /// Removes all bodies and frees their memory.
    pub(crate) fn forget_bodies(&mut self) {
        self.ends = Vec::new();
    }

    /// Updates the slabs of the bodies in a range of places, and the cubes around their boxes:
    /// centre and half side.
    pub fn update(
        &mut self,
        executor: Executor<'_>,
        cubes: &mut [[f32; 4]],
        posed: UpdateInputs<'_>,
        range: Range<usize>,
    ) {
        let Executor { tier, pool } = executor;
        let coefficients = self.directions.coefficients();
        let slabs = coefficients.len();
        let (first, hulls) = (range.start, &self.hulls);
        let ends = &mut self.ends[range.start * slabs..range.end * slabs];
        pool.pieces(ends, BODIES_PER_TASK * slabs, |start, ends| {
            let refit = Refit { posed, hulls, coefficients, first: first + start / slabs, ends };
            dispatch(tier, refit);
        });
        let ends = self.ends[range.start * slabs..].chunks_exact(slabs);
        for (cube, ends) in cubes[range].iter_mut().zip(ends) {
            *cube = cube_about(ends);
        }
    }
}

fn hull_in_eights(shape: &Shape) -> Vec<[F64x8; 3]> {
    let used = Hull::of(&shape.vertices).vertices;
    let in_eights = used.chunks(LANES).map(|some| {
        let mut eights = [F64x8::splat(0.0); 3];
        for lane in 0..LANES {
            let vertex = shape.vertices[*some.get(lane).unwrap_or(&some[0]) as usize];
            for axis in 0..3 {
                eights[axis].0[lane] = f64::from(vertex[axis]);
            }
        }
        eights
    });
    in_eights.collect()
}

/// The cube around a box, whose slabs are the first three. If two boxes meet, so do their cubes.
fn cube_about(ends: &[[f32; 2]]) -> [f32; 4] {
    let mut cube = [0.0; 4];
    for (axis, &[lo, hi]) in ends[..3].iter().enumerate() {
        let [lo, hi] = [lo, hi].map(f64::from);
        let centre = (0.5 * (lo + hi)) as f32;
        let half = (hi - f64::from(centre)).max(f64::from(centre) - lo);
        cube[axis] = centre;
        cube[3] = up(half).max(cube[3]);
    }
    cube
}

/// Computes the slabs of consecutive places.
struct Refit<'a> {
    posed: UpdateInputs<'a>,
    hulls: &'a [Vec<[F64x8; 3]>],
    coefficients: &'static [[i8; 3]],
    first: usize,
    ends: &'a mut [[f32; 2]],
}

impl Kernel for Refit<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let slabs = self.coefficients.len();
        let UpdateInputs { frames, bodies, places, .. } = self.posed;
        for (place, ends) in (self.first..).zip(self.ends.chunks_exact_mut(slabs)) {
            let body = places.body[place] as usize;
            let frame = &frames[places.shape[place] as usize];
            let (turn, t) = (rotation(bodies.rotation[body]), bodies.translation[body]);
            let hull = &self.hulls[frame.shape as usize];
            fit(ends, self.coefficients, hull, &turn, t, frame.reach);
            if frame.margin > 0.0 {
                widen(ends, self.coefficients, frame.margin);
            }
        }
    }
}

/// The slabs of posed points along integer combinations of the world axes.
#[inline(always)]
fn fit(
    ends: &mut [[f32; 2]],
    coefficients: &[[i8; 3]],
    hull: &[[F64x8; 3]],
    turn: &Rotation,
    t: [f32; 3],
    reach: f32,
) {
    let mut wide = [[F64x8::splat(0.0); 3]; 3];
    let mut origin = [F64x8::splat(0.0); 3];
    for i in 0..3 {
        origin[i] = F64x8::splat(f64::from(t[i]));
        for j in 0..3 {
            wide[i][j] = F64x8::splat(turn[i][j]);
        }
    }
    let mut lo = [F64x8::splat(f64::INFINITY); 13];
    let mut hi = [F64x8::splat(f64::NEG_INFINITY); 13];
    for &vertices in hull {
        let [x, y, z] = rotate_of(&wide, vertices);
        let p = [x + origin[0], y + origin[1], z + origin[2]];
        for (slab, c) in coefficients.iter().enumerate() {
            let [x, y, z] = [
                F64x8::splat(f64::from(c[0])) * p[0],
                F64x8::splat(f64::from(c[1])) * p[1],
                F64x8::splat(f64::from(c[2])) * p[2],
            ];
            let along = (x + y) + z;
            lo[slab] = lo[slab].min(along);
            hi[slab] = hi[slab].max(along);
        }
    }
    for (slab, end) in ends.iter_mut().enumerate() {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for lane in 0..LANES {
            least = least.min(lo[slab].0[lane]);
            most = most.max(hi[slab].0[lane]);
        }
        let (lo, hi) = refit(least, most, reach, t);
        *end = [lo, hi];
    }
}

/// Moves slabs outward by `margin`.
fn widen(ends: &mut [[f32; 2]], coefficients: &[[i8; 3]], margin: f32) {
    for ([lo, hi], c) in ends.iter_mut().zip(coefficients) {
        let out = f64::from(margin) * norm(c.map(f32::from));
        (*lo, *hi) = (down(f64::from(*lo) - out), up(f64::from(*hi) + out));
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::super::ShapeFrame;
    use super::*;
    use crate::bodies::{Bodies, Places};
    use crate::mesh::ProceduralShape;
    use crate::rounding::exp2;
    use crate::simd::Tier;
    use crate::threads::Threads;
    use crate::volume::ShapeSpec;

    /// Slabs are rounded outward only once. Doing it twice would lose no pair, but report some that
    /// are apart.
    #[test]
    fn slabs_grow_by_their_margin() {
        let half = [1.0, 2.5, 0.75];
        let [x, y, z] = half.map(|half| 2.0 * half);
        let mesh = ProceduralShape::Box { x, y, z }.build().expect("a box");
        let shape = Shape::build(&mesh, &ShapeSpec::default()).expect("a shape");
        let frame = ShapeFrame::new(&shape, &shape.ordop.basis);
        let grown = frame.grown(0.25);
        let mut bodies = Bodies::default();
        let t = [3.0, -7.0, 0.5];
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], t);
        let mut intervals = Intervals::new(DirectionSet::K6, &[shape], 1);
        for (frame, margin) in [(frame, 0.0), (grown, 0.25)] {
            let posed = UpdateInputs {
                frames: &[frame].into_iter().collect(),
                bodies: &bodies,
                places: &Places::new(&bodies),
                balls: &[],
            };
            let pool = Threads::default();
            let executor = pool.executor(Tier::SCALAR);
            intervals.update(executor, &mut [[0.0; 4]], posed, 0..1);
            // All sums are numbers of f32.
            for (axis, &[lo, hi]) in intervals.ends.iter().enumerate() {
                let out = half[axis] + margin;
                let [below, above] = [t[axis] - out, t[axis] + out];
                let places = if margin > 0.0 { 2 } else { 1 };
                let [mut least, mut most] = [below, above];
                for _ in 0..places {
                    (least, most) = (least.next_down(), most.next_up());
                }
                assert!((least..below).contains(&lo), "{lo} of {below}");
                assert!(above < hi && hi <= most, "{hi} of {above}");
            }
        }
    }

    /// A cube contains its box and is as small as the box is wide.
    #[test]
    fn cube_contains_its_box_tightly() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut next = || (random.next_u32() >> 8) as f32 * exp2(-24) as f32;
        for n in 0..1000 {
            let far = exp2(n % 40 - 20) as f32;
            let ends: [[f32; 2]; 3] = std::array::from_fn(|_| {
                let lo = (next() - 0.5) * far;
                [lo, lo + next()]
            });
            let [x, y, z, half] = cube_about(&ends);
            let mut widest = 0.0_f64;
            for (centre, [lo, hi]) in [x, y, z].into_iter().zip(ends) {
                let [centre, half, lo, hi] = [centre, half, lo, hi].map(f64::from);
                assert!(centre - half <= lo && hi <= centre + half, "{ends:?}");
                let slack = exp2(-22) * lo.abs().max(hi.abs());
                widest = widest.max(0.5 * (hi - lo) + slack);
            }
            assert!(f64::from(half) <= widest * (1.0 + exp2(-22)), "{ends:?}");
        }
    }

    /// Mirrored slabs meet exactly if the true ones do, so lists of pairs can't distinguish them.
    #[test]
    fn slabs_fit_posed_vertices() {
        let vertices = [[1.0, 2.0, 3.0], [-2.0, 0.5, 1.0], [0.25, -4.0, -0.5]];
        let mut hull = [F64x8::splat(0.0); 3];
        for (axis, eight) in hull.iter_mut().enumerate() {
            eight.0 = std::array::from_fn(|lane| vertices[lane % 3][axis]);
        }
        // A quarter turn about z, then (10, −20, 30): (x, y, z) goes to (10 − y, x − 20, z + 30).
        let turn = rotation([0.0, 0.0, 1.0, 1.0]);
        let placed = vertices.map(|[x, y, z]: [f64; 3]| [10.0 - y, x - 20.0, z + 30.0]);
        let coefficients = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, -1, 0], [-1, 1, 1]];
        let mut ends = [[0.0; 2]; 6];
        fit(&mut ends, &coefficients, &[hull], &turn, [10.0, -20.0, 30.0], 5.0);
        let wide = {
            let mut wide = ends;
            widen(&mut wide, &coefficients, 0.125);
            wide
        };
        for (slab, c) in coefficients.iter().enumerate() {
            let along =
                placed.map(|p| (0..3).map(|axis| f64::from(c[axis]) * p[axis]).sum::<f64>());
            let truth =
                along.into_iter().fold([f64::MAX, f64::MIN], |[lo, hi], x| [lo.min(x), hi.max(x)]);
            let out = 0.125 * f64::from(c.map(|x: i8| x * x).iter().sum::<i8>()).sqrt();
            for (ends, out) in [(ends[slab], 0.0), (wide[slab], out)] {
                let [lo, hi] = ends.map(f64::from);
                let [beyond, above] = [truth[0] - out - lo, hi - truth[1] - out];
                assert!((0.0..2e-5).contains(&beyond), "{c:?}: {beyond}");
                assert!((0.0..2e-5).contains(&above), "{c:?}: {above}");
            }
        }
    }
}
