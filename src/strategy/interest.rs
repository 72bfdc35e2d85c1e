//! Which bodies are of interest in a frame (a list, or those whose sphere centres lie in a view cone), and which pairs.

use crate::bodies::Bodies;
use crate::pairs::PairList;
use crate::rounding::pose::rotation;
use crate::settings::{Interest, ViewCone};

/// Marks the bodies of interest. `centre` gives a body's sphere centre in the world frame.
pub(crate) fn mark(
    interest: &Interest,
    bodies: &Bodies,
    centre: impl Fn(usize) -> [f32; 3],
    marks: &mut [bool],
) {
    match interest {
        Interest::Bodies(list) => {
            marks.fill(false);
            for &body in list {
                marks[body as usize] = true;
            }
        }
        Interest::Cone(cone) => {
            let cone = PlacedCone::new(cone, bodies);
            for (body, mark) in marks.iter_mut().enumerate() {
                *mark = cone.sees(centre(body));
            }
        }
    }
}

/// Pairs of places, some of which have a body of interest.
pub(super) struct Chosen<'a> {
    pub pairs: &'a PairList,
    /// The body in each place.
    pub body: &'a [u32],
    pub interest: &'a [bool],
}

impl Chosen<'_> {
    /// Every pair with its bodies, and whether one of them is of interest.
    fn judged(&self) -> impl Iterator<Item = ([u32; 2], [u32; 2], bool)> {
        self.pairs.iter().map(|places| {
            let bodies = places.map(|place| self.body[place as usize]);
            let chosen = bodies.iter().any(|&body| self.interest[body as usize]);
            (places, bodies, chosen)
        })
    }

    /// Lists the pairs that are to be refined.
    pub fn select(&self, selected: &mut PairList) {
        selected.clear();
        for ([i, j], _, chosen) in self.judged() {
            if chosen {
                selected.push(i, j);
            }
        }
    }

    /// Appends, as bodies, the pairs that weren't to be refined and those that `passed`, in their common order: a list
    /// must not show where blocks, and so threads, begin.
    pub fn merge(&self, passed: &PairList, out: &mut PairList) {
        let mut passed = passed.iter().peekable();
        for (_, [a, b], chosen) in self.judged() {
            if !chosen || passed.next_if_eq(&[a, b]).is_some() {
                out.push(a, b);
            }
        }
    }
}

/// A view cone in the world frame.
struct PlacedCone {
    apex: [f64; 3],
    direction: [f64; 3],
    cosine: f64,
    range: f64,
}

impl PlacedCone {
    fn new(cone: &ViewCone, bodies: &Bodies) -> Self {
        let given = cone.direction.map(f64::from);
        let (apex, turned) = match cone.body {
            Some(body) => {
                let turn = rotation(bodies.rotation[body as usize]);
                (
                    bodies.translation[body as usize],
                    turn.map(|row| dot(row, given)),
                )
            }
            None => (cone.apex.unwrap_or_default(), given),
        };
        let length = dot(turned, turned).sqrt();
        Self {
            apex: apex.map(f64::from),
            direction: turned.map(|x| x / length),
            cosine: libm::cos(f64::from(cone.half_angle).to_radians()),
            range: cone.range.map_or(f64::INFINITY, f64::from),
        }
    }

    /// The apex itself is in the cone, so a body that looks is always of interest.
    fn sees(&self, centre: [f32; 3]) -> bool {
        let way: [f64; 3] = std::array::from_fn(|i| f64::from(centre[i]) - self.apex[i]);
        let distance = dot(way, way).sqrt();
        distance <= self.range && dot(way, self.direction) >= self.cosine * distance
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
