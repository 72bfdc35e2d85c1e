//! Long-lived worlds of boxes in which space repeats along some axes.

use std::ffi::{c_char, c_void};

use super::border::{
    Buffer, Out, Refusal, SdopEventKind, SdopIdPair, SdopStatus, answer, call, call_back, column,
    cull, culls, free, handle, list, make, shared,
};
use super::boxes::builder;
use crate::bodies::{Groups, Motion};
use crate::living::BodyId;
use crate::periodic::{PeriodicBox, PeriodicBoxes, PeriodicEvents, PeriodicPair};

/// A long-lived set of boxes in space that repeats along some axes.
#[derive(Debug)]
pub struct SdopPeriodicBoxes(PeriodicBoxes);

culls!(SdopPeriodicBoxes);

/// A box in space that repeats. It may be anywhere; along a periodic axis it has to be shorter than
/// half of the period.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopPeriodicBox {
    /// The lower corner.
    pub min: [f64; 3],
    /// The upper corner.
    pub max: [f64; 3],
    /// Whether it is scenery; pairs of two such boxes are never reported.
    pub fixed: bool,
    /// Whether it lies still for the time being; its pairs stay.
    pub resting: bool,
    /// Which boxes it may collide with; all bits for all.
    pub groups: Groups,
}

impl From<SdopPeriodicBox> for PeriodicBox {
    fn from(body: SdopPeriodicBox) -> Self {
        Self {
            min: body.min,
            max: body.max,
            motion: Motion::of(!body.fixed, body.resting),
            groups: body.groups,
        }
    }
}

/// Two bodies, of which the second touches the first when it is moved by whole periods.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopPeriodicPair {
    /// The bodies.
    pub bodies: SdopIdPair,
    /// The number of periods along each axis by which the second body is moved, from where it was
    /// put.
    pub image: [i32; 3],
}

impl From<&PeriodicPair> for SdopPeriodicPair {
    fn from(pair: &PeriodicPair) -> Self {
        Self { bodies: pair.bodies.into(), image: pair.image }
    }
}

/// A pair of a periodic world and how it has changed. A pair that has ended has its former image.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopPeriodicEvent {
    /// How it has changed.
    pub kind: SdopEventKind,
    /// The pair.
    pub pair: SdopPeriodicPair,
}

/// Receives an event of a periodic world, after the pointer that was passed along. Must return
/// normally.
pub type SdopTakePeriodicEvent = Option<unsafe extern "C" fn(*mut c_void, SdopPeriodicEvent)>;

/// The periods that C gives: 0 for an axis without one.
///
/// # Safety
/// The pointer is null or to three numbers.
pub(super) unsafe fn periods(given: *const [f64; 3]) -> Result<[Option<f64>; 3], Refusal> {
    // SAFETY: the caller's promise.
    let given = unsafe { shared(given, "periods") }?;
    Ok(given.map(|period| (period != 0.0).then_some(period)))
}

/// A box between two corners that is neither fixed nor resting, in all groups. Change what differs.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_periodic_box_between(
    min_x: f64,
    min_y: f64,
    min_z: f64,
    max_x: f64,
    max_y: f64,
    max_z: f64,
) -> SdopPeriodicBox {
    SdopPeriodicBox {
        min: [min_x, min_y, min_z],
        max: [max_x, max_y, max_z],
        fixed: false,
        resting: false,
        groups: Groups::ALL,
    }
}

/// Makes a world without boxes. `periods` are three lengths along x, y and z, 0 for an axis without
/// a period. `finder` is "auto" if null; 0 threads are 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_new(
    periods: *const [f64; 3],
    finder: *const c_char,
    threads: usize,
    out: *mut *mut SdopPeriodicBoxes,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let (periods, culler) = unsafe { (self::periods(periods)?, builder(finder, threads)?) };
        let boxes = PeriodicBoxes::with(&culler, periods)?;
        Ok(SdopPeriodicBoxes(boxes))
    })
}

/// Frees a world; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_free(world: *mut SdopPeriodicBoxes) {
    // SAFETY: the caller's promise.
    unsafe { free(world) }
}

/// Changes the periods. Boxes stay where they were put. If one is too large for them, nothing
/// changes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_set_periods(
    world: *mut SdopPeriodicBoxes,
    periods: *const [f64; 3],
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, periods) = unsafe { (handle(world, "world")?, self::periods(periods)?) };
        Ok(it.0.set_periods(periods)?)
    })
}

/// Adds a box; `id` gets its id, which stays until the box is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_insert(
    world: *mut SdopPeriodicBoxes,
    body: *const SdopPeriodicBox,
    id: *mut u64,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(id) }, "id", || {
        // SAFETY: the caller's promise.
        let (it, body) = unsafe { (handle(world, "world")?, *shared(body, "body")?) };
        Ok(it.0.insert(PeriodicBox::from(body))?.to_bits())
    })
}

/// Removes a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_remove(
    world: *mut SdopPeriodicBoxes,
    id: u64,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        Ok(it.0.remove(BodyId::from_bits(id))?)
    })
}

/// Moves boxes, or changes them in any of their properties: columns of ids and boxes. If one is
/// rejected, those before it have changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_set(
    world: *mut SdopPeriodicBoxes,
    ids: *const u64,
    bodies: *const SdopPeriodicBox,
    count: usize,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        // SAFETY: the caller's promise.
        let (ids, bodies) =
            unsafe { (column(ids, count, "ids")?, column(bodies, count, "bodies")?) };
        for (&id, &body) in ids.iter().zip(bodies) {
            it.0.set(BodyId::from_bits(id), PeriodicBox::from(body))?;
        }
        Ok(())
    })
}

/// Never reports the pair of two boxes again, in any image, until it is included or one of them is
/// removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_exclude(
    world: *mut SdopPeriodicBoxes,
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
pub unsafe extern "C" fn sdop_periodic_boxes_include(
    world: *mut SdopPeriodicBoxes,
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

/// Finds the pairs of which an image meets. `pairs` gets their number; read them with
/// `sdop_periodic_boxes_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_cull(
    world: *mut SdopPeriodicBoxes,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, None, pairs) }
}

/// `sdop_periodic_boxes_cull`, if images have at most `limit` pairs; more are an error that has
/// their number. A pair across a corner of the period is found at several images, and counts as
/// often.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_cull_up_to(
    world: *mut SdopPeriodicBoxes,
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, Some(limit), pairs) }
}

/// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
/// `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_pairs(
    world: *const SdopPeriodicBoxes,
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
/// function. Two boxes are one pair, in whatever image they meet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_periodic_boxes_events(
    world: *mut SdopPeriodicBoxes,
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

/// Passes events to a callback.
///
/// # Safety
/// The callback may be called with this pointer.
pub(super) unsafe fn pass_periodic_events(
    events: &PeriodicEvents,
    take: unsafe extern "C" fn(*mut c_void, SdopPeriodicEvent),
    user: *mut c_void,
) {
    let kinds = [
        (SdopEventKind::Begun, events.begun()),
        (SdopEventKind::Persisting, events.persisting()),
        (SdopEventKind::Ended, events.ended()),
    ];
    for (kind, pairs) in kinds {
        for pair in pairs.iter().map(SdopPeriodicPair::from) {
            // SAFETY: the caller's promise.
            unsafe { take(user, SdopPeriodicEvent { kind, pair }) };
        }
    }
}
