//! Crowds of bodies, and what happens to them from frame to frame.

use rand::{Rng, RngExt};

use super::DrawnCase;
use super::contacts::forms;
use crate::case::{Frame, picked};
use crate::draw::bodies::{crowd as uniform, rotation};
use crate::draw::forms::{self, Form, FormError};
use crate::truth::reference_shapes::Shapes;
use sdop::bodies::Bodies;
use sdop::volume::{Axes, DirectionSet, Shape};

/// What happens to the bodies of a crowd.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrowdKind {
    /// Nothing: one frame.
    Still,
    /// Bodies drift and turn.
    Moving,
    /// One frame of radii from 2⁻⁶ to 4.
    Sizes,
    /// Few pairs, then all, then few.
    Growth,
    /// One body touches all others.
    Hub,
    /// All pairs at once, more than 2¹⁸ of them, and again.
    NewPairs,
    /// One body touches thousands.
    Partners,
    /// Frames come again.
    Repeated,
    /// The same bodies in another order.
    Renumbered,
    /// Bodies exchange places.
    Swap,
    /// Bodies jump far away and back.
    Teleport,
    /// Bodies come and go.
    InsertRemove,
    /// Bodies turn in place.
    Turn,
    /// Bodies move by a few times their size.
    Move,
}

/// Draws a crowd.
pub fn crowd(kind: CrowdKind, number: u32, rng: &mut impl Rng) -> Result<DrawnCase, FormError> {
    let shapes = shapes(kind, rng)?;
    let bodies = match kind {
        CrowdKind::Growth => dense(&shapes.built, 96, rng),
        CrowdKind::NewPairs => dense(&shapes.built, 768, rng),
        CrowdKind::Hub => hub(&shapes.built, 384, rng),
        CrowdKind::Partners => hub(&shapes.built, 4500, rng),
        CrowdKind::Sizes => fix_some(uniform(&shapes, 96, 4.0, rng)),
        _ => fix_some(uniform(&shapes, 40, 4.0, rng)),
    };
    let (bodies, was): (Vec<Bodies>, Vec<_>) = match kind {
        CrowdKind::InsertRemove => changing(bodies, rng),
        _ => frames(kind, number, bodies, rng).into_iter().map(|frame| (frame, None)).unzip(),
    };
    let frame = |(bodies, was)| Frame { was, ..Frame::fitted(bodies, &shapes.built) };
    let frames = bodies.into_iter().zip(was).map(frame).collect();
    Ok(DrawnCase { shapes: shapes.built, frames })
}

fn shapes(kind: CrowdKind, rng: &mut impl Rng) -> Result<Shapes, FormError> {
    let forms = match kind {
        CrowdKind::Growth | CrowdKind::NewPairs => vec![Form::of("tetrahedron", [0.0, 0.0])],
        CrowdKind::Hub | CrowdKind::Partners => {
            vec![Form::of("tetrahedron", [-6.0, -6.0]), Form::of("box", [4.0, 4.0])]
        }
        CrowdKind::Sizes => forms(rng, 5)
            .into_iter()
            .map(|form| Form { radius: Some([-6.0, 2.0]), ..form })
            .collect(),
        _ => forms(rng, 3),
    };
    forms::build(&forms, 1, DirectionSet::K18, Axes::Principal, rng)
}

/// Every fifth body becomes static.
fn fix_some(mut bodies: Bodies) -> Bodies {
    for (i, dynamic) in bodies.dynamic.iter_mut().enumerate() {
        *dynamic = i % 5 != 4;
    }
    bodies
}

/// All bodies about one point.
fn dense(shapes: &[Shape], count: usize, rng: &mut impl Rng) -> Bodies {
    let mut bodies = Bodies::default();
    let reach = shapes[0].ball.radius / 16.0;
    for _ in 0..count {
        let t = std::array::from_fn(|_| rng.random_range(-reach..reach));
        bodies.push(0, true, rotation(rng), t);
    }
    bodies
}

/// Small bodies inside of a large one: the first form is small, the second large.
fn hub(shapes: &[Shape], count: usize, rng: &mut impl Rng) -> Bodies {
    let mut bodies = Bodies::default();
    let reach = shapes[1].ball.radius / 4.0;
    bodies.push(1, true, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
    for _ in 0..count {
        let t = std::array::from_fn(|_| rng.random_range(-reach..reach));
        bodies.push(0, false, rotation(rng), t);
    }
    bodies
}

fn frames(kind: CrowdKind, number: u32, first: Bodies, rng: &mut impl Rng) -> Vec<Bodies> {
    match kind {
        CrowdKind::Moving => {
            let velocities: Vec<[f32; 3]> = (0..first.len())
                .map(|_| std::array::from_fn(|_| rng.random_range(-0.08..0.08)))
                .collect();
            let step = |n: u16| {
                let mut frame = first.clone();
                for i in (0..first.len()).filter(|i| first.dynamic[*i]) {
                    for axis in 0..3 {
                        frame.translation[i][axis] += f32::from(n) * velocities[i][axis];
                        frame.rotation[i][axis] += f32::from(n) * velocities[i][(axis + 1) % 3];
                    }
                }
                frame
            };
            (0..10).map(step).collect()
        }
        CrowdKind::Growth => {
            let spread = |by: f32| {
                let mut frame = first.clone();
                for (i, t) in frame.translation.iter_mut().enumerate() {
                    *t = std::array::from_fn(|axis| {
                        t[axis] + by * (i / 5_usize.pow(axis as u32) % 5) as f32
                    });
                }
                frame
            };
            vec![spread(1.5), spread(0.5), first.clone(), spread(1.5), first]
        }
        CrowdKind::NewPairs => {
            // All are apart, or all but the first third.
            let apart = |kept: usize| {
                let mut frame = first.clone();
                for (i, t) in frame.translation.iter_mut().enumerate().skip(kept) {
                    *t = std::array::from_fn(|axis| {
                        t[axis] + 4.0 * (1 + i / 10_usize.pow(axis as u32) % 10) as f32
                    });
                }
                frame
            };
            let some = first.len() / 3;
            match number % 2 {
                0 => vec![apart(0), first.clone(), apart(0), first],
                _ => vec![apart(0), apart(some), first],
            }
        }
        CrowdKind::Repeated => {
            let second = permuted_places(&first, rng);
            vec![
                first.clone(),
                first.clone(),
                second.clone(),
                first.clone(),
                second.clone(),
                second,
            ]
        }
        CrowdKind::Renumbered => vec![renumbered(&first, rng)],
        CrowdKind::Swap => {
            let mut frames = vec![first];
            for _ in 0..5 {
                let next = permuted_places(&frames[frames.len() - 1], rng);
                frames.push(next);
            }
            frames
        }
        CrowdKind::Teleport => {
            let mut away = first.clone();
            for i in (0..first.len()).filter(|i| first.dynamic[*i] && i % 3 != 0) {
                away.translation[i][i % 2] += (1_u64 << 30) as f32;
            }
            vec![first.clone(), away.clone(), first.clone(), first, away]
        }
        _ => vec![first],
    }
}

/// Dynamic bodies in one another's places.
fn permuted_places(bodies: &Bodies, rng: &mut impl Rng) -> Bodies {
    let mut next = bodies.clone();
    let movable: Vec<usize> = (0..bodies.len()).filter(|i| bodies.dynamic[*i]).collect();
    for (to, from) in movable.iter().zip(permutation(movable.len(), rng)) {
        next.translation[*to] = bodies.translation[movable[from]];
        next.rotation[*to] = bodies.rotation[movable[from]];
    }
    next
}

/// The same bodies under other numbers.
fn renumbered(bodies: &Bodies, rng: &mut impl Rng) -> Bodies {
    picked(bodies, &permutation(bodies.len(), rng))
}

/// 0 … n − 1 in any order (Fisher and Yates).
fn permutation(n: usize, rng: &mut impl Rng) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for last in (1..n).rev() {
        order.swap(last, rng.random_range(0..=last));
    }
    order
}

/// The former number of each body of a frame, if it existed; `None` for a frame in which no number
/// changed.
type FormerNumbers = Option<Vec<Option<u32>>>;

/// Some bodies go, others come, numbers change: each frame's former numbers.
fn changing(all: Bodies, rng: &mut impl Rng) -> (Vec<Bodies>, Vec<FormerNumbers>) {
    let (mut frames, mut changes) = (Vec::new(), Vec::new());
    let mut before: Vec<usize> = (0..all.len() / 2).collect();
    frames.push(picked(&all, &before));
    changes.push(None);
    for _ in 0..5 {
        let now: Vec<usize> =
            permutation(all.len(), rng).into_iter().filter(|i| i % 7 != frames.len() % 7).collect();
        let former = |body: &usize| before.iter().position(|i| i == body).map(|i| i as u32);
        changes.push(Some(now.iter().map(former).collect()));
        frames.push(picked(&all, &now));
        before = now;
    }
    (frames, changes)
}
