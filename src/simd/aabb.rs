//! World-aligned boxes with the memory layout that vector loads rely on.

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
#[derive(Clone, Copy, Debug, Default)]
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
    /// Whether the boxes meet, as [`Aabb`] says.
    #[inline(always)]
    #[cfg(target_arch = "x86_64")]
    pub fn meets(&self, other: &Self) -> bool {
        use std::arch::x86_64::{_mm_and_ps, _mm_cmple_ps, _mm_load_ps, _mm_movemask_ps};
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

#[cfg(test)]
mod tests {
    use super::{Aabb, TaggedBox, boxes_of, numbers_of};

    /// Boxes that touch on an axis meet, those a step apart don't, whatever slots and tags are.
    #[test]
    fn tagged_boxes_meet_as_boxes_do() {
        for number in [0, 1, 0x7fff_ffff, u32::MAX] {
            let tagged = |min, max| TaggedBox {
                min,
                slot: number,
                max,
                tags: number,
            };
            let all = tagged([-1.0; 3], [9.0; 3]);
            let middle = tagged([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
            assert!(middle.meets(&all) && all.meets(&middle));
            for axis in 0..3 {
                let (mut below, mut above) = (all, all);
                (below.max[axis], above.min[axis]) = (middle.min[axis], middle.max[axis]);
                assert!(middle.meets(&below) && middle.meets(&above));
                below.max[axis] = below.max[axis].next_down();
                above.min[axis] = above.min[axis].next_up();
                assert!(!middle.meets(&below) && !middle.meets(&above));
                assert!(!below.meets(&middle) && !above.meets(&middle));
            }
        }
    }

    #[test]
    fn numbers_keep_their_order() {
        let [min, max] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        let boxes = [Aabb { min, max }, Aabb { min: max, max: min }];
        let expected = [
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            [4.0, 5.0, 6.0, 1.0, 2.0, 3.0],
        ];
        assert_eq!(numbers_of(&boxes), expected);
        assert_eq!(boxes_of(&expected), boxes);
        assert!(numbers_of(&[]).is_empty() && boxes_of(&[]).is_empty());
    }
}
