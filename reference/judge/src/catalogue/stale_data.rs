//! Changes of a body between two frames: its position, its shape, its number, or the origin of all
//! positions, each alone and all at once.
//!
//! Each row has a static body and a moving one, far from each other. In each frame a change brings
//! some of the moving bodies to their partners, from either side along one axis. A culler that
//! keeps stale data misses a pair.

use rand::Rng;

use super::changes::{
    MEETING_DISTANCE, PARTED_DISTANCE, QUARTER_TURNS, TIP_DISTANCE, UNTURNED, cube, needle, places,
};
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use sdop::bodies::Bodies;

/// What changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StaleKind {
    /// Bodies stay where they are and get another shape.
    Reshape,
    /// Bodies move, and all have other numbers.
    Reorder,
    /// Bodies move, and all of them, static ones as well, are seen from another origin.
    Rebase,
    /// Bodies jump, get another shape, come, go and move in one frame, in which all have other
    /// numbers.
    AllAtOnce,
}

const ROWS: usize = 10;
const FRAMES: usize = 6;
/// Where each frame's origin is along the axis of the changes.
const ORIGINS: [f32; FRAMES] = [0.0, 4096.0, -4096.0, 65_536.0, 0.0, -8192.0];

/// A body in a frame.
struct RowBody {
    /// The same for the same body in all frames.
    id: usize,
    shape: u32,
    dynamic: bool,
    rotation: [f32; 4],
    translation: [f32; 3],
}

/// A case whose changes are along the axis of this number, modulo 3.
pub fn changing(
    kind: StaleKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let shapes = vec![cube(rng)?, needle()?];
    let axis = number as usize % 3;
    let places = places(axis, ROWS, rng);
    let mut frames: Vec<Frame> = Vec::new();
    let mut before: Vec<usize> = Vec::new();
    for n in 0..FRAMES {
        let mut all: Vec<RowBody> =
            (0..ROWS).flat_map(|row| placed(kind, axis, &places, row, n)).collect();
        if matches!(kind, StaleKind::Reorder | StaleKind::AllAtOnce) {
            let by = 7 * n % all.len();
            all.rotate_left(by);
        }
        let number = |id: usize| before.iter().position(|&known| known == id);
        let former = |body: &RowBody| number(body.id).map(|at| at as u32);
        let was = (n > 0).then(|| all.iter().map(former).collect());
        let mut bodies = Bodies::default();
        for body in &all {
            bodies.push(body.shape, body.dynamic, body.rotation, body.translation);
        }
        before = all.iter().map(|body| body.id).collect();
        frames.push(Frame { was, ..Frame::fitted(bodies, &shapes) });
    }
    Ok(DrawnCase { shapes, frames })
}

/// A row's bodies in a frame: the static one, and the other, which meets it in every other frame.
/// On either side there are rows that meet in the first frame and rows that don't.
fn placed(kind: StaleKind, axis: usize, places: &[[f32; 3]], row: usize, n: usize) -> Vec<RowBody> {
    let after = (n % 2 == 1) != (row / 2 % 2 == 1);
    let side = if row.is_multiple_of(2) { 1.0 } else { -1.0 };
    let origin = match kind {
        StaleKind::Rebase => ORIGINS[n],
        _ => 0.0,
    };
    let at = |distance: f32| {
        let mut place = places[row];
        place[axis] += side * distance + origin;
        place
    };
    let moving = |id: usize, shape: u32, distance: f32| RowBody {
        id,
        shape,
        dynamic: true,
        rotation: QUARTER_TURNS[axis],
        translation: at(distance),
    };
    let mut all = vec![RowBody {
        id: 2 * row,
        shape: 0,
        dynamic: false,
        rotation: UNTURNED,
        translation: at(0.0),
    }];
    let id = 2 * row + 1;
    let change = match kind {
        StaleKind::Reshape => 1,
        StaleKind::AllAtOnce => row % 4,
        StaleKind::Reorder | StaleKind::Rebase => 3,
    };
    match change {
        0 => all.push(moving(id, 0, if after { MEETING_DISTANCE } else { 1e6 })),
        1 => all.push(moving(id, u32::from(after), TIP_DISTANCE)),
        // A new body each time, which is gone in the next frame.
        2 if after => all.push(moving(id + 2 * ROWS * (n + 1), 0, MEETING_DISTANCE)),
        2 => {}
        _ => all.push(moving(id, 0, if after { MEETING_DISTANCE } else { PARTED_DISTANCE })),
    }
    all
}
