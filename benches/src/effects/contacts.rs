//! Which bounding spheres touch, in f64. Effects find contacts themselves, so that trajectories
//! never depend on the culling under test.

use super::world_centre;
use sdop::bodies::Bodies;
use sdop::volume::Shape;

/// A bounding sphere in the world, in f64.
#[derive(Clone, Copy)]
pub(super) struct WorldSphere {
    pub centre: [f64; 3],
    pub radius: f64,
}

/// The bounding spheres of all bodies, and a grid of them.
pub(super) struct Contacts {
    /// By shape: the ball's centre in the body frame and its radius.
    balls: Vec<([f32; 3], f32)>,
    spheres: Vec<WorldSphere>,
    grid: ContactGrid,
}

impl Contacts {
    pub fn new(shapes: &[Shape]) -> Self {
        let balls = shapes.iter().map(|s| (s.ball.centre, s.ball.radius));
        Self { balls: balls.collect(), spheres: Vec::new(), grid: ContactGrid::default() }
    }

    /// Finds the spheres of all bodies at their poses.
    pub fn find_spheres(&mut self, bodies: &Bodies) {
        self.spheres.clear();
        self.spheres.extend((0..bodies.len()).map(|body| {
            let (centre, radius) = self.balls[bodies.shape[body] as usize];
            let world = world_centre(centre, &bodies.rotation[body], &bodies.translation[body]);
            WorldSphere { centre: world.map(f64::from), radius: f64::from(radius) }
        }));
        self.grid.sort(&self.spheres);
    }

    /// The spheres, by body.
    pub fn spheres(&self) -> &[WorldSphere] {
        &self.spheres
    }

    /// Calls `visit` for every body whose sphere touches that of `body`, and for `body`.
    pub fn each_touching(&self, body: usize, mut visit: impl FnMut(usize)) {
        let sphere = &self.spheres[body];
        self.grid.near(sphere, |other| {
            if touch(sphere, &self.spheres[other]) {
                visit(other);
            }
        });
    }
}

/// From the first centre to the second.
pub(super) fn difference(a: &WorldSphere, b: &WorldSphere) -> [f64; 3] {
    [0, 1, 2].map(|axis| b.centre[axis] - a.centre[axis])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn touch(a: &WorldSphere, b: &WorldSphere) -> bool {
    let n = difference(a, b);
    let reach = a.radius + b.radius;
    dot(n, n) <= reach * reach
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
        let widest = spheres.iter().map(|sphere| 2.0 * sphere.radius).fold(0.0, f64::max);
        let most = libm::ceil(libm::cbrt(spheres.len() as f64));
        for axis in 0..3 {
            self.low[axis] = along(axis).fold(f64::MAX, f64::min);
            let extent = (along(axis).fold(f64::MIN, f64::max) - self.low[axis]).max(0.0);
            let width = (widest * (1.0 + 1e-6)).max(extent / most);
            let count = libm::floor(extent / width) + 1.0;
            // One cell where everything lies in one point, or where nothing does.
            self.per_length[axis] = if width > 0.0 { 1.0 / width } else { 0.0 };
            self.cells[axis] = if count <= most + 1.0 { count as usize } else { 1 };
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
