//! Brownian kicks: in each step a share of the dynamic bodies, drawn with replacement, gets a new
//! velocity (about N/100 in Broadmark's brownian scene, Serpa & Rodrigues 2019).

use std::ops::Range;

use serde::Deserialize;

use super::InitialState;
use super::{BuiltEffect, Effect, Velocities};
use crate::number::{Interval, Share};
use crate::random::Stream;
use sdop::bodies::Bodies;

/// `brownian = { share = 0.01, speed = [min, max] }`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { share = 0.1, speed = [0, 2] }")]
pub struct Settings {
    /// Mean share of the dynamic bodies that a step kicks.
    pub share: Share,
    /// Range of the new speeds; directions are uniform.
    pub speed: Interval,
}

/// The stream of kicks, apart from those of the initial state.
const KICK_STREAM: u64 = 1 << 32;

struct Brownian {
    draws: Stream,
    speed: Interval,
    kicks_a_step: f64,
    /// Where each run of the scene's dynamic bodies begins and ends, and how many dynamic bodies
    /// precede it.
    runs: Vec<(Range<usize>, usize)>,
    dynamic: u32,
    /// The scene's numbers of the bodies that are held, unless all are.
    numbers: Option<Vec<u32>>,
}

pub(super) fn new(settings: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    let mut dynamic = 0;
    let mut runs = Vec::new();
    for run in start.moving {
        runs.push((run.clone(), dynamic));
        dynamic += run.len();
    }
    Ok(Box::new(Brownian {
        draws: Stream::new(start.seed, KICK_STREAM),
        speed: settings.speed,
        kicks_a_step: f64::from(settings.share.0) * dynamic as f64,
        runs,
        // A scene has fewer than 2³² bodies.
        dynamic: dynamic as u32,
        numbers: None,
    }))
}

impl Brownian {
    /// The place of the scene's dynamic body `chosen` among the bodies that are held.
    fn place(&self, chosen: u32) -> Option<usize> {
        let chosen = chosen as usize;
        let after = self.runs.partition_point(|(_, before)| *before <= chosen);
        let (run, before) = &self.runs[after - 1];
        let body = run.start + chosen - before;
        match &self.numbers {
            None => Some(body),
            Some(numbers) => numbers.binary_search(&(body as u32)).ok(),
        }
    }
}

impl Effect for Brownian {
    fn step(
        &mut self,
        _: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        // The fraction of a kick is drawn, so that the mean is the share also for few bodies.
        let kicks = (self.kicks_a_step + f64::from(self.draws.unit())) as u64;
        let mut kicked = 0;
        for _ in 0..kicks {
            let chosen = self.draws.index(self.dynamic);
            let velocity = self.draws.vector(self.speed);
            // Every process draws all kicks and keeps those of the bodies that it moves.
            let place = self.place(chosen).filter(|&place| moves(dynamic, place));
            if let Some(place) = place {
                velocities.linear[place] = velocity;
                kicked += 1;
            }
        }
        kicked
    }

    fn wakes(&self) -> bool {
        true
    }

    fn renumber(&mut self, numbers: &[u32]) {
        self.numbers = Some(numbers.to_vec());
    }
}

/// Whether a place lies in one of the runs, which ascend.
fn moves(runs: &[Range<usize>], place: usize) -> bool {
    let after = runs.partition_point(|run| run.start <= place);
    after > 0 && runs[after - 1].contains(&place)
}
