//! Which bodies move in each frame, and where to.
//!
//! The scene is the uniform one of all comparisons. A mover goes a tenth of its radius per frame
//! along a straight line and turns round at the walls.

use clap::ValueEnum;
use serde::Serialize;

use sdop::bodies::Bodies;
use sdop_bench::random::Stream;
use sdop_bench::scene::Scene;

use crate::frame::Frame;
use crate::scenes::{Course, Order, Spread};

/// The seed of what moves.
const SEED: u64 = 0x6d6f_7665_7273;
/// Seconds per frame, at a speed of one radius per second.
const DT: f32 = 0.1;
/// A wave takes so many frames through the box.
const WAVE_FRAMES: usize = 200;
/// Of so many frames the first ones have all movers, the others none.
const WAKING: [usize; 2] = [5, 20];

/// Which bodies move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// The same ones in each frame.
    Same,
    /// A random set, drawn anew for each frame.
    Fresh,
    /// Neighbours along x, from one end of the box to the other.
    Wave,
    /// All movers for five frames, then none for fifteen.
    Waking,
    /// A random set, and each goes anywhere.
    Teleport,
    /// A random set, each replaced by a new body somewhere else.
    Replaced,
}

impl Motion {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Same => "the same ones",
            Self::Fresh => "a fresh random set",
            Self::Wave => "a moving wave",
            Self::Waking => "all waking, then sleeping",
            Self::Teleport => "teleports",
            Self::Replaced => "removed and inserted",
        }
    }
}

/// The bodies and who moves.
pub struct MoverCourse {
    /// The scene as it was placed.
    pub scene: Scene,
    /// All bodies after the last frame.
    pub present: Frame,
    motion: Motion,
    movers: usize,
    /// Bodies, the first of which move; of a wave, all bodies along x.
    order: Vec<u32>,
    velocities: Vec<[f32; 3]>,
    half_side: f32,
    draws: Stream,
    frame: usize,
}

impl MoverCourse {
    /// So many bodies of which so many move.
    pub fn new(bodies: usize, movers: usize, motion: Motion) -> miette::Result<Self> {
        let mut course = Course::new(Spread::Uniform, bodies, Order::Random, 0)?;
        let mut present = Frame::default();
        course.next_frame(&mut present)?;
        let mut draws = Stream::new(SEED, motion as u64);
        let mut order: Vec<u32> = (0..bodies as u32).collect();
        if motion == Motion::Wave {
            let x_of = |&body: &u32| present.bodies.translation[body as usize][0];
            order.sort_by(|a, b| x_of(a).total_cmp(&x_of(b)));
        } else {
            draw_first(&mut order, movers, &mut draws);
        }
        let scene = course.scene;
        Ok(Self {
            velocities: scene.velocities.linear.clone(),
            half_side: scene.side.map_or(f32::INFINITY, |side| side / 2.0),
            scene,
            present,
            motion,
            movers,
            order,
            draws,
            frame: 0,
        })
    }

    /// The next frame's changes.
    pub fn next_frame(&mut self, frame: &mut Frame) {
        let mut changed = self.next_movers();
        changed.sort_unstable();
        let mut moved = Bodies::default();
        for &body in &changed {
            let at = body as usize;
            let place = self.next_place(at);
            let bodies = &mut self.present.bodies;
            bodies.translation[at] = place;
            moved.push(bodies.shape[at], bodies.dynamic[at], bodies.rotation[at], place);
        }
        frame.fill(&moved, &self.scene.shapes);
        for (&body, (&slabs, &corners)) in
            changed.iter().zip(frame.boxes.iter().zip(&frame.corners))
        {
            self.present.boxes[body as usize] = slabs;
            self.present.corners[body as usize] = corners;
        }
        frame.changed = Some(changed);
        self.frame += 1;
    }

    fn next_movers(&mut self) -> Vec<u32> {
        let is_awake = self.frame % WAKING[1] < WAKING[0];
        match self.motion {
            Motion::Same => {}
            Motion::Waking if is_awake => {}
            Motion::Waking => return Vec::new(),
            Motion::Wave => return self.in_wave().to_vec(),
            Motion::Fresh | Motion::Teleport | Motion::Replaced => {
                draw_first(&mut self.order, self.movers, &mut self.draws);
            }
        }
        self.order[..self.movers].to_vec()
    }

    /// As many as should move, further along x from frame to frame.
    fn in_wave(&self) -> &[u32] {
        let ways = self.order.len() - self.movers;
        let start = self.frame % WAVE_FRAMES * ways / (WAVE_FRAMES - 1);
        &self.order[start..][..self.movers]
    }

    fn next_place(&mut self, body: usize) -> [f32; 3] {
        if matches!(self.motion, Motion::Teleport | Motion::Replaced) {
            let half = self.half_side;
            return [(); 3].map(|()| self.draws.between(-half, half));
        }
        let (half, velocity) = (self.half_side, &mut self.velocities[body]);
        let mut place = self.present.bodies.translation[body];
        for (x, v) in place.iter_mut().zip(velocity) {
            if x.abs() > half && x.signum() == v.signum() {
                *v = -*v;
            }
            *x += *v * DT;
        }
        place
    }
}

/// Draws so many at random, which come first.
fn draw_first(order: &mut [u32], count: usize, draws: &mut Stream) {
    for at in 0..count.min(order.len()) {
        let other = at + draws.index((order.len() - at) as u32) as usize;
        order.swap(at, other);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may stop")]

    use super::*;

    fn next(course: &mut MoverCourse) -> Frame {
        let mut frame = Frame::default();
        course.next_frame(&mut frame);
        frame
    }

    /// Every motion moves about as many as it should, each once, and boxes are where they were
    /// moved to.
    #[test]
    fn movers_are_as_many_as_asked_for() {
        for &motion in Motion::value_variants() {
            let mut course = MoverCourse::new(1000, 100, motion).unwrap();
            let (mut most, mut all) = (0, 0);
            for _ in 0..WAVE_FRAMES {
                let frame = next(&mut course);
                let changed = frame.changed.as_ref().unwrap();
                assert!(changed.windows(2).all(|two| two[0] < two[1]));
                for (body, slabs) in frame.changes() {
                    assert_eq!(course.present.boxes[body as usize], *slabs);
                }
                most = changed.len().max(most);
                all += changed.len();
            }
            let mean = all / WAVE_FRAMES;
            let expected = if motion == Motion::Waking { 25 } else { 100 };
            assert!(mean == expected && most == 100, "{motion:?}: {mean}, {most}");
        }
    }

    /// The same bodies move in each frame, or other ones.
    #[test]
    fn fresh_movers_differ() {
        let two = |motion| {
            let mut course = MoverCourse::new(1000, 100, motion).unwrap();
            [(); 2].map(|()| next(&mut course).changed)
        };
        let [one, other] = two(Motion::Same);
        assert_eq!(one, other);
        let [one, other] = two(Motion::Fresh);
        assert_ne!(one, other);
    }
}
