//! Tests one pair at a time, for engines with their own broad phase.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::bodies::SdopShape;
use super::border::{Out, SdopStatus, answer, free, handle, make, shared};
use crate::settings::DirectionSet;
use crate::world::PairTest;

/// The or-DOPs of shapes, as they are and grown by margins, for tests of single pairs.
#[derive(Debug)]
pub struct SdopPairTest(PairTest);

/// Makes a test without shapes, of or-DOPs with `k` faces: 6, 14, 18 or 26; 0 is 18.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_pair_test_new(k: u32, out: *mut *mut SdopPairTest) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        let directions = match k {
            0 => DirectionSet::K18,
            k => k.to_string().parse()?,
        };
        Ok(SdopPairTest(PairTest::new(directions)))
    })
}

/// Frees a test; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_pair_test_free(test: *mut SdopPairTest) {
    // SAFETY: the caller's promise.
    unsafe { free(test) }
}

/// Adds a shape, which the test copies. `number` gets its number: 0 for the first, and one more for
/// each shape that is added or grown.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_pair_test_add(
    test: *mut SdopPairTest,
    shape: *const SdopShape,
    number: *mut u32,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(number) }, "number", || {
        // SAFETY: the caller's promise.
        let (test, shape) = unsafe { (handle(test, "test")?, shared(shape, "shape")?) };
        Ok(test.0.add(&shape.0)?)
    })
}

/// Adds a shape of the test grown by `margin`, a length. `number` gets the number of the grown
/// shape.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_pair_test_grow(
    test: *mut SdopPairTest,
    shape: u32,
    margin: f32,
    number: *mut u32,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(number) }, "number", || {
        // SAFETY: the caller's promise.
        Ok(unsafe { handle(test, "test") }?.0.grown(shape, margin)?)
    })
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
