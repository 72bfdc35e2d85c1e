//! Long-lived worlds of meshes.

use super::bodies::{SdopOptions, SdopShape, builder, copies};
use super::border::{SdopIdPair, SdopTakeEvent, SdopTakeIdPairs, bodies, border};
use super::call::{read_back, saved};
use crate::bodies::{Groups, Motion};
use crate::world::{Body, BodyId, World};

/// A long-lived set of bodies: ids that stay, groups, margins, translations in double, pairs and
/// events.
#[derive(Debug)]
pub struct SdopWorld(pub(super) World);

/// A body to be inserted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopBody {
    /// Number of its shape.
    pub shape: u32,
    /// Whether it is scenery; pairs of two such bodies are never reported.
    pub fixed: bool,
    /// Whether it lies still for the time being; its pairs stay.
    pub resting: bool,
    /// Quaternion x, y, z, w of any non-zero norm.
    pub rotation: [f32; 4],
    /// Translation of its origin, world frame.
    pub translation: [f64; 3],
    /// Contact margin, a length: pairs are reported whose meshes, each grown by its margin, meet.
    pub margin: f32,
    /// Which bodies it may collide with; all bits for all.
    pub groups: Groups,
    /// Whether the rotation was rounded from double: `sdop_body_turned` sets it. The body is then
    /// grown by what that may move its points.
    pub rounded: bool,
}

bodies!(SdopBody = Body { shape, rotation, rounded, translation, margin, groups });

/// A body of a shape at a place in the world frame: not turned, neither fixed nor resting, without
/// a margin, in all groups. Change what differs.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_body_at(shape: u32, x: f64, y: f64, z: f64) -> SdopBody {
    Body::at(shape, [0.0, 0.0, 0.0, 1.0], [x, y, z]).into()
}

/// A body with a rotation in double, a quaternion of any non-zero norm: `rotation` gets the nearest
/// floats, and `rounded` says whether they are others. No pair of the exact pose is missed.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_body_turned(body: SdopBody, x: f64, y: f64, z: f64, w: f64) -> SdopBody {
    let Body { rotation, rounded, .. } = Body::default().turned([x, y, z, w]);
    SdopBody { rotation, rounded, ..body }
}

border! {
world: SdopWorld;

/// Makes a world without bodies. `shapes` may be null if there are none yet, `options` for the
/// defaults.
fn sdop_world_new(
    [*const shapes: Option<&SdopShape>; shape_count],
    ?const options: SdopOptions,
) -> new SdopWorld {
    // SAFETY: the caller's promise.
    let culler = unsafe { builder(options) }?;
    SdopWorld(World::with(copies(shapes)?, &culler)?)
}

/// Frees a world; null is fine.
free sdop_world_free;
/// Adds a shape; `number` gets its number.
fn sdop_world_add_shape(*mut world, *const shape: SdopShape) -> *mut number: u32 {
    world.0.add_shape(shape.0.clone())?
}

/// Removes a shape that no body has.
fn sdop_world_remove_shape(*mut world, shape: u32) { world.0.remove_shape(shape)?; }
/// Replaces a shape by another: its bodies have the new shape from the next cull on.
fn sdop_world_replace_shape(*mut world, number: u32, *const shape: SdopShape) {
    world.0.replace_shape(number, &shape.0)?;
}

/// Adds a body; `id` gets its id, which stays until the body is removed.
fn sdop_world_insert(*mut world, *const body: SdopBody) -> *mut id: u64 {
    world.0.insert(*body)?.to_bits()
}

/// Reads a body.
fn sdop_world_body(*const world, #id) -> *mut body: SdopBody { world.0.body(id)?.into() }
/// Copies the ids of all bodies into `buffer`, sorted by slots. If they don't fit, `count` says how
/// many there are.
fn sdop_world_ids(*const world) -> [u64] {
    world.0.ids().map(BodyId::to_bits).collect::<Vec<_>>()
}

/// Removes a body.
fn sdop_world_remove(*mut world, #id) { world.0.remove(id)?; }
/// Changes a body in any of its properties.
fn sdop_world_set(*mut world, #id, *const body: SdopBody) { world.0.set(id, *body)?; }
/// Moves bodies: columns of ids, rotations and translations. If one is rejected, those before it
/// have moved.
fn sdop_world_set_poses(
    *mut world,
    [*const ids: u64, *const rotation: [f32; 4], *const translation: [f64; 3]; count],
) {
    for ((&id, &rotation), &translation) in ids.iter().zip(rotation).zip(translation) {
        world.0.set_pose(BodyId::from_bits(id), rotation, translation)?;
    }
}

/// Moves bodies as `sdop_world_set_poses` does, with rotations in double: no pair of the exact
/// poses is missed.
fn sdop_world_set_poses_f64(
    *mut world,
    [*const ids: u64, *const rotation: [f64; 4], *const translation: [f64; 3]; count],
) {
    for ((&id, &rotation), &translation) in ids.iter().zip(rotation).zip(translation) {
        world.0.set_pose_f64(BodyId::from_bits(id), rotation, translation)?;
    }
}

/// Puts a body to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
fn sdop_world_set_motion(*mut world, #id, fixed: bool, resting: bool) {
    world.0.set_motion(id, Motion::of(!fixed, resting))?;
}

/// Sets the bodies of interest, for the strategies that use them.
fn sdop_world_set_interest(*mut world, [*const ids: u64; count]) {
    world.0.set_interest(&ids.iter().copied().map(BodyId::from_bits).collect::<Vec<_>>())?;
}

/// Never reports the pair of two bodies again, such as two links that share a joint, until it is
/// included or one of them is removed.
fn sdop_world_exclude(*mut world, #a, #b) { world.0.exclude(a, b)?; }
/// Reports the pair of two bodies again when it meets.
fn sdop_world_include(*mut world, #a, #b) { world.0.include(a, b)?; }
/// Finds the pairs that might touch now. `pairs` gets their number; read them with
/// `sdop_world_pairs`.
fn sdop_world_cull(*mut world) -> *mut pairs: usize { world.0.cull()?.len() }
/// `sdop_world_cull`, if there are at most `limit` pairs; more are an error that
/// has their number, and memory for them is never allocated.
fn sdop_world_cull_up_to(*mut world, limit: usize) -> *mut pairs: usize {
    world.0.cull_up_to(limit)?.len()
}

/// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
/// says how many there are.
fn sdop_world_pairs(*mut world) -> [SdopIdPair] { world.0.pairs() }
/// Culls as `sdop_world_cull` does and passes the pairs to `take`, not sorted, about 65,000 at a
/// time: the world keeps none. With several threads, `take` is called from any of them, one call at
/// a time.
fn sdop_world_cull_each(*mut world, |take: SdopTakeIdPairs|) {
    world.0.cull_in_portions(move |pairs| take.all(pairs.iter()))?;
}

/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function.
fn sdop_world_events(*mut world, |take: SdopTakeEvent|) { take.each(world.0.events().iter()); }
/// Copies the world as bytes into `buffer`, for `sdop_world_restore`. If they don't fit, `count`
/// says how many there are.
fn sdop_world_snapshot(*mut world) -> [u8] { saved(&world.0.snapshot())? }
/// Gives this world the state of a snapshot. It must have the same shapes under the same numbers.
fn sdop_world_restore(*mut world, [*const bytes: u8; count]) {
    world.0.restore(&read_back(bytes)?)?;
}
}
