//! Gravity: v ← v + dt·a, the same for all bodies. With a period, the acceleration rotates about an
//! axis, which stirs a box of bodies (Broadmark's rotating-gravity scene, Serpa & Rodrigues 2019).

use std::f64::consts::TAU;
use std::ops::Range;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::InitialState;
use super::{BuiltEffect, Effect, Velocities};
use crate::number::{Positive, Real, vector};
use sdop::bodies::Bodies;

/// `gravity = [0, 0, -9.81]`, or `gravity = { acceleration = [0, 0, -9.81] }`, for a turning one
/// with `period` in seconds and an `axis`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration at the start, world frame.
    pub acceleration: [Real; 3],
    /// Seconds per full turn; `None` for a constant acceleration.
    pub period: Option<Positive>,
    /// The axis about which it turns, right-handed; z when absent.
    pub axis: Option<[Real; 3]>,
}

/// The keys of the table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    acceleration: [Real; 3],
    period: Option<Positive>,
    axis: Option<[Real; 3]>,
}

impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(GravityVisitor)
    }
}

/// Reads an acceleration alone, or a table with it.
struct GravityVisitor;

impl<'de> Visitor<'de> for GravityVisitor {
    type Value = Settings;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an acceleration such as [0, 0, -9.81], or { acceleration = [0, 0, -9.81] }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Settings, A::Error> {
        let acceleration = Deserialize::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(Settings { acceleration, period: None, axis: None })
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Settings, A::Error> {
        let Table { acceleration, period, axis } =
            Deserialize::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Settings { acceleration, period, axis })
    }
}

struct Gravity {
    dt: f32,
    acceleration: [f64; 3],
    /// Unit axis, and turns per step.
    turning: Option<([f64; 3], f64)>,
    steps: u64,
}

pub(super) fn new(settings: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    if settings.axis.is_some() && settings.period.is_none() {
        return Err((
            "an axis without a period".to_owned(),
            "give the period in seconds, or leave the axis out",
        ));
    }
    let axis = vector(settings.axis.unwrap_or([Real(0.0), Real(0.0), Real(1.0)])).map(f64::from);
    let norm = libm::sqrt(dot(axis, axis));
    if norm == 0.0 {
        return Err((
            "the axis has no direction".to_owned(),
            "any vector but zero, for example axis = [0, 0, 1]",
        ));
    }
    let turns_a_step =
        settings.period.map(|Positive(period)| f64::from(start.dt) / f64::from(period));
    Ok(Box::new(Gravity {
        dt: start.dt,
        acceleration: vector(settings.acceleration).map(f64::from),
        turning: turns_a_step.map(|turns| (axis.map(|x| x / norm), turns)),
        steps: 0,
    }))
}

impl Effect for Gravity {
    fn step(
        &mut self,
        _: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        let now = match self.turning {
            None => self.acceleration,
            Some((axis, turns_a_step)) => {
                let turns = self.steps as f64 * turns_a_step;
                rotated(self.acceleration, axis, TAU * (turns - libm::floor(turns)))
            }
        };
        self.steps += 1;
        let gain = now.map(|a| self.dt * a as f32);
        let mut changed = 0;
        for run in dynamic {
            for v in &mut velocities.linear[run.clone()] {
                for axis in 0..3 {
                    v[axis] += gain[axis];
                }
            }
            changed += run.len() as u64;
        }
        changed
    }
}

/// Rodrigues: a·cos θ + (k × a)·sin θ + k(k·a)(1 − cos θ) for the unit axis k.
fn rotated(a: [f64; 3], k: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = libm::sincos(angle);
    let along = dot(k, a) * (1.0 - cos);
    let across = [k[1] * a[2] - k[2] * a[1], k[2] * a[0] - k[0] * a[2], k[0] * a[1] - k[1] * a[0]];
    [0, 1, 2].map(|i| a[i] * cos + across[i] * sin + k[i] * along)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
