//! Which boxes may meet which, while few of them move.
//!
//! A body that moves often has an enlarged box, which contains its own, and a list of candidates:
//! all bodies whose enlarged boxes meet it. If a body has no enlarged box, its own counts. While a
//! body moves within its enlarged box, its partners are among its candidates. One that leaves it
//! gets another, and is searched for in an index of all these boxes. How much a box is enlarged
//! follows from its last motion. Bodies that seldom move are searched for whenever they do.

use super::{Body, BoxIndex, FIXED_TAG, Search, sort_each_once};
use crate::bodies::{Aabb, Groups, PairRules};
use crate::pairs::{FoundPartners, Runs, compare};
use crate::simd::{TaggedBox, prefetch};

/// Tag of a box that doesn't collide with all groups.
const GROUPED_TAG: u32 = 2;

/// Tag of an enlarged box in the index.
const ENLARGED_TAG: u32 = 4;

/// An enlarged box is left after about this number of frames of equal motion, or of one in any
/// direction.
const FRAMES_AHEAD: f32 = 6.0;
const FRAMES_ASIDE: f32 = 1.0;

/// A box that has moved by more than its longest side over this isn't enlarged: it would meet too
/// many, or be left at once.
const SIDE_PER_MOTION: f32 = 8.0;

/// A body has moved often if fewer than this number of searches have passed since it moved before.
/// Lists pay in frames in which half of the bodies have, because each is of use for several moves.
/// In a world whose boxes are in the nearer caches, they pay for bodies that move less often too.
const MOST_REST: u32 = 4;
const MOST_REST_IN_CACHE: u32 = 32;

/// What is kept of this number of bodies fits into the nearer caches.
pub(crate) const BODIES_IN_CACHE: usize = 1 << 15;

/// Bodies that are searched for together.
const SEEKERS_PER_BATCH: usize = 16;

/// The number of bodies by which prefetching is ahead.
const PREFETCH_DISTANCE: usize = 8;

/// The most candidates per body, above which the lists are given up.
const CANDIDATES_PER_BODY: usize = 64;

/// A body with its box, or one to be inserted or removed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IndexedBox {
    pub slot: u32,
    /// A removed body meets no box.
    pub is_present: bool,
    pub tags: u32,
    pub aabb: Aabb,
}

/// The boxes of a world, and the candidates of those that have moved.
#[derive(Clone, Debug)]
pub(crate) struct Candidates {
    /// The enlarged boxes, and those of bodies that have none.
    index: BoxIndex,
    /// The enlarged box of each slot that has one.
    enlarged: Vec<Aabb>,
    /// All candidates are in a body's list. There may be others in it, that are no more.
    lists: Runs<u32, 4>,
    /// The number of this search; those of bodies are lower, unless they have moved before it.
    number: u32,
    /// Bodies of this search that have moved often, and whether they get lists.
    often: usize,
    lists_pay: bool,
    /// The boxes in the index of bodies that get a list, and of the others that are searched for.
    listed: Vec<TaggedBox>,
    unlisted: Vec<TaggedBox>,
    search: Search,
    /// What was found for one body, or for all that have no list.
    found: Vec<u32>,
    /// The end of each one's part.
    ends: Vec<usize>,
    differences: Vec<(u32, bool)>,
    /// Bodies with lists, and those that come into them.
    gained: Vec<[u32; 2]>,
}

impl Candidates {
    /// The boxes of `count` bodies, all present, no two in one slot.
    pub fn of(boxes: impl Iterator<Item = IndexedBox> + Clone, count: usize) -> Self {
        Self {
            index: BoxIndex::of(boxes.map(|indexed| indexed.tagged()), count),
            enlarged: Vec::new(),
            lists: Runs::default(),
            number: MOST_REST_IN_CACHE,
            often: 0,
            lists_pay: false,
            listed: Vec::new(),
            unlisted: Vec::new(),
            search: Search::default(),
            found: Vec::new(),
            ends: Vec::new(),
            differences: Vec::new(),
            gained: Vec::new(),
        }
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.index.len
    }

    /// Moves changed bodies, and lists those whose boxes meet each one's, are not both fixed, and
    /// are allowed by the rules: sorted, each once. Returns the number of boxes and cells read;
    /// `None` if there are more than `most_work`, or more than `most` pairs. Then these boxes are
    /// unknown.
    pub fn find(
        &mut self,
        changed: &[IndexedBox],
        rules: PairRules<'_>,
        found: &mut FoundPartners,
        [most_work, most]: [usize; 2],
    ) -> Option<usize> {
        self.listed.clear();
        self.unlisted.clear();
        self.number = self.number.checked_add(1)?; // then all pairs are found once
        for (number, indexed) in changed.iter().enumerate() {
            let ahead = [3, 2, 1].map(|steps| changed.get(number + steps * PREFETCH_DISTANCE));
            self.index.prefetch(ahead);
            self.put(indexed);
        }
        self.lists_pay = 2 * std::mem::take(&mut self.often) >= changed.len();
        self.index.compact();
        let mut work = self.list_candidates(most_work)?;
        work += self.find_unlisted(rules, most_work.checked_sub(work)?)?;
        let (mut ends, mut first) = (self.ends.iter(), 0);
        for (number, indexed) in changed.iter().enumerate() {
            if self.unlisted.len() < changed.len() {
                self.prefetch([2, 1].map(|steps| changed.get(number + steps * PREFETCH_DISTANCE)));
            }
            if indexed.is_present {
                if self.index.bodies[indexed.slot as usize].is_listed {
                    work += self.list_partners(indexed.slot, rules, &mut found.partners);
                } else if let Some(&end) = ends.next() {
                    let own = &self.found[std::mem::replace(&mut first, end)..end];
                    found.partners.extend_from_slice(own);
                }
            }
            found.ends.push(found.partners.len());
            // A pair of two changed bodies is found twice.
            if work > most_work || found.partners.len() / 2 > most {
                return None;
            }
        }
        Some(work)
    }

    /// Moves, inserts or removes a body, and notes whether it must be searched for.
    #[inline(always)]
    fn put(&mut self, indexed: &IndexedBox) {
        let slot = indexed.slot;
        if !indexed.is_present {
            return self.remove(slot);
        }
        self.index.extend_to(slot as usize + 1);
        let most_rest =
            if self.index.len > BODIES_IN_CACHE { MOST_REST } else { MOST_REST_IN_CACHE };
        let tagged = indexed.tagged();
        let body = &mut self.index.bodies[slot as usize];
        let former = std::mem::replace(&mut body.tagged, tagged);
        let rest = self.number - std::mem::replace(&mut body.search, self.number);
        self.often += usize::from(rest < most_rest);
        if body.is_listed
            && former.tags == tagged.tags
            && self.enlarged[slot as usize].contains(&indexed.aabb)
        {
            return;
        }
        let is_to_list = self.lists_pay && rest < most_rest;
        let enlarged = is_to_list.then(|| enlarge(&indexed.aabb, &former.aabb())).flatten();
        body.is_listed = enlarged.is_some();
        let Some(enlarged) = enlarged else {
            if !body.list.is_empty() {
                self.lists.replace(&mut body.list, &[]);
            }
            self.index.put(&tagged);
            return self.unlisted.push(tagged);
        };
        if self.enlarged.len() <= slot as usize {
            self.enlarged.resize(self.index.bodies.len(), Aabb::default());
        }
        self.enlarged[slot as usize] = enlarged;
        let Aabb { min, max } = enlarged;
        let tagged = TaggedBox { min, slot, max, tags: tagged.tags | ENLARGED_TAG };
        self.index.put(&tagged);
        self.listed.push(tagged);
    }

    /// Removes a body, if it is there.
    fn remove(&mut self, slot: u32) {
        if self.index.bodies.get(slot as usize).is_some_and(|body| body.is_present) {
            self.index.remove(slot);
            self.found.clear();
            self.take_list(slot);
            self.index.bodies[slot as usize] = Body::NONE;
        }
    }

    /// Searches for bodies that get a list.
    fn list_candidates(&mut self, most: usize) -> Option<usize> {
        let listed = std::mem::take(&mut self.listed);
        let mut work = 0;
        for batch in listed.chunks(SEEKERS_PER_BATCH) {
            work += self.index.search(batch, &mut self.search, most - work)?;
            let mut first = 0;
            for (number, seeker) in batch.iter().enumerate() {
                let Self { index, search: Search { quads, ends, hits, .. }, found, .. } = self;
                let own = std::mem::replace(&mut first, ends[number])..ends[number];
                found.clear();
                index.each_meeting(seeker, &quads[own], hits, |other, _| {
                    if other != seeker.slot {
                        found.push(other);
                    }
                });
                sort_each_once(found, 0);
                self.take_list(seeker.slot);
            }
        }
        self.listed = listed;
        if self.lists.taken() > CANDIDATES_PER_BODY * self.len() {
            return None;
        }
        if self.lists.is_sparse(self.index.bodies.len()) {
            self.lists.compact(self.index.bodies.iter_mut().map(|body| &mut body.list));
        }
        Some(work)
    }

    /// Finds the partners of bodies that get no list, and notes these in those of others.
    fn find_unlisted(&mut self, rules: PairRules<'_>, most: usize) -> Option<usize> {
        let Self { index, search, found, ends: all_ends, gained, .. } = self;
        found.clear();
        all_ends.clear();
        gained.clear();
        let mut work = 0;
        for batch in self.unlisted.chunks(SEEKERS_PER_BATCH) {
            work += index.search(batch, search, most - work)?;
            let Search { quads, ends, hits, .. } = &mut *search;
            let mut first = 0;
            for (seeker, &end) in batch.iter().zip(&*ends) {
                let start = found.len();
                let own = &quads[std::mem::replace(&mut first, end)..end];
                index.each_meeting(seeker, own, hits, |other, tags| {
                    let is_enlarged = tags & ENLARGED_TAG != 0;
                    if is_enlarged {
                        gained.push([other, seeker.slot]);
                    }
                    let tagged = &index.bodies[other as usize].tagged;
                    if other != seeker.slot
                        && (!is_enlarged || tagged.meets(seeker))
                        && may_meet(seeker, [other, tags], rules)
                    {
                        found.push(other);
                    }
                });
                sort_each_once(found, start);
                all_ends.push(found.len());
            }
        }
        for &[other, slot] in &self.gained {
            self.lists.set(&mut self.index.bodies[other as usize].list, slot, true);
        }
        Some(work)
    }

    /// Gives a slot the list that was found, and notes the slot in those of the others that have
    /// one.
    fn take_list(&mut self, slot: u32) {
        let Self { index: BoxIndex { bodies, .. }, lists, found, differences, .. } = self;
        compare(lists.get(bodies[slot as usize].list), found, differences);
        let gone =
            differences.iter().filter(|(_, is_near)| !is_near).map(|&(other, _)| (other, false));
        // Those that were near before, too: this one may have been in their lists in vain.
        for (other, is_near) in gone.chain(found.iter().map(|&other| (other, true))) {
            let other = &mut bodies[other as usize];
            if other.is_listed {
                lists.set(&mut other.list, slot, is_near);
            }
        }
        lists.replace(&mut bodies[slot as usize].list, found);
    }

    /// Prefetches what [`Self::list_partners`] will read of later bodies.
    #[inline(always)]
    fn prefetch(&self, [next, soon]: [Option<&IndexedBox>; 2]) {
        let body = |ahead: &IndexedBox| self.index.bodies.get(ahead.slot as usize);
        if let Some(body) = next.and_then(body) {
            self.lists.prefetch(body.list);
        }
        if let Some(body) = soon.and_then(body) {
            for &other in self.lists.get(body.list) {
                prefetch(&self.index.bodies[other as usize]);
            }
        }
    }

    /// Appends the candidates of a body that are its partners. Returns the number of candidates.
    #[inline(always)]
    fn list_partners(&self, slot: u32, rules: PairRules<'_>, partners: &mut Vec<u32>) -> usize {
        let bodies = &self.index.bodies;
        let body = &bodies[slot as usize];
        let list = self.lists.get(body.list);
        let start = partners.len();
        partners.resize(start + list.len(), 0);
        let (met, mut count) = (&mut partners[start..], 0);
        // Without branches: which boxes meet can't be foreseen.
        for &other in list {
            met[count] = other;
            count += usize::from(bodies[other as usize].tagged.meets(&body.tagged));
        }
        let mut kept = 0;
        for at in 0..count {
            let TaggedBox { slot, tags, .. } = bodies[met[at] as usize].tagged;
            met[kept] = slot;
            kept += usize::from(may_meet(&body.tagged, [slot, tags], rules));
        }
        partners.truncate(start + kept);
        list.len()
    }
}

impl IndexedBox {
    #[inline(always)]
    fn tagged(&self) -> TaggedBox {
        TaggedBox { min: self.aabb.min, slot: self.slot, max: self.aabb.max, tags: self.tags }
    }
}

/// Whether a pair of a body and another one, of which slot and tags are given, is reported if their
/// boxes meet.
#[inline(always)]
fn may_meet(body: &TaggedBox, [slot, tags]: [u32; 2], rules: PairRules<'_>) -> bool {
    let are_fixed = body.tags & tags & FIXED_TAG != 0;
    let collide = (body.tags | tags) & GROUPED_TAG == 0
        || rules.groups[body.slot as usize].collide(rules.groups[slot as usize]);
    !are_fixed && collide && !rules.excluded.contains(body.slot, slot)
}

/// A box that contains this one, and those that it will probably be in the next frames. `None` if
/// it moves too fast.
fn enlarge(aabb: &Aabb, former: &Aabb) -> Option<Aabb> {
    let motion = [0, 1, 2]
        .map(|axis| [aabb.min[axis] - former.min[axis], aabb.max[axis] - former.max[axis]]);
    let most = motion.as_flattened().iter().fold(0.0_f32, |most, by| most.max(by.abs()));
    let side = (0..3).map(|axis| aabb.max[axis] - aabb.min[axis]).fold(0.0, f32::max);
    if !(SIDE_PER_MOTION * most <= side) {
        return None;
    }
    let mut enlarged = *aabb;
    for (axis, [lower, upper]) in motion.into_iter().enumerate() {
        // Ends move outward or not at all, whatever is rounded.
        let (lower, upper) = (lower.min(0.0) * FRAMES_AHEAD, upper.max(0.0) * FRAMES_AHEAD);
        let aside = most * FRAMES_ASIDE;
        enlarged.min[axis] = (aabb.min[axis] + (lower - aside)).max(f32::MIN);
        enlarged.max[axis] = (aabb.max[axis] + (upper + aside)).min(f32::MAX);
    }
    Some(enlarged)
}

/// The tags of a body.
pub(crate) fn tags(is_dynamic: bool, groups: Groups) -> u32 {
    (FIXED_TAG * u32::from(!is_dynamic)) | (GROUPED_TAG * u32::from(groups != Groups::ALL))
}
