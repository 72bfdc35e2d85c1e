//! Cuts faces of more than three corners into triangles.
//!
//! Readers make a fan of triangles about a face's first corner, which is right for a convex face.
//! Here the fans of all other faces are replaced by ears: a corner is cut off if it is convex and
//! its triangle contains no other corner. Every sign is exact ([`robust::orient2d`]). It is taken
//! in the face's dominant plane, which drops the coordinate along which the normal is longest.
//!
//! Cutting a corner off, whichever it is, takes a triangle out of the face. Therefore the triangles
//! cover the face exactly once if none of them is turned over. If an edge crosses another one, or
//! no corner is left that can be cut off, the face is not simple and keeps its fan. A corner on the
//! line between its neighbours, or at the position of one of them, may give a triangle without
//! area, so that every corner is used and all edges fit those of the next face.
//!
//! A face is far from flat if the heights of its corners over its mean plane differ by more than an
//! eighth of its largest extent. Such a quad keeps its fan; larger faces are cut as they appear in
//! the dominant plane. A file with faces that are not simple or far from flat gets a warning.

use std::collections::VecDeque;

use glam::DVec3;
use robust::{Coord, orient2d};

use super::text::{LineProblem, LineWarning};
use crate::mesh::topology::has_area;
use crate::mesh::{Problem, TriangleMesh, in_f64};

/// A face of more than three corners, whose triangles are a fan about the first of them.
pub(super) struct Polygon {
    pub first_triangle: usize,
    pub corners: usize,
    pub line: Option<usize>,
}

/// A face is far from flat beyond this difference of heights, in units of its largest extent.
const MOST_HEIGHT: f64 = 0.125;

/// Comparisons per corner that cutting a face may take. Only faces of thousands of corners can need
/// more, and only if many of their edges lie above each other.
const MOST_TESTS: usize = 1 << 13;

/// Replaces the fans of the faces for which they are wrong. Returns a warning if there are faces
/// that have no right triangles.
///
/// # Errors
/// A face that would take too long.
pub(super) fn cut(
    mesh: &mut TriangleMesh,
    polygons: &[Polygon],
) -> Result<Option<LineWarning>, LineProblem> {
    let mut doubtful = Vec::new();
    for polygon in polygons {
        let place = polygon.first_triangle..polygon.first_triangle + polygon.corners - 2;
        let fan = &mesh.triangles[place.clone()];
        if !fan.iter().any(|triangle| has_area(mesh, triangle)) {
            continue;
        }
        let [a, b, _] = fan[0];
        let corners: Vec<u32> = [a, b].into_iter().chain(fan.iter().map(|t| t[2])).collect();
        let points: Vec<DVec3> =
            corners.iter().map(|&i| in_f64(&mesh.vertices[i as usize])).collect();
        let face = Face::new(&points);
        let is_quad = polygon.corners == 4;
        let mut is_simple = face.is_convex();
        if !(is_simple || is_quad && face.is_far_from_flat) {
            let ears = face.ears().map_err(|TooManyTests| too_many_tests(polygon))?;
            is_simple = ears.is_some();
            for (triangle, ear) in mesh.triangles[place].iter_mut().zip(ears.unwrap_or_default()) {
                *triangle = ear.map(|corner| corners[corner]);
            }
        }
        if !is_simple || face.is_far_from_flat {
            doubtful.push(polygon);
        }
    }
    let Some(first) = doubtful.first() else {
        return Ok(None);
    };
    let message = format!(
        "{} of {} faces with more than three corners cross themselves or are far from flat, so that their triangles \
         are a guess; the first has {} corners and begins with triangle {}",
        doubtful.len(),
        polygons.len(),
        first.corners,
        first.first_triangle
    );
    Ok(Some((first.line, message)))
}

fn too_many_tests(polygon: &Polygon) -> LineProblem {
    let message = format!("a face of {} corners takes too long to triangulate", polygon.corners);
    let help = "triangulate it in the program that the file comes from";
    (polygon.line, Problem::malformed(message, help))
}

struct TooManyTests;

/// A face in its dominant plane.
struct Face {
    /// The corners; counter-clockwise if the face is simple.
    points: Vec<Coord<f64>>,
    is_far_from_flat: bool,
}

impl Face {
    fn new(corners: &[DVec3]) -> Self {
        let from_first: Vec<DVec3> = corners.iter().map(|&corner| corner - corners[0]).collect();
        let normal: DVec3 = from_first.windows(2).map(|edge| edge[0].cross(edge[1])).sum();
        let extent = |direction: DVec3| {
            let along = from_first.iter().map(|corner| corner.dot(direction));
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (lo, hi) = along.fold(ends, |(lo, hi), x| (lo.min(x), hi.max(x)));
            hi - lo
        };
        let size = DVec3::AXES.map(extent);
        let axis = normal.abs().max_position();
        let (mut x, mut y) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut is_clockwise = normal[axis] < 0.0;
        if size[x] < size[y] {
            // Corners are sorted by x, along which few of them should be side by side.
            (x, y) = (y, x);
            is_clockwise = !is_clockwise;
        }
        let sign = if is_clockwise { -1.0 } else { 1.0 };
        let point = |corner: &DVec3| Coord { x: corner[x], y: sign * corner[y] };
        let largest = size.into_iter().fold(0.0, f64::max);
        Self {
            points: corners.iter().map(point).collect(),
            is_far_from_flat: extent(normal.normalize_or_zero()) > MOST_HEIGHT * largest,
        }
    }

    /// Whether the corners turn left, or not at all, and go round once.
    fn is_convex(&self) -> bool {
        let mut points = self.points.clone();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let count = points.len();
        let next = |i: usize| points[(i + 1) % count];
        let upward = |i: usize| (points[i].y, points[i].x) < (next(i).y, next(i).x);
        let turn = |i: usize| orient2d(points[i], next(i), next(i + 1));
        let reversals = (0..count).filter(|&i| upward(i) != upward((i + 1) % count)).count();
        reversals <= 2 && (0..count).all(|i| turn(i) >= 0.0) && (0..count).any(|i| turn(i) > 0.0)
    }

    /// The triangles that the face consists of, if it is simple.
    fn ears(&self) -> Result<Option<Vec<[usize; 3]>>, TooManyTests> {
        let mut tests = 0;
        if self.crosses_itself(&mut tests)? { Ok(None) } else { Ears::new(self, tests).cut() }
    }

    fn within_limit(&self, tests: &mut usize) -> Result<(), TooManyTests> {
        *tests += 1;
        if *tests > MOST_TESTS * self.points.len() { Err(TooManyTests) } else { Ok(()) }
    }

    /// Whether two edges have a point in common that is an end of neither.
    fn crosses_itself(&self, tests: &mut usize) -> Result<bool, TooManyTests> {
        let next = self.points.iter().cycle().skip(1);
        let mut edges: Vec<_> = self.points.iter().zip(next).map(|(&p, &q)| (p, q)).collect();
        let low = |(p, q): (Coord<f64>, Coord<f64>)| p.x.min(q.x);
        edges.sort_unstable_by(|&a, &b| low(a).total_cmp(&low(b)));
        let parts = |(a, b), (p, q)| {
            let (p, q) = (orient2d(a, b, p), orient2d(a, b, q));
            p.min(q) < 0.0 && p.max(q) > 0.0
        };
        for (i, &a) in edges.iter().enumerate() {
            let reach = a.0.x.max(a.1.x);
            for &b in edges[i + 1..].iter().take_while(|&&b| low(b) < reach) {
                self.within_limit(tests)?;
                let above = |a: (Coord<f64>, Coord<f64>), b: (Coord<f64>, Coord<f64>)| {
                    a.0.y.min(a.1.y) >= b.0.y.max(b.1.y)
                };
                if !above(a, b) && !above(b, a) && parts(a, b) && parts(b, a) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }
}

/// A face from which ears are cut off.
struct Ears<'a> {
    face: &'a Face,
    tests: usize,
    /// The neighbours of each corner that is left.
    previous: Vec<usize>,
    next: Vec<usize>,
    is_left: Vec<bool>,
    /// Corners that are not convex at first, sorted by x. If a convex corner's triangle contains
    /// corners of a simple face, one of them is among these.
    reflex: Vec<usize>,
    /// Corners that may be ears.
    queue: VecDeque<usize>,
}

impl<'a> Ears<'a> {
    fn new(face: &'a Face, tests: usize) -> Self {
        let count = face.points.len();
        let mut ears = Self {
            face,
            tests,
            previous: (0..count).map(|i| (i + count - 1) % count).collect(),
            next: (0..count).map(|i| (i + 1) % count).collect(),
            is_left: vec![true; count],
            reflex: Vec::new(),
            queue: (1..count).chain([0]).collect(),
        };
        ears.reflex = (0..count).filter(|&i| ears.turn(i) <= 0.0).collect();
        ears.reflex.sort_by(|&i, &j| face.points[i].x.total_cmp(&face.points[j].x));
        ears
    }

    fn cut(mut self) -> Result<Option<Vec<[usize; 3]>>, TooManyTests> {
        let (mut triangles, mut have_area) = (Vec::new(), false);
        while triangles.len() + 2 < self.face.points.len() {
            let Some(ear) = self.next_ear()? else {
                return Ok(None);
            };
            let (previous, next) = (self.previous[ear], self.next[ear]);
            have_area |= self.turn(ear) > 0.0;
            let mut triangle = [previous, ear, next];
            triangle.sort_unstable(); // this turns it, but not over
            triangles.push(triangle);
            self.is_left[ear] = false;
            (self.next[previous], self.previous[next]) = (next, previous);
            self.queue.extend([previous, next]);
        }
        Ok(have_area.then_some(triangles))
    }

    /// A corner that may be cut off: an ear, or if there is none, a corner on a line with its
    /// neighbours.
    fn next_ear(&mut self) -> Result<Option<usize>, TooManyTests> {
        while let Some(corner) = self.queue.pop_front() {
            if self.is_left[corner] && self.is_ear(corner)? {
                return Ok(Some(corner));
            }
        }
        // Cutting an ear off may make an ear of a corner that is not next to it.
        let left: Vec<usize> = (0..self.is_left.len()).filter(|&i| self.is_left[i]).collect();
        self.reflex.retain(|&corner| self.is_left[corner]);
        for &corner in &left {
            if self.is_ear(corner)? {
                return Ok(Some(corner));
            }
        }
        Ok(left.into_iter().find(|&corner| self.turn(corner) == 0.0))
    }

    /// Positive where the corner is convex.
    fn turn(&self, corner: usize) -> f64 {
        let points = &self.face.points;
        orient2d(points[self.previous[corner]], points[corner], points[self.next[corner]])
    }

    /// Whether a corner is convex and its triangle contains none of the others.
    fn is_ear(&mut self, corner: usize) -> Result<bool, TooManyTests> {
        self.face.within_limit(&mut self.tests)?;
        if self.turn(corner) <= 0.0 {
            return Ok(false);
        }
        let points = &self.face.points;
        let triangle = [self.previous[corner], corner, self.next[corner]].map(|i| points[i]);
        let [a, b, c] = triangle;
        let from = self.reflex.partition_point(|&i| points[i].x < a.x.min(b.x).min(c.x));
        for &other in &self.reflex[from..] {
            let p = points[other];
            if p.x > a.x.max(b.x).max(c.x) {
                break;
            }
            self.face.within_limit(&mut self.tests)?;
            let is_within = self.is_left[other]
                && !triangle.contains(&p)
                && [(a, b), (b, c), (c, a)].iter().all(|&(p0, p1)| orient2d(p0, p1, p) >= 0.0);
            if is_within && self.turn(other) <= 0.0 {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
