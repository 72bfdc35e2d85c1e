//! Seeded draws: orientations in a chosen relation, contacts, and whole frames of them.

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::contact::{Contact, ContactKind, PlacedShape};
use crate::truth::reference_shapes::Shapes;
use sdop::bodies::Bodies;
use sdop::rounding::pose;

/// How the second body's orientation relates to the first's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TurnKind {
    /// Both any, norms from 0.1 to 1.
    #[default]
    Any,
    /// Neither is turned.
    Identity,
    /// Both by the cube's own rotations, with small integer quaternions.
    Quarter,
    /// One component one ulp from the first's.
    Ulp,
    /// The first's, turned by 1e-7 to 1e-3 more: edges nearly parallel.
    NearlyParallel,
    /// Any, with a norm of 1 ± 1e-6, 1e18 or 1e-18.
    Norm,
    /// The first's negated, or with negative zeros.
    Sign,
}

/// An orientation of any direction with a norm from 0.1 to 1.
pub fn rotation(rng: &mut impl Rng) -> [f32; 4] {
    loop {
        let q: [f32; 4] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let norm: f32 = q.iter().map(|x| x * x).sum();
        if (0.01..=1.0).contains(&norm) {
            return q;
        }
    }
}

/// A direction, not normalised.
pub fn direction(rng: &mut impl Rng) -> [f64; 3] {
    let [x, y, z, _] = rotation(rng);
    if [x, y, z] == [0.0; 3] {
        return [1.0, 0.0, 0.0];
    }
    [x, y, z].map(f64::from)
}

impl TurnKind {
    /// The first body's orientation.
    pub fn first(self, rng: &mut impl Rng) -> [f32; 4] {
        match self {
            Self::Identity => [0.0, 0.0, 0.0, 1.0],
            Self::Quarter => quarter(rng),
            Self::Sign if rng.random_range(0..2) == 0 => [-0.0, 0.0, -0.0, 1.0],
            Self::Norm => norm(rng, 0),
            _ => rotation(rng),
        }
    }

    /// The second body's, given the first's.
    pub fn second(self, first: [f32; 4], rng: &mut impl Rng) -> [f32; 4] {
        match self {
            Self::Any => rotation(rng),
            Self::Identity => first,
            Self::Quarter => quarter(rng),
            Self::Ulp => {
                let mut q = first;
                let at = rng.random_range(0..4);
                q[at] =
                    if rng.random_range(0..2) == 0 { q[at].next_up() } else { q[at].next_down() };
                q
            }
            Self::NearlyParallel => {
                let size = 10_f32.powf(rng.random_range(-7.0..-3.0));
                let by = rotation(rng);
                std::array::from_fn(|i| first[i] + size * by[i])
            }
            Self::Norm => norm(rng, 1),
            Self::Sign => first.map(|x| -x),
        }
    }
}

/// An integer quaternion of one of the cube's rotations.
fn quarter(rng: &mut impl Rng) -> [f32; 4] {
    const TURNS: [[f32; 4]; 6] = [
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, -1.0],
        [0.0, 0.0, 1.0, 1.0],
        [1.0, 1.0, 1.0, 1.0],
        [1.0, 0.0, 0.0, 0.0],
    ];
    TURNS[rng.random_range(0..TURNS.len())]
}

fn norm(rng: &mut impl Rng, offset: usize) -> [f32; 4] {
    const NORMS: [f64; 5] = [1.0 - 1e-6, 1e18, 1e-18, 1.0 + 1e-6, 1.0];
    let q = rotation(rng).map(f64::from);
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let wanted = NORMS[(rng.random_range(0..NORMS.len()) + offset) % NORMS.len()];
    q.map(|x| (x / length * wanted) as f32)
}

/// What contacts a frame is made of.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct ContactSpec {
    /// What may touch.
    pub kinds: Vec<ContactKind>,
    /// How orientations relate.
    pub turn: TurnKind,
    /// The largest gap or overlap, in u = 2⁻²⁴ of the bodies' reach; 0 is as close as rounding
    /// allows.
    pub gap: f64,
    /// Least and largest power of two of the distance from the world's origin; absent: at the
    /// origin.
    pub origin: Option<[f64; 2]>,
    /// Vectors that span the directions of contacts, for kinds that take any: one is a line, two a
    /// plane, none all space.
    pub span: Vec<[f64; 3]>,
}

impl Default for ContactSpec {
    fn default() -> Self {
        Self {
            kinds: ContactKind::ALL[..8].to_vec(),
            turn: TurnKind::Any,
            gap: 4.0,
            origin: None,
            span: Vec::new(),
        }
    }
}

impl ContactSpec {
    /// A contact.
    pub fn contact(&self, rng: &mut impl Rng) -> Contact {
        let drawn = direction(rng);
        let spanned = self.span.iter().zip(drawn);
        let spanned = spanned
            .fold([0.0; 3], |sum: [f64; 3], (v, c)| std::array::from_fn(|i| sum[i] + c * v[i]));
        let gap = if self.gap > 0.0 { rng.random_range(-self.gap..self.gap) } else { 0.0 };
        Contact {
            kind: self.kinds[rng.random_range(0..self.kinds.len())],
            pick: std::array::from_fn(|_| rng.random_range(0..1 << 20)),
            direction: if spanned == [0.0; 3] { drawn } else { spanned },
            gap,
        }
    }

    /// A body to start from.
    pub fn start(&self, shape: usize, rng: &mut impl Rng) -> PlacedShape {
        let rotation = self.turn.first(rng);
        let translation = match self.origin {
            None => [0.0; 3],
            Some([least, most]) => {
                let distance =
                    2_f64.powf(if most > least { rng.random_range(least..most) } else { least });
                let d = direction(rng);
                let size = d.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                d.map(|x| (x / size * distance) as f32)
            }
        };
        PlacedShape { shape, rotation, translation }
    }

    /// A body of `shape` in contact with `first`; next to it where the contact lies outside the
    /// contract.
    pub fn partner(
        &self,
        shapes: &Shapes,
        first: &PlacedShape,
        shape: usize,
        rng: &mut impl Rng,
    ) -> PlacedShape {
        let rotation = self.turn.second(first.rotation, rng);
        let contact = self.contact(rng);
        let translation =
            contact.place(shapes, first, shape, rotation).unwrap_or(first.translation);
        PlacedShape { shape, rotation, translation }
    }
}

/// Appends a body at rest.
pub fn add(bodies: &mut Bodies, placed: &PlacedShape, dynamic: bool) {
    let shape = placed.shape as u32; // shapes are few
    bodies.push(shape, dynamic, placed.rotation, placed.translation);
}

/// One dynamic probe among static partners, each in contact with it: every tested pair is a near
/// miss. Half of the partners come before the probe, so that either body is the first of the pair.
pub fn probe(
    shapes: &Shapes,
    spec: &ContactSpec,
    probe_shape: usize,
    partners: usize,
    rng: &mut impl Rng,
) -> Bodies {
    let probe = spec.start(probe_shape, rng);
    let mut bodies = Bodies::default();
    for i in 0..=partners {
        if i == partners / 2 {
            add(&mut bodies, &probe, true);
            continue;
        }
        let shape = rng.random_range(0..shapes.built.len());
        let partner = spec.partner(shapes, &probe, shape, rng);
        add(&mut bodies, &partner, false);
    }
    bodies
}

/// Dynamic bodies with uniform centres in a cube: `side` is in units of the shapes' mean bounding
/// radius.
pub fn crowd(shapes: &Shapes, bodies: usize, side: f64, rng: &mut impl Rng) -> Bodies {
    let radii = shapes.built.iter().map(|s| f64::from(s.ball.radius));
    let mean = radii.sum::<f64>() / shapes.built.len() as f64;
    let side = (side * mean) as f32;
    let mut frame = Bodies::default();
    for _ in 0..bodies {
        let shape = rng.random_range(0..shapes.built.len());
        let rotation = rotation(rng);
        let centre: [f32; 3] = std::array::from_fn(|_| rng.random_range(0.0..side));
        // The ball's centre is what is uniform, wherever the shape's origin is.
        let ball = shapes.built[shape].ball.centre;
        let offset = pose::rotate(&pose::rotation(rotation), ball);
        let placed = PlacedShape {
            shape,
            rotation,
            translation: std::array::from_fn(|i| centre[i] - offset[i] as f32),
        };
        add(&mut frame, &placed, true);
    }
    frame
}
