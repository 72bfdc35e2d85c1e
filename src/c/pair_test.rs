//! Tests one pair at a time, for engines with their own broad phase.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::bodies::{SdopShape, directions};
use super::border::border;
use crate::world::PairTest;

/// The or-DOPs of shapes, as they are and grown by margins, for tests of single pairs.
#[derive(Debug)]
pub struct SdopPairTest(PairTest);

border! {
test: SdopPairTest;

/// Makes a test without shapes, of or-DOPs with `k` faces: 6, 14, 18 or 26; 0 is 18.
fn sdop_pair_test_new(k: u32) -> new SdopPairTest { SdopPairTest(PairTest::new(directions(k)?)) }
/// Frees a test; null is fine.
free sdop_pair_test_free;
/// Adds a shape, which the test copies. `number` gets its number: 0 for the first, and one more for
/// each shape that is added or grown.
fn sdop_pair_test_add(*mut test, *const shape: SdopShape) -> *mut number: u32 {
    test.0.add(&shape.0)?
}

/// Adds a shape of the test grown by `margin`, a length. `number` gets the number of the grown
/// shape.
fn sdop_pair_test_grow(*mut test, shape: u32, margin: f32) -> *mut number: u32 {
    test.0.grown(shape, margin)?
}
}

/// Whether two shapes may touch, the second posed in the frame of the first by a quaternion x, y,
/// z, w of any non-zero norm and the translation of its origin. False only if they are apart in
/// exact arithmetic; true for null pointers, unknown numbers and poses that are not finite. Many
/// threads may call it at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_pair_test_may_touch(
    test: *const SdopPairTest,
    first: u32,
    second: u32,
    rotation: *const [f32; 4],
    translation: *const [f32; 3],
) -> bool {
    // SAFETY: the caller's promise.
    let given = unsafe { (test.as_ref(), rotation.as_ref(), translation.as_ref()) };
    let (Some(test), Some(rotation), Some(translation)) = given else {
        return true;
    };
    let answer = || test.0.may_touch(first, second, *rotation, *translation);
    catch_unwind(AssertUnwindSafe(answer)).unwrap_or(true)
}
