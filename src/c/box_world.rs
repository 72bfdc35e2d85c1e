//! Long-lived worlds of boxes.

use std::ffi::{c_char, c_void};

use super::border::{
    Buffer, Out, SdopIdPair, SdopStatus, SdopTakeEvent, answer, call, call_back, column, cull,
    culls, free, handle, list, make, pass_events, read_back, saved, shared,
};
use super::boxes::builder;
use crate::bodies::{Aabb, Groups, Motion};
use crate::boxes::{BoxBody, BoxWorld};
use crate::living::BodyId;

/// A long-lived set of boxes: ids that stay, groups, pairs and events.
#[derive(Debug)]
pub struct SdopBoxWorld(pub(super) BoxWorld);

culls!(SdopBoxWorld);

/// A box to be inserted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopBoxBody {
    /// Where it is.
    pub bounds: Aabb,
    /// Whether it is scenery; pairs of two such boxes are never reported.
    pub fixed: bool,
    /// Whether it lies still for the time being; its pairs stay.
    pub resting: bool,
    /// Which boxes it may collide with; all bits for all.
    pub groups: Groups,
}

impl From<SdopBoxBody> for BoxBody {
    fn from(body: SdopBoxBody) -> Self {
        Self {
            bounds: body.bounds,
            motion: Motion::of(!body.fixed, body.resting),
            groups: body.groups,
        }
    }
}

/// A box that is neither fixed nor resting, in all groups. Change what differs.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_box_body_at(bounds: Aabb) -> SdopBoxBody {
    SdopBoxBody { bounds, fixed: false, resting: false, groups: Groups::ALL }
}

/// Makes a world without boxes. `finder` is "auto" if null; 0 threads are 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_new(
    finder: *const c_char,
    threads: usize,
    out: *mut *mut SdopBoxWorld,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let world = BoxWorld::with(&unsafe { builder(finder, threads) }?)?;
        Ok(SdopBoxWorld(world))
    })
}

/// Frees a world; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_free(world: *mut SdopBoxWorld) {
    // SAFETY: the caller's promise.
    unsafe { free(world) }
}

/// Adds a box; `id` gets its id, which stays until the box is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_insert(
    world: *mut SdopBoxWorld,
    body: *const SdopBoxBody,
    id: *mut u64,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(id) }, "id", || {
        // SAFETY: the caller's promise.
        let (it, body) = unsafe { (handle(world, "world")?, *shared(body, "body")?) };
        Ok(it.0.insert(BoxBody::from(body))?.to_bits())
    })
}

/// Removes a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_remove(world: *mut SdopBoxWorld, id: u64) -> SdopStatus {
    // SAFETY: the caller's promise.
    call(|| Ok(unsafe { handle(world, "world") }?.0.remove(BodyId::from_bits(id))?))
}

/// Changes a box in any of its properties.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_set(
    world: *mut SdopBoxWorld,
    id: u64,
    body: *const SdopBoxBody,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, body) = unsafe { (handle(world, "world")?, *shared(body, "body")?) };
        Ok(it.0.set(BodyId::from_bits(id), BoxBody::from(body))?)
    })
}

/// Moves boxes: columns of ids and boxes. If one is rejected, those before it have moved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_set_bounds(
    world: *mut SdopBoxWorld,
    ids: *const u64,
    boxes: *const Aabb,
    count: usize,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        // SAFETY: the caller's promise.
        let (ids, boxes) = unsafe { (column(ids, count, "ids")?, column(boxes, count, "boxes")?) };
        let ids: Vec<_> = ids.iter().map(|&id| BodyId::from_bits(id)).collect();
        Ok(it.0.set_many(&ids, boxes)?)
    })
}

/// Never reports the pair of two boxes again until it is included or one of them is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_exclude(
    world: *mut SdopBoxWorld,
    a: u64,
    b: u64,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        it.0.exclude(BodyId::from_bits(a), BodyId::from_bits(b))?;
        Ok(())
    })
}

/// Reports the pair of two boxes again when it meets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_include(
    world: *mut SdopBoxWorld,
    a: u64,
    b: u64,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        it.0.include(BodyId::from_bits(a), BodyId::from_bits(b))?;
        Ok(())
    })
}

/// Finds the boxes that meet now. `pairs` gets their number; read them with `sdop_box_world_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_cull(
    world: *mut SdopBoxWorld,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, None, pairs) }
}

/// `sdop_box_world_cull`, if there are at most `limit` pairs; more are an error that
/// has their number, and memory for them is never allocated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_cull_up_to(
    world: *mut SdopBoxWorld,
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, Some(limit), pairs) }
}

/// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
/// says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_pairs(
    world: *mut SdopBoxWorld,
    buffer: *mut SdopIdPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        Ok(it.0.pairs().map(SdopIdPair::from))
    })
}

/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_events(
    world: *mut SdopBoxWorld,
    take: SdopTakeEvent,
    user: *mut c_void,
) -> SdopStatus {
    call_back(take, |take| {
        // SAFETY: the caller's promise.
        let events = unsafe { handle(world, "world") }?.0.events();
        // SAFETY: the caller's promise.
        unsafe { pass_events(&events, take, user) };
        Ok(())
    })
}

/// Copies the world as bytes into `buffer`, for `sdop_box_world_restore`. If they don't fit,
/// `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_snapshot(
    world: *mut SdopBoxWorld,
    buffer: *mut u8,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let bytes = saved(&unsafe { handle(world, "world") }?.0.snapshot())?;
        Ok(bytes.into_iter())
    })
}

/// Gives this world the state of a snapshot.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_box_world_restore(
    world: *mut SdopBoxWorld,
    bytes: *const u8,
    count: usize,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, bytes) = unsafe { (handle(world, "world")?, column(bytes, count, "bytes")?) };
        Ok(it.0.restore(&read_back(bytes)?)?)
    })
}
