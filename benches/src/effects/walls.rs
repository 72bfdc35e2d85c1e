//! Elastic walls of the box: a body whose bounding sphere reaches beyond a wall is mirrored back, w
//! ← 2(wall − r) − w for its centre w, and its velocity is reversed (paper, section 5).
//!
//! `specular` reverses the velocity component across the wall. `reverse` is the paper's equation 3,
//! v' = −v, read literally: the whole velocity turns. Both keep the speed.

use std::ops::Range;

use super::InitialState;
use super::world_centre;
use super::{BuiltEffect, Effect, Velocities};
use sdop::bodies::Bodies;
use sdop::choice::choices;

choices! {
    /// How a wall turns a body's velocity.
    Settings, "kind of wall", {
        /// The component across the wall is reversed.
        Specular = "specular",
        /// The whole velocity is reversed.
        Reverse = "reverse",
    }
}

/// Two roundings of 2⁻²⁴ each, with room to spare.
const CENTRE_ROUNDING: f32 = 1.0 / (1 << 22) as f32;

struct Walls {
    kind: Settings,
    /// By shape: the ball's centre in the body frame, and how far it may get from the box's middle
    /// along an axis.
    shapes: Vec<([f32; 3], f32)>,
}

pub(super) fn new(kind: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    let Some(side) = start.side else {
        return Err((
            "the scene has no box".to_owned(),
            "add [box] with side = …, or leave the walls out",
        ));
    };
    let half = 0.5 * side;
    let shapes = start.shapes.iter().map(|s| (s.ball.centre, half - s.ball.radius));
    let walls = Walls { kind: *kind, shapes: shapes.collect() };
    let bodies = &start.bodies;
    for body in (0..bodies.len()).filter(|&body| bodies.dynamic[body]) {
        let (centre, limit) = walls.shapes[bodies.shape[body] as usize];
        let t = &bodies.translation[body];
        let world = world_centre(centre, &bodies.rotation[body], t);
        // A seeded body sits inside, but its t and its sphere's centre were each rounded once.
        let rounding = |axis: usize| CENTRE_ROUNDING * (t[axis].abs() + world[axis].abs());
        let inside = (0..3).all(|axis| world[axis].abs() <= limit + rounding(axis));
        if limit < 0.0 || !inside {
            let radius = start.shapes[bodies.shape[body] as usize].ball.radius;
            return Err((
                format!(
                    "dynamic body {body} of radius {radius} at {world:?} starts beyond a wall of a box of side {side}"
                ),
                "the box is centred on the origin and holds whole spheres: enlarge it or move the body",
            ));
        }
    }
    Ok(Box::new(walls))
}

impl Effect for Walls {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64 {
        let mut changed = 0;
        for body in dynamic.iter().cloned().flatten() {
            let (centre, limit) = self.shapes[bodies.shape[body] as usize];
            let t = &mut bodies.translation[body];
            let world = world_centre(centre, &bodies.rotation[body], t);
            let hit = world.map(|w| w.abs() > limit);
            if hit == [false; 3] {
                continue;
            }
            let v = &mut velocities.linear[body];
            for axis in 0..3 {
                if hit[axis] {
                    let offset = world[axis] - t[axis];
                    t[axis] = mirror(world[axis], limit) - offset;
                }
                if hit[axis] || self.kind == Settings::Reverse {
                    v[axis] = -v[axis];
                }
            }
            changed += 1;
        }
        changed
    }
}

/// `w` mirrored at the limit that it passed. A step longer than the box would pass the opposite
/// limit as well: it ends there.
fn mirror(w: f32, limit: f32) -> f32 {
    (2.0 * limit.copysign(w) - w).clamp(-limit, limit)
}
