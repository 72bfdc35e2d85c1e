//! Brownian kicks: each step a share of the dynamic bodies, drawn with replacement, gets a new velocity
//! (Broadmark's brownian scene kicks about N/100, Serpa & Rodrigues 2019).

use std::ops::Range;

use serde::Deserialize;

use super::Start;
use super::{Effect, Made};
use crate::bodies::Bodies;
use crate::lab::number::{Interval, Share};
use crate::lab::random::Stream;

/// `brownian = { share = 0.01, speed = [min, max] }`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Mean share of the dynamic bodies that a step kicks.
    pub share: Share,
    /// Range of the new speeds; directions are uniform.
    pub speed: Interval,
}

/// The stream of kicks, apart from those of the initial state.
const STREAM: u64 = 1 << 32;

struct Brownian {
    draws: Stream,
    speed: Interval,
    kicks_a_step: f64,
    dynamic: Vec<u32>,
}

pub(super) fn new(settings: &Settings, start: &Start<'_>) -> Made {
    let flags = &start.bodies.dynamic;
    // A scene has fewer than 2³² bodies.
    let dynamic: Vec<u32> = (0..flags.len())
        .filter(|&body| flags[body])
        .map(|body| body as u32)
        .collect();
    Ok(Box::new(Brownian {
        draws: Stream::new(start.seed, STREAM),
        speed: settings.speed,
        kicks_a_step: f64::from(settings.share.0) * dynamic.len() as f64,
        dynamic,
    }))
}

impl Effect for Brownian {
    fn step(&mut self, bodies: &mut Bodies, _: &[Range<usize>]) -> u64 {
        // The fraction of a kick is drawn, so that the mean is the share also for few bodies.
        let kicks = (self.kicks_a_step + f64::from(self.draws.unit())) as u64;
        for _ in 0..kicks {
            let chosen = self.draws.index(self.dynamic.len() as u32);
            let body = self.dynamic[chosen as usize];
            bodies.velocity[body as usize] = self.draws.vector(self.speed);
        }
        kicks
    }
}
