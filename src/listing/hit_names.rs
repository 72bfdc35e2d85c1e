//! What is listed for the hits of a first test: bodies, or the places from which pairs are refined.

use crate::broad_phase::PairFinder;
use crate::simd::Lanes;

/// What the names of the finder's slots are.
///
/// Volumes other than spheres are looked up by place. With spheres alone, names are bodies, so that
/// hits need not be looked up by place: naming slots by place under every strategy took 2.5 % more
/// instructions per frame of spheres (10,000 bodies, grid, AVX2).
#[derive(Clone, Copy)]
pub(crate) enum SlotNames<'a> {
    /// Bodies, in the order of the user's columns.
    Bodies,
    /// Places; these are the bodies in them.
    Places(&'a [u32]),
    /// The slots themselves: places have the order of slots, and these are the bodies in them.
    Slots(&'a [u32]),
}

/// What is listed for a pair of slots.
#[derive(Clone, Copy)]
pub(crate) enum PairNames {
    /// Its bodies, the lower first, to be reported.
    Bodies,
    /// Its places, that of the lower body first, to be refined.
    Places,
}

/// The tables by which hits are named.
#[derive(Clone, Copy)]
pub(crate) struct HitNames<'a> {
    /// The entry of each slot in which hits are looked up: its name, or its body if slots are their
    /// own names.
    pub by_slot: &'a [u32],
    listed: PairNames,
    slots: SlotNames<'a>,
}

impl<'a> HitNames<'a> {
    /// The bodies of hits, which are the finder's names of its slots.
    pub fn bodies(finder: &'a PairFinder) -> Self {
        Self { by_slot: finder.names(), listed: PairNames::Bodies, slots: SlotNames::Bodies }
    }

    pub fn new(finder: &'a PairFinder, listed: PairNames, slots: SlotNames<'a>) -> Self {
        let by_slot = match slots {
            SlotNames::Bodies | SlotNames::Places(_) => finder.names(),
            SlotNames::Slots(body) => body,
        };
        Self { by_slot, listed, slots }
    }

    /// The listed numbers of hits with these entries, that of the lower body first.
    #[inline(always)]
    pub fn listed<L: Lanes>(
        &self,
        l: L,
        hits: HitSlots,
        hit: L::I,
        entries: [L::I; 2],
    ) -> [L::I; 2] {
        let (mut names, mut bodies) = (entries, entries);
        match self.slots {
            SlotNames::Bodies => {}
            // Written out, because a closure would be compiled without the tier's features.
            SlotNames::Places(body) => {
                bodies = [l.gather_u32(body, entries[0]), l.gather_u32(body, entries[1])]
            }
            SlotNames::Slots(_) => names = hits.slots(l, hit),
        }
        let listed = match self.listed {
            PairNames::Bodies => bodies,
            PairNames::Places => names,
        };
        in_order(l, listed, bodies)
    }

    /// The body of a listed name.
    pub fn body_of(&self, name: u32) -> u32 {
        match (self.listed, self.slots) {
            (PairNames::Places, SlotNames::Places(body) | SlotNames::Slots(body)) => {
                body[name as usize]
            }
            _ => name,
        }
    }
}

/// The meaning of hits.
#[derive(Clone, Copy)]
pub(crate) enum HitSlots {
    /// Slots that this slot meets.
    With(usize),
    /// Codes of a block whose lane 0 has this slot.
    Codes(usize),
}

impl HitSlots {
    /// The slots of a vector of pairs.
    #[inline(always)]
    fn slots<L: Lanes>(self, l: L, hit: L::I) -> [L::I; 2] {
        match self {
            Self::With(slot) => [l.splat_u32(slot as u32), hit],
            Self::Codes(first) => {
                let (other, lane) = l.split_u32(hit);
                [l.add_u32(l.splat_u32(first as u32), lane), other]
            }
        }
    }

    /// Looks up a table by slot for a vector of pairs.
    #[inline(always)]
    pub fn entries<L: Lanes>(self, l: L, hit: L::I, table: &[u32]) -> [L::I; 2] {
        match self {
            Self::With(slot) => [l.splat_u32(table[slot]), l.gather_u32(table, hit)],
            Self::Codes(first) => {
                let ((other, lane), own) = (l.split_u32(hit), &table[first..]);
                let own = match own.first_chunk() {
                    Some(own) => l.lookup_16_u32(own, lane),
                    None => l.gather_u32(own, lane),
                };
                [own, l.gather_u32(table, other)]
            }
        }
    }
}

/// The listed numbers of a pair, that of the lower body first.
#[inline(always)]
fn in_order<L: Lanes>(l: L, listed: [L::I; 2], bodies: [L::I; 2]) -> [L::I; 2] {
    let [one, other] = listed;
    let swapped = l.gt_u32(bodies[0], bodies[1]);
    [l.select_u32(swapped, other, one), l.select_u32(swapped, one, other)]
}
