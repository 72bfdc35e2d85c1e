//! The update stage (the paper's Nu): poses in, world-space volumes out.
//!
//! A body's volumes move, they are never re-fitted: a sphere update is a copy of the translation (ball-centred shapes) or one
//! transformed point, an or-DOP update turns the basis. World-aligned volumes alone are re-fitted, from hull vertices.

use std::ops::Range;

use crate::crew::Crew;
use crate::overlap::ordop::{O, Q, S, SHAPE, T};
use crate::places::Places;
use crate::rounding::pose::{Rotation, norm, refit, rotate, rotation, transform, world_axes};
use crate::rounding::sphere::{inflate_radius, world_ball};
use crate::rounding::{down, up};
use crate::scene::bodies::Bodies;
use crate::simd::ROW;
use crate::volume::{Basis, DirectionSet, Hull, Shape};

/// What updating a body needs to know of its shape.
#[derive(Clone, Debug)]
pub struct ShapeFrame {
    /// The shape, and how far it is grown.
    shape: u32,
    margin: f32,
    centre: [f32; 3],
    radius: f32,
    /// R, if the ball's centre is the body's origin: no pose changes it then.
    inflated: Option<f32>,
    reach: f32,
    basis: [[f32; 3]; 3],
}

impl ShapeFrame {
    /// The frame of a shape whose or-DOP stands on `basis`.
    #[must_use]
    pub fn new(shape: &Shape, basis: &Basis) -> Self {
        let frame = Self {
            shape: 0,
            margin: 0.0,
            centre: shape.ball.centre.to_array(),
            radius: 0.0,
            inflated: None,
            reach: shape.reach,
            basis: basis.columns.map(|column| column.to_array()),
        };
        frame.with_radius(shape.ball.radius)
    }

    /// The same with another radius about the ball's centre.
    #[must_use]
    pub fn with_radius(self, radius: f32) -> Self {
        let centred = self.centre == [0.0; 3];
        Self {
            radius,
            inflated: centred.then(|| inflate_radius(radius)),
            ..self
        }
    }

    /// The same as that of the shape of this number, whose hull world-aligned volumes are fitted to.
    #[must_use]
    pub fn numbered(self, shape: u32) -> Self {
        Self { shape, ..self }
    }

    /// The same, grown by `margin` all around.
    #[must_use]
    pub fn grown(&self, margin: f32) -> Self {
        let grow = |size: f32| up(f64::from(size) + f64::from(margin));
        let frame = Self {
            margin,
            reach: grow(self.reach),
            ..*self
        };
        frame.with_radius(grow(self.radius))
    }

    /// The ball's radius, not inflated.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The ball's centre, body frame.
    #[must_use]
    pub fn centre(&self) -> [f32; 3] {
        self.centre
    }

    /// What no point of the shape is farther from the body origin than.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// Inflated world sphere (x, y, z, R) of a body in this shape.
    #[inline]
    #[must_use]
    pub fn sphere(&self, q: [f32; 4], t: [f32; 3]) -> [f32; 4] {
        let (centre, inflated) = match self.inflated {
            Some(inflated) => (t, inflated),
            None => {
                let (centre, radius) = world_ball(&rotation(q), t, self.centre, self.radius);
                (centre, inflate_radius(radius))
            }
        };
        [centre[0], centre[1], centre[2], inflated]
    }

    /// The or-DOP row (Q, t, o) of a body in this shape.
    #[inline]
    #[must_use]
    pub fn row(&self, q: [f32; 4], t: [f32; 3]) -> [f32; ROW] {
        let turn = rotation(q);
        let mut row = [0.0; ROW];
        for (j, axis) in world_axes(&turn, self.basis).into_iter().enumerate() {
            row[Q + 3 * j..Q + 3 * j + 3].copy_from_slice(&axis);
        }
        row[T..T + 3].copy_from_slice(&t);
        if self.centre != [0.0; 3] {
            let offset = rotate(&turn, self.centre).map(|x| x as f32);
            row[O..O + 3].copy_from_slice(&offset);
        }
        row
    }
}

/// or-DOP rows by place, each with the frame in which it was last made.
#[derive(Clone, Debug, Default)]
pub struct OrDopRows {
    /// One row a body.
    pub rows: Vec<[f32; ROW]>,
    made: Vec<u32>,
}

/// Bodies whose spheres, and whose rows, one thread updates at a time: some ten microseconds.
const SPHERES: usize = 4096;
const ROWS: usize = 256;

/// Updates the spheres (x, y, z, R) of the bodies in a range of places.
pub fn update_spheres(
    crew: &Crew,
    spheres: &mut [[f32; 4]],
    frames: &[ShapeFrame],
    bodies: &Bodies,
    places: &Places,
    range: Range<usize>,
) {
    let first = range.start;
    crew.pieces(&mut spheres[range], SPHERES, |start, spheres| {
        let start = first + start;
        let who = places.body[start..].iter().zip(&places.shape[start..]);
        for (sphere, (&body, &shape)) in spheres.iter_mut().zip(who) {
            let (body, frame) = (body as usize, &frames[shape as usize]);
            let t = bodies.translation[body];
            // The rotation lies elsewhere in memory: reading it for nothing doubles the time of a million bodies.
            *sphere = match frame.inflated {
                Some(inflated) => [t[0], t[1], t[2], inflated],
                None => frame.sphere(bodies.rotation[body], t),
            };
        }
    });
}

impl OrDopRows {
    /// Room for `bodies` bodies.
    #[must_use]
    pub fn new(bodies: usize) -> Self {
        Self {
            rows: vec![[0.0; ROW]; bodies],
            made: vec![0; bodies],
        }
    }

    /// Room for another number of bodies.
    pub(crate) fn resize(&mut self, bodies: usize) {
        self.rows.resize(bodies, [0.0; ROW]);
        self.made.resize(bodies, 0);
    }

    /// Updates the rows of the bodies in a range of places; `stamp` counts frames from 1.
    pub fn update(
        &mut self,
        crew: &Crew,
        frames: &[ShapeFrame],
        bodies: &Bodies,
        places: &Places,
        range: Range<usize>,
        stamp: u32,
    ) {
        let first = range.start;
        self.made[range.clone()].fill(stamp);
        crew.pieces(&mut self.rows[range], ROWS, |start, rows| {
            for (row, place) in rows.iter_mut().zip(first + start..) {
                *row = row_of(frames, bodies, places, place);
            }
        });
    }

    /// Lazily updates the rows in the places `wanted` whose bodies move and whose rows are not yet made in this frame. Returns
    /// how many were made.
    pub fn update_missing(
        &mut self,
        frames: &[ShapeFrame],
        bodies: &Bodies,
        places: &Places,
        wanted: &[u32],
        stamp: u32,
    ) -> u64 {
        let mut made = 0;
        for &place in wanted {
            let place = place as usize;
            if place < places.moving && self.made[place] != stamp {
                self.rows[place] = row_of(frames, bodies, places, place);
                self.made[place] = stamp;
                made += 1;
            }
        }
        made
    }
}

fn row_of(frames: &[ShapeFrame], bodies: &Bodies, places: &Places, place: usize) -> [f32; ROW] {
    let (body, shape) = (places.body[place] as usize, places.shape[place]);
    let frame = &frames[shape as usize];
    let mut row = frame.row(bodies.rotation[body], bodies.translation[body]);
    row[S] = f32::from_bits(SHAPE + shape);
    row
}

/// World-aligned slabs by place, re-fitted each frame from the hull's vertices and rounded outward.
#[derive(Clone, Debug)]
pub struct Intervals {
    directions: DirectionSet,
    /// Hull vertices of each shape, body frame.
    hulls: Vec<Vec<[f32; 3]>>,
    /// `ends[place·slabs + slab]` = [lo, hi].
    pub ends: Vec<[f32; 2]>,
}

impl Intervals {
    /// Room for `bodies` bodies in `shapes`.
    #[must_use]
    pub fn new(directions: DirectionSet, shapes: &[Shape], bodies: usize) -> Self {
        let hull = |shape: &Shape| {
            let used = Hull::of(&shape.vertices).vertices;
            used.iter()
                .map(|&v| shape.vertices[v as usize].to_array())
                .collect()
        };
        Self {
            directions,
            hulls: shapes.iter().map(hull).collect(),
            ends: vec![[0.0; 2]; bodies * directions.slabs()],
        }
    }

    /// Room for another number of bodies.
    pub(crate) fn resize(&mut self, bodies: usize) {
        let slabs = self.directions.slabs();
        self.ends.resize(bodies * slabs, [0.0; 2]);
    }

    /// Re-fits the slabs of the bodies in a range of places, and the cubes about their boxes: centre and half side.
    pub fn update(
        &mut self,
        cubes: &mut [[f32; 4]],
        frames: &[ShapeFrame],
        bodies: &Bodies,
        places: &Places,
        range: Range<usize>,
    ) {
        let coefficients = self.directions.coefficients();
        for place in range {
            let body = places.body[place] as usize;
            let frame = &frames[places.shape[place] as usize];
            let (turn, t) = (rotation(bodies.rotation[body]), bodies.translation[body]);
            let ends = &mut self.ends[place * coefficients.len()..][..coefficients.len()];
            let hull = &self.hulls[frame.shape as usize];
            fit(ends, coefficients, hull, &turn, t, frame.reach);
            if frame.margin > 0.0 {
                widen(ends, coefficients, frame.margin);
            }
            cubes[place] = cube(ends);
        }
    }
}

/// The cube about a box, whose slabs are the first three: if two boxes meet, so do their cubes.
fn cube(ends: &[[f32; 2]]) -> [f32; 4] {
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

/// The slabs of posed points along integer directions of the world axes.
fn fit(
    ends: &mut [[f32; 2]],
    coefficients: &[[i8; 3]],
    hull: &[[f32; 3]],
    turn: &Rotation,
    t: [f32; 3],
    reach: f32,
) {
    let mut extremes = [[f64::INFINITY, f64::NEG_INFINITY]; 13];
    for &vertex in hull {
        let p = transform(turn, vertex, t);
        for (extreme, c) in extremes.iter_mut().zip(coefficients) {
            let [x, y, z] = [0, 1, 2].map(|axis| f64::from(c[axis]) * p[axis]);
            let along = (x + y) + z;
            *extreme = [extreme[0].min(along), extreme[1].max(along)];
        }
    }
    for (end, extreme) in ends.iter_mut().zip(extremes) {
        let (lo, hi) = refit(extreme[0], extreme[1], reach, t);
        *end = [lo, hi];
    }
}

/// Moves slabs out by `margin`.
fn widen(ends: &mut [[f32; 2]], coefficients: &[[i8; 3]], margin: f32) {
    for ([lo, hi], c) in ends.iter_mut().zip(coefficients) {
        let out = f64::from(margin) * norm(c.map(f32::from));
        (*lo, *hi) = (down(f64::from(*lo) - out), up(f64::from(*hi) + out));
    }
}
