//! The bodies of a history after some frames.

use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

use super::worlds::{JudgedWorld, ReportedPair};
use super::{Change, History, HistoryError};
use sdop::Groups;
use sdop::bodies::Aabb;
use sdop::boxes::BoxWorld;
use sdop::world::BodyId;

/// Two bodies, or two parts of them, by their numbers, the body of the lower number first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NumberedPair {
    /// The bodies.
    pub bodies: [u32; 2],
    /// A part of each; `None` is the pair of the bodies.
    pub parts: Option<[u32; 2]>,
    /// The number of periods along each axis by which the second body is moved.
    pub image: [i32; 3],
}

impl NumberedPair {
    /// Two bodies in either order.
    pub fn of(bodies: [u32; 2]) -> Self {
        Self::new(bodies, None, [0; 3])
    }

    /// Two bodies in either order, the parts in the same order, and the image of the second.
    pub fn new([a, b]: [u32; 2], parts: Option<[u32; 2]>, image: [i32; 3]) -> Self {
        match a <= b {
            true => Self { bodies: [a, b], parts, image },
            false => {
                Self { bodies: [b, a], parts: parts.map(|[i, j]| [j, i]), image: image.map(|n| -n) }
            }
        }
    }
}

impl fmt::Display for NumberedPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.bodies;
        match self.parts {
            None => write!(f, "bodies {a} and {b}"),
            Some([i, j]) => write!(f, "part {i} of body {a} and part {j} of body {b}"),
        }
    }
}

/// Pairs of numbers, sorted.
pub type Pairs = Vec<NumberedPair>;

/// The bodies after some frames of a history.
#[derive(Clone, Debug)]
pub struct State<B> {
    /// By number; those that have left are `None`.
    pub bodies: Vec<Option<B>>,
    /// Pairs that aren't reported.
    pub excluded: Vec<[usize; 2]>,
    /// Bodies of interest.
    pub interest: Vec<usize>,
    /// The slot of each body, by number: worlds order the two bodies of a pair by their slots, and
    /// one-sided tests use the planes of the first.
    slots: Arc<Vec<usize>>,
    /// The state that was saved.
    saved: Option<Box<Self>>,
}

impl<B: Copy> State<B> {
    /// After each frame, the first bodies' frame before the others.
    pub fn all(history: &History<B>) -> Result<Vec<Self>, HistoryError> {
        let mut state = Self {
            bodies: history.first.iter().copied().map(Some).collect(),
            excluded: Vec::new(),
            interest: Vec::new(),
            slots: Arc::new(slots(history)?),
            saved: None,
        };
        let mut all = vec![state.clone()];
        for frame in &history.frames {
            frame.iter().for_each(|(_, change)| state.take(change));
            all.push(state.clone());
        }
        Ok(all)
    }

    /// Makes a change.
    pub fn take(&mut self, change: &Change<B>) {
        match change {
            Change::Insert(body) => self.bodies.push(Some(*body)),
            Change::Remove(number) => {
                self.bodies[*number] = None;
                self.excluded.retain(|pair| !pair.contains(number));
                self.interest.retain(|of_interest| of_interest != number);
            }
            Change::Set(number, body) => self.bodies[*number] = Some(*body),
            Change::Exclude(pair, true) => self.excluded.push(*pair),
            Change::Exclude(pair, false) => self.excluded.retain(|known| known != pair),
            Change::Interest(numbers) => self.interest.clone_from(numbers),
            Change::Save => self.saved = Some(Box::new(Self { saved: None, ..self.clone() })),
            Change::Restore => {
                let saved = self.saved.take().unwrap_or_else(|| unreachable!("drawn after a save"));
                let count = self.bodies.len();
                *self = Self { saved: Some(saved.clone()), ..*saved };
                self.bodies.resize(count, None);
            }
            Change::Detour(_) => {}
        }
    }

    /// The bodies that are there, with their numbers, in the order of slots.
    pub fn present(&self) -> impl Iterator<Item = (usize, B)> {
        let numbered = self.bodies.iter().enumerate();
        let present = numbered.filter_map(|(number, body)| Some((number, (*body)?)));
        let mut present: Vec<_> = present.collect();
        present.sort_by_key(|(number, _)| self.slots[*number]);
        present.into_iter()
    }

    /// The pairs i < j of present bodies, in their order, that neither groups nor exclusion part.
    pub fn parts(&self, groups: impl Fn(&B) -> Groups) -> (Vec<usize>, impl Fn([u32; 2]) -> bool) {
        let (numbers, bodies): (Vec<usize>, Vec<B>) = self.present().unzip();
        let groups: Vec<Groups> = bodies.iter().map(groups).collect();
        let (named, excluded) = (numbers.clone(), self.excluded.clone());
        let parts = move |pair: [u32; 2]| {
            let [i, j] = pair.map(|at| at as usize);
            let mut name = [named[i], named[j]];
            name.sort_unstable();
            !groups[i].collide(groups[j]) || excluded.contains(&name)
        };
        (numbers, parts)
    }

    /// A newly built world, and the pairs that it finds.
    pub fn fresh<W: JudgedWorld<Body = B>>(&self, mut world: W) -> Result<Pairs, HistoryError> {
        let mut ids = vec![None; self.bodies.len()];
        for (number, body) in self.present() {
            ids[number] = Some(world.insert(body)?);
        }
        let id = |number: &usize| ids[*number];
        for pair in &self.excluded {
            if let [Some(a), Some(b)] = pair.each_ref().map(id) {
                world.exclude([a, b], true)?;
            }
        }
        let interest: Vec<BodyId> = self.interest.iter().filter_map(id).collect();
        world.interest(&interest)?;
        let numbers = ids.iter().zip(0..);
        let numbers = numbers.filter_map(|(id, number)| Some(((*id)?, number))).collect();
        Ok(by_number(world.cull()?, &numbers))
    }
}

/// Pairs of ids as pairs of numbers.
pub fn by_number(
    pairs: impl IntoIterator<Item = ReportedPair>,
    numbers: &HashMap<BodyId, u32>,
) -> Pairs {
    let number = |id| numbers.get(&id).copied().unwrap_or(u32::MAX);
    let numbered = pairs
        .into_iter()
        .map(|pair| NumberedPair::new(pair.bodies.map(number), pair.parts, pair.image));
    in_order(numbered)
}

/// The pairs, sorted.
pub fn in_order(pairs: impl Iterator<Item = NumberedPair>) -> Pairs {
    let mut pairs: Pairs = pairs.collect();
    pairs.sort_unstable();
    pairs
}

/// The slot that each body gets in a world, by number. Slots are given again after a cull.
fn slots<B>(history: &History<B>) -> Result<Vec<usize>, HistoryError> {
    let (mut world, mut ids, mut saved) = (BoxWorld::new(), Vec::new(), BoxWorld::new());
    let apart = |number: usize| Aabb::new([number as f32; 3], [number as f32; 3]);
    for number in 0..history.first.len() {
        ids.push(world.insert(apart(number))?);
    }
    world.cull()?;
    for frame in &history.frames {
        for (_, change) in frame {
            match change {
                Change::Insert(_) => ids.push(world.insert(apart(ids.len()))?),
                Change::Remove(number) => world.remove(ids[*number])?,
                Change::Save => saved = world.clone(),
                Change::Restore => world = saved.clone(),
                Change::Detour(kind) => drop(world.detour(*kind)?),
                _ => {}
            }
        }
        world.cull()?;
    }
    Ok(ids.iter().map(|id| id.slot()).collect())
}
