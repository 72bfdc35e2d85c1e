//! Ids that stay: slots, and how often each has been given.

use std::fmt;

use super::WorldError;

/// A body of a world. Stays the same until the body is removed, and is never given to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// Where a column a body may keep this one's entry: below [`World::slots`](super::World::slots), and given to another
    /// body once this one is removed.
    #[must_use]
    pub fn slot(self) -> usize {
        self.slot as usize
    }
}

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.slot, self.generation)
    }
}

/// The slots of a world, and who lives in them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ids {
    present: Vec<bool>,
    generation: Vec<u32>,
    /// Empty slots, and those emptied since the last cull, which its pairs still name.
    free: Vec<u32>,
    emptied: Vec<u32>,
}

impl Ids {
    /// The slot that the next body gets.
    pub fn next(&self) -> usize {
        self.free.last().map_or(self.slots(), |&slot| slot as usize)
    }

    /// Gives [`Self::next`] to a body. True if the slot is new, so that columns lack it.
    pub fn take(&mut self) -> bool {
        if let Some(slot) = self.free.pop() {
            let slot = slot as usize;
            self.generation[slot] += 1;
            self.present[slot] = true;
            return false;
        }
        self.present.push(true);
        self.generation.push(0);
        true
    }

    /// Takes a body out of its slot, which nobody gets before [`Self::settle`].
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        let slot = self.slot(id)?;
        self.present[slot] = false;
        self.emptied.push(id.slot);
        Ok(())
    }

    /// A cull's pairs name none of the bodies that have been removed: their slots may be given away.
    pub fn settle(&mut self) {
        self.free.append(&mut self.emptied);
    }

    /// Who is in a slot, or was last.
    pub fn id(&self, slot: u32) -> BodyId {
        BodyId {
            slot,
            generation: self.generation[slot as usize],
        }
    }

    /// The slot of a body that is there.
    pub fn slot(&self, id: BodyId) -> Result<usize, WorldError> {
        let slot = id.slot as usize;
        let lives = self.present.get(slot) == Some(&true) && self.generation[slot] == id.generation;
        lives.then_some(slot).ok_or(WorldError::Gone(id))
    }

    /// Whether each slot has a body.
    pub fn present(&self) -> &[bool] {
        &self.present
    }

    /// Number of slots.
    pub fn slots(&self) -> usize {
        self.present.len()
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.present.len() - self.free.len() - self.emptied.len()
    }
}
