//! Finds the pairs of parts within a world's pairs.

use std::collections::BTreeMap;

use super::part_set::{PartSet, PosedParts};
use super::{Compound, CompoundError};
use crate::posed::QueryShape;
use crate::simd::in_default_mode;
use crate::world::renew;
use crate::world::{Body, BodyId, World};

/// Two parts of two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartPair {
    /// The bodies, the lower slot first.
    pub bodies: [BodyId; 2],
    /// The number of each body's part. A body whose shape is not a compound has the part 0.
    pub parts: [u32; 2],
}

/// Finds the pairs of parts within the pairs of bodies that a [`World`] reports. See the
/// [module](super).
///
/// A call costs time for the pairs with a body that has changed since the last call, and one
/// comparison for each other pair.
#[derive(Clone, Debug, Default)]
pub struct PartCuller {
    /// By the number of the world's shape.
    compounds: BTreeMap<u32, Compound>,
    /// The world's shapes at the last call.
    shapes: Vec<Option<QueryShape>>,
    /// The parts of each shape number.
    sets: Vec<Option<PartSet>>,
    bodies: Vec<BodyPair>,
    pairs: Vec<PartPair>,
    /// Both lists of the call before; the next call fills their memory again.
    former: (Vec<BodyPair>, Vec<PartPair>),
    are_found: bool,
}

/// A pair of bodies as they were tested, and the end of their pairs of parts in the list.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BodyPair {
    ids: [BodyId; 2],
    bodies: [Body; 2],
    end: usize,
}

impl PartCuller {
    /// A culler without compounds: every shape is one part.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the parts of a shape of the world. The world's shape of that number has to be
    /// [`Compound::shape`].
    pub fn set_parts(&mut self, shape: u32, compound: Compound) {
        self.compounds.insert(shape, compound);
        self.are_found = false;
    }

    /// From now on, the world's shape of that number is one part. Use it before a compound is
    /// replaced by another shape.
    pub fn remove_parts(&mut self, shape: u32) {
        self.are_found &= self.compounds.remove(&shape).is_none();
    }

    /// Finds the pairs of parts in the pairs of the world's last [`cull`](World::cull): call it
    /// after each cull, before bodies change. Returns them sorted by the slots of the
    /// bodies and then by parts. Two bodies that are one part each are tested by the world alone.
    ///
    /// # Errors
    /// The world's pairs are not those of its present bodies, because it was changed, restored or
    /// culled in portions since its last cull; or a shape of the world isn't that of its compound.
    /// [`Self::pairs`] are those of the call before. Or there is no memory for the pairs: then
    /// there are none.
    pub fn cull(&mut self, world: &World) -> Result<&[PartPair], CompoundError> {
        let is_full = in_default_mode(|| self.bring_shapes(world).map(|()| self.find(world)))?;
        if is_full {
            (self.pairs, self.bodies, self.are_found) = (Vec::new(), Vec::new(), false);
            return Err(CompoundError::OutOfMemory);
        }
        Ok(&self.pairs)
    }

    /// The pairs of the last call of [`Self::cull`].
    #[must_use]
    pub fn pairs(&self) -> &[PartPair] {
        &self.pairs
    }

    /// The pairs of bodies of which some parts may touch, sorted by slots.
    pub fn body_pairs(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        let mut start = 0;
        let has_parts = move |pair: &&BodyPair| std::mem::replace(&mut start, pair.end) < pair.end;
        self.bodies.iter().filter(has_parts).map(|pair| pair.ids)
    }

    /// Brings the parts of each shape number up to date.
    fn bring_shapes(&mut self, world: &World) -> Result<(), CompoundError> {
        if !world.has_present_pairs() {
            return Err(CompoundError::NotCulled);
        }
        let is_other = |(number, compound): &(&u32, &Compound)| {
            world.shape_digest(**number) != Some(compound.digest)
        };
        if let Some((&shape, compound)) = self.compounds.iter().find(is_other) {
            let compound = compound.shape().name.clone();
            return Err(CompoundError::OtherShape { shape, compound });
        }
        let renewed = renew(&mut self.shapes, world);
        self.are_found &= !renewed.contains(&true);
        if self.are_found {
            return Ok(());
        }
        let numbered = (0..).zip(&self.shapes);
        let sets = numbered.map(|(number, shape)| match self.compounds.get(&number) {
            Some(compound) => Some(compound.parts.clone()),
            None => shape.clone().map(PartSet::alone),
        });
        self.sets = sets.collect();
        self.bodies.clear();
        self.pairs.clear();
        self.are_found = true;
        Ok(())
    }

    /// Finds the pairs of parts of all pairs of bodies. Pairs of bodies that have not changed keep
    /// theirs: both lists are sorted by slots. Returns whether memory didn't suffice.
    fn find(&mut self, world: &World) -> bool {
        std::mem::swap(&mut self.bodies, &mut self.former.0);
        std::mem::swap(&mut self.pairs, &mut self.former.1);
        self.bodies.clear();
        self.pairs.clear();
        let (former_bodies, former_pairs) = &self.former;
        let mut former = former_bodies.iter().peekable();
        let mut start = 0;
        let (mut first, mut second, mut placed) = (None, None, None);
        let mut is_full = self.bodies.try_reserve(world.pairs().len()).is_err();
        for ids in world.pairs() {
            if is_full {
                break;
            }
            let [Ok(a), Ok(b)] = ids.map(|id| world.body(id)) else {
                continue; // removed since the cull
            };
            while let Some(gone) = former.next_if(|pair| pair.ids < ids) {
                start = gone.end;
            }
            let known = former.next_if(|pair| pair.ids == ids);
            let range = start..known.map_or(start, |pair| pair.end);
            start = range.end;
            if known.is_some_and(|pair| pair.bodies == [a, b]) {
                is_full = self.pairs.try_reserve(range.len()).is_err();
                if !is_full {
                    self.pairs.extend_from_slice(&former_pairs[range]);
                }
            } else if let [Some(set), Some(other)] =
                [a, b].map(|body| self.sets[body.shape as usize].as_ref())
            {
                let mut take = |parts| {
                    is_full = is_full || self.pairs.try_reserve(1).is_err();
                    if !is_full {
                        self.pairs.push(PartPair { bodies: ids, parts });
                    }
                };
                if set.len() == 1 && other.len() == 1 {
                    take([0, 0]);
                } else {
                    // Pairs with the same first body follow each other.
                    if placed.replace(ids[0]) != Some(ids[0]) {
                        place(&mut first, set, a, a.translation);
                    }
                    let second = place(&mut second, other, b, a.translation);
                    if let Some(first) = &mut first {
                        first.each_pair(second, take);
                    }
                }
            }
            let end = self.pairs.len();
            self.bodies.push(BodyPair { ids, bodies: [a, b], end });
        }
        is_full
    }
}

/// Places the parts of a body in memory that others have used before.
fn place<'a, 'b>(
    memory: &'b mut Option<PosedParts<'a>>,
    set: &'a PartSet,
    body: Body,
    origin: [f64; 3],
) -> &'b mut PosedParts<'a> {
    match memory {
        Some(parts) => {
            parts.reset(set, body, origin);
            parts
        }
        None => memory.insert(PosedParts::new(set, body, origin)),
    }
}
