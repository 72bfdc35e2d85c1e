//! The same tests as most programs write them: f32, no margin, no directed rounding.
//!
//! They are wrong on purpose. A group of hard cases on which they miss nothing is useless and is
//! replaced.

use sdop_reference as reference;

use reference::exact::meeting;
use reference::exact::mesh::Mesh;

use super::answers::{Answers, Predicate};
use super::reference_shapes::{InvalidInput, Shapes};
use sdop::bodies::Bodies;
use sdop::settings::Overlap;

type Vector = [f32; 3];

/// What the naive tests lose in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NaiveMisses {
    /// Sphere pairs.
    pub sphere: u64,
    /// World-aligned box pairs.
    pub aabb: u64,
    /// or-DOP pairs, two-sided.
    pub ordop: u64,
    /// Mesh pairs that meet without their surfaces meeting, which a test of surfaces alone loses.
    pub surface: u64,
}

impl NaiveMisses {
    /// Adds another frame's.
    pub fn add(&mut self, other: &Self) {
        self.sphere += other.sphere;
        self.aabb += other.aabb;
        self.ordop += other.ordop;
        self.surface += other.surface;
    }

    /// All of them.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.sphere + self.aabb + self.ordop + self.surface
    }

    /// Counts the overlaps among the answers that a naive test denies.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn count(
        shapes: &Shapes,
        bodies: &Bodies,
        answers: &Answers,
    ) -> Result<Self, InvalidInput> {
        let posed: Vec<PosedVolumes> = (0..bodies.len())
            .map(|i| {
                let pose = (bodies.rotation[i], bodies.translation[i]);
                PosedVolumes::new(shapes, bodies.shape[i] as usize, pose)
            })
            .collect();
        let lost = |predicate: Predicate, test: fn(&PosedVolumes, &PosedVolumes) -> bool| {
            let asked = answers.pairs.iter().zip(answers.of(predicate));
            let denied = asked.filter(|&(&[i, j], &overlap)| {
                overlap && !test(&posed[i as usize], &posed[j as usize])
            });
            denied.count() as u64
        };
        Ok(Self {
            sphere: lost(Predicate::Sphere, spheres),
            aabb: lost(Predicate::Aabb, boxes),
            ordop: lost(Predicate::OrDop(Overlap::TwoSided), ordops),
            surface: contained(shapes, bodies, answers)?,
        })
    }
}

/// Whether balls, boxes around the vertices or or-DOPs meet, by a naive test.
#[must_use]
pub fn naive_overlap(shapes: &Shapes, bodies: &Bodies, pair: [u32; 2], by: Predicate) -> bool {
    let [a, b] = pair.map(|body| {
        let body = body as usize;
        let pose = (bodies.rotation[body], bodies.translation[body]);
        PosedVolumes::new(shapes, bodies.shape[body] as usize, pose)
    });
    match by {
        Predicate::Sphere => spheres(&a, &b),
        Predicate::OrDop(_) => ordops(&a, &b),
        _ => boxes(&a, &b),
    }
}

/// Mesh pairs that meet by containment alone: their surfaces, decided exactly, don't.
fn contained(shapes: &Shapes, bodies: &Bodies, answers: &Answers) -> Result<u64, InvalidInput> {
    let open = |shape: &reference::Shape| -> Mesh {
        let mut mesh = shape.mesh().clone();
        mesh.components.iter_mut().for_each(|c| c.closed = false);
        mesh
    };
    let surfaces: Vec<Mesh> = shapes.judged.iter().map(open).collect();
    let judged = shapes.bodies(bodies)?;
    let posed = |i: u32| {
        let i = i as usize;
        (&surfaces[bodies.shape[i] as usize], &judged[i].pose)
    };
    let meeting = answers.pairs.iter().zip(answers.of(Predicate::Mesh));
    let apart =
        meeting.filter(|&(&[i, j], &meet)| meet && !meeting::meet(posed(i), posed(j)).meets);
    Ok(apart.count() as u64)
}

/// World-space volumes, everything rounded to nearest.
struct PosedVolumes {
    centre: Vector,
    radius: f32,
    lo: Vector,
    hi: Vector,
    /// Face normals and the or-DOP's slabs seen from the world's origin.
    slabs: Vec<(Vector, f32, f32)>,
    /// The or-DOP's corners.
    corners: Vec<Vector>,
}

fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl PosedVolumes {
    fn new(shapes: &Shapes, shape: usize, (q, t): ([f32; 4], Vector)) -> Self {
        let (shape, polytope) = (&shapes.built[shape], &shapes.judged[shape].polytope);
        let length = q.iter().map(|x| x * x).sum::<f32>().sqrt();
        let q = glam::Quat::from_array(q.map(|x| x / length));
        let turn = |v: [f32; 3]| (q * glam::Vec3::from(v)).to_array();
        let place = |v: [f32; 3]| {
            let p = turn(v);
            [p[0] + t[0], p[1] + t[1], p[2] + t[2]]
        };
        let vertices: Vec<Vector> = shape.vertices.iter().map(|&v| place(v)).collect();
        let fold = |pick: fn(f32, f32) -> f32, start: f32| {
            vertices.iter().fold([start; 3], |m, v| [0, 1, 2].map(|i| pick(m[i], v[i])))
        };
        let ordop = &shape.ordop;
        let corners = polytope.rounded.iter().map(|xi| polytope.position(xi));
        let corners = corners.map(|p| place(p.map(|x| x as f32)));
        let slabs = ordop.directions.coefficients().iter().enumerate();
        let slabs = slabs.map(|(i, &c)| {
            let normal = turn(ordop.basis.direction(c));
            let shift = dot(normal, t);
            (normal, ordop.lo[i] + shift, ordop.hi[i] + shift)
        });
        Self {
            centre: place(shape.ball.centre),
            radius: shape.ball.radius,
            lo: fold(f32::min, f32::INFINITY),
            hi: fold(f32::max, f32::NEG_INFINITY),
            slabs: slabs.collect(),
            corners: corners.collect(),
        }
    }
}

fn spheres(a: &PosedVolumes, b: &PosedVolumes) -> bool {
    let d = [0, 1, 2].map(|i| b.centre[i] - a.centre[i]);
    let reach = a.radius + b.radius;
    dot(d, d) <= reach * reach
}

fn boxes(a: &PosedVolumes, b: &PosedVolumes) -> bool {
    (0..3).all(|i| a.lo[i] <= b.hi[i] && b.lo[i] <= a.hi[i])
}

/// Each one's slabs against the other's corners.
fn ordops(a: &PosedVolumes, b: &PosedVolumes) -> bool {
    slabs_meet(a, b) && slabs_meet(b, a)
}

fn slabs_meet(a: &PosedVolumes, b: &PosedVolumes) -> bool {
    a.slabs.iter().all(|&(normal, lo, hi)| {
        let along = b.corners.iter().map(|&v| dot(normal, v));
        let (min, max) =
            along.fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
        min <= hi && lo <= max
    })
}
