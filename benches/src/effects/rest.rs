//! Rest: a body that has been slow for some time falls asleep, as in physics engines. Asleep, it
//! keeps its pose to the bit, and its velocity, until it wakes.
//!
//! A body is slow while its speed is below `speed` and, where `rate` is given, its angular speed
//! below `rate`. In each step a body that isn't slow wakes all slow ones whose bounding spheres
//! touch its own, and they stay awake for `after` seconds more. A new velocity, from a kick or from
//! the response to a contact, wakes a body as soon as it is no longer slow. Bodies that are slow at
//! the start begin asleep.
//!
//! Who wakes follows from the poses and velocities of all bodies before they move, so the order of
//! bodies doesn't matter.

use std::ops::Range;

use serde::Deserialize;

use super::InitialState;
use super::contacts::{Contacts, dot};
use super::{BuiltEffect, Effect, Velocities};
use crate::number::Positive;
use sdop::bodies::Bodies;

/// `rest = { speed = 0.1, after = 0.5 }`, and `rate` for a limit of the angular speed.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The speed below which a body is slow.
    pub speed: Positive,
    /// The angular speed below which it is slow, radians per second; `None` for any.
    pub rate: Option<Positive>,
    /// Seconds until a slow body falls asleep.
    pub after: Positive,
}

struct Rest {
    /// Squares of the limits.
    speed: f64,
    rate: f64,
    /// Steps until a slow body falls asleep.
    steps: u32,
    /// Steps for which each body has been slow and nothing woke it, at most `steps`. At `steps` it
    /// is asleep.
    slow_steps: Vec<u32>,
    awake: Vec<Range<usize>>,
    contacts: Contacts,
}

pub(super) fn new(settings: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    let Settings { speed: Positive(speed), rate, after: Positive(after) } = *settings;
    // The cast saturates.
    let steps = libm::ceil(f64::from(after) / f64::from(start.dt)).max(1.0) as u32;
    let square = |limit: f32| f64::from(limit) * f64::from(limit);
    let mut rest = Rest {
        speed: square(speed),
        rate: rate.map_or(f64::INFINITY, |Positive(rate)| square(rate)),
        steps,
        slow_steps: Vec::new(),
        awake: Vec::new(),
        contacts: Contacts::new(start.shapes),
    };
    let start_steps = |body| u32::from(rest.is_slow(start.velocities, body)) * steps;
    rest.slow_steps = (0..start.bodies.len()).map(start_steps).collect();
    rest.find_awake(&super::runs(&start.bodies.dynamic));
    Ok(Box::new(rest))
}

impl Rest {
    /// Whether a body is slow. An f32's square is exact in f64; a NaN isn't slow.
    fn is_slow(&self, velocities: &Velocities, body: usize) -> bool {
        let square = |v: &[f32; 3]| {
            let v = v.map(f64::from);
            dot(v, v)
        };
        square(&velocities.linear[body]) < self.speed
            && square(&velocities.angular[body]) < self.rate
    }

    fn is_awake(&self, body: usize) -> bool {
        self.slow_steps[body] < self.steps
    }

    /// Lists the runs of bodies that are awake.
    fn find_awake(&mut self, dynamic: &[Range<usize>]) {
        let mut awake = std::mem::take(&mut self.awake);
        awake.clear();
        for body in dynamic.iter().cloned().flatten().filter(|&b| self.is_awake(b)) {
            match awake.last_mut() {
                Some(run) if run.end == body => run.end += 1,
                _ => awake.push(body..body + 1),
            }
        }
        self.awake = awake;
    }

    /// Wakes the slow bodies that touch one of the fast bodies.
    fn wake_touched(&mut self, fast: &[usize], bodies: &Bodies) {
        if fast.is_empty() {
            return;
        }
        self.contacts.find_spheres(bodies);
        for &body in fast {
            // A static body's steps are never read, and a fast one's are 0.
            self.contacts.each_touching(body, |other| self.slow_steps[other] = 0);
        }
    }
}

impl Effect for Rest {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        let before: Vec<bool> = (0..bodies.len()).map(|body| self.is_awake(body)).collect();
        let mut fast = Vec::new();
        for body in dynamic.iter().cloned().flatten() {
            if self.is_slow(velocities, body) {
                self.slow_steps[body] = self.steps.min(self.slow_steps[body] + 1);
            } else {
                self.slow_steps[body] = 0;
                fast.push(body);
            }
        }
        self.wake_touched(&fast, bodies);
        self.find_awake(dynamic);
        let turned = |&body: &usize| self.is_awake(body) != before[body];
        dynamic.iter().cloned().flatten().filter(turned).count() as u64
    }

    fn wakes(&self) -> bool {
        true
    }

    fn awake(&self) -> Option<&[Range<usize>]> {
        Some(&self.awake)
    }
}
