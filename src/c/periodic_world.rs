//! Long-lived worlds of meshes in which space repeats along some axes.

use std::ffi::c_void;

use super::bodies::{SdopOptions, SdopShape, builder, shapes};
use super::border::{
    Buffer, Out, SdopStatus, answer, call, call_back, column, cull, culls, free, handle, list,
    make, shared,
};
use super::periodic_boxes::{
    SdopPeriodicPair, SdopTakePeriodicEvent, pass_periodic_events, periods,
};
use super::world::SdopBody;
use crate::world::PeriodicWorld;
use crate::world::{Body, BodyId};

/// A long-lived set of bodies in space that repeats along some axes. Along a periodic axis, the
/// ball about a body, with its margin, has to be smaller than half of the period.
#[derive(Debug)]
pub struct SdopPeriodicWorld(PeriodicWorld);

culls!(SdopPeriodicWorld);

/// Makes a world without bodies. `periods` are three lengths along x, y and z, 0 for an axis
/// without a period. `options` may be null for the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_new(
    shapes: *const *const SdopShape,
    shape_count: usize,
    periods: *const [f64; 3],
    options: *const SdopOptions,
    out: *mut *mut SdopPeriodicWorld,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let (shapes, periods, culler) = unsafe {
            (self::shapes(shapes, shape_count)?, self::periods(periods)?, builder(options)?)
        };
        let world = PeriodicWorld::with(shapes, &culler, periods)?;
        Ok(SdopPeriodicWorld(world))
    })
}

/// Frees a world; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_free(world: *mut SdopPeriodicWorld) {
    // SAFETY: the caller's promise.
    unsafe { free(world) }
}

/// Changes the periods. Bodies stay where they were put. If one is too large for them, nothing
/// changes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_set_periods(
    world: *mut SdopPeriodicWorld,
    periods: *const [f64; 3],
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, periods) = unsafe { (handle(world, "world")?, self::periods(periods)?) };
        Ok(it.0.set_periods(periods)?)
    })
}

/// Adds a body; `id` gets its id, which stays until the body is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_insert(
    world: *mut SdopPeriodicWorld,
    body: *const SdopBody,
    id: *mut u64,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(id) }, "id", || {
        // SAFETY: the caller's promise.
        let (it, body) = unsafe { (handle(world, "world")?, *shared(body, "body")?) };
        Ok(it.0.insert(Body::from(body))?.to_bits())
    })
}

/// Removes a body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_remove(
    world: *mut SdopPeriodicWorld,
    id: u64,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        Ok(it.0.remove(BodyId::from_bits(id))?)
    })
}

/// Moves bodies, or changes them in any of their properties: columns of ids and bodies. If one is
/// rejected, those before it have changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_set(
    world: *mut SdopPeriodicWorld,
    ids: *const u64,
    bodies: *const SdopBody,
    count: usize,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        // SAFETY: the caller's promise.
        let (ids, bodies) =
            unsafe { (column(ids, count, "ids")?, column(bodies, count, "bodies")?) };
        for (&id, &body) in ids.iter().zip(bodies) {
            it.0.set(BodyId::from_bits(id), Body::from(body))?;
        }
        Ok(())
    })
}

/// Never reports the pair of two bodies again, in any image, until it is included or one of them is
/// removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_exclude(
    world: *mut SdopPeriodicWorld,
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

/// Reports the pair of two bodies again when it meets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_include(
    world: *mut SdopPeriodicWorld,
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

/// Finds the pairs of which an image may touch. `pairs` gets their number; read them with
/// `sdop_periodic_world_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_cull(
    world: *mut SdopPeriodicWorld,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, None, pairs) }
}

/// `sdop_periodic_world_cull`, if images have at most `limit` pairs; more are an error that has
/// their number. A pair across a corner of the period is found at several images, and counts as
/// often.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_cull_up_to(
    world: *mut SdopPeriodicWorld,
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, Some(limit), pairs) }
}

/// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
/// `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_pairs(
    world: *const SdopPeriodicWorld,
    buffer: *mut SdopPeriodicPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { shared(world, "world") }?;
        Ok(it.0.pairs().iter().map(SdopPeriodicPair::from))
    })
}

/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function. Two bodies are one pair, in whatever image they touch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_world_events(
    world: *mut SdopPeriodicWorld,
    take: SdopTakePeriodicEvent,
    user: *mut c_void,
) -> SdopStatus {
    call_back(take, |take| {
        // SAFETY: the caller's promise.
        let events = unsafe { handle(world, "world") }?.0.events();
        // SAFETY: the caller's promise.
        unsafe { pass_periodic_events(&events, take, user) };
        Ok(())
    })
}
