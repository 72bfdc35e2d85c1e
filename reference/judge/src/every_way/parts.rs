//! Cases of bodies with parts in a long-lived world of compounds.

use super::lives;
use crate::case::{Case, Frame};
use crate::contestant::BodyPart;
use crate::ours::configurations::Mode;
use crate::ours::histories::{CompoundWorld, HistoryError, culler};
use crate::shrink::Lists;
use sdop::compound::{Compound, Part, PartCuller};
use sdop::settings::{Budget, CullSettings};
use sdop::world::{Body, World};

/// The pairs of bodies with parts that may touch, frame by frame, sorted.
pub(super) fn lists(case: &Case, way: &CullSettings, mode: Mode) -> Result<Lists, HistoryError> {
    let way = CullSettings { budget: Some(Budget::Tests(3)), ..way.clone() };
    let mut known: Vec<&[BodyPart]> = Vec::new();
    for parts in case.frames.iter().flat_map(|frame| &frame.parts).flatten() {
        if !parts.is_empty() && !known.contains(&parts.as_slice()) {
            known.push(parts);
        }
    }
    let (mut shapes, mut parts) = (case.shapes.clone(), PartCuller::new());
    for list in &known {
        let list: Vec<Part> = list.iter().map(part).collect();
        let compound = Compound::build("parts", &case.shapes, &list)?;
        shapes.push(compound.shape().clone());
        parts.set_parts(shapes.len() as u32 - 1, compound);
    }
    // The number of a body's shape in the world: compounds follow the case's own shapes.
    let number = |frame: &Frame, i: usize| {
        let list = frame.parts.as_ref().map(|parts| parts[i].as_slice());
        let at = known.iter().position(|known| Some(*known) == list);
        at.map_or(frame.bodies.shape[i], |at| (case.shapes.len() + at) as u32)
    };
    let mut world = CompoundWorld { world: World::with(shapes, &culler(&way, mode))?, parts };
    let body = |frame: &Frame, i: usize| {
        let translation = frame.bodies.translation[i].map(f64::from);
        let mut body = Body::at(number(frame, i), frame.bodies.rotation[i], translation);
        body.motion = frame.motion(i);
        body
    };
    lives::lists(&mut world, case, body, |_, _| Ok(()))
}

fn part(part: &BodyPart) -> Part {
    let (rotation, translation) = part.rotation_and_translation();
    Part { shape: part.shape, rotation, translation, rounded: false }
}
