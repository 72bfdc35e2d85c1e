//! or-DOP updates: the basis is turned with the body, its slabs stay.
//!
//! Eight bodies at a time. A row takes eighteen divisions of f64, a vector of which costs little more than one alone.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane or axis is an index into several columns at once"
)]

use std::ops::Range;

use super::ShapeFrame;
use super::eight::{EIGHT, Eight};
use crate::crew::Crew;
use crate::overlap::ordop::{O, Q, S, SHAPE, T};
use crate::places::Places;
use crate::rounding::pose::{axes_of, rotation_of};
use crate::scene::bodies::Bodies;
use crate::simd::{Kernel, Lanes, Level, ROW, dispatch};

/// Bodies whose rows one thread makes at a time: some microseconds.
const ROWS: usize = 512;

/// or-DOP rows by place, each with the frame in which it was last made.
#[derive(Clone, Debug, Default)]
pub struct OrDopRows {
    /// One row a body.
    pub rows: Vec<[f32; ROW]>,
    made: Vec<u32>,
    missing: Vec<u32>,
}

/// What rows are made from.
#[derive(Clone, Copy)]
pub struct Posed<'a> {
    /// Of every shape.
    pub frames: &'a [ShapeFrame],
    /// The poses.
    pub bodies: &'a Bodies,
    /// Who stands where.
    pub places: &'a Places,
}

impl OrDopRows {
    /// Room for `bodies` bodies.
    #[must_use]
    pub fn new(bodies: usize) -> Self {
        let mut rows = Self::default();
        rows.resize(bodies);
        rows
    }

    /// Room for another number of bodies.
    pub(crate) fn resize(&mut self, bodies: usize) {
        self.rows.resize(bodies, [0.0; ROW]);
        self.made.resize(bodies, 0);
    }

    /// Updates the rows of the bodies in a range of places; `stamp` counts frames from 1.
    pub fn update(
        &mut self,
        level: Level,
        crew: &Crew,
        posed: Posed<'_>,
        range: Range<usize>,
        stamp: u32,
    ) {
        let first = range.start;
        self.made[range.clone()].fill(stamp);
        crew.pieces(&mut self.rows[range], ROWS, |start, rows| {
            let first = first + start;
            dispatch(level, InTurn { posed, first, rows });
        });
    }

    /// Lazily updates the rows in the places `wanted` whose bodies move and whose rows are not yet made in this frame. Returns
    /// how many were made.
    pub fn update_missing(
        &mut self,
        level: Level,
        posed: Posed<'_>,
        wanted: &[u32],
        stamp: u32,
    ) -> u64 {
        self.missing.clear();
        for &place in wanted {
            let at = place as usize;
            if at < posed.places.moving && self.made[at] != stamp {
                self.made[at] = stamp;
                self.missing.push(place);
            }
        }
        let (places, rows) = (self.missing.as_slice(), self.rows.as_mut_slice());
        dispatch(
            level,
            Listed {
                posed,
                places,
                rows,
            },
        );
        self.missing.len() as u64
    }
}

/// Rows of consecutive places.
struct InTurn<'a> {
    posed: Posed<'a>,
    first: usize,
    rows: &'a mut [[f32; ROW]],
}

impl Kernel for InTurn<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let (mut place, mut made) = (self.first as u32, [[0.0; ROW]; EIGHT]);
        for rows in self.rows.chunks_mut(EIGHT) {
            let last = place + rows.len() as u32 - 1;
            let mut places = [last; EIGHT];
            for entry in &mut places {
                *entry = place.min(last);
                place += 1;
            }
            self.posed.make(&places, &mut made);
            rows.copy_from_slice(&made[..rows.len()]);
        }
    }
}

/// Rows of listed places.
struct Listed<'a> {
    posed: Posed<'a>,
    places: &'a [u32],
    rows: &'a mut [[f32; ROW]],
}

impl Kernel for Listed<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let mut made = [[0.0; ROW]; EIGHT];
        for some in self.places.chunks(EIGHT) {
            let mut places = [some[0]; EIGHT];
            places[..some.len()].copy_from_slice(some);
            self.posed.make(&places, &mut made);
            for (&place, row) in some.iter().zip(&made) {
                self.rows[place as usize] = *row;
            }
        }
    }
}

impl Posed<'_> {
    /// The rows (Q, t, o, shape) of the bodies in eight places.
    #[inline(always)]
    fn make(&self, places: &[u32; EIGHT], rows: &mut [[f32; ROW]; EIGHT]) {
        let zero = Eight::splat(0.0);
        let (mut q, mut basis, mut scale) = ([zero; 4], [[zero; 3]; 3], zero);
        for lane in 0..EIGHT {
            let place = places[lane] as usize;
            let (body, shape) = (self.places.body[place] as usize, self.places.shape[place]);
            let frame = &self.frames[shape as usize];
            let rotation = &self.bodies.rotation[body];
            for i in 0..4 {
                q[i].0[lane] = f64::from(rotation[i]);
            }
            for j in 0..3 {
                for i in 0..3 {
                    basis[j][i].0[lane] = f64::from(frame.basis[j][i]);
                }
            }
            scale.0[lane] = frame.scale;
            let row = &mut rows[lane];
            row[T..T + 3].copy_from_slice(&self.bodies.translation[body]);
            row[O..O + 3].fill(0.0);
            row[S] = f32::from_bits(SHAPE + shape);
        }
        let turn = rotation_of(q);
        let axes = axes_of(&turn, basis, scale);
        for j in 0..3 {
            for i in 0..3 {
                let along = axes[j][i].rounded();
                for lane in 0..EIGHT {
                    rows[lane][Q + 3 * j + i] = along[lane];
                }
            }
        }
        for lane in 0..EIGHT {
            let shape = self.places.shape[places[lane] as usize];
            let centre = &self.frames[shape as usize].centre;
            if *centre != [0.0; 3] {
                for i in 0..3 {
                    let [x, y, z] = [
                        f64::from(centre[0]),
                        f64::from(centre[1]),
                        f64::from(centre[2]),
                    ];
                    let offset =
                        turn[i][0].0[lane] * x + turn[i][1].0[lane] * y + turn[i][2].0[lane] * z;
                    rows[lane][O + i] = offset as f32;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::rounding::pose::{rotate, rotation, world_axes};
    use crate::volume::{Axes, Shape, ShapeSpec};
    use crate::{mesh::ProceduralShape, volume::Origin};

    /// A box about the origin, and one whose ball is centred elsewhere.
    fn shapes() -> Vec<Shape> {
        let form = ProceduralShape::Box {
            x: 1.0,
            y: 2.5,
            z: 0.75,
        };
        [Vec3::ZERO, Vec3::new(0.5, -3.0, 0.125)]
            .into_iter()
            .filter_map(|offset| {
                let mut mesh = form.build().ok()?;
                mesh.vertices.iter_mut().for_each(|v| *v += offset);
                let spec = ShapeSpec {
                    origin: Origin::File,
                    axes: Axes::Principal,
                    ..ShapeSpec::default()
                };
                Shape::build(&mesh, &spec).ok()
            })
            .collect()
    }

    #[test]
    fn every_lane_of_every_tier_computes_what_one_f64_would() {
        let shapes = shapes();
        let frames: Vec<_> = shapes
            .iter()
            .map(|s| ShapeFrame::new(s, &s.ordop.basis))
            .collect();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut number = |exponent: i32| {
            let x = (random.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0;
            x * 2.0f32.powi(exponent)
        };
        let mut bodies = Bodies::default();
        for body in 0..61 {
            // Quaternions of any norm, subnormal and huge ones too.
            let exponent = [0, 1, 40, -70, 63, -130][body % 6];
            let rotation = [(); 4].map(|()| number(exponent));
            bodies.push(body as u32 % 2, true, rotation, [(); 3].map(|()| number(9)));
        }
        let places = Places::new(&bodies);
        let posed = Posed {
            frames: &frames,
            bodies: &bodies,
            places: &places,
        };
        let expected = |body: usize| {
            let (shape, turn) = (body % 2, rotation(bodies.rotation[body]));
            let basis = shapes[shape].ordop.basis.columns.map(|c| c.to_array());
            let offset = rotate(&turn, shapes[shape].ball.centre.to_array());
            let mut row = [0.0; ROW];
            row[Q..Q + 9].copy_from_slice(world_axes(&turn, basis).as_flattened());
            row[T..T + 3].copy_from_slice(&bodies.translation[body]);
            if shape == 1 {
                row[O..O + 3].copy_from_slice(&offset.map(|x| x as f32));
            }
            row[S] = f32::from_bits(SHAPE + shape as u32);
            row
        };
        for level in Level::available() {
            let (mut eager, mut lazy) = (OrDopRows::new(61), OrDopRows::new(61));
            eager.update(level, &Crew::default(), posed, 0..61, 1);
            let wanted: Vec<u32> = (0..61).chain(0..30).collect();
            assert_eq!(lazy.update_missing(level, posed, &wanted, 1), 61);
            for body in 0..61 {
                let bits = |row: &[f32; ROW]| row.map(f32::to_bits);
                assert_eq!(
                    bits(&eager.rows[body]),
                    bits(&expected(body)),
                    "{level}: {body}"
                );
                assert_eq!(
                    bits(&lazy.rows[body]),
                    bits(&expected(body)),
                    "{level}: {body}"
                );
            }
        }
    }
}
