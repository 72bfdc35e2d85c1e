//! The scenes of the comparison, built by the bench's scene code: the same frames for all engines.
//!
//! Bodies are balls around their origins with 1.5 overlaps each on average. They move a tenth of a
//! unit radius per frame and are reflected at walls. The paper's scene, 500 bodies in a box of
//! 16.1, is used as the smallest uniform one.

use std::path::Path;

use clap::ValueEnum;
use sdop::bodies::Bodies;
use sdop::mesh::ProceduralShape;
use sdop_bench::effects::Effects;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::scene::{Scene, SceneFile};
use serde::Serialize;

use crate::frame::{Frame, ORDERS};

/// How bodies are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Spread {
    /// Evenly, all of one radius.
    Uniform,
    /// Evenly, radii from 1 to 16, log-uniform.
    Mixed,
    /// In dense balls of some 370 bodies with void between them.
    Clustered,
    /// Evenly, boxes with sides 1 : 8 : 64 in any order; bodies are balls to nobody.
    Long,
}

/// In which order bodies are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// As drawn.
    Random,
    /// Along a Morton curve through their places in the first timed frame.
    Sorted,
}

/// Pairs of boxes in the first frame, by spread and number of bodies: a definition that drifts is
/// no comparison.
pub const EXPECTED: [(Spread, usize, usize); 19] = [
    (Spread::Uniform, 500, 2229),
    (Spread::Uniform, 1000, 1604),
    (Spread::Uniform, 10_000, 14_975),
    (Spread::Uniform, 100_000, 145_899),
    (Spread::Uniform, 1_000_000, 1_447_305),
    (Spread::Mixed, 500, 792),
    (Spread::Mixed, 1000, 1539),
    (Spread::Mixed, 10_000, 15_000),
    (Spread::Mixed, 100_000, 146_863),
    (Spread::Mixed, 1_000_000, 1_450_190),
    (Spread::Clustered, 500, 752),
    (Spread::Clustered, 1000, 2204),
    (Spread::Clustered, 10_000, 24_251),
    (Spread::Clustered, 100_000, 250_227),
    (Spread::Clustered, 1_000_000, 2_509_501),
    (Spread::Long, 500, 683),
    (Spread::Long, 1000, 1418),
    (Spread::Long, 10_000, 14_515),
    (Spread::Long, 100_000, 148_841),
];

/// A scene and where it is.
pub struct Course {
    /// The scene, with its bodies in the given order.
    pub scene: Scene,
    effects: Effects,
    bodies: Bodies,
    started: bool,
    is_long: bool,
}

impl Course {
    /// The scene of this many bodies, numbered in the given order; `timed_from` is the first timed
    /// frame.
    pub fn new(
        spread: Spread,
        bodies: usize,
        order: Order,
        timed_from: usize,
    ) -> miette::Result<Self> {
        let text = definition(spread, bodies);
        let name = format!("{spread:?} of {bodies}");
        let mut scene = SceneFile::parse(&text, &name, Path::new(""))?.build()?;
        if order == Order::Sorted {
            let mut ahead = Self::start(scene.clone(), spread)?;
            let mut frame = Frame::default();
            for _ in 0..=timed_from {
                ahead.next_frame(&mut frame)?;
            }
            permute(&mut scene, &along_curve(&frame.bodies.translation));
        }
        Self::start(scene, spread)
    }

    fn start(scene: Scene, spread: Spread) -> miette::Result<Self> {
        Ok(Self {
            effects: scene.start_effects()?,
            bodies: scene.bodies.clone(),
            started: false,
            is_long: spread == Spread::Long,
            scene,
        })
    }

    /// Writes the next frame; the first is the scene as placed.
    pub fn next_frame(&mut self, frame: &mut Frame) -> miette::Result<()> {
        if self.started {
            self.effects.step(&mut self.bodies).or_report()?;
        }
        self.started = true;
        if self.is_long {
            frame.fill_long(&self.bodies, &self.scene.shapes);
        } else {
            frame.fill(&self.bodies, &self.scene.shapes);
        }
        Ok(())
    }
}

fn definition(spread: Spread, bodies: usize) -> String {
    let side = 160.0 * (bodies as f64 / 1e4).cbrt();
    let clusters = (27 * bodies).div_ceil(10_000);
    let (bounds, radius, placement) = match spread {
        Spread::Uniform if bodies == 500 => ("side = 16.1".to_owned(), "1.0", String::new()),
        Spread::Uniform => ("partners = 1.5".to_owned(), "1.0", String::new()),
        Spread::Mixed => ("partners = 1.5".to_owned(), "[0.25, 4.0]", String::new()),
        Spread::Clustered => (
            format!("side = {side:?}"),
            "1.0",
            format!("placement = {{ clusters = {{ number = {clusters}, radius = 10.0 }} }}"),
        ),
        // Three partners per box on average, as boxes of balls have that meet 1.5 spheres.
        Spread::Long => (format!("side = {:?}", 0.72 * side), "1.0", String::new()),
    };
    // A shape for each order of the sides; what they look like matters to nobody.
    let forms: &[&str] = match spread {
        Spread::Long => &ProceduralShape::NAMES[..ORDERS.len()],
        _ => &["box"],
    };
    let group = |k: usize| {
        let count = bodies * (k + 1) / forms.len() - bodies * k / forms.len();
        format!(
            "[[bodies]]\nshape = '{}'\ncount = {count}\nradius = {radius}\nspeed = 1.0\n{placement}\n",
            forms[k]
        )
    };
    format!(
        "name = 'field'\nseed = 1\nframes = 1\ndt = 0.1\n[box]\n{bounds}\n{}[effects]\nmotion = true\nwalls = 'specular'\n",
        (0..forms.len()).map(group).collect::<String>()
    )
}

/// Bodies by the Morton code of their cell, 1024 cells per side.
fn along_curve(places: &[[f32; 3]]) -> Vec<usize> {
    let reach = places.iter().flatten().fold(0.0_f32, |m, x| m.max(x.abs()));
    let code = |place: &[f32; 3]| {
        let cells = place.map(|x| (((x + reach) / (2.0 * reach) * 1024.0) as u32).min(1023));
        (0..10).fold(0_u32, |code, bit| {
            let digits = (0..3).map(|axis| (cells[axis] >> bit & 1) << (3 * bit + axis));
            code | digits.sum::<u32>()
        })
    };
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by_cached_key(|&body| code(&places[body]));
    order
}

fn permute(scene: &mut Scene, order: &[usize]) {
    fn column<T: Copy>(column: &mut Vec<T>, order: &[usize]) {
        *column = order.iter().map(|&body| column[body]).collect();
    }
    let Scene { bodies, velocities, .. } = scene;
    column(&mut bodies.shape, order);
    column(&mut bodies.dynamic, order);
    column(&mut bodies.rotation, order);
    column(&mut bodies.translation, order);
    column(&mut velocities.linear, order);
    column(&mut velocities.angular, order);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may stop")]

    use super::*;

    /// Sorting renumbers bodies and changes nothing else.
    #[test]
    fn sorting_only_renumbers_bodies() {
        let frames = |order| {
            let mut course = Course::new(Spread::Mixed, 300, order, 5).unwrap();
            let mut frame = Frame::default();
            for _ in 0..7 {
                course.next_frame(&mut frame).unwrap();
            }
            frame.boxes
        };
        let (random, sorted) = (frames(Order::Random), frames(Order::Sorted));
        assert_ne!(random, sorted);
        let bits = |boxes: &[crate::frame::Slabs]| {
            let mut bits: Vec<_> = boxes.iter().map(|b| b.map(|s| s.map(f32::to_bits))).collect();
            bits.sort_unstable();
            bits
        };
        assert_eq!(bits(&random), bits(&sorted));
    }

    #[test]
    fn neighbours_on_the_curve_are_near() {
        let mut course = Course::new(Spread::Uniform, 1000, Order::Sorted, 0).unwrap();
        let mut frame = Frame::default();
        course.next_frame(&mut frame).unwrap();
        let t = &frame.bodies.translation;
        let step = |w: &[[f32; 3]]| (0..3).map(|i| (w[0][i] - w[1][i]).abs()).sum::<f32>();
        let mean = t.windows(2).map(step).sum::<f32>() / 999.0;
        // Two uniform points of the box are a box's side apart in this norm.
        let side = course.scene.side.unwrap();
        assert!(mean < 0.25 * side, "{mean} of {side}");
    }
}
