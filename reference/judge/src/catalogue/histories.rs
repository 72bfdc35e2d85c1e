//! Many frames, and many bodies: cubes and octahedra on a lattice, of which many touch to the bit.
//!
//! In each frame a few bodies step along an axis or turn by a quarter. Every fourth frame changes
//! only the additional input of the claim, or nothing.

use rand::{Rng, RngExt};

use super::claim_inputs::groups;
use super::exact_touches::{TURNS, solids};
use super::{CatalogueError, DrawnCase};
use crate::case::{Frame, picked};
use crate::claim::Claim;
use crate::contestant::{BodyPart, WorldBox};
use sdop::bodies::Bodies;
use sdop::volume::Shape;

/// What changes over many frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HistoryKind {
    /// Poses.
    Bodies,
    /// Poses, and the set of bodies.
    Sets,
    /// Poses and filters.
    Filters,
    /// Poses and margins, some larger than the bodies.
    Margins,
    /// Poses; states are saved and restored.
    States,
    /// Poses of bodies, and their parts.
    Parts,
    /// Poses and periods.
    Periods,
    /// Poses, over hundreds of frames.
    Frames,
}

impl HistoryKind {
    /// The claims that are about it.
    pub fn claims(self) -> &'static [Claim] {
        match self {
            Self::Bodies | Self::Sets | Self::Frames => Claim::PLAIN,
            Self::Filters => &[Claim::Filter],
            Self::Margins => &[Claim::Margin],
            Self::States => &[Claim::Restore],
            Self::Parts => &[Claim::Parts],
            Self::Periods => &[Claim::Periodic],
        }
    }
}

const COUNT: usize = 20;
const FRAMES: usize = 48;
const MANY_FRAMES: usize = 280;
/// Places along each axis of the lattice; bodies reach from one to the next.
const PLACES: i32 = 5;

/// A case of many frames.
pub fn history(
    kind: HistoryKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let size = 2_f32.powi(rng.random_range(-3..=3));
    let shapes = solids(size)?.to_vec();
    let mut frames = vec![first(kind, size, &shapes, rng)?];
    let count = if kind == HistoryKind::Frames { MANY_FRAMES } else { FRAMES };
    let mut saved: Option<usize> = None;
    while frames.len() < count {
        let n = frames.len();
        let mut next = Frame { was: None, save: false, restore: false, ..frames[n - 1].clone() };
        if n % 4 == 3 {
            other_input(kind, &mut next, size, &shapes, rng)?;
        } else {
            step(&mut next, size, rng);
            refit(&mut next, size, &shapes)?;
        }
        if kind == HistoryKind::Sets && n % 6 == 5 - number as usize % 2 {
            next = other_set(&next, rng);
        }
        if kind == HistoryKind::States {
            if let Some(saved) = saved.filter(|_| rng.random_range(0..5) == 0) {
                // Half of the time the frames after the saved one come again.
                let again = saved + 1..(saved + 1 + rng.random_range(0..5)).min(n);
                let mut again: Vec<Frame> = frames[again]
                    .iter()
                    .map(|frame| Frame { save: false, restore: false, ..frame.clone() })
                    .collect();
                again.push(next);
                again[0].restore = true;
                frames.append(&mut again);
                continue;
            }
            next.save = n == 1 || rng.random_range(0..6) == 0;
            saved = if next.save { Some(n) } else { saved };
        }
        frames.push(next);
    }
    Ok(DrawnCase { shapes, frames })
}

/// Bodies on the lattice, with the input of the claim.
fn first(
    kind: HistoryKind,
    size: f32,
    shapes: &[Shape],
    rng: &mut impl Rng,
) -> Result<Frame, CatalogueError> {
    let mut bodies = Bodies::default();
    for i in 0..COUNT {
        let t = std::array::from_fn(|_| 2.0 * size * rng.random_range(-PLACES..=PLACES) as f32);
        let turn = TURNS[rng.random_range(0..TURNS.len())];
        bodies.push(u32::from(i % 3 == 0), i % 5 != 4, turn, t);
    }
    let mut frame = Frame { bodies, ..Frame::default() };
    if kind == HistoryKind::Parts {
        frame.parts = Some(draw_parts(size, rng));
    }
    refit(&mut frame, size, shapes)?;
    other_input(kind, &mut frame, size, shapes, rng)?;
    frame.was = None;
    Ok(frame)
}

/// A few bodies move by a place, or by half of one, or turn.
fn step(frame: &mut Frame, size: f32, rng: &mut impl Rng) {
    for i in 0..frame.bodies.len() {
        if !frame.bodies.dynamic[i] || rng.random_range(0..4) > 0 {
            continue;
        }
        let axis = rng.random_range(0..3);
        let by = [-2.0, -1.0, 1.0, 2.0][rng.random_range(0..4)] * size;
        let t = &mut frame.bodies.translation[i][axis];
        *t += if t.abs() > 2.0 * size * PLACES as f32 { -t.signum() * by.abs() } else { by };
        if rng.random_range(0..4) == 0 {
            frame.bodies.rotation[i] = TURNS[rng.random_range(0..TURNS.len())];
        }
    }
}

/// The boxes of the solids themselves, which touch where they do.
fn refit(frame: &mut Frame, size: f32, shapes: &[Shape]) -> Result<(), CatalogueError> {
    if let Some(parts) = frame.parts.take() {
        let bodies = std::mem::take(&mut frame.bodies);
        *frame = Frame { was: frame.was.take(), ..Frame::of_parts(bodies, parts, shapes)? };
        return Ok(());
    }
    let solid = |&[x, y, z]: &[f32; 3]| -> WorldBox {
        [x - size, y - size, z - size, x + size, y + size, z + size]
    };
    frame.boxes = frame.bodies.translation.iter().map(solid).collect();
    Ok(())
}

/// Another input, and nothing else.
fn other_input(
    kind: HistoryKind,
    frame: &mut Frame,
    size: f32,
    shapes: &[Shape],
    rng: &mut impl Rng,
) -> Result<(), CatalogueError> {
    let count = frame.bodies.len();
    match kind {
        HistoryKind::Filters => {
            let mut filter = groups(count, rng);
            for j in 1..count as u32 {
                filter
                    .excluded
                    .extend((rng.random_range(0..2) == 0).then(|| [rng.random_range(0..j), j]));
            }
            filter.excluded.sort_unstable();
            frame.filter = Some(filter);
        }
        HistoryKind::Margins => {
            let mut margin = |_| size * rng.random_range(0..=6) as f32 / 2.0;
            frame.margins = Some((0..count).map(&mut margin).collect());
        }
        HistoryKind::Periods => {
            let period = |rng: &mut _| {
                let wide = RngExt::random_range(rng, PLACES..=3 * PLACES);
                (wide < 2 * PLACES + 4).then(|| f64::from(2.0 * size) * f64::from(wide))
            };
            frame.periods = Some([0, 1, 2].map(|_| period(rng)));
        }
        HistoryKind::Parts => {
            frame.parts = Some(draw_parts(size, rng));
            frame.was = Some((0..count as u32).map(Some).collect());
            refit(frame, size, shapes)?;
        }
        _ => {}
    }
    Ok(())
}

/// Up to three parts for each body, none for some.
fn draw_parts(size: f32, rng: &mut impl Rng) -> Vec<Vec<BodyPart>> {
    let mut part = || {
        let [x, y, z, w] = TURNS[rng.random_range(0..TURNS.len())];
        let [tx, ty, tz] = std::array::from_fn(|_| size * rng.random_range(-4..=4) as f32);
        BodyPart { shape: rng.random_range(0..2), pose: [x, y, z, w, tx, ty, tz] }
    };
    (0..COUNT).map(|i| (0..i % 4).map(|_| part()).collect()).collect()
}

/// Some bodies leave, some come back as new ones, and all numbers change.
fn other_set(frame: &Frame, rng: &mut impl Rng) -> Frame {
    let count = frame.bodies.len();
    let mut order: Vec<usize> = (0..count).filter(|_| rng.random_range(0..8) > 0).collect();
    let left = order.len();
    order.rotate_left(left / 3);
    order.extend((0..COUNT.saturating_sub(left)).map(|_| rng.random_range(0..count)));
    let former = |(at, &body): (usize, &usize)| (at < left).then_some(body as u32);
    Frame {
        bodies: picked(&frame.bodies, &order),
        boxes: order.iter().map(|&i| frame.boxes[i]).collect(),
        was: Some(order.iter().enumerate().map(former).collect()),
        ..frame.clone()
    }
}

/// Sets of more and more bodies, the last one with more than 16 bits count.
const SETS: [usize; 2] = [1 << 12, 70_000];
/// Half sizes from a place to the next one: bodies there are far apart.
const SPACING: f32 = 6.0;

/// Octahedra far from each other. In each of two frames, others have left their places and touch
/// one of very different number, tip to tip.
pub fn many(number: u32, rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    let shapes = vec![solids(1.0)?[1].clone()];
    let count = SETS[number as usize % SETS.len()];
    let place = |i: usize| [i / 64, i / 8 % 8, i % 8].map(|n| SPACING * n as f32);
    let mut frame = || {
        let mut bodies = Bodies::default();
        let first = rng.random_range(0..16);
        for i in 0..count {
            let mut t = place(i);
            if i % 32 == first {
                let shift = count / 2 + rng.random_range(0..64);
                t = place((i + shift) % count);
                t[rng.random_range(0..3)] += if rng.random() { 2.0 } else { -2.0 };
            }
            bodies.push(0, i % 5 != 4, [0.0, 0.0, 0.0, 1.0], t);
        }
        let boxes = bodies.translation.iter();
        let boxes = boxes.map(|&[x, y, z]| [x - 1.0, y - 1.0, z - 1.0, x + 1.0, y + 1.0, z + 1.0]);
        Frame { boxes: boxes.collect(), bodies, ..Frame::default() }
    };
    Ok(DrawnCase { frames: vec![frame(), frame()], shapes })
}
