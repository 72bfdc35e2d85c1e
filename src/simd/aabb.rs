//! World-aligned boxes with the memory layout that vector loads rely on.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

use super::prefetch;

/// A closed, world-aligned box: boxes that touch meet. Its ends are finite, and each lower end is
/// at most the upper one; sides may have no length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Aabb {
    /// The lower corner.
    pub min: [f32; 3],
    /// The upper corner.
    pub max: [f32; 3],
}

const _: () = assert!(size_of::<Aabb>() == size_of::<[f32; 6]>());
const _: () = assert!(align_of::<Aabb>() == align_of::<[f32; 6]>());

/// The bits of infinity, above those of every finite positive number.
const INFINITY: u32 = f32::INFINITY.to_bits();

/// What a world asks of each box that is set, by bits, so that it holds in every floating-point
/// mode.
#[cfg(target_arch = "x86_64")]
impl Aabb {
    /// The lower ends, the upper ones, and 0 in each fourth lane.
    #[inline(always)]
    fn bits_of_ends(&self) -> [__m128i; 2] {
        let numbers = std::ptr::from_ref(self);
        // SAFETY: every CPU of this architecture has SSE2. A box is six times four bytes (asserted
        // above); the loads read the first four numbers and the last two, unaligned.
        unsafe {
            // As wide as a box is copied: a load that spans two fresh stores waits for both.
            let front = _mm_loadu_si128(numbers.cast());
            let back = _mm_loadl_epi64(numbers.cast::<u8>().add(16).cast());
            let lower = _mm_srli_si128::<4>(_mm_slli_si128::<4>(front));
            let upper = _mm_or_si128(_mm_srli_si128::<12>(front), _mm_slli_si128::<4>(back));
            [lower, upper]
        }
    }

    /// Whether the ends have the same bits as another's.
    #[inline]
    pub(crate) fn has_bits_of(&self, other: &Self) -> bool {
        let ([lower, upper], [other_lower, other_upper]) =
            (self.bits_of_ends(), other.bits_of_ends());
        // SAFETY: every CPU of this architecture has SSE2.
        unsafe {
            let lower = _mm_cmpeq_epi32(lower, other_lower);
            let upper = _mm_cmpeq_epi32(upper, other_upper);
            _mm_movemask_epi8(_mm_and_si128(lower, upper)) == 0xffff
        }
    }

    /// Whether the ends are finite and in order; it is false for a lower end of 0 and an upper end
    /// of −0.
    #[inline]
    pub(crate) fn is_surely_sound(&self) -> bool {
        let [lower, upper] = self.bits_of_ends();
        // SAFETY: every CPU of this architecture has SSE2.
        unsafe {
            let infinity = _mm_set1_epi32(INFINITY as i32);
            let is_finite = |ends| {
                let size = _mm_and_si128(ends, _mm_set1_epi32(i32::MAX));
                _mm_cmpgt_epi32(infinity, size)
            };
            // The bits of positive numbers are in the order of the numbers; those of negative ones
            // in the opposite order.
            let rank = |ends| _mm_xor_si128(ends, _mm_srli_epi32::<1>(_mm_srai_epi32::<31>(ends)));
            let are_finite = _mm_and_si128(is_finite(lower), is_finite(upper));
            let are_reversed = _mm_cmpgt_epi32(rank(lower), rank(upper));
            _mm_movemask_epi8(_mm_andnot_si128(are_reversed, are_finite)) == 0xffff
        }
    }
}

/// What a world asks of each box that is set, by bits, so that it holds in every floating-point
/// mode.
#[cfg(not(target_arch = "x86_64"))]
impl Aabb {
    /// Whether the ends have the same bits as another's.
    #[inline]
    pub(crate) fn has_bits_of(&self, other: &Self) -> bool {
        let bits = |aabb: &Self| [aabb.min, aabb.max].map(|ends| ends.map(f32::to_bits));
        bits(self) == bits(other)
    }

    /// Whether the ends are finite and in order; it is false for a lower end of 0 and an upper end
    /// of −0.
    #[inline]
    pub(crate) fn is_surely_sound(&self) -> bool {
        // The bits of positive numbers are in the order of the numbers; those of negative ones in
        // the opposite order.
        let rank = |bits: u32| (bits ^ (((bits as i32) >> 31) as u32 >> 1)) as i32;
        let size = |bits: u32| bits & !(1 << 31);
        let is_sound = |axis: usize| {
            let (lo, hi) = (self.min[axis].to_bits(), self.max[axis].to_bits());
            (size(lo) < INFINITY) & (size(hi) < INFINITY) & (rank(lo) <= rank(hi))
        };
        is_sound(0) & is_sound(1) & is_sound(2)
    }
}

/// The six numbers of each box: those of its lower corner, then those of its upper corner.
#[must_use]
pub fn numbers_of(boxes: &[Aabb]) -> &[[f32; 6]] {
    // SAFETY: a box is `repr(C)`: twice three f32 in this order. Its size and alignment are those
    // of six f32 (asserted above), so it has no padding, and each pattern of bits is an f32. The
    // slice borrows from `boxes`.
    unsafe { std::slice::from_raw_parts(boxes.as_ptr().cast(), boxes.len()) }
}

/// The boxes that rows of six numbers are: lower corner, then upper corner.
#[must_use]
pub fn boxes_of(numbers: &[[f32; 6]]) -> &[Aabb] {
    // SAFETY: as above, the other way round: each pattern of bits is a box, whose fields are plain
    // f32.
    unsafe { std::slice::from_raw_parts(numbers.as_ptr().cast(), numbers.len()) }
}

/// A box in half a cache line, with two numbers that its owner needs.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct TaggedBox {
    /// The lower corner.
    pub min: [f32; 3],
    /// Whose box this is.
    pub slot: u32,
    /// The upper corner.
    pub max: [f32; 3],
    /// What else is to be known of it.
    pub tags: u32,
}

const _: () = assert!(size_of::<TaggedBox>() == size_of::<[f32; 8]>());
const _: () = assert!(align_of::<TaggedBox>() >= size_of::<[f32; 4]>());

impl TaggedBox {
    /// The box without its numbers.
    #[inline(always)]
    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }

    /// A box that meets none.
    pub const NONE: Self = Self { min: [f32::NAN; 3], slot: 0, max: [f32::NAN; 3], tags: 0 };

    /// Whether the boxes meet, as [`Aabb`] says.
    #[inline(always)]
    #[cfg(target_arch = "x86_64")]
    pub fn meets(&self, other: &Self) -> bool {
        let halves = |tagged| {
            let corners = std::ptr::from_ref::<Self>(tagged).cast::<f32>();
            // SAFETY: every CPU of this architecture has SSE2. A tagged box is eight times four
            // bytes, of which each pattern is an f32, aligned to 32 bytes (asserted above).
            unsafe { [_mm_load_ps(corners), _mm_load_ps(corners.add(4))] }
        };
        let ([min, max], [other_min, other_max]) = (halves(self), halves(other));
        // SAFETY: every CPU of this architecture has SSE2. The lanes of slot and tags are left out.
        unsafe {
            let both = _mm_and_ps(_mm_cmple_ps(min, other_max), _mm_cmple_ps(other_min, max));
            _mm_movemask_ps(both) & 0b111 == 0b111
        }
    }

    /// Whether the boxes meet, as [`Aabb`] says.
    #[inline(always)]
    #[cfg(not(target_arch = "x86_64"))]
    pub fn meets(&self, other: &Self) -> bool {
        // Without branches: which boxes meet can't be foreseen.
        let on =
            |axis: usize| (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis]);
        on(0) & on(1) & on(2)
    }
}

/// Four boxes, each in a lane, with two numbers of each that their owner needs: two cache lines. A
/// lane without a box meets none.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct BoxQuad {
    /// The lower ends by axis, then the upper ones.
    ends: [[f32; 4]; 6],
    /// Whose boxes these are.
    pub slots: [u32; 4],
    /// What else is to be known of them.
    pub tags: [u32; 4],
}

/// A box in four equal lanes: its upper ends by axis, then its lower ones, as [`BoxQuad::meeting`]
/// compares them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct SeekerQuad([[f32; 4]; 6]);

impl SeekerQuad {
    /// Four times this box.
    #[inline(always)]
    pub fn of(&TaggedBox { min, max, .. }: &TaggedBox) -> Self {
        Self([max[0], max[1], max[2], min[0], min[1], min[2]].map(|end| [end; 4]))
    }
}

impl Default for BoxQuad {
    fn default() -> Self {
        Self { ends: [[f32::NAN; 4]; 6], slots: [0; 4], tags: [0; 4] }
    }
}

impl BoxQuad {
    /// Puts a box into a lane.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, &TaggedBox { min, slot, max, tags }: &TaggedBox) {
        for axis in 0..3 {
            (self.ends[axis][lane], self.ends[axis + 3][lane]) = (min[axis], max[axis]);
        }
        (self.slots[lane], self.tags[lane]) = (slot, tags);
    }

    /// The box in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> TaggedBox {
        let end = |at: usize| self.ends[at][lane];
        let [min, max] = [0, 3].map(|at| [end(at), end(at + 1), end(at + 2)]);
        TaggedBox { min, slot: self.slots[lane], max, tags: self.tags[lane] }
    }

    /// Removes the box in a lane.
    #[inline(always)]
    pub fn clear(&mut self, lane: usize) {
        self.ends.iter_mut().for_each(|ends| ends[lane] = f32::NAN);
    }

    /// Prefetches both cache lines.
    #[inline(always)]
    pub fn prefetch(&self) {
        prefetch(&self.ends[0]);
        prefetch(&self.ends[4]);
    }

    /// The lanes whose boxes meet this one, as [`Aabb`] says, a bit each.
    #[inline(always)]
    #[cfg(target_arch = "x86_64")]
    pub fn meeting(&self, SeekerQuad(seeker): &SeekerQuad) -> u32 {
        // SAFETY: every CPU of this architecture has SSE2. Each row is four f32, and both types
        // begin at a multiple of 16 bytes, as all their rows do.
        unsafe {
            let row = |rows: &[[f32; 4]; 6], at: usize| _mm_load_ps(rows[at].as_ptr());
            let from = |at| _mm_cmple_ps(row(&self.ends, at), row(seeker, at));
            let to = |at| _mm_cmple_ps(row(seeker, at), row(&self.ends, at));
            let lower = _mm_and_ps(_mm_and_ps(from(0), from(1)), from(2));
            let upper = _mm_and_ps(_mm_and_ps(to(3), to(4)), to(5));
            _mm_movemask_ps(_mm_and_ps(lower, upper)) as u32
        }
    }

    /// The lanes whose boxes meet this one, as [`Aabb`] says, a bit each.
    #[inline(always)]
    #[cfg(not(target_arch = "x86_64"))]
    pub fn meeting(&self, SeekerQuad(seeker): &SeekerQuad) -> u32 {
        // Without branches: which boxes meet can't be foreseen.
        let meets = |lane: usize| {
            let from = |at: usize| self.ends[at][lane] <= seeker[at][lane];
            let to = |at: usize| seeker[at][lane] <= self.ends[at][lane];
            from(0) & from(1) & from(2) & to(3) & to(4) & to(5)
        };
        (0..4).map(|lane| u32::from(meets(lane)) << lane).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::{Aabb, BoxQuad, SeekerQuad, TaggedBox, boxes_of, numbers_of};

    /// Boxes that touch on an axis meet, those a step apart don't, whatever slots and tags are; a
    /// lane without a box meets none, also one that had a box, and so does a box of NaN.
    #[test]
    fn tagged_boxes_and_those_in_lanes_meet_as_boxes_do() {
        let middle = Aabb { min: [1.0, 2.0, 3.0], max: [4.0, 5.0, 6.0] };
        let all = Aabb { min: [-1.0; 3], max: [9.0; 3] };
        let tagged =
            |&Aabb { min, max }: &Aabb, number| TaggedBox { min, slot: number, max, tags: number };
        let meeting = |quad: &BoxQuad, aabb: &Aabb| quad.meeting(&SeekerQuad::of(&tagged(aabb, 0)));
        for (number, lane) in [0, 1, 0x7fff_ffff, u32::MAX].into_iter().zip(0..4) {
            let alone = |aabb: &Aabb| {
                let mut quad = BoxQuad::default();
                quad.put(lane, &tagged(aabb, number));
                let TaggedBox { slot, tags, .. } = quad.get(lane);
                assert_eq!((quad.get(lane).aabb(), slot, tags), (*aabb, number, number));
                quad
            };
            let meet = |one: &Aabb, other: &Aabb| {
                let lanes = meeting(&alone(one), other);
                let meet = tagged(one, number).meets(&tagged(other, number));
                assert_eq!(lanes, u32::from(meet) << lane);
                meet
            };
            for axis in 0..3 {
                let (mut below, mut above) = (all, all);
                (below.max[axis], above.min[axis]) = (middle.min[axis], middle.max[axis]);
                assert!(meet(&middle, &below) && meet(&middle, &above));
                assert!(meet(&below, &middle) && meet(&above, &middle));
                below.max[axis] = below.max[axis].next_down();
                above.min[axis] = above.min[axis].next_up();
                assert!(!meet(&middle, &below) && !meet(&middle, &above));
                assert!(!meet(&below, &middle) && !meet(&above, &middle));
            }
            let mut emptied = alone(&middle);
            emptied.clear(lane);
            assert_eq!(meeting(&emptied, &all), 0);
            let none = TaggedBox::NONE;
            assert!(!none.meets(&tagged(&all, number)) && !tagged(&all, number).meets(&none));
        }
    }

    /// Every pair of these numbers as ends of one axis, between sound ends of the others.
    #[test]
    fn soundness_and_bits_are_those_of_numbers() {
        let least = f32::from_bits(1);
        let positive = [0.0, least, f32::MIN_POSITIVE, 1.0, f32::MAX, f32::INFINITY];
        let all: Vec<f32> =
            (positive.iter().flat_map(|&x| [-x, x])).chain([f32::NAN, -f32::NAN]).collect();
        let aabb = |axis: usize, lo, hi| {
            let mut aabb = Aabb { min: [-1.0, -2.0, -3.0], max: [1.0, -2.0, 3.0] };
            (aabb.min[axis], aabb.max[axis]) = (lo, hi);
            aabb
        };
        for axis in 0..3 {
            for (&lo, &hi) in all.iter().flat_map(|lo| all.iter().map(move |hi| (lo, hi))) {
                let is_sound = lo.is_finite() && hi.is_finite() && lo <= hi;
                let are_zeros = lo == 0.0 && hi == 0.0 && !lo.is_sign_negative();
                let expected = is_sound && !(are_zeros && hi.is_sign_negative());
                assert_eq!(aabb(axis, lo, hi).is_surely_sound(), expected, "{lo} {hi}");
                for &other in &all {
                    let is_same = other.to_bits() == hi.to_bits();
                    let [one, two] = [hi, other].map(|end| aabb(axis, lo, end));
                    assert_eq!(one.has_bits_of(&two), is_same, "{hi} {other}");
                    let [one, two] = [hi, other].map(|end| aabb(axis, end, lo));
                    assert_eq!(one.has_bits_of(&two), is_same, "{hi} {other}");
                }
            }
        }
    }

    #[test]
    fn numbers_keep_their_order() {
        let [min, max] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        let boxes = [Aabb { min, max }, Aabb { min: max, max: min }];
        let expected = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]];
        assert_eq!(numbers_of(&boxes), expected);
        assert_eq!(boxes_of(&expected), boxes);
        assert!(numbers_of(&[]).is_empty() && boxes_of(&[]).is_empty());
    }
}
