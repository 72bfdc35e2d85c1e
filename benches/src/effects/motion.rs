//! Rigid motion: t ← t + dt·v. Written `motion = true`.

use std::fmt;
use std::ops::Range;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

use super::InitialState;
use super::{BuiltEffect, Effect, Velocities};
use sdop::bodies::Bodies;

/// `true`: there is nothing to set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings;

impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TrueVisitor;
        impl Visitor<'_> for TrueVisitor {
            type Value = Settings;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, or no such line where it is not simulated")
            }

            fn visit_bool<E: Error>(self, on: bool) -> Result<Settings, E> {
                if on { Ok(Settings) } else { Err(E::invalid_value(Unexpected::Bool(on), &self)) }
            }
        }
        deserializer.deserialize_bool(TrueVisitor)
    }
}

struct Motion {
    dt: f32,
}

pub(super) fn new(Settings: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    Ok(Box::new(Motion { dt: start.dt }))
}

impl Effect for Motion {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        let mut changed = 0;
        for run in dynamic {
            let linear = &velocities.linear[run.clone()];
            for (t, v) in bodies.translation[run.clone()].iter_mut().zip(linear) {
                for axis in 0..3 {
                    t[axis] += self.dt * v[axis];
                }
            }
            changed += run.len() as u64;
        }
        changed
    }
}
