//! Robots of many parts that fly and turn, and which of their parts meet.

use miette::IntoDiagnostic as _;
use sdop::compound::Part;
use sdop::volume::ShapeSpec;
use sdop::{ProceduralShape, Shape};
use sdop_bench::random::Stream;
use sdop_bench::remedy::OrReport as _;
use sdop_reference::WidePose;
use sdop_reference::wide::meet;

/// The parts of a robot.
pub const PARTS: usize = 30;

/// Half sides of the shapes.
pub const HALF_SIDES: [[f32; 3]; 3] = [[0.5, 0.25, 0.25], [0.25, 0.5, 0.125], [0.375; 3]];

/// The pose of a robot.
#[derive(Clone, Copy)]
pub struct RobotPose {
    pub rotation: [f32; 4],
    pub translation: [f64; 3],
}

/// The pose of one part in the world frame: a unit quaternion and a translation.
#[derive(Clone, Copy)]
pub struct PartPose {
    pub shape: usize,
    pub rotation: [f64; 4],
    pub translation: [f64; 3],
}

/// Robots and where they are in each frame.
pub struct Robots {
    pub shapes: Vec<Shape>,
    /// The parts of every robot.
    pub parts: Vec<Part>,
    pub frames: Vec<Vec<RobotPose>>,
}

/// A part of a robot, and of another one.
pub type Meeting = [[u32; 2]; 2];

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

    /// The parts of all robots where they are in the world.
    pub fn posed<'a>(&'a self, robots: &'a [RobotPose]) -> impl Iterator<Item = PartPose> + 'a {
        robots
            .iter()
            .flat_map(|robot| self.parts.iter().map(|part| composed(robot, part)))
    }

    /// All pairs of parts of two robots whose meshes meet, sorted. Poses are composed in f64.
    pub fn truth(&self, robots: &[RobotPose]) -> miette::Result<Vec<Meeting>> {
        let mesh = |shape: &Shape| {
            let (vertices, triangles) = (shape.vertices.clone(), shape.triangles.clone());
            sdop_reference::Shape::of_mesh(vertices, triangles).into_diagnostic()
        };
        let meshes = self
            .shapes
            .iter()
            .map(mesh)
            .collect::<miette::Result<Vec<_>>>()?;
        let parts: Vec<PartPose> = self.posed(robots).collect();
        let wide =
            |part: &PartPose| WidePose::new(part.rotation, part.translation).into_diagnostic();
        let poses = parts.iter().map(wide).collect::<miette::Result<Vec<_>>>()?;
        let mut meeting = Vec::new();
        for (i, one) in parts.iter().enumerate() {
            for (j, other) in parts.iter().enumerate().skip((i / PARTS + 1) * PARTS) {
                let apart = [0, 1, 2].map(|axis| one.translation[axis] - other.translation[axis]);
                // No part reaches farther than 0.65 from its origin.
                if apart.iter().map(|x| x * x).sum::<f64>() > 1.7 {
                    continue;
                }
                if meet(
                    (&meshes[one.shape], &poses[i]),
                    (&meshes[other.shape], &poses[j]),
                )
                .meets
                {
                    meeting.push([named(i), named(j)]);
                }
            }
        }
        Ok(meeting)
    }
}

/// The robot and the part of a part's number among all.
pub fn named(number: usize) -> [u32; 2] {
    [number / PARTS, number % PARTS].map(|n| n as u32)
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
        });
    }
    parts
}

/// Straight flights in a box with elastic walls, each robot turning about an axis of its own.
fn fly(count: usize, frames: usize, random: &mut Stream) -> Vec<Vec<RobotPose>> {
    let half = 3.35 * (count as f64).cbrt();
    let place =
        |random: &mut Stream| [(); 3].map(|()| half * (2.0 * f64::from(random.unit()) - 1.0));
    let mut robots: Vec<RobotPose> = (0..count)
        .map(|_| RobotPose {
            rotation: random.rotation(),
            translation: place(random),
        })
        .collect();
    let mut steps: Vec<[f64; 3]> = (0..count)
        .map(|_| random.direction().map(|x| 0.1 * f64::from(x)))
        .collect();
    let turns: Vec<[f32; 3]> = (0..count).map(|_| random.direction()).collect();
    let mut all = vec![robots.clone()];
    while all.len() < frames {
        for ((robot, step), axis) in robots.iter_mut().zip(&mut steps).zip(&turns) {
            for (x, step) in robot.translation.iter_mut().zip(step) {
                *x += *step;
                if x.abs() > half {
                    *step = step.abs() * -x.signum();
                }
            }
            let [x, y, z] = axis.map(|x| 0.02 * f64::from(x));
            let turned = product([x, y, z, 1.0], robot.rotation.map(f64::from));
            robot.rotation = unit(turned).map(|x| x as f32);
        }
        all.push(robots.clone());
    }
    all
}

fn composed(robot: &RobotPose, part: &Part) -> PartPose {
    let q = unit(robot.rotation.map(f64::from));
    let [x, y, z] = part.translation;
    let turned = product(product(q, [x, y, z, 0.0]), [-q[0], -q[1], -q[2], q[3]]);
    PartPose {
        shape: part.shape as usize,
        rotation: unit(product(q, part.rotation.map(f64::from))),
        translation: [0, 1, 2].map(|axis| robot.translation[axis] + turned[axis]),
    }
}

fn product([x, y, z, w]: [f64; 4], [a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    ]
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / norm)
}
