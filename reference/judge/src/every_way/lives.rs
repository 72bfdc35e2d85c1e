//! Cases in a long-lived world: one world has all frames of a case.

use std::collections::HashMap;

use crate::case::{Case, Frame};
use crate::ours::histories::{HistoryError, JudgedWorld};
use crate::shrink::Lists;
use sdop::world::BodyId;

/// The sorted pairs of bodies that a world reports in each frame. `body` makes the body of a frame
/// with some number into one of the world, which is set or inserted; bodies that are gone are
/// removed. `prepare` is called after that, before the world culls.
pub(super) fn lists<W: JudgedWorld>(
    world: &mut W,
    case: &Case,
    body: impl Fn(&Frame, usize) -> W::Body,
    prepare: impl Fn(&mut W, &Frame) -> Result<(), HistoryError>,
) -> Result<Lists, HistoryError> {
    let (mut held, mut lists): (Vec<(BodyId, W::Body)>, Lists) = (Vec::new(), Vec::new());
    for frame in &case.frames {
        let former = |i: usize| match &frame.was {
            Some(was) => was[i].map(|number| held[number as usize]),
            None => held.get(i).copied(),
        };
        let stay: Vec<_> = (0..frame.bodies.len()).map(former).collect();
        for gone in held.iter().filter(|one| !stay.contains(&Some(**one))) {
            world.remove(gone.0)?;
        }
        let mut now = Vec::new();
        for (i, former) in stay.into_iter().enumerate() {
            let body = body(frame, i);
            let id = match former {
                Some((id, from)) => world.change(id, from, body).map(|()| id),
                None => world.insert(body),
            };
            now.push((id?, body));
        }
        held = now;
        prepare(world, frame)?;
        let numbers: HashMap<BodyId, u32> = held.iter().map(|one| one.0).zip(0..).collect();
        let pairs = world.cull()?.into_iter();
        let pairs = pairs.filter(|pair| pair.parts.is_none());
        let pairs = pairs.map(|pair| pair.bodies.map(|id| numbers[&id]));
        let mut list: Vec<[u32; 2]> = pairs.map(|[i, j]| [i.min(j), i.max(j)]).collect();
        list.sort_unstable();
        lists.push(list);
    }
    Ok(lists)
}
