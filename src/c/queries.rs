//! Queries about the bodies of a world: those that may touch a volume or meet a segment.

use super::border::{Buffer, Out, SdopStatus, answer, call, free, handle, list, make, shared};
use super::box_world::SdopBoxWorld;
use super::world::SdopWorld;
use crate::living::BodyId;
use crate::query::{Line, LineHit, QueryIndex, QueryVolume};

/// The bodies of a world, prepared for queries. Many threads may query it at the same time, while
/// none updates it.
#[derive(Debug)]
pub struct SdopQueryIndex(QueryIndex);

/// The points from + s·(to − from) for 0 ≤ s ≤ 1, world frame.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopSegment {
    /// The point of s = 0.
    pub from: [f64; 3],
    /// The point of s = 1.
    pub to: [f64; 3],
}

impl From<SdopSegment> for Line {
    fn from(segment: SdopSegment) -> Self {
        let SdopSegment { from, to } = segment;
        Self::Segment { from, to }
    }
}

/// A body that a segment may meet.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopHit {
    /// The body.
    pub id: u64,
    /// An s at or before the first point that the segment shares with the body.
    pub at: f64,
}

impl From<LineHit> for SdopHit {
    fn from(hit: LineHit) -> Self {
        Self { id: hit.body.to_bits(), at: hit.at }
    }
}

/// Makes an index without bodies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_new(out: *mut *mut SdopQueryIndex) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || Ok(SdopQueryIndex(QueryIndex::new())))
}

/// Frees an index; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_free(index: *mut SdopQueryIndex) {
    // SAFETY: the caller's promise.
    unsafe { free(index) }
}

/// Brings the index up to date with a world: queries then see its bodies as they are now. A body
/// that has not changed since the last update costs one comparison. No cull is needed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_update(
    index: *mut SdopQueryIndex,
    world: *const SdopWorld,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, world) = unsafe { (handle(index, "index")?, shared(world, "world")?) };
        it.0.update(&world.0);
        Ok(())
    })
}

/// `sdop_query_index_update` for a world of boxes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_update_boxes(
    index: *mut SdopQueryIndex,
    world: *const SdopBoxWorld,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, world) = unsafe { (handle(index, "index")?, shared(world, "world")?) };
        it.0.update(&world.0);
        Ok(())
    })
}

/// Writes the ids of the bodies that may touch a box on the world's axes into `buffer`, sorted by
/// slots. No body that has a point in common with it is missed. If they don't fit, `count` says how
/// many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_touching_box(
    index: *const SdopQueryIndex,
    min: *const [f64; 3],
    max: *const [f64; 3],
    buffer: *mut u64,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let (it, min, max) =
            unsafe { (shared(index, "index")?, *shared(min, "min")?, *shared(max, "max")?) };
        let found = it.0.touching(&QueryVolume::Box { min, max })?;
        Ok(found.into_iter().map(BodyId::to_bits))
    })
}

/// `sdop_query_index_touching_box` for a ball, or a point if the radius is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_touching_ball(
    index: *const SdopQueryIndex,
    centre: *const [f64; 3],
    radius: f64,
    buffer: *mut u64,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let (it, centre) = unsafe { (shared(index, "index")?, *shared(centre, "centre")?) };
        let found = it.0.touching(&QueryVolume::Ball { centre, radius })?;
        Ok(found.into_iter().map(BodyId::to_bits))
    })
}

/// Finds the body whose volume a segment may meet first: no other is met at a smaller s. `found`
/// gets whether there is such a body, and `hit`, unless it is null, gets it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_first(
    index: *const SdopQueryIndex,
    segment: *const SdopSegment,
    hit: *mut SdopHit,
    found: *mut bool,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    let (hit, found) = unsafe { (Out::new(hit), Out::new(found)) };
    answer(found, "found", || {
        // SAFETY: the caller's promise.
        let (it, segment) = unsafe { (shared(index, "index")?, *shared(segment, "segment")?) };
        let first = it.0.first(&segment.into())?;
        if let (Some(first), Ok(hit)) = (first, hit.checked("hit")) {
            // SAFETY: not null, so it may be written, by the caller's promise.
            unsafe { hit.write(first.into()) };
        }
        Ok(first.is_some())
    })
}

/// Writes all bodies that a segment may meet into `buffer`, sorted by s. If they don't fit, `count`
/// says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_query_index_along(
    index: *const SdopQueryIndex,
    segment: *const SdopSegment,
    buffer: *mut SdopHit,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let (it, segment) = unsafe { (shared(index, "index")?, *shared(segment, "segment")?) };
        let hits = it.0.along(&segment.into())?;
        Ok(hits.into_iter().map(SdopHit::from))
    })
}
