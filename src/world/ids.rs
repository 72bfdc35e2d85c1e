//! Stable ids: a slot, and a generation that counts how often it was used.

use std::fmt;
use std::sync::Arc;

use super::WorldError;

/// The id of a body of a world. It stays the same until the body is removed, and is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// The body's index into columns with one entry per body: less than
    /// [`World::slots`](super::World::slots), and reused for another body once this one is removed.
    #[must_use]
    pub fn slot(self) -> usize {
        self.slot as usize
    }

    /// The id as a number, for other languages and for files: the generation in the upper half, the
    /// slot in the lower.
    #[must_use]
    pub fn to_bits(self) -> u64 {
        u64::from(self.generation) << 32 | u64::from(self.slot)
    }

    /// The id of [`Self::to_bits`]. Any other number is an id that no body has.
    #[must_use]
    pub fn from_bits(bits: u64) -> Self {
        Self { slot: bits as u32, generation: (bits >> 32) as u32 }
    }
}

impl BodyId {
    /// The bodies in two slots, at the time of these generations.
    #[inline(always)]
    pub(super) fn pair_of(slots: [u32; 2], generation: &[u32]) -> [Self; 2] {
        slots.map(|slot| Self { slot, generation: generation[slot as usize] })
    }
}

/// The number of [`BodyId::to_bits`], as other languages have it, then the slot if it was used
/// before.
impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_bits().fmt(f)?;
        match self.generation {
            0 => Ok(()),
            generation => write!(f, " (slot {}, generation {generation})", self.slot),
        }
    }
}

/// The slots of a world, and their bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ids {
    pub(super) present: Vec<bool>,
    /// How often each slot was used before; shared with the lists of pairs.
    pub(super) generation: Arc<Vec<u32>>,
    /// Empty slots, including those emptied since the last cull, which its pairs still contain.
    pub(super) free: Vec<u32>,
    pub(super) emptied: Vec<u32>,
    /// The generation of a new slot, above those of all slots that were removed ([`Self::shrink`]).
    pub(super) first_generation: u32,
    pub(super) bodies: usize,
}

impl Ids {
    /// The slot that the next body gets.
    pub fn next(&self) -> usize {
        self.free.last().map_or(self.slots(), |&slot| slot as usize)
    }

    /// Gives [`Self::next`] to a body. Returns whether the slot is new, so that columns have no
    /// entry for it yet.
    pub fn take(&mut self) -> bool {
        self.bodies += 1;
        let generation = Arc::make_mut(&mut self.generation);
        if let Some(slot) = self.free.pop() {
            let slot = slot as usize;
            generation[slot] += 1;
            self.present[slot] = true;
            return false;
        }
        self.present.push(true);
        generation.push(self.first_generation);
        true
    }

    /// Removes a body from its slot, which isn't reused before [`Self::settle`].
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        let slot = self.slot(id)?;
        self.present[slot] = false;
        self.emptied.push(id.slot);
        self.bodies -= 1;
        Ok(())
    }

    /// Frees the slots of removed bodies after a cull, whose pairs don't contain them, except slots
    /// that have used all their generations.
    pub fn settle(&mut self) {
        let generation = &self.generation;
        let emptied = self.emptied.drain(..);
        let lasting = emptied.filter(|&slot| generation[slot as usize] < u32::MAX);
        self.free.extend(lasting);
    }

    /// Removes free slots at the end and returns the number of slots left. Their ids are never
    /// reused.
    pub fn shrink(&mut self) -> usize {
        let mut is_free = vec![false; self.slots()];
        for &slot in &self.free {
            is_free[slot as usize] = true;
        }
        let gone = is_free.iter().rev().take_while(|is_free| **is_free).count();
        let left = self.slots() - gone;
        // Free slots have generations below the largest number.
        let after = self.generation[left..].iter().map(|&used| used + 1);
        self.first_generation = after.fold(self.first_generation, u32::max);
        self.free.retain(|&slot| (slot as usize) < left);
        self.present.truncate(left);
        self.generation = Arc::new(self.generation[..left].to_vec());
        self.present.shrink_to_fit();
        self.free.shrink_to_fit();
        self.emptied.shrink_to_fit();
        left
    }

    /// The id of the present or last body in a slot.
    pub fn id(&self, slot: u32) -> BodyId {
        BodyId { slot, generation: self.generation[slot as usize] }
    }

    /// The present bodies, by slot.
    pub fn iter(&self) -> impl Iterator<Item = BodyId> + Clone + '_ {
        let slots = (0..).zip(&self.present);
        slots.filter(|(_, is_present)| **is_present).map(|(slot, _)| self.id(slot))
    }

    /// The slot of a present body.
    #[inline]
    pub fn slot(&self, id: BodyId) -> Result<usize, WorldError> {
        let slot = id.slot as usize;
        // An error that isn't needed would be made and dropped for every body that is set.
        if self.present.get(slot) == Some(&true) && self.generation[slot] == id.generation {
            Ok(slot)
        } else {
            Err(WorldError::Gone(id))
        }
    }

    /// Whether all these bodies are present.
    pub fn have(&self, ids: &[BodyId]) -> bool {
        let is_present = |id: &BodyId| self.present.get(id.slot()) == Some(&true);
        let is_same = |id: &BodyId| self.generation[id.slot()] == id.generation;
        ids.iter().all(|id| is_present(id) && is_same(id))
    }

    /// Whether each slot has a body.
    pub fn present(&self) -> &[bool] {
        &self.present
    }

    /// How often each slot was given before.
    pub fn generation(&self) -> &Arc<Vec<u32>> {
        &self.generation
    }

    /// Number of slots.
    pub fn slots(&self) -> usize {
        self.present.len()
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.bodies
    }
}

/// Keeps the first entries of a column by slot, and no room for more.
pub(crate) fn shrink_column<T>(column: &mut Vec<T>, len: usize) {
    column.truncate(len);
    column.shrink_to_fit();
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn filled(slots: u32) -> Ids {
        let mut ids = Ids::default();
        (0..slots).for_each(|_| assert!(ids.take()));
        ids
    }

    /// Slots at the end are given back.
    #[test]
    fn free_end_slots_are_removed() {
        let mut ids = filled(6);
        for slot in [1, 4, 5] {
            ids.remove(ids.id(slot)).unwrap();
        }
        assert_eq!(ids.shrink(), 6, "pairs may name what was emptied");
        ids.settle();
        assert_eq!((ids.shrink(), ids.len(), ids.next()), (4, 3, 1));
        assert!(!ids.take() && ids.take());
        let given = [1, 4].map(|slot| ids.id(slot));
        let again = |slot| BodyId { slot, generation: 1 };
        assert_eq!(given, [1, 4].map(again), "generation 0 was another's");
        assert_eq!(ids.iter().count(), 5);
    }

    /// A slot without generations left is retired.
    #[test]
    fn used_up_slot_is_retired() {
        let mut ids = filled(2);
        ids.generation = Arc::new(vec![u32::MAX - 1, 7]);
        for _ in 0..2 {
            ids.remove(ids.id(0)).unwrap();
            ids.settle();
            ids.take();
        }
        let given: Vec<_> = ids.iter().map(|id| [id.slot, id.generation]).collect();
        assert_eq!(given, [[1, 7], [2, 0]]);
        assert_eq!((ids.len(), ids.slots(), ids.shrink()), (2, 3, 3));
    }
}
