//! Which boxes may meet which, while few of them move.
//!
//! A body that moves often is listed: it has an enlarged box around its own, and a list of
//! candidates, which are the bodies that meet the enlarged box with theirs, enlarged or not. While
//! it moves within its enlarged box, it is compared with its candidates alone. When it leaves that,
//! it gets another one, and is searched for in the index, which has these boxes. How much a box is
//! enlarged follows from its last motion. A body that isn't listed is searched for whenever it
//! moves.

use std::ops::Range;

use super::{Body, BoxIndex, FIXED_TAG, Search, each_meeting, sort_each_once};
use crate::bodies::{Aabb, Groups, PairRules};
use crate::pairs::{FoundPartners, Runs};
use crate::simd::{TaggedBox, prefetch};

/// Tag of a box that doesn't collide with all groups.
const GROUPED_TAG: u32 = 2;

/// Tag of an enlarged box in the index.
const ENLARGED_TAG: u32 = 4;

/// A box is enlarged by this many times its last motion ahead, and by this many to all sides.
const FRAMES_AHEAD: f32 = 6.0;
const FRAMES_ASIDE: f32 = 1.0;

/// A box that has moved by more than its longest side over this isn't enlarged: it would meet too
/// many, or be left at once.
const SIDE_PER_MOTION: f32 = 8.0;

/// A body moves often if fewer than this number of searches have passed since it moved before. If
/// half of the changed bodies do, a list pays for each of them: it serves for several moves. In a
/// world that fits into the nearer caches, it pays for bodies that move less often, too.
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

/// The boxes of a world, and the candidates of its listed bodies.
#[derive(Clone, Debug)]
pub(crate) struct Candidates {
    /// The boxes of all bodies, enlarged if they are listed.
    index: BoxIndex,
    /// The enlarged box of each slot whose body is listed: the index has it in three cache lines.
    enlarged: Vec<Aabb>,
    /// The lists have all candidates, and may have others that were candidates.
    lists: Runs<u32, 4>,
    /// The number of this search; those of bodies are at most this.
    number: u32,
    /// Changed bodies of this search that move often, and whether lists pay for such bodies, as the
    /// search before has shown.
    often: usize,
    lists_pay: bool,
    /// The boxes in the index of the bodies that are searched for.
    seekers: Vec<TaggedBox>,
    search: Search,
    /// The partners of all seekers that aren't listed, and the end of each one's part.
    partners: Vec<u32>,
    ends: Vec<usize>,
    /// A body's new list and its former one.
    list: Vec<u32>,
    former: Vec<u32>,
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
            seekers: Vec::new(),
            search: Search::default(),
            partners: Vec::new(),
            ends: Vec::new(),
            list: Vec::new(),
            former: Vec::new(),
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
        self.seekers.clear();
        self.number = self.number.checked_add(1)?; // then all pairs are found once
        for (number, indexed) in changed.iter().enumerate() {
            let ahead = [3, 2, 1].map(|steps| changed.get(number + steps * PREFETCH_DISTANCE));
            self.index.prefetch(ahead);
            self.put(indexed);
        }
        self.lists_pay = 2 * std::mem::take(&mut self.often) >= changed.len();
        self.index.compact();
        let mut work = self.search(rules, most_work)?;
        let has_listed = self.ends.len() < changed.len();
        let (mut ends, mut first) = (self.ends.iter(), 0);
        for (number, indexed) in changed.iter().enumerate() {
            if has_listed {
                self.prefetch([2, 1].map(|steps| changed.get(number + steps * PREFETCH_DISTANCE)));
            }
            if indexed.is_present {
                if self.index.bodies[indexed.slot as usize].is_listed {
                    work += self.list_partners(indexed.slot, rules, &mut found.partners);
                } else if let Some(&end) = ends.next() {
                    let own = &self.partners[std::mem::replace(&mut first, end)..end];
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

    /// Moves, inserts or removes a body, and lists it among the seekers if it must be searched for.
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
        let pays = self.lists_pay && rest < most_rest;
        let enlarged = pays.then(|| enlarge(&indexed.aabb, &former.aabb())).flatten();
        body.is_listed = enlarged.is_some();
        let mut seeker = tagged;
        if let Some(enlarged) = enlarged {
            if self.enlarged.len() <= slot as usize {
                self.enlarged.resize(self.index.bodies.len(), Aabb::default());
            }
            self.enlarged[slot as usize] = enlarged;
            let Aabb { min, max } = enlarged;
            seeker = TaggedBox { min, slot, max, tags: tagged.tags | ENLARGED_TAG };
        } else if !body.list.is_empty() {
            self.lists.replace(&mut body.list, &[]);
        }
        self.index.put(&seeker);
        self.seekers.push(seeker);
    }

    /// Removes a body, if it is there.
    fn remove(&mut self, slot: u32) {
        if self.index.bodies.get(slot as usize).is_some_and(|body| body.is_present) {
            self.index.remove(slot);
            self.list.clear();
            self.take_list(slot);
            self.index.bodies[slot as usize] = Body::NONE;
        }
    }

    /// Searches for the seekers: finds the candidates of those that are listed, and the partners of
    /// the others. Returns the number of boxes and cells read, or `None` if there are more than
    /// `most`, or too many candidates.
    fn search(&mut self, rules: PairRules<'_>, most: usize) -> Option<usize> {
        self.partners.clear();
        self.ends.clear();
        let seekers = std::mem::take(&mut self.seekers);
        let mut work = 0;
        for batch in seekers.chunks(SEEKERS_PER_BATCH) {
            work += self.index.search(batch, &mut self.search, most - work)?;
            let mut first = 0;
            for (number, seeker) in batch.iter().enumerate() {
                let end = self.search.ends[number];
                let quads = std::mem::replace(&mut first, end)..end;
                if seeker.tags & ENLARGED_TAG != 0 {
                    self.find_candidates(seeker, quads);
                } else {
                    self.find_partners(seeker, quads, rules);
                }
            }
        }
        self.seekers = seekers;
        if self.lists.taken() > CANDIDATES_PER_BODY * self.len() {
            return None;
        }
        if self.lists.is_sparse(self.index.bodies.len()) {
            self.lists.compact(self.index.bodies.iter_mut().map(|body| &mut body.list));
        }
        Some(work)
    }

    /// Gives a listed body its candidates, which are in these of the search's quads.
    fn find_candidates(&mut self, seeker: &TaggedBox, quads: Range<usize>) {
        let Self { index, search, list, .. } = self;
        list.clear();
        each_meeting(&index.quads, seeker, &search.quads[quads], &mut search.hits, |other, _| {
            if other != seeker.slot {
                list.push(other);
            }
        });
        sort_each_once(list, 0);
        self.take_list(seeker.slot);
    }

    /// Finds the partners of a body that isn't listed, which are in these of the search's quads,
    /// and adds it to the candidates of listed ones.
    fn find_partners(&mut self, seeker: &TaggedBox, quads: Range<usize>, rules: PairRules<'_>) {
        let Self { index, search, lists, partners, ends, .. } = self;
        let BoxIndex { quads: all, bodies, .. } = index;
        let start = partners.len();
        each_meeting(all, seeker, &search.quads[quads], &mut search.hits, |slot, tags| {
            let mut meets = slot != seeker.slot;
            if tags & ENLARGED_TAG != 0 {
                let other = &mut bodies[slot as usize];
                lists.set(&mut other.list, seeker.slot, true);
                meets = other.tagged.meets(seeker);
            }
            if meets && may_meet(seeker, [slot, tags], rules) {
                partners.push(slot);
            }
        });
        sort_each_once(partners, start);
        ends.push(partners.len());
    }

    /// Gives a slot its new list, and adds the slot to those of its candidates or removes it from
    /// those of former ones.
    fn take_list(&mut self, slot: u32) {
        let Self { index: BoxIndex { bodies, .. }, lists, list, former, .. } = self;
        let run = &mut bodies[slot as usize].list;
        former.clear();
        former.extend_from_slice(lists.get(*run));
        lists.replace(run, list);
        let gone = former.iter().filter(|other| list.binary_search(other).is_err());
        // Candidates that have stayed may not have this one: a list may have former candidates.
        let all = gone.map(|other| (other, false)).chain(list.iter().map(|other| (other, true)));
        for (&other, is_near) in all {
            let other = &mut bodies[other as usize];
            if other.is_listed {
                lists.set(&mut other.list, slot, is_near);
            }
        }
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

    /// Appends those candidates of a listed body that are its partners. Returns the number of its
    /// candidates.
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
