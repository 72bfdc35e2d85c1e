//! [`OrDopRows`]: or-DOP updates. The basis is rotated with the body, and its slabs stay.
//!
//! Rows are computed for sixteen bodies at a time in every tier.

use std::ops::Range;

use super::PREFETCH_DISTANCE;
use super::aligned_rows::AlignedRows;
use super::f64_lanes::F64Lanes;
use super::frame::{BASIS, CENTRE, INVERSE_LENGTHS, ShapeFrames};
use super::row::{O, Q, S, SHAPE, T};
use crate::bodies::Bodies;
use crate::bodies::Places;
use crate::rounding::pose::{axes_of, rotate_of, rotation_of};
use crate::simd::{
    Kernel, Lanes, MAX_WIDTH, ROW, Tier, dispatch, prefetch, prefetch_ends, turn_rows,
};
use crate::threads::Executor;

/// Bodies whose rows one thread computes at a time: a few microseconds.
const ROWS_PER_TASK: usize = 512;

/// Bodies whose rows are computed together.
pub(super) const BODIES_PER_BATCH: usize = MAX_WIDTH;

/// or-DOP rows by place, each with the frame in which it was last computed.
#[derive(Clone, Debug, Default)]
pub struct OrDopRows {
    /// One row per body.
    pub rows: AlignedRows,
    made: Vec<u32>,
    missing: Vec<u32>,
}

/// The inputs of an or-DOP update.
#[derive(Clone, Copy)]
pub struct UpdateInputs<'a> {
    /// The frames of all shapes.
    pub frames: &'a ShapeFrames,
    /// The bodies, with their poses.
    pub bodies: &'a Bodies,
    /// The body in each place.
    pub places: &'a Places,
    /// Updated spheres by place, or an empty slice. If the centre of each ball is its body's
    /// origin, translations are read from here in order, instead of from the user's columns in
    /// random order.
    pub balls: &'a [[f32; 4]],
}

impl OrDopRows {
    /// Rows for `bodies` bodies.
    #[must_use]
    pub fn new(bodies: usize) -> Self {
        let mut rows = Self::default();
        rows.resize(bodies);
        rows
    }

    /// Room for another number of bodies.
    pub(crate) fn resize(&mut self, bodies: usize) {
        self.rows.resize(bodies);
        self.made.resize(bodies, 0);
    }

    /// Updates the rows of the bodies in a range of places. `stamp` is the number of the frame,
    /// from 1.
    pub fn update(
        &mut self,
        executor: Executor<'_>,
        posed: UpdateInputs<'_>,
        range: Range<usize>,
        stamp: u32,
    ) {
        let Executor { tier, pool } = executor;
        let first = range.start;
        self.made[range.clone()].fill(stamp);
        pool.pieces(&mut self.rows[range], ROWS_PER_TASK, |start, rows| {
            let first = first + start;
            dispatch(tier, ConsecutiveRows { posed, first, rows });
        });
    }

    /// Lazily updates the rows in the places `wanted` whose bodies move and whose rows are not yet
    /// computed in this frame. Returns how many it computed.
    pub fn update_missing(
        &mut self,
        tier: Tier,
        posed: UpdateInputs<'_>,
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
        let (places, rows) = (self.missing.as_slice(), &mut *self.rows);
        dispatch(tier, ListedRows { posed, places, rows });
        self.missing.len() as u64
    }
}

/// Computes the rows of consecutive places.
pub(super) struct ConsecutiveRows<'a> {
    pub posed: UpdateInputs<'a>,
    pub first: usize,
    pub rows: &'a mut [[f32; ROW]],
}

impl Kernel for ConsecutiveRows<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let places = self.posed.places;
        let mut first = self.first;
        for rows in self.rows.chunks_mut(BODIES_PER_BATCH) {
            self.posed.prefetch(first + PREFETCH_DISTANCE);
            let (count, here) = (rows.len(), first..first + rows.len());
            let (bodies, shapes) = (&places.body[here.clone()], &places.shape[here]);
            match (bodies.first_chunk(), shapes.first_chunk(), rows.first_chunk_mut()) {
                (Some(bodies), Some(shapes), Some(rows)) => {
                    let mut buffer = [[0.0; 4]; BODIES_PER_BATCH];
                    let origins = self.posed.origins(first, bodies, &mut buffer);
                    self.posed.make(l, (bodies, shapes), origins, rows);
                }
                _ => {
                    let last = first + count - 1;
                    let places = std::array::from_fn(|lane| (first + lane).min(last) as u32);
                    let mut made = [[0.0; ROW]; BODIES_PER_BATCH];
                    self.posed.make_listed(l, &places, &mut made);
                    rows.copy_from_slice(&made[..count]);
                }
            }
            first += BODIES_PER_BATCH;
        }
    }
}

/// Computes the rows of listed places.
struct ListedRows<'a> {
    posed: UpdateInputs<'a>,
    places: &'a [u32],
    rows: &'a mut [[f32; ROW]],
}

impl Kernel for ListedRows<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let mut made = [[0.0; ROW]; BODIES_PER_BATCH];
        for some in self.places.chunks(BODIES_PER_BATCH) {
            let mut places = [some[0]; BODIES_PER_BATCH];
            places[..some.len()].copy_from_slice(some);
            self.posed.make_listed(l, &places, &mut made);
            for (&place, row) in some.iter().zip(&made) {
                self.rows[place as usize] = *row;
            }
        }
    }
}

impl UpdateInputs<'_> {
    /// Prefetches the poses of the bodies in sixteen places, from `place` on.
    #[inline(always)]
    fn prefetch(&self, place: usize) {
        let end = self.places.body.len();
        for &body in &self.places.body[place.min(end)..end.min(place + BODIES_PER_BATCH)] {
            prefetch(&self.bodies.rotation[body as usize]);
            if !self.balls_are_at_origins() {
                prefetch_ends(&self.bodies.translation[body as usize]);
            }
        }
    }

    /// Whether translations can be read from the balls.
    #[inline(always)]
    fn balls_are_at_origins(&self) -> bool {
        self.frames.are_centred() && !self.balls.is_empty()
    }

    /// The translations of the bodies in sixteen places from `first` on, as the first three numbers
    /// of quads: the balls themselves, or otherwise gathered into `buffer`.
    #[inline(always)]
    fn origins<'b>(
        &'b self,
        first: usize,
        bodies: &[u32; BODIES_PER_BATCH],
        buffer: &'b mut [[f32; 4]; BODIES_PER_BATCH],
    ) -> &'b [[f32; 4]; BODIES_PER_BATCH] {
        match self.balls.get(first..).and_then(<[_]>::first_chunk) {
            Some(balls) if self.balls_are_at_origins() => balls,
            _ => self.gather(bodies, buffer),
        }
    }

    /// Gathers translations as the first three numbers of quads.
    #[inline(always)]
    fn gather<'b>(
        &self,
        bodies: &[u32; BODIES_PER_BATCH],
        buffer: &'b mut [[f32; 4]; BODIES_PER_BATCH],
    ) -> &'b [[f32; 4]; BODIES_PER_BATCH] {
        for (origin, &body) in buffer.iter_mut().zip(bodies) {
            let [x, y, z] = self.bodies.translation[body as usize];
            *origin = [x, y, z, 0.0];
        }
        buffer
    }

    /// The rows of the bodies in any sixteen places.
    #[inline(always)]
    fn make_listed<L: Lanes>(
        &self,
        l: L,
        places: &[u32; BODIES_PER_BATCH],
        rows: &mut [[f32; ROW]; BODIES_PER_BATCH],
    ) {
        let (mut bodies, mut shapes) = ([0; BODIES_PER_BATCH], [0; BODIES_PER_BATCH]);
        for (lane, &place) in places.iter().enumerate() {
            bodies[lane] = self.places.body[place as usize];
            shapes[lane] = self.places.shape[place as usize];
        }
        let mut buffer = [[0.0; 4]; BODIES_PER_BATCH];
        let origins = self.gather(&bodies, &mut buffer);
        self.make(l, (&bodies, &shapes), origins, rows);
    }

    /// Computes the rows (Q, t, o, shape) of sixteen bodies; the first three numbers of each of
    /// `origins` are the translation. Inputs are transposed to columns and results back to rows, a
    /// vector at a time. Doing this number by number would take longer than the arithmetic.
    #[inline(always)]
    fn make<L: Lanes>(
        &self,
        l: L,
        (bodies, shapes): (&[u32; BODIES_PER_BATCH], &[u32; BODIES_PER_BATCH]),
        origins: &[[f32; 4]; BODIES_PER_BATCH],
        rows: &mut [[f32; ROW]; BODIES_PER_BATCH],
    ) {
        let (mut codes, mut made) = ([0; BODIES_PER_BATCH], [[0.0; BODIES_PER_BATCH]; ROW]);
        for lane in 0..BODIES_PER_BATCH {
            // Fits, because the contract allows fewer bodies than there are codes.
            codes[lane] = bodies[lane] << 4;
            made[S][lane] = f32::from_bits(SHAPE + shapes[lane]);
        }
        let are_centred = self.frames.are_centred();
        let mut start = 0;
        while start < BODIES_PER_BATCH {
            // Loops, because closures would be compiled without the tier's features.
            let q = l.gather_quads(&self.bodies.rotation, &codes[start..]);
            let record = l.load_transposed(&self.frames.records, &shapes[start..]);
            let translation = l.load_quads(&origins[start..]);
            let zero = F64Lanes(l, l.splat_f64(0.0));
            let (mut pose, mut shape) = ([zero; 4], [zero; ROW]);
            for (number, q) in pose.iter_mut().zip(q) {
                *number = F64Lanes::of(l, q);
            }
            for (number, entry) in shape.iter_mut().zip(record) {
                *number = F64Lanes::of(l, entry);
            }
            let basis =
                [column(&shape, BASIS), column(&shape, BASIS + 3), column(&shape, BASIS + 6)];
            let unit =
                (shape[INVERSE_LENGTHS] + shape[INVERSE_LENGTHS + 1]) + shape[INVERSE_LENGTHS + 2];
            let turn = rotation_of(pose);
            let axes = axes_of(&turn, basis, unit);
            for (number, along) in axes.as_flattened().iter().enumerate() {
                l.store(along.rounded(), &mut made[Q + number][start..]);
            }
            for (number, along) in translation.iter().take(3).enumerate() {
                l.store(*along, &mut made[T + number][start..]);
            }
            if !are_centred {
                let centre = [record[CENTRE], record[CENTRE + 1], record[CENTRE + 2]];
                let zero = l.splat(0.0);
                let is_apart = l.gt(l.abs(centre[0]), zero)
                    | l.gt(l.abs(centre[1]), zero)
                    | l.gt(l.abs(centre[2]), zero);
                let offset = rotate_of(&turn, column(&shape, CENTRE));
                for (number, along) in offset.iter().enumerate() {
                    let along = l.select(is_apart, along.rounded(), zero);
                    l.store(along, &mut made[O + number][start..]);
                }
            }
            start += L::WIDTH;
        }
        turn_rows(l, &made, rows);
    }
}

/// Three consecutive numbers.
#[inline(always)]
fn column<N: Copy>(numbers: &[N; ROW], first: usize) -> [N; 3] {
    [numbers[first], numbers[first + 1], numbers[first + 2]]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::rounding::pose::{rotate, rotation, world_axes};
    use crate::threads::Threads;
    use crate::update::ShapeFrame;
    use crate::volume::{Axes, Shape, ShapeSpec};
    use crate::{mesh::ProceduralShape, volume::Origin};

    /// A box about the origin, and one whose ball is centred elsewhere.
    fn shapes() -> Vec<Shape> {
        let form = ProceduralShape::Box { x: 1.0, y: 2.5, z: 0.75 };
        [Vec3::ZERO, Vec3::new(0.5, -3.0, 0.125)]
            .into_iter()
            .filter_map(|offset| {
                let mut mesh = form.build().ok()?;
                for vertex in &mut mesh.vertices {
                    *vertex = (Vec3::from(*vertex) + offset).to_array();
                }
                let spec = ShapeSpec {
                    origin: Origin::File,
                    axes: Axes::Principal,
                    ..ShapeSpec::default()
                };
                Shape::build(&mesh, &spec).ok()
            })
            .collect()
    }

    /// Every lane of every tier computes what one f64 would.
    #[test]
    fn every_lane_matches_plain_f64() {
        let shapes = shapes();
        let frames: ShapeFrames =
            shapes.iter().map(|s| ShapeFrame::new(s, &s.ordop.basis)).collect();
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
        let posed = UpdateInputs { frames: &frames, bodies: &bodies, places: &places, balls: &[] };
        let expected = |body: usize| {
            let (shape, turn) = (body % 2, rotation(bodies.rotation[body]));
            let basis = shapes[shape].ordop.basis.columns;
            let offset = rotate(&turn, shapes[shape].ball.centre);
            let mut row = [0.0; ROW];
            row[Q..Q + 9].copy_from_slice(world_axes(&turn, basis).as_flattened());
            row[T..T + 3].copy_from_slice(&bodies.translation[body]);
            if shape == 1 {
                row[O..O + 3].copy_from_slice(&offset.map(|x| x as f32));
            }
            row[S] = f32::from_bits(SHAPE + shape as u32);
            row
        };
        for body in 0..61 {
            let frame = &frames[body % 2];
            let (q, t) = (bodies.rotation[body], bodies.translation[body]);
            let row = frame.row(body as u32 % 2, q, t);
            assert_eq!(row.map(f32::to_bits), expected(body).map(f32::to_bits));
        }
        for tier in Tier::available() {
            let (mut eager, mut lazy) = (OrDopRows::new(61), OrDopRows::new(61));
            let pool = Threads::default();
            eager.update(pool.executor(tier), posed, 0..61, 1);
            let wanted: Vec<u32> = (0..61).chain(0..30).collect();
            assert_eq!(lazy.update_missing(tier, posed, &wanted, 1), 61);
            for body in 0..61 {
                let bits = |row: &[f32; ROW]| row.map(f32::to_bits);
                assert_eq!(bits(&eager.rows[body]), bits(&expected(body)), "{tier}: {body}");
                assert_eq!(bits(&lazy.rows[body]), bits(&expected(body)), "{tier}: {body}");
            }
        }
    }
}
