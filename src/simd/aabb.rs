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

#[cfg(test)]
mod tests {
    use super::{Aabb, boxes_of, numbers_of};

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
