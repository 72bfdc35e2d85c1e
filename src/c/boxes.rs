//! Boxes: long-lived worlds, and a culler that gets all boxes anew in each frame.

use super::border::{
    SdopIdPair, SdopPair, SdopStatus, SdopTakeEvent, SdopTakeIdPairs, SdopTakePairs, bodies, border,
};
use super::call::{self, Refusal, check_list, column, read_back, saved, write_all};
use crate::bodies::{Aabb, Groups, Motion};
use crate::boxes::{BoxBody, BoxCuller, BoxCullerBuilder, BoxWorld};
use crate::living::BodyId;
use crate::pairs::PairList;
use crate::settings::Finder;

/// A long-lived set of boxes: ids that stay, groups, pairs and events.
#[derive(Debug)]
pub struct SdopBoxWorld(pub(super) BoxWorld);

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

bodies!(SdopBoxBody = BoxBody { bounds, groups });

/// A box that is neither fixed nor resting, in all groups. Change what differs.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_box_body_at(bounds: Aabb) -> SdopBoxBody {
    BoxBody::from(bounds).into()
}

border! {
world: SdopBoxWorld;

/// Makes a world without boxes. `finder` is "auto" if null; 0 threads are 1.
fn sdop_box_world_new(?text finder = "auto", threads: usize) -> new SdopBoxWorld {
    SdopBoxWorld(BoxWorld::with(&builder(finder, threads)?)?)
}

/// Frees a world; null is fine.
free sdop_box_world_free;
/// Adds a box; `id` gets its id, which stays until the box is removed.
fn sdop_box_world_insert(*mut world, *const body: SdopBoxBody) -> *mut id: u64 {
    world.0.insert(*body)?.to_bits()
}

/// Reads a box.
fn sdop_box_world_body(*const world, #id) -> *mut body: SdopBoxBody { world.0.body(id)?.into() }
/// Copies the ids of all boxes into `buffer`, sorted by slots. If they don't fit, `count` says how
/// many there are.
fn sdop_box_world_ids(*const world) -> [u64] {
    world.0.ids().map(BodyId::to_bits).collect::<Vec<_>>()
}

/// Removes a box.
fn sdop_box_world_remove(*mut world, #id) { world.0.remove(id)?; }
/// Changes a box in any of its properties.
fn sdop_box_world_set(*mut world, #id, *const body: SdopBoxBody) { world.0.set(id, *body)?; }
/// Moves boxes: columns of ids and boxes. If one is rejected, those before it have moved.
fn sdop_box_world_set_bounds(*mut world, [*const ids: u64, *const boxes: Aabb; count]) {
    let ids: Vec<_> = ids.iter().copied().map(BodyId::from_bits).collect();
    world.0.set_many(&ids, boxes)?;
}

/// Puts a box to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
fn sdop_box_world_set_motion(*mut world, #id, fixed: bool, resting: bool) {
    world.0.set_motion(id, Motion::of(!fixed, resting))?;
}

/// Never reports the pair of two boxes again until it is included or one of them is removed.
fn sdop_box_world_exclude(*mut world, #a, #b) { world.0.exclude(a, b)?; }
/// Reports the pair of two boxes again when it meets.
fn sdop_box_world_include(*mut world, #a, #b) { world.0.include(a, b)?; }
/// Finds the boxes that meet now. `pairs` gets their number; read them with `sdop_box_world_pairs`.
fn sdop_box_world_cull(*mut world) -> *mut pairs: usize { world.0.cull()?.len() }
/// `sdop_box_world_cull`, if there are at most `limit` pairs; more are an error that
/// has their number, and memory for them is never allocated.
fn sdop_box_world_cull_up_to(*mut world, limit: usize) -> *mut pairs: usize {
    world.0.cull_up_to(limit)?.len()
}

/// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
/// says how many there are.
fn sdop_box_world_pairs(*mut world) -> [SdopIdPair] { world.0.pairs() }
/// Culls as `sdop_box_world_cull` does and passes the pairs to `take`, not sorted, about 65,000 at
/// a time: the world keeps none. With several threads, `take` is called from any of them, one call
/// at a time.
fn sdop_box_world_cull_each(*mut world, |take: SdopTakeIdPairs|) {
    world.0.cull_in_portions(move |pairs| take.all(pairs.iter()))?;
}

/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function.
fn sdop_box_world_events(*mut world, |take: SdopTakeEvent|) { take.each(world.0.events().iter()); }
/// Copies the world as bytes into `buffer`, for `sdop_box_world_restore`. If they don't fit,
/// `count` says how many there are.
fn sdop_box_world_snapshot(*mut world) -> [u8] { saved(&world.0.snapshot())? }
/// Gives this world the state of a snapshot.
fn sdop_box_world_restore(*mut world, [*const bytes: u8; count]) {
    world.0.restore(&read_back(bytes)?)?;
}
}

/// Finds the boxes that meet, frame after frame.
#[derive(Debug)]
pub struct SdopBoxCuller(BoxCuller);

/// How a culler of boxes is made of what C gives.
pub(super) fn builder(finder: &str, threads: usize) -> Result<BoxCullerBuilder, Refusal> {
    let finder: Finder = finder.parse()?;
    Ok(BoxCuller::builder().finder(finder).threads(threads))
}

impl SdopBoxCuller {
    /// The culler of a frame whose boxes have these groups.
    fn with(&mut self, groups: Option<&[Groups]>) -> &mut BoxCuller {
        self.0.set_groups(groups.map(<[Groups]>::to_vec));
        &mut self.0
    }
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
    call::run(|| {
        let mut written = 0;
        check_list(out, count, &raw mut written)?;
        // SAFETY: the caller's promise.
        let boxes = unsafe { column(boxes, count, "boxes") }?;
        let outward = boxes.iter().map(|&[a, b, c, d, e, f]| Aabb::outward([a, b, c], [d, e, f]));
        // SAFETY: the caller's promise.
        unsafe { write_all(out, count, &raw mut written, outward) }
    })
}

border! {
culler: SdopBoxCuller;

/// Makes a culler of boxes. `finder` is "auto" if null; 0 threads are 1.
fn sdop_box_culler_new(?text finder = "auto", threads: usize) -> new SdopBoxCuller {
    SdopBoxCuller(builder(finder, threads)?.build()?)
}

/// Frees a culler; null is fine.
free sdop_box_culler_free;
/// Finds the pairs of boxes that meet, touching included, and whose groups collide. If `groups` is
/// null, all collide. `pairs` gets their number; read them with `sdop_box_culler_pairs`.
fn sdop_box_culler_cull(
    *mut culler,
    [*const boxes: Aabb, ?const groups: Groups; count],
) -> *mut pairs: usize {
    culler.with(groups).cull(boxes)?.len()
}

/// `sdop_box_culler_cull`, if there are at most `limit` pairs; more are an error that has their
/// number, and memory for them is never allocated.
fn sdop_box_culler_cull_up_to(
    *mut culler,
    [*const boxes: Aabb, ?const groups: Groups; count],
    limit: usize,
) -> *mut pairs: usize {
    culler.with(groups).cull_up_to(boxes, limit)?.len()
}

/// Copies the pairs of the last frame into `buffer`, in an order that depends only on the finder
/// and the frames so far. If they don't fit, `count` says how many there are.
fn sdop_box_culler_pairs(*mut culler) -> [SdopPair] { culler.0.pairs().iter() }
/// Culls as `sdop_box_culler_cull` does and passes the pairs to `take`, about 65,000 at a time, so
/// that memory doesn't grow with their number. With several threads, `take` is called from any of
/// them, one call at a time.
fn sdop_box_culler_cull_each(
    *mut culler,
    [*const boxes: Aabb, ?const groups: Groups; count],
    |take: SdopTakePairs|,
) {
    let take = move |portion: &PairList| take.all(portion.iter());
    culler.with(groups).cull_in_portions(boxes, take)?;
}
}
