//! Queries about the bodies of a world: those that may touch a volume or meet a segment.

use std::mem::MaybeUninit;

use super::bodies::SdopShape;
use super::border::{SdopIdPair, border};
use super::boxes::SdopBoxWorld;
use super::world::SdopWorld;
use crate::living::BodyId;
use crate::query::{Line, LineHit, QueryIndex, QueryShape, QueryVolume};

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

/// Writes a hit, and returns whether there is one.
fn write_hit(first: Option<LineHit>, hit: Option<&mut MaybeUninit<SdopHit>>) -> bool {
    if let (Some(first), Some(hit)) = (first, hit) {
        hit.write(first.into());
    }
    first.is_some()
}

border! {
index: SdopQueryIndex;

/// Makes an index without bodies.
fn sdop_query_index_new() -> new SdopQueryIndex { SdopQueryIndex(QueryIndex::new()) }
/// `sdop_query_index_new`, for the pairs of two sets: found by `threads` threads, and an error if
/// there are more than `limit`.
fn sdop_query_index_with(threads: usize, limit: usize) -> new SdopQueryIndex {
    SdopQueryIndex(QueryIndex::with_threads(threads)?.most_answers(limit))
}

/// Frees an index; null is fine.
free sdop_query_index_free;
/// Brings the index up to date with a world: queries then see its bodies as they are now. A body
/// that has not changed since the last update costs one comparison. No cull is needed.
fn sdop_query_index_update(*mut index, *const world: SdopWorld) { index.0.update(&world.0); }
/// `sdop_query_index_update` for a world of boxes.
fn sdop_query_index_update_boxes(*mut index, *const world: SdopBoxWorld) {
    index.0.update(&world.0);
}

/// Writes the ids of the bodies that may touch a box on the world's axes into `buffer`, sorted by
/// slots. No body that has a point in common with it is missed. If they don't fit, `count` says how
/// many there are.
fn sdop_query_index_touching_box(
    *const index,
    *const min: [f64; 3],
    *const max: [f64; 3],
) -> [u64] {
    let found = index.0.touching(&QueryVolume::Box { min: *min, max: *max })?;
    found.into_iter().map(BodyId::to_bits)
}

/// `sdop_query_index_touching_box` for a ball, or a point if the radius is 0.
fn sdop_query_index_touching_ball(*const index, *const centre: [f64; 3], radius: f64) -> [u64] {
    let found = index.0.touching(&QueryVolume::Ball { centre: *centre, radius })?;
    found.into_iter().map(BodyId::to_bits)
}

/// `sdop_query_index_touching_box` for a shape, grown by `margin`. The rotation is a quaternion of
/// any non-zero norm.
fn sdop_query_index_touching_shape(
    *const index,
    *const shape: SdopShape,
    *const rotation: [f64; 4],
    *const translation: [f64; 3],
    margin: f32,
) -> [u64] {
    let shape = QueryShape::new(&shape.0);
    let found = index.0.touching(&QueryVolume::shape(&shape, *rotation, *translation, margin))?;
    found.into_iter().map(BodyId::to_bits)
}

/// Finds the body whose volume a segment may meet first: no other is met at a smaller s. `found`
/// gets whether there is such a body, and `hit`, unless it is null, gets it.
fn sdop_query_index_first(
    *const index,
    *const segment: SdopSegment,
    ?mut hit: SdopHit,
) -> *mut found: bool {
    write_hit(index.0.first(&Line::from(*segment))?, hit)
}

/// `sdop_query_index_first` for a ray, the points origin + s·direction for 0 ≤ s.
fn sdop_query_index_first_of_ray(
    *const index,
    *const origin: [f64; 3],
    *const direction: [f64; 3],
    ?mut hit: SdopHit,
) -> *mut found: bool {
    write_hit(index.0.first(&Line::Ray { origin: *origin, direction: *direction })?, hit)
}

/// Writes all bodies that a segment may meet into `buffer`, sorted by s. If they don't fit, `count`
/// says how many there are.
fn sdop_query_index_along(*const index, *const segment: SdopSegment) -> [SdopHit] {
    index.0.along(&Line::from(*segment))?
}
/// `sdop_query_index_along` for a ray.
fn sdop_query_index_along_ray(
    *const index,
    *const origin: [f64; 3],
    *const direction: [f64; 3],
) -> [SdopHit] {
    index.0.along(&Line::Ray { origin: *origin, direction: *direction })?
}

/// Writes the pairs of a body of this index and one of another that may touch into `buffer`, in
/// this order, sorted by slots. If they don't fit, `count` says how many there are.
fn sdop_query_index_pairs_with(*const index, *const other: SdopQueryIndex) -> [SdopIdPair] {
    index.0.pairs_with(&other.0)?
}
}
