//! Queries about the bodies of a world: those that may touch a volume or meet a segment.

use super::border::border;
use super::boxes::SdopBoxWorld;
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

border! {
index: SdopQueryIndex;

/// Makes an index without bodies.
fn sdop_query_index_new() -> new SdopQueryIndex { SdopQueryIndex(QueryIndex::new()) }
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

/// Finds the body whose volume a segment may meet first: no other is met at a smaller s. `found`
/// gets whether there is such a body, and `hit`, unless it is null, gets it.
fn sdop_query_index_first(
    *const index,
    *const segment: SdopSegment,
    ?mut hit: SdopHit,
) -> *mut found: bool {
    let first = index.0.first(&Line::from(*segment))?;
    if let (Some(first), Some(hit)) = (first, hit) {
        hit.write(first.into());
    }
    first.is_some()
}

/// Writes all bodies that a segment may meet into `buffer`, sorted by s. If they don't fit, `count`
/// says how many there are.
fn sdop_query_index_along(*const index, *const segment: SdopSegment) -> [SdopHit] {
    index.0.along(&Line::from(*segment))?
}
}
