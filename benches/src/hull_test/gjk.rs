//! Convex hulls: the tightest convex volume, by GJK (Gilbert, Johnson & Keerthi 1988) with
//! certified rejection.
//!
//! Hulls A and B meet iff their difference A ⊖ B contains the origin. GJK walks towards the origin
//! over simplices of that set. A pair is culled only on a direction d along which *every* vertex of
//! A lies below every vertex of B by more than the rounding, so that the hull keeps the culler's
//! promise; if the walk is undecided, the pair is reported. No maintained crate certifies its
//! rejections: their f32 tolerances cull touching pairs. Supports climb over the hull's edges from
//! the last vertex found; rounding can strand a climb, so the certificate scans all vertices.

use glam::{DMat3, DVec3};

use sdop::bodies::Bodies;
use sdop::rounding::pose::rotation;
use sdop::volume::{Hull, Shape};

/// Margin of the certificate relative to the sizes involved: some hundred times what the f64 steps
/// can err by.
const CERTIFICATE_MARGIN: f64 = 1.0 / (1_u64 << 42) as f64;
/// Walks that take longer are undecided; ten steps are usual.
const MOST_STEPS: usize = 64;

/// A shape's hull as GJK walks it.
#[derive(Clone, Debug)]
pub struct HullGraph {
    points: Vec<DVec3>,
    /// `links[starts[v]..starts[v + 1]]` are the neighbours of v; none on a flat hull.
    links: Vec<u32>,
    starts: Vec<u32>,
    reach: f64,
}

impl HullGraph {
    /// The hull of a shape, body frame.
    #[must_use]
    pub fn new(shape: &Shape) -> Self {
        let hull = Hull::of(&shape.vertices);
        let points = hull.points(&shape.vertices);
        let place = |vertex: u32| hull.vertices.partition_point(|&v| v < vertex) as u32;
        // Every edge belongs to two facets, once in each direction.
        let mut edges: Vec<[u32; 2]> = hull
            .facets
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|edge| edge.map(place))
            .collect();
        edges.sort_unstable();
        let start = |v: usize| edges.partition_point(|&[from, _]| (from as usize) < v) as u32;
        Self {
            starts: (0..=points.len()).map(start).collect(),
            links: edges.iter().map(|&[_, to]| to).collect(),
            points: points.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect(),
            reach: f64::from(shape.reach),
        }
    }

    /// A vertex far along `direction`, found from vertex `from`.
    fn climb(&self, direction: DVec3, from: u32) -> u32 {
        if self.links.is_empty() {
            return self.scan(direction);
        }
        let height = |v: u32| self.points[v as usize].dot(direction);
        let (mut at, mut top) = (from, height(from));
        loop {
            let [start, end] = [at as usize, at as usize + 1].map(|v| self.starts[v] as usize);
            let before = at;
            for &next in &self.links[start..end] {
                let here = height(next);
                if here > top {
                    (at, top) = (next, here);
                }
            }
            if at == before {
                return at;
            }
        }
    }

    /// The farthest vertex along `direction`.
    fn scan(&self, direction: DVec3) -> u32 {
        let heights = self.points.iter().map(|p| p.dot(direction));
        let farthest = heights.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        farthest.map_or(0, |(v, _)| v as u32)
    }
}

/// A hull and where it is.
#[derive(Clone, Copy, Debug)]
pub struct PosedHull<'a> {
    /// The hull.
    pub graph: &'a HullGraph,
    /// Body to world.
    pub turn: DMat3,
    /// World position of the body origin.
    pub origin: DVec3,
}

impl<'a> PosedHull<'a> {
    /// The hull of body `i`.
    #[must_use]
    pub fn of(graphs: &'a [HullGraph], bodies: &Bodies, i: usize) -> Self {
        let rows = rotation(bodies.rotation[i]);
        Self {
            graph: &graphs[bodies.shape[i] as usize],
            turn: DMat3::from_cols_array_2d(&rows).transpose(),
            origin: DVec3::from_array(bodies.translation[i].map(f64::from)),
        }
    }
}

/// Whether the hulls may touch: never false when they do.
#[must_use]
pub fn may_touch(a: &PosedHull<'_>, b: &PosedHull<'_>) -> bool {
    let gap = b.origin - a.origin;
    let mut walk = GjkWalk {
        a,
        b,
        gap,
        margin: CERTIFICATE_MARGIN * (a.graph.reach + b.graph.reach + gap.abs().max_element()),
        at: [0; 2],
    };
    let mut simplex = Simplex::default();
    let mut direction = if gap == DVec3::ZERO { DVec3::X } else { gap };
    for _ in 0..MOST_STEPS {
        let point = walk.support(direction);
        if point.dot(direction) < 0.0 {
            return !walk.separates(direction);
        }
        simplex.push(point);
        match simplex.approach() {
            Some(next) if next.length_squared() > f64::MIN_POSITIVE => direction = next,
            _ => return true,
        }
    }
    true
}

/// Two hulls seen from A's origin, in world axes.
struct GjkWalk<'a> {
    a: &'a PosedHull<'a>,
    b: &'a PosedHull<'a>,
    gap: DVec3,
    margin: f64,
    at: [u32; 2],
}

impl GjkWalk<'_> {
    /// A point of A ⊖ B far along `direction`.
    fn support(&mut self, direction: DVec3) -> DVec3 {
        let farthest = |hull: &PosedHull<'_>, direction: DVec3, at: &mut u32| {
            *at = hull.graph.climb(hull.turn.transpose() * direction, *at);
            hull.turn * hull.graph.points[*at as usize]
        };
        let a = farthest(self.a, direction, &mut self.at[0]);
        let b = farthest(self.b, -direction, &mut self.at[1]);
        a - (b + self.gap)
    }

    /// The certificate: along `direction` all of A is below all of B.
    fn separates(&self, direction: DVec3) -> bool {
        let unit = direction.normalize();
        let (towards, away) = (self.a.turn.transpose() * unit, self.b.turn.transpose() * -unit);
        let top = |graph: &HullGraph, d: DVec3| graph.points[graph.scan(d) as usize].dot(d);
        let reach = top(self.a.graph, towards) + top(self.b.graph, away);
        reach - self.gap.dot(unit) < -self.margin
    }
}

/// Up to four points of A ⊖ B, newest last.
#[derive(Default)]
struct Simplex {
    points: [DVec3; 4],
    len: usize,
}

impl Simplex {
    fn push(&mut self, point: DVec3) {
        self.points[self.len] = point;
        self.len += 1;
    }

    fn keep<const N: usize>(&mut self, points: [DVec3; N]) {
        self.points[..N].copy_from_slice(&points);
        self.len = N;
    }

    /// Keeps the face nearest the origin and returns the direction from there to it; `None` when
    /// the origin is inside. The newest point a is beyond the origin in the last direction, so only
    /// faces with a can be nearest.
    fn approach(&mut self) -> Option<DVec3> {
        let [p, q, r, s] = self.points;
        match self.len {
            1 => Some(-p),
            2 => Some(self.segment(q, p)),
            3 => Some(self.triangle(r, q, p)),
            _ => self.tetrahedron(s, r, q, p),
        }
    }

    fn segment(&mut self, a: DVec3, b: DVec3) -> DVec3 {
        let ab = b - a;
        if ab.dot(-a) > 0.0 {
            self.keep([b, a]);
            ab.cross(-a).cross(ab)
        } else {
            self.keep([a]);
            -a
        }
    }

    fn triangle(&mut self, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        if normal.cross(ac).dot(-a) > 0.0 {
            if ac.dot(-a) > 0.0 {
                self.keep([c, a]);
                return ac.cross(-a).cross(ac);
            }
            return self.segment(a, b);
        }
        if ab.cross(normal).dot(-a) > 0.0 {
            return self.segment(a, b);
        }
        if normal.dot(-a) > 0.0 {
            self.keep([c, b, a]);
            normal
        } else {
            self.keep([b, c, a]);
            -normal
        }
    }

    fn tetrahedron(&mut self, a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
        for (b, c, opposite) in [(b, c, d), (c, d, b), (d, b, c)] {
            let normal = (b - a).cross(c - a);
            let outward = if normal.dot(opposite - a) > 0.0 { -normal } else { normal };
            if outward.dot(-a) > 0.0 {
                return Some(self.triangle(a, b, c));
            }
        }
        None
    }
}
