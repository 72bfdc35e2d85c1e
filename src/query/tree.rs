//! A tree of boxes that is built once and then changed box by box: sixteen boxes form a group, and
//! sixteen groups form a group of the level above, up to a single one.
//!
//! A build sorts boxes by size and halves them along their widest axis, by number, so that groups
//! are small however far apart some boxes are. A box that moves changes the groups above it, in the
//! same place; a new one is appended, and a removed one leaves its place empty. All of this makes
//! groups wider, never wrong; [`Tree::is_worn`] returns whether rebuilding pays.

use crate::bodies::Aabb;
use crate::simd::{Lanes, MAX_WIDTH};

/// Boxes in a group.
pub(super) const BOXES_PER_GROUP: usize = MAX_WIDTH;

/// At least the number of levels of a tree of 2³² boxes.
const MOST_LEVELS: usize = 8;

/// The most groups that are still to be searched: all but one of a group in each level, and its
/// last.
pub(super) const MOST_WAITING: usize = MOST_LEVELS * BOXES_PER_GROUP;

/// Boxes of one class differ in size by no more than this power of two.
const CLASS_OCTAVES: i32 = 3;
const MOST_CLASSES: i32 = 16;

/// A tree is worn when more than one in this many boxes was appended or removed …
const BOXES_PER_LATE: usize = 8;
const LEAST_LATE_LIMIT: usize = 64;

/// … or when its groups are this many times as wide as when it was built.
const WORN_WIDTH_RATIO: f64 = 2.0;

/// No group counts for more than this number of usual ones, so that few that are wide don't hide
/// the others.
const MOST_USUAL_WIDTHS: f64 = 16.0;

/// Up to sixteen boxes, as columns.
#[derive(Clone, Debug)]
pub(super) struct BoxGroup {
    pub lo: [[f32; BOXES_PER_GROUP]; 3],
    pub hi: [[f32; BOXES_PER_GROUP]; 3],
    /// Lanes that hold a box.
    pub present: u32,
}

impl BoxGroup {
    const EMPTY: Self =
        Self { lo: [[0.0; BOXES_PER_GROUP]; 3], hi: [[0.0; BOXES_PER_GROUP]; 3], present: 0 };

    pub fn set(&mut self, lane: usize, aabb: &Aabb) {
        for axis in 0..3 {
            self.lo[axis][lane] = aabb.min[axis];
            self.hi[axis][lane] = aabb.max[axis];
        }
        self.present |= 1 << lane;
    }

    pub fn get(&self, lane: usize) -> Aabb {
        Aabb { min: self.lo.map(|ends| ends[lane]), max: self.hi.map(|ends| ends[lane]) }
    }

    /// The lanes that hold a box.
    pub fn lanes(&self) -> impl Iterator<Item = usize> + use<> {
        lanes_of(self.present)
    }

    /// The sum of the half sides of a box, or 0 if there is none.
    fn width_of(&self, lane: usize) -> f64 {
        let half_sides = self.get(lane).half_sides();
        let is_present = self.present >> lane & 1 == 1;
        f64::from(u8::from(is_present)) * half_sides.iter().copied().map(f64::from).sum::<f64>()
    }

    /// The box around all of them, if there are any.
    pub fn bounds(&self) -> Option<Aabb> {
        self.lanes().map(|lane| self.get(lane)).reduce(|a, b| Aabb {
            min: std::array::from_fn(|axis| a.min[axis].min(b.min[axis])),
            max: std::array::from_fn(|axis| a.max[axis].max(b.max[axis])),
        })
    }

    /// The lanes whose boxes meet `aabb`.
    #[inline(always)]
    pub fn meeting<L: Lanes>(&self, l: L, other: &Aabb) -> u32 {
        let mut apart = 0;
        for lane in (0..BOXES_PER_GROUP).step_by(L::WIDTH) {
            let beyond = |axis: usize| {
                l.gt(l.load(&self.lo[axis][lane..]), l.splat(other.max[axis]))
                    | l.gt(l.splat(other.min[axis]), l.load(&self.hi[axis][lane..]))
            };
            apart |= l.bits(beyond(0) | beyond(1) | beyond(2)) << lane;
        }
        self.present & !apart
    }
}

/// The numbers of the set bits.
pub(super) fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < 32).then_some(lane)
    })
}

/// Boxes by place, each with a number that its user gave.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// The groups of boxes, then those of the groups of the level before, up to one group.
    levels: Vec<Vec<BoxGroup>>,
    /// The number in each place.
    numbers: Vec<u32>,
    /// Groups of boxes that have changed since the levels above were last updated.
    changed: Vec<u32>,
    late: usize,
    /// The half sides of all groups of boxes when the tree was built, and now.
    built_width: f64,
    width: f64,
    /// The most that one group adds to them, once the tree was built.
    most_width: Option<f64>,
}

impl Tree {
    /// Builds a tree and puts the boxes into the order of their places.
    pub fn build(mut boxes: Vec<(u32, Aabb)>) -> Self {
        put_in_order(&mut boxes);
        let mut tree = Self::default();
        for (number, aabb) in &boxes {
            tree.push(*number, aabb);
        }
        tree.settle();
        tree.late = 0;
        let above = tree.levels.get(1).into_iter().flatten();
        let mut widths: Vec<f64> =
            above.flat_map(|group| group.lanes().map(|lane| group.width_of(lane))).collect();
        widths.sort_unstable_by(f64::total_cmp);
        tree.most_width = widths.get(widths.len() / 2).map(|usual| MOST_USUAL_WIDTHS * usual);
        tree.width = widths.into_iter().map(|width| tree.counted(width)).sum();
        tree.built_width = tree.width;
        tree
    }

    /// The part of a group's width that counts.
    fn counted(&self, width: f64) -> f64 {
        self.most_width.map_or(width, |most| width.min(most))
    }

    /// The numbers by place, including those of removed boxes.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The box in a place.
    #[inline(always)]
    pub fn bounds(&self, place: u32) -> Aabb {
        let place = place as usize;
        self.levels[0][place / BOXES_PER_GROUP].get(place % BOXES_PER_GROUP)
    }

    /// Appends a box, and returns its place.
    pub fn push(&mut self, number: u32, aabb: &Aabb) -> u32 {
        let place = self.numbers.len();
        self.numbers.push(number);
        let (mut groups, mut level) = (place / BOXES_PER_GROUP + 1, 0);
        loop {
            if self.levels.len() == level {
                self.levels.push(Vec::new());
                self.changed.push(0); // what was on top is below now
            }
            self.levels[level].resize(groups, BoxGroup::EMPTY);
            if groups == 1 && self.levels.len() == level + 1 {
                break;
            }
            (groups, level) = (groups.div_ceil(BOXES_PER_GROUP), level + 1);
        }
        self.late += 1;
        self.set(place as u32, aabb);
        place as u32
    }

    /// Moves the box in a place.
    pub fn set(&mut self, place: u32, aabb: &Aabb) {
        let place = place as usize;
        self.levels[0][place / BOXES_PER_GROUP].set(place % BOXES_PER_GROUP, aabb);
        self.changed.push((place / BOXES_PER_GROUP) as u32);
    }

    /// Removes the box in a place.
    pub fn remove(&mut self, place: u32) {
        let place = place as usize;
        self.levels[0][place / BOXES_PER_GROUP].present &= !(1 << (place % BOXES_PER_GROUP));
        self.changed.push((place / BOXES_PER_GROUP) as u32);
        self.late += 1;
    }

    /// Updates the levels above.
    pub fn settle(&mut self) {
        let mut changed = std::mem::take(&mut self.changed);
        if changed.is_empty() {
            return;
        }
        changed.sort_unstable();
        for level in 0..self.levels.len() - 1 {
            changed.dedup();
            for group in &mut changed {
                let (at, bounds) = (*group as usize, self.levels[level][*group as usize].bounds());
                let above = &mut self.levels[level + 1][at / BOXES_PER_GROUP];
                let lane = at % BOXES_PER_GROUP;
                let former = above.width_of(lane);
                match bounds {
                    Some(bounds) => above.set(lane, &bounds),
                    None => above.present &= !(1 << lane),
                }
                if level == 0 {
                    let now = above.width_of(lane);
                    self.width += self.counted(now) - self.counted(former);
                }
                *group /= BOXES_PER_GROUP as u32;
            }
        }
        changed.clear();
        self.changed = changed;
    }

    /// Whether rebuilding pays.
    pub fn is_worn(&self) -> bool {
        self.late > LEAST_LATE_LIMIT + self.numbers.len() / BOXES_PER_LATE
            || self.width > WORN_WIDTH_RATIO * self.built_width
    }

    /// The groups of boxes; the first has places 0 to 15.
    pub fn groups(&self) -> &[BoxGroup] {
        self.levels.first().map_or(&[], Vec::as_slice)
    }

    /// The top group, where a search begins, unless there are no boxes.
    pub fn top(&self) -> Option<Node> {
        let level = self.levels.len().checked_sub(1)? as u32;
        Some(Node { level, group: 0 })
    }

    /// A group of a level.
    #[inline(always)]
    pub fn group(&self, node: Node) -> &BoxGroup {
        &self.levels[node.level as usize][node.group as usize]
    }

    /// Calls `take` with the place of each box that meets `aabb`.
    #[inline(always)]
    pub fn each_meeting<L: Lanes>(&self, l: L, aabb: &Aabb, mut take: impl FnMut(usize)) {
        let mut waiting = [Node::default(); MOST_WAITING];
        let mut count = 0;
        if let Some(top) = self.top() {
            (waiting[0], count) = (top, 1);
        }
        while count > 0 {
            count -= 1;
            let node = waiting[count];
            for lane in lanes_of(self.group(node).meeting(l, aabb)) {
                match node.below(lane) {
                    LaneContent::Place(place) => take(place),
                    LaneContent::Node(node) => {
                        waiting[count] = node;
                        count += 1;
                    }
                }
            }
        }
    }
}

/// A group of a tree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    level: u32,
    group: u32,
}

/// The object in a lane of a group.
pub(super) enum LaneContent {
    Place(usize),
    Node(Node),
}

impl Node {
    #[inline(always)]
    pub fn below(self, lane: usize) -> LaneContent {
        let at = self.group as usize * BOXES_PER_GROUP + lane;
        match self.level {
            0 => LaneContent::Place(at),
            level => LaneContent::Node(Self { level: level - 1, group: at as u32 }),
        }
    }
}

/// Puts boxes in order: those of similar size together, the largest first, and those near each
/// other in space.
fn put_in_order(boxes: &mut [(u32, Aabb)]) {
    let largest = boxes.iter().map(|(_, aabb)| octave_of(aabb)).max().unwrap_or(0);
    let class = |aabb: &Aabb| ((largest - octave_of(aabb)) / CLASS_OCTAVES).min(MOST_CLASSES - 1);
    boxes.sort_by_key(|(_, aabb)| class(aabb));
    let mut start = 0;
    for boxes in boxes.chunk_by_mut(|(_, a), (_, b)| class(a) == class(b)) {
        halve(boxes, start);
        start += boxes.len();
    }
}

/// Sorts boxes, which have the places from `start` on, into halves along their widest axis, each
/// half of whole groups of the highest possible level, and each half likewise.
fn halve(boxes: &mut [(u32, Aabb)], start: usize) {
    if boxes.len() <= BOXES_PER_GROUP {
        return;
    }
    let levels = (boxes.len() - 1).ilog(BOXES_PER_GROUP);
    let unit = BOXES_PER_GROUP.pow(levels);
    let middle = (start + boxes.len() / 2 + unit / 2) / unit * unit - start;
    let mut range = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
    for (_, aabb) in &*boxes {
        for (axis, [lowest, highest]) in range.iter_mut().enumerate() {
            let centre = centre_of(aabb, axis);
            (*lowest, *highest) = (lowest.min(centre), highest.max(centre));
        }
    }
    let width = range.map(|[lowest, highest]| highest - lowest);
    let wider = |a: usize, b: usize| if width[b] > width[a] { b } else { a };
    let axis = wider(wider(0, 1), 2);
    let by_centre = |(_, a): &(u32, Aabb), (_, b): &(u32, Aabb)| {
        centre_of(a, axis).total_cmp(&centre_of(b, axis))
    };
    boxes.select_nth_unstable_by(middle, by_centre);
    let (lower, upper) = boxes.split_at_mut(middle);
    halve(lower, start);
    halve(upper, start + middle);
}

fn centre_of(aabb: &Aabb, axis: usize) -> f32 {
    0.5 * aabb.min[axis] + 0.5 * aabb.max[axis]
}

/// The exponent of the longest side.
fn octave_of(aabb: &Aabb) -> i32 {
    let longest = aabb.half_sides().into_iter().fold(0.0, f32::max);
    (longest.to_bits() >> (f32::MANTISSA_DIGITS - 1)) as i32
}

#[cfg(test)]
mod tests;
