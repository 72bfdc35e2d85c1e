//! A culler in Rust, judged: a grid over bounding balls that claims to miss no pair of meshes.
//!
//! `cargo run --release --example judge` passes. With `-- --tight-cells` the cells are exactly as
//! large as the largest ball, and counted in f32: a partner can be two cells away.

use std::collections::HashMap;
use std::process::ExitCode;

use sdop::Bodies;
use sdop::rounding::pose::{rotation, transform};
use sdop_judge::{Claim, Contestant, JudgeError, Scene, judge};

/// A grid over bounding balls, counted anew in each frame.
pub struct Grid {
    /// Centre in the body frame and radius of each shape's ball.
    balls: Vec<([f32; 3], f64)>,
    tight: bool,
    pairs: Vec<[u32; 2]>,
}

impl Grid {
    /// The culler of a case's bodies; with `tight`, cells are as large as the largest ball.
    pub fn new(scene: &Scene<'_>, tight: bool) -> Self {
        let ball = |shape: &sdop::Shape| (shape.ball.centre, f64::from(shape.ball.radius));
        Self { balls: scene.shapes.iter().map(ball).collect(), tight, pairs: Vec::new() }
    }

    /// The cell of a point; indices beyond 2³⁰ would round, and such frames have one cell.
    fn cell(&self, x: f64, least: f64, diameter: f64, size: f64) -> i64 {
        if size / diameter >= 2_f64.powi(30) {
            0
        } else if self.tight {
            ((x as f32 - least as f32) / diameter as f32).floor() as i64
        } else {
            (x / (diameter * (1.0 + 2_f64.powi(-20)))).floor() as i64
        }
    }
}

impl Contestant for Grid {
    fn frame(&mut self, bodies: &Bodies) {
        self.pairs.clear();
        let ball = |i: usize| {
            let (centre, radius) = self.balls[bodies.shape[i] as usize];
            (transform(&rotation(bodies.rotation[i]), centre, bodies.translation[i]), radius)
        };
        let balls: Vec<([f64; 3], f64)> = (0..bodies.len()).map(ball).collect();
        let diameter = 2.0 * balls.iter().fold(f64::MIN_POSITIVE, |most, ball| most.max(ball.1));
        let size = balls.iter().flat_map(|ball| ball.0).fold(0.0, |most: f64, x| most.max(x.abs()));
        let least = [0, 1, 2].map(|axis| {
            let all = balls.iter().map(|ball| ball.0[axis]);
            all.fold(f64::INFINITY, f64::min)
        });
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (j, (b, rb)) in balls.iter().enumerate() {
            let cell = [0, 1, 2].map(|axis| self.cell(b[axis], least[axis], diameter, size));
            for n in 0..27 {
                let near = [0, 1, 2].map(|axis| cell[axis] + [n % 3, n / 3 % 3, n / 9][axis] - 1);
                for &i in cells.get(&near).into_iter().flatten() {
                    let (a, ra) = balls[i as usize];
                    let d2: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum();
                    let moves = bodies.dynamic[i as usize] || bodies.dynamic[j];
                    if moves && d2.sqrt() <= ra + rb + 1e-13 * (size + diameter) {
                        self.pairs.push([i, j as u32]);
                    }
                }
            }
            cells.entry(cell).or_default().push(j as u32);
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }

    fn change(&mut self, _bodies: &Bodies, _was: &[Option<u32>]) -> bool {
        true // nothing is kept from frame to frame
    }
}

fn main() -> Result<ExitCode, JudgeError> {
    let tight = std::env::args().any(|argument| argument == "--tight-cells");
    let verdict = judge(|scene: &Scene<'_>| Grid::new(scene, tight)).claims(Claim::Mesh).run()?;
    print!("{verdict}");
    Ok(if verdict.passed() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
