//! Free rotation about a fixed world axis: q ← normalise(q + ½dt·ωq), with ω a pure quaternion
//! (first order, then back to unit length). The scene draws each dynamic body's ω: any direction, a
//! rate in radians per second.

use std::ops::Range;

use serde::Deserialize;

use super::InitialState;
use super::{BuiltEffect, Effect, Velocities};
use crate::number::Interval;
use sdop::bodies::Bodies;

/// `spin = { rate = [min, max] }`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { rate = [0, 2] }, in radians per second"
)]
pub struct Settings {
    /// Range of angular speeds, radians per second.
    pub rate: Interval,
}

struct Spin {
    half_dt: f32,
}

pub(super) fn new(_: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    Ok(Box::new(Spin { half_dt: 0.5 * start.dt }))
}

impl Effect for Spin {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        let mut changed = 0;
        for run in dynamic {
            let spins = &velocities.angular[run.clone()];
            for (q, spin) in bodies.rotation[run.clone()].iter_mut().zip(spins) {
                *q = turned(*q, spin.map(|rate| self.half_dt * rate));
            }
            changed += run.len() as u64;
        }
        changed
    }
}

/// normalise(q + hq) for the pure quaternion h. The norm is taken in f64, where no f32's square
/// leaves the range.
fn turned([x, y, z, w]: [f32; 4], h: [f32; 3]) -> [f32; 4] {
    let q = [
        x + (h[0] * w + h[1] * z - h[2] * y),
        y + (h[1] * w + h[2] * x - h[0] * z),
        z + (h[2] * w + h[0] * y - h[1] * x),
        w - (h[0] * x + h[1] * y + h[2] * z),
    ]
    .map(f64::from);
    let norm = libm::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    q.map(|component| (component / norm) as f32)
}
