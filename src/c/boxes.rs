//! A culler that gets all boxes anew in each frame.

use std::ffi::{c_char, c_void};

use super::border::{
    Buffer, Out, Refusal, SdopPair, SdopStatus, SdopTakePairs, User, answer, call_back, column,
    free, handle, list, make, optional, pairs, text,
};
use crate::bodies::{Aabb, Groups};
use crate::boxes::{BoxCuller, BoxCullerBuilder};
use crate::pairs::PairList;
use crate::settings::Finder;

/// Finds the boxes that meet, frame after frame.
#[derive(Debug)]
pub struct SdopBoxCuller(BoxCuller);

/// How a culler of boxes is made of what C gives.
///
/// # Safety
/// The finder is null or a text that ends with a zero.
pub(super) unsafe fn builder(
    finder: *const c_char,
    threads: usize,
) -> Result<BoxCullerBuilder, Refusal> {
    // SAFETY: the caller's promise.
    let finder: Finder = unsafe { text(finder, "auto") }?.parse()?;
    Ok(BoxCuller::builder().finder(finder).threads(threads))
}

/// Rounds boxes in double, each the lower corner x, y, z and then the upper one, to the smallest
/// boxes of floats that contain them. No pair is missed that way; boxes that are less than that
/// apart may be reported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_boxes_outward(
    boxes: *const [f64; 6],
    count: usize,
    out: *mut Aabb,
) -> SdopStatus {
    let mut written = 0;
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(out, count, &raw mut written) }, || {
        // SAFETY: the caller's promise.
        let boxes = unsafe { column(boxes, count, "boxes") }?;
        Ok(boxes.iter().map(|&[a, b, c, d, e, f]| Aabb::outward([a, b, c], [d, e, f])))
    })
}

/// Makes a culler of boxes. `finder` is "auto" if null; 0 threads are 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_new(
    finder: *const c_char,
    threads: usize,
    out: *mut *mut SdopBoxCuller,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let culler = unsafe { builder(finder, threads) }?.build()?;
        Ok(SdopBoxCuller(culler))
    })
}

/// Frees a culler; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_free(culler: *mut SdopBoxCuller) {
    // SAFETY: the caller's promise.
    unsafe { free(culler) }
}

impl SdopBoxCuller {
    /// The frame's boxes; its groups are set.
    ///
    /// # Safety
    /// The columns have `count` entries for as long as the call lasts; that of groups may be null.
    unsafe fn take<'a>(
        &mut self,
        boxes: *const Aabb,
        groups: *const Groups,
        count: usize,
    ) -> Result<&'a [Aabb], Refusal> {
        // SAFETY: the caller's promise.
        let (boxes, groups) = unsafe { (column(boxes, count, "boxes")?, optional(groups, count)) };
        self.0.set_groups(groups.map(<[Groups]>::to_vec));
        Ok(boxes)
    }
}

/// Finds the pairs of boxes that meet, touching included, and whose groups collide. If `groups` is
/// null, all collide. `pairs` gets their number; read them with `sdop_box_culler_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_cull(
    culler: *mut SdopBoxCuller,
    boxes: *const Aabb,
    groups: *const Groups,
    count: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(pairs) }, "pairs", || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        // SAFETY: the caller's promise.
        let boxes = unsafe { it.take(boxes, groups, count) }?;
        Ok(it.0.cull(boxes)?.len())
    })
}

/// `sdop_box_culler_cull`, if there are at most `limit` pairs; more are an error that has their
/// number, and memory for them is never allocated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_cull_up_to(
    culler: *mut SdopBoxCuller,
    boxes: *const Aabb,
    groups: *const Groups,
    count: usize,
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(pairs) }, "pairs", || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        // SAFETY: the caller's promise.
        let boxes = unsafe { it.take(boxes, groups, count) }?;
        Ok(it.0.cull_up_to(boxes, limit)?.len())
    })
}

/// Copies the pairs of the last frame into `buffer`, in an order that depends only on the finder
/// and the frames so far. If they don't fit, `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_pairs(
    culler: *mut SdopBoxCuller,
    buffer: *mut SdopPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        Ok(pairs(it.0.pairs()))
    })
}

/// Culls as `sdop_box_culler_cull` does and passes the pairs to `take`, about 65,000 at a time, so
/// that memory doesn't grow with their number. With several threads, `take` is called from any of
/// them, one call at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_culler_cull_each(
    culler: *mut SdopBoxCuller,
    boxes: *const Aabb,
    groups: *const Groups,
    count: usize,
    take: SdopTakePairs,
    user: *mut c_void,
) -> SdopStatus {
    call_back(take, |take| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        // SAFETY: the caller's promise.
        let boxes = unsafe { it.take(boxes, groups, count) }?;
        let user = User(user);
        // SAFETY: the caller's promise.
        let hand_over = move |portion: &PairList| unsafe { user.take(take, portion) };
        it.0.cull_in_portions(boxes, hand_over)?;
        Ok(())
    })
}
