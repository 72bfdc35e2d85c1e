//! Robots of many parts that fly and turn, and which of their parts meet.

use miette::IntoDiagnostic as _;
use sdop::compound::Part;
use sdop::rounding::compose::product;
use sdop::rounding::pose::{rotate_of, rotation};
use sdop::volume::ShapeSpec;
use sdop::{Body, ProceduralShape, Shape};
use sdop_bench::random::Stream;
use sdop_bench::remedy::OrReport as _;
use sdop_reference::WidePose;
use sdop_reference::wide::meet;

use crate::boxes::Slabs;

/// The parts of a robot.
pub const PARTS: usize = 30;

/// Half sides of the parts' shapes.
const HALF_SIDES: [[f32; 3]; 3] = [[0.5, 0.25, 0.25], [0.25, 0.5, 0.125], [0.375; 3]];

/// No part reaches farther from its origin.
const REACH: f64 = 0.66;

/// Robots and where they are in each frame. Parts are numbered robot by robot.
pub struct Robots {
    pub shapes: Vec<Shape>,
    /// The parts of every robot.
    pub parts: Vec<Part>,
    pub frames: Vec<Vec<Body>>,
}

impl Robots {
    /// So many robots, each with three others within reach on average.
    pub fn new(count: usize, frames: usize) -> miette::Result<Self> {
        let mut random = Stream::new(2, 0);
        let shape = |half_sides: [f32; 3]| {
            let [x, y, z] = half_sides.map(|half| 2.0 * half);
            let mesh = ProceduralShape::Box { x, y, z }.build().or_report()?;
            Shape::build(&mesh, &ShapeSpec::default()).or_report()
        };
        let shapes = HALF_SIDES.into_iter().map(shape);
        Ok(Self {
            shapes: shapes.collect::<miette::Result<_>>()?,
            parts: tree(&mut random),
            frames: fly(count, frames, &mut random),
        })
    }

    /// Robots in each frame.
    pub fn count(&self) -> usize {
        self.frames[0].len()
    }

    /// All pairs of parts of two robots whose meshes meet, sorted.
    pub fn truth(&self, robots: &[Body]) -> miette::Result<Vec<[u32; 2]>> {
        let mesh = |shape: &Shape| {
            let (vertices, triangles) = (shape.vertices.clone(), shape.triangles.clone());
            sdop_reference::Shape::of_mesh(vertices, triangles).into_diagnostic()
        };
        let meshes = self.shapes.iter().map(mesh);
        let meshes = meshes.collect::<miette::Result<Vec<_>>>()?;
        let wide = |part: Body| {
            let pose = WidePose::new(part.rotation.map(f64::from), part.translation);
            Ok((part, pose.into_diagnostic()?))
        };
        let parts = posed(&self.parts, robots).map(wide);
        let parts = parts.collect::<miette::Result<Vec<_>>>()?;
        let mut meeting = Vec::new();
        for (i, (one, pose)) in parts.iter().enumerate() {
            for (j, (other, there)) in parts.iter().enumerate().skip((i / PARTS + 1) * PARTS) {
                let apart = [0, 1, 2].map(|axis| one.translation[axis] - other.translation[axis]);
                if apart.iter().any(|x| x.abs() > 2.0 * REACH) {
                    continue;
                }
                let [mesh, partner] = [one, other].map(|part| &meshes[part.shape as usize]);
                if meet((mesh, pose), (partner, there)).meets {
                    meeting.push([i as u32, j as u32]);
                }
            }
        }
        Ok(meeting)
    }
}

/// The parts of all robots where they are in the world, with rotations rounded to f32.
pub fn posed<'a>(parts: &'a [Part], robots: &'a [Body]) -> impl Iterator<Item = Body> + 'a {
    let composed = |robot: &Body, part: &Part| {
        let turned = rotate_of(&rotation(robot.rotation), part.translation);
        Body::at(
            part.shape,
            product(robot.rotation, part.rotation),
            [0, 1, 2].map(|axis| robot.translation[axis] + turned[axis]),
        )
    };
    let of = move |robot| parts.iter().map(move |part| composed(robot, part));
    robots.iter().flat_map(of)
}

/// The box about a part on the world's axes, in f32.
pub fn slabs(part: &Body) -> Slabs {
    let half_sides = HALF_SIDES[part.shape as usize];
    let rows = rotation(part.rotation);
    [0, 1, 2].map(|axis| {
        let half: f32 = (0..3).map(|i| rows[axis][i].abs() as f32 * half_sides[i]).sum();
        let middle = part.translation[axis] as f32;
        [middle - half, middle + half]
    })
}

/// Parts as the links of a tree: each at an end of an earlier one, turned by any angle.
fn tree(random: &mut Stream) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for number in 0..PARTS {
        let from = match number {
            0 => [0.0; 3],
            _ => parts[random.index(number as u32) as usize].translation,
        };
        let way = random.direction();
        parts.push(Part {
            shape: (number % HALF_SIDES.len()) as u32,
            rotation: random.rotation(),
            translation: [0, 1, 2].map(|axis| from[axis] + 0.75 * f64::from(way[axis])),
            rounded: false,
        });
    }
    parts
}

/// Straight flights in a box with elastic walls, each robot turning about an axis of its own.
fn fly(count: usize, frames: usize, random: &mut Stream) -> Vec<Vec<Body>> {
    let half = 3.35 * (count as f64).cbrt();
    let mut start = || {
        let place = [(); 3].map(|()| half * (2.0 * f64::from(random.unit()) - 1.0));
        let step = random.direction().map(|x| 0.1 * f64::from(x));
        let [x, y, z] = random.direction().map(|x| 0.02 * x);
        (Body::at(0, random.rotation(), place), step, [x, y, z, 1.0])
    };
    let mut robots: Vec<_> = (0..count).map(|_| start()).collect();
    let mut all = Vec::new();
    for _ in 0..frames {
        all.push(robots.iter().map(|(robot, ..)| *robot).collect());
        for (robot, steps, turn) in &mut robots {
            for (x, step) in robot.translation.iter_mut().zip(steps) {
                *x += *step;
                if x.abs() > half {
                    *step = step.abs() * -x.signum();
                }
            }
            robot.rotation = product(*turn, robot.rotation);
        }
    }
    all
}
