//! Tips that touch across cells: the partner's cell is two away when the cell's side is the bodies' diameter and the
//! division rounds.

use rand::{Rng, RngExt};

use super::exact::solids;
use super::{CatalogueError, Drawn};
use crate::bodies::Bodies;
use crate::lab::judge::case::Frame;

/// Pairs a case.
const PAIRS: usize = 16;

/// Pairs of octahedra, tip to tip along an axis, each pair placed where a grid of the diameter loses it if such a place is
/// found.
pub fn tips_across_borders(rng: &mut impl Rng) -> Result<Drawn, CatalogueError> {
    let size = 2_f32.powi(rng.random_range(-6..=6));
    let [_, octahedron] = solids(size)?;
    let cell = 2.0 * octahedron.ball.radius;
    let mut bodies = Bodies::default();
    for n in 0..PAIRS {
        let axis = rng.random_range(0..3);
        let mut from = [0.0; 3];
        // Pairs stay away from one another.
        from[(axis + 1) % 3] = 8.0 * size * n as f32;
        from[axis] = across(cell, 2.0 * size, rng);
        let mut to = from;
        to[axis] += 2.0 * size; // exact: `across` sees to that
        for t in [from, to] {
            bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], t);
        }
    }
    let shapes = vec![octahedron];
    let frames = vec![Frame::fitted(bodies, &shapes)];
    Ok(Drawn { shapes, frames })
}

/// A place x such that x + step is exact and lies two cells further on, by division or by multiplication.
fn across(cell: f32, step: f32, rng: &mut impl Rng) -> f32 {
    let divided = rng.random_range(0..2) == 0;
    let index = |x: f32| {
        if divided {
            (x / cell).floor()
        } else {
            (x * (1.0 / cell)).floor()
        }
    };
    let mut nearest = 0.0;
    for _ in 0..4096 {
        let border = rng.random_range(16..4096) as f32 * cell;
        let mut x = border;
        for _ in 0..3 {
            x = x.next_down();
            let exact = f64::from(x + step) == f64::from(x) + f64::from(step);
            if !exact {
                continue;
            }
            if index(x + step) - index(x) > 1.5 {
                return x;
            }
            nearest = x;
        }
    }
    nearest
}
