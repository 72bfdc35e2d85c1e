//! Elastic response: two bodies whose bounding spheres touch and approach exchange momentum along
//! the line of centres, as smooth balls of equal density (mass ∝ r³) do; a static body has infinite
//! mass.
//!
//! With n = cj − ci, the relative approach a = (vi − vj)·n / |n|² > 0 changes vi by −2mj/(mi +
//! mj)·a·n and vj by 2mi/(mi + mj)·a·n: momentum and kinetic energy stay. The paper's bodies pass
//! through one another; this effect is for scenes in which they shouldn't. Contacts are those of
//! the spheres in f64, found here and charged to this effect, so that trajectories never depend on
//! the culling under test. Pairs are treated in index order.

use std::ops::Range;

use super::InitialState;
use super::contacts::{Contacts, WorldSphere, difference, dot};
use super::{BuiltEffect, Effect, Velocities};
use sdop::bodies::Bodies;
use sdop::choice::choices;

choices! {
    /// How bodies respond to contact.
    Settings, "response", {
        /// Momentum and energy are kept.
        Elastic = "elastic",
    }
}

struct Elastic {
    contacts: Contacts,
}

pub(super) fn new(Settings::Elastic: &Settings, start: &InitialState<'_>) -> BuiltEffect {
    Ok(Box::new(Elastic { contacts: Contacts::new(start.shapes) }))
}

impl Effect for Elastic {
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        _: &[Range<usize>],
    ) -> u64 {
        self.contacts.find_spheres(bodies);
        let spheres = self.contacts.spheres();
        let mut changed = 0;
        let mut partners = Vec::new();
        for i in 0..spheres.len() {
            partners.clear();
            self.contacts.each_touching(i, |j| {
                if i < j && (bodies.dynamic[i] || bodies.dynamic[j]) {
                    partners.push(j);
                }
            });
            partners.sort_unstable();
            for &j in &partners {
                changed += exchange(bodies, &mut velocities.linear, spheres, i, j);
            }
        }
        changed
    }

    fn wakes(&self) -> bool {
        true
    }
}

/// Exchanges momentum if i and j approach; returns how many bodies changed.
fn exchange(
    bodies: &Bodies,
    velocity: &mut [[f32; 3]],
    spheres: &[WorldSphere],
    i: usize,
    j: usize,
) -> u64 {
    let n = difference(&spheres[i], &spheres[j]);
    let (vi, vj) = (velocity[i].map(f64::from), velocity[j].map(f64::from));
    let approach = dot([0, 1, 2].map(|axis| vi[axis] - vj[axis]), n);
    // Coincident centres have no line between them: their approach is 0, and dividing by n·n would
    // make NaN.
    if approach <= 0.0 {
        return 0;
    }
    let rate = approach / dot(n, n);
    let (share_i, share_j) = shares(bodies, spheres, i, j);
    if bodies.dynamic[i] {
        velocity[i] = [0, 1, 2].map(|axis| (vi[axis] - share_i * rate * n[axis]) as f32);
    }
    if bodies.dynamic[j] {
        velocity[j] = [0, 1, 2].map(|axis| (vj[axis] + share_j * rate * n[axis]) as f32);
    }
    u64::from(bodies.dynamic[i]) + u64::from(bodies.dynamic[j])
}

/// 2mj/(mi + mj) and 2mi/(mi + mj); a static partner is infinitely heavy.
fn shares(bodies: &Bodies, spheres: &[WorldSphere], i: usize, j: usize) -> (f64, f64) {
    if !bodies.dynamic[i] || !bodies.dynamic[j] {
        return (2.0, 2.0);
    }
    let mass = |body: usize| spheres[body].radius * spheres[body].radius * spheres[body].radius;
    let (mi, mj) = (mass(i), mass(j));
    (2.0 * mj / (mi + mj), 2.0 * mi / (mi + mj))
}
