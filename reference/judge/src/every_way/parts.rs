//! Cases of bodies with parts in a long-lived world of compounds.

use std::collections::HashMap;

use crate::case::{Case, Frame};
use crate::contestant::BodyPart;
use crate::ours::configurations::Mode;
use crate::ours::histories::{CompoundWorld, HistoryError, JudgedWorld, culler};
use crate::shrink::Lists;
use sdop::Motion;
use sdop::compound::{Compound, Part, PartCuller};
use sdop::settings::{Budget, CullSettings};
use sdop::world::{Body, BodyId, World};

/// The pairs of bodies with parts that may touch, frame by frame, sorted. One world has all frames:
/// bodies are set, inserted and removed.
pub(super) fn lists(case: &Case, way: &CullSettings, mode: Mode) -> Result<Lists, HistoryError> {
    let way = CullSettings {
        budget: Some(Budget::Tests(3)),
        ..way.clone()
    };
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
    let mut world = CompoundWorld {
        world: World::with(shapes, &culler(&way, mode))?,
        parts,
    };
    let (mut held, mut lists): (Vec<(BodyId, Body)>, Lists) = (Vec::new(), Vec::new());
    for frame in &case.frames {
        let bodies = &frame.bodies;
        let former = |i: usize| match &frame.was {
            Some(was) => was[i].map(|number| held[number as usize]),
            None => held.get(i).copied(),
        };
        let stay: Vec<Option<(BodyId, Body)>> = (0..bodies.len()).map(former).collect();
        for gone in held.iter().filter(|one| !stay.contains(&Some(**one))) {
            JudgedWorld::remove(&mut world, gone.0)?;
        }
        let mut now = Vec::new();
        for (i, former) in stay.into_iter().enumerate() {
            let translation = bodies.translation[i].map(f64::from);
            let mut body = Body::at(number(frame, i), bodies.rotation[i], translation);
            body.motion = if bodies.dynamic[i] {
                Motion::Dynamic
            } else {
                Motion::Fixed
            };
            let id = match former {
                Some((id, from)) => world.change(id, from, body).map(|()| id),
                None => JudgedWorld::insert(&mut world, body),
            };
            now.push((id?, body));
        }
        held = now;
        let numbers: HashMap<BodyId, u32> = held.iter().map(|one| one.0).zip(0..).collect();
        let pairs = world
            .cull()?
            .into_iter()
            .filter(|pair| pair.parts.is_none());
        let pairs = pairs.map(|pair| pair.bodies.map(|id| numbers[&id]));
        let mut list: Vec<[u32; 2]> = pairs.map(|[i, j]| [i.min(j), i.max(j)]).collect();
        list.sort_unstable();
        lists.push(list);
    }
    Ok(lists)
}

fn part(part: &BodyPart) -> Part {
    let (rotation, translation) = part.rotation_and_translation();
    Part {
        shape: part.shape,
        rotation,
        translation,
    }
}
