//! Finds the pairs of bodies between two sets.

use super::QueryError;
use super::answers::AnswerCount;
use super::index::{QueryIndex, SolidBody, TREES, moved};
use super::tree::{BOXES_PER_GROUP, BoxGroup, lanes_of};
use crate::bodies::Aabb;
use crate::living::BodyId;
use crate::simd::{Kernel, Lanes, dispatch, in_default_mode};

/// Groups of the first set that one thread tests at a time.
const GROUPS_PER_TASK: usize = 16;

impl QueryIndex {
    /// The pairs of a body of this set and one of another that may touch, sorted by the slot of the
    /// first and of the second. It uses all threads of this index. Both sets may come from the same
    /// world, and from worlds of either kind.
    ///
    /// # Errors
    /// One of the indices was never updated, or there are more pairs than [`Self::most_answers`] of
    /// this index.
    pub fn pairs_with(&self, other: &Self) -> Result<Vec<[BodyId; 2]>, QueryError> {
        self.check_updated()?;
        other.check_updated()?;
        let mut tasks = Vec::new();
        for tree in 0..TREES {
            let groups = self.trees[tree].groups().len();
            let starts = (0..groups).step_by(GROUPS_PER_TASK);
            tasks.extend(starts.map(|start| {
                let end = groups.min(start + GROUPS_PER_TASK);
                (tree, start..end, Vec::new())
            }));
        }
        let count = AnswerCount::up_to(self.most_answers);
        in_default_mode(|| {
            self.threads.each(&mut tasks, |_, (tree, groups, found)| {
                for group in groups.clone() {
                    let start = found.len();
                    let pairs = GroupPairs { sets: [self, other], tree: *tree, group, found };
                    dispatch(self.tier, pairs);
                    count.add(found, start);
                }
            });
        });
        let mut pairs = count.room()?;
        tasks.iter().for_each(|(_, _, found)| pairs.extend_from_slice(found));
        pairs.sort_unstable_by_key(|[one, other]: &[BodyId; 2]| {
            (one.slot() as u64) << 32 | other.slot() as u64
        });
        Ok(pairs)
    }
}

/// The pairs of a group of the first set.
struct GroupPairs<'a> {
    sets: [&'a QueryIndex; 2],
    tree: usize,
    group: usize,
    found: &'a mut Vec<[BodyId; 2]>,
}

impl Kernel for GroupPairs<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let [one, other] = self.sets;
        let group = &one.trees[self.tree].groups()[self.group];
        let by = [0, 1, 2].map(|axis| one.origin[axis] - other.origin[axis]);
        let Some(bounds) = group.bounds() else {
            return;
        };
        let group = seen_from(group, by);
        let bounds = moved(&bounds, by);
        for tree in 0..TREES {
            other.trees[tree].each_meeting(l, &bounds, |place| {
                let aabb = other.trees[tree].bounds(place as u32);
                let meeting = group.meeting(l, &aabb);
                if meeting == 0 {
                    return;
                }
                let solid = other.solid(tree, place);
                for lane in lanes_of(meeting) {
                    let first = self.group * BOXES_PER_GROUP + lane;
                    if may_touch(one.solid(self.tree, first), solid) {
                        let pair = [one.id_at(self.tree, first), other.id_at(tree, place)];
                        self.found.push(pair);
                    }
                }
            });
        }
    }
}

/// The boxes of a group, moved.
fn seen_from(group: &BoxGroup, by: [f64; 3]) -> BoxGroup {
    let mut seen = group.clone();
    if by == [0.0; 3] {
        return seen;
    }
    for lane in group.lanes() {
        seen.set(lane, &moved(&group.get(lane), by));
    }
    seen
}

/// Whether two bodies whose boxes meet may touch.
fn may_touch(one: SolidBody<'_>, other: SolidBody<'_>) -> bool {
    let touches_box = |aabb: Aabb, solid: SolidBody<'_>| match solid {
        SolidBody::Box(_) => true,
        SolidBody::Shape(body) => {
            let [lo, hi] = [aabb.min, aabb.max].map(|corner| corner.map(f64::from));
            body.may_touch_box(lo, hi)
        }
    };
    match (one, other) {
        (SolidBody::Box(aabb), solid) | (solid, SolidBody::Box(aabb)) => touches_box(aabb, solid),
        (SolidBody::Shape(one), SolidBody::Shape(other)) => one.may_touch(&other),
    }
}
