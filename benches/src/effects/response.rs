//! Elastic response: two bodies whose bounding spheres touch and approach exchange momentum along
//! the line of centres, as smooth balls of equal density (mass ∝ r³) do; a static body has infinite
//! mass.
//!
//! With n = cj − ci, the relative approach a = (vi − vj)·n / |n|² > 0 changes vi by −2mj/(mi +
//! mj)·a·n and vj by 2mi/(mi + mj)·a·n: momentum and kinetic energy stay. The paper's bodies pass
//! through one another; this effect is for scenes in which they shouldn't. Contacts are those of
//! the spheres in f64, found here and charged to this effect, so that trajectories never depend on
//! the culling under test. Pairs are treated in index order.

use std::ops::Range;

use super::{BuiltEffect, Effect, Velocities};
use super::{InitialState, world_centre};
use sdop::bodies::Bodies;
use sdop::choice::choices;

choices! {
    /// How bodies respond to contact.
    Settings, "response", {
        /// Momentum and energy are kept.
        Elastic = "elastic",
    }
}

/// A bounding sphere in the world, in f64.
#[derive(Clone, Copy)]
struct WorldSphere {
    centre: [f64; 3],
    radius: f64,
}

struct Elastic {
    /// By shape: the ball's centre in the body frame and its radius.
    balls: Vec<([f32; 3], f32)>,
    spheres: Vec<WorldSphere>,
    grid: ContactGrid,
}

pub(super) fn new(Settings::Elastic: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    let balls = start
        .shapes
        .iter()
        .map(|s| (s.ball.centre, s.ball.radius))
        .collect();
    Ok(Box::new(Elastic {
        balls,
        spheres: Vec::new(),
        grid: ContactGrid::default(),
    }))
}

impl Effect for Elastic {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        _: &[Range<usize>],
    ) -> u64 {
        self.spheres.clear();
        self.spheres.extend((0..bodies.len()).map(|body| {
            let (centre, radius) = self.balls[bodies.shape[body] as usize];
            let world = world_centre(centre, &bodies.rotation[body], &bodies.translation[body]);
            WorldSphere {
                centre: world.map(f64::from),
                radius: f64::from(radius),
            }
        }));
        let spheres = &self.spheres;
        self.grid.sort(spheres);
        let mut changed = 0;
        let mut partners = Vec::new();
        for i in 0..spheres.len() {
            partners.clear();
            self.grid.near(&spheres[i], |j| {
                if i < j
                    && (bodies.dynamic[i] || bodies.dynamic[j])
                    && touch(&spheres[i], &spheres[j])
                {
                    partners.push(j);
                }
            });
            partners.sort_unstable();
            for &j in &partners {
                changed += exchange(bodies, &mut velocities.linear, spheres, i, j);
            }
        }
        changed
    }
}

fn difference(a: &WorldSphere, b: &WorldSphere) -> [f64; 3] {
    [0, 1, 2].map(|axis| b.centre[axis] - a.centre[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn touch(a: &WorldSphere, b: &WorldSphere) -> bool {
    let n = difference(a, b);
    let reach = a.radius + b.radius;
    dot(n, n) <= reach * reach
}

/// Exchanges momentum if i and j approach; returns how many bodies changed.
fn exchange(
    bodies: &Bodies,
    velocity: &mut [[f32; 3]],
    spheres: &[WorldSphere],
    i: usize,
    j: usize,
) -> u64 {
    let n = difference(&spheres[i], &spheres[j]);
    let (vi, vj) = (velocity[i].map(f64::from), velocity[j].map(f64::from));
    let approach = dot([0, 1, 2].map(|axis| vi[axis] - vj[axis]), n);
    // Coincident centres have no line between them: their approach is 0, and dividing by n·n would
    // make NaN.
    if approach <= 0.0 {
        return 0;
    }
    let rate = approach / dot(n, n);
    let (share_i, share_j) = shares(bodies, spheres, i, j);
    if bodies.dynamic[i] {
        velocity[i] = [0, 1, 2].map(|axis| (vi[axis] - share_i * rate * n[axis]) as f32);
    }
    if bodies.dynamic[j] {
        velocity[j] = [0, 1, 2].map(|axis| (vj[axis] + share_j * rate * n[axis]) as f32);
    }
    u64::from(bodies.dynamic[i]) + u64::from(bodies.dynamic[j])
}

/// 2mj/(mi + mj) and 2mi/(mi + mj); a static partner is infinitely heavy.
fn shares(bodies: &Bodies, spheres: &[WorldSphere], i: usize, j: usize) -> (f64, f64) {
    if !bodies.dynamic[i] || !bodies.dynamic[j] {
        return (2.0, 2.0);
    }
    let mass = |body: usize| spheres[body].radius * spheres[body].radius * spheres[body].radius;
    let (mi, mj) = (mass(i), mass(j));
    (2.0 * mj / (mi + mj), 2.0 * mi / (mi + mj))
}

/// Uniform cells over the bodies' extent, each at least as wide as the largest sphere, bodies
/// sorted by cell.
#[derive(Default)]
struct ContactGrid {
    low: [f64; 3],
    per_length: [f64; 3],
    cells: [usize; 3],
    /// Where each cell's bodies start in `order`; one entry more than cells.
    starts: Vec<usize>,
    order: Vec<u32>,
}

impl ContactGrid {
    fn sort(&mut self, spheres: &[WorldSphere]) {
        self.fit(spheres);
        let cells = self.cells.iter().product::<usize>();
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        for sphere in spheres {
            let cell = self.index(self.cell(sphere));
            self.starts[cell + 1] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 1] += self.starts[cell];
        }
        // Filling moves each start to its cell's end, so the ends are shifted back by one cell
        // afterwards.
        self.order.resize(spheres.len(), 0);
        for (body, sphere) in spheres.iter().enumerate() {
            let cell = self.index(self.cell(sphere));
            // A scene has fewer than 2³² bodies.
            self.order[self.starts[cell]] = body as u32;
            self.starts[cell] += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Chooses the cells: wide enough that touching spheres are in neighbouring cells even after
    /// rounding, and at most about one per body.
    fn fit(&mut self, spheres: &[WorldSphere]) {
        let along = |axis: usize| spheres.iter().map(move |sphere| sphere.centre[axis]);
        let widest = spheres
            .iter()
            .map(|sphere| 2.0 * sphere.radius)
            .fold(0.0, f64::max);
        let most = libm::ceil(libm::cbrt(spheres.len() as f64));
        for axis in 0..3 {
            self.low[axis] = along(axis).fold(f64::MAX, f64::min);
            let extent = (along(axis).fold(f64::MIN, f64::max) - self.low[axis]).max(0.0);
            let width = (widest * (1.0 + 1e-6)).max(extent / most);
            let count = libm::floor(extent / width) + 1.0;
            // One cell where everything lies in one point, or where nothing does.
            self.per_length[axis] = if width > 0.0 { 1.0 / width } else { 0.0 };
            self.cells[axis] = if count <= most + 1.0 {
                count as usize
            } else {
                1
            };
        }
    }

    fn cell(&self, sphere: &WorldSphere) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let at = (sphere.centre[axis] - self.low[axis]) * self.per_length[axis];
            // The cast truncates and saturates: both keep neighbours neighbours.
            (at as usize).min(self.cells[axis] - 1)
        })
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// Calls `visit` for every body in the sphere's cell and the cells around it.
    fn near(&self, sphere: &WorldSphere, mut visit: impl FnMut(usize)) {
        let centre = self.cell(sphere);
        let around = |axis: usize| {
            centre[axis].saturating_sub(1)..=(centre[axis] + 1).min(self.cells[axis] - 1)
        };
        for z in around(2) {
            for y in around(1) {
                // Cells along x lie side by side: one stretch.
                let first = self.index([*around(0).start(), y, z]);
                let last = self.index([*around(0).end(), y, z]);
                for &body in &self.order[self.starts[first]..self.starts[last + 1]] {
                    visit(body as usize);
                }
            }
        }
    }
}
