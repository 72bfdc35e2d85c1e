//! Long-lived worlds of meshes.

use std::ffi::c_void;

use super::bodies::{SdopOptions, SdopShape, builder, shapes};
use super::border::{
    Buffer, Out, SdopIdPair, SdopStatus, SdopTakeEvent, answer, call, call_back, column, cull,
    culls, free, handle, list, make, pass_events, read_back, saved, shared,
};
use crate::bodies::{Groups, Motion};
use crate::world::{Body, BodyId, World, WorldError};

/// A long-lived set of bodies: ids that stay, groups, margins, translations in double, pairs and
/// events.
#[derive(Debug)]
pub struct SdopWorld(pub(super) World);

culls!(SdopWorld);

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

impl From<SdopBody> for Body {
    fn from(body: SdopBody) -> Self {
        Self {
            shape: body.shape,
            motion: Motion::of(!body.fixed, body.resting),
            rotation: body.rotation,
            rounded: body.rounded,
            translation: body.translation,
            groups: body.groups,
            margin: body.margin,
        }
    }
}

/// A body of a shape at a place in the world frame: not turned, neither fixed nor resting, without
/// a margin, in all groups. Change what differs.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_body_at(shape: u32, x: f64, y: f64, z: f64) -> SdopBody {
    SdopBody {
        shape,
        fixed: false,
        resting: false,
        rotation: [0.0, 0.0, 0.0, 1.0],
        rounded: false,
        translation: [x, y, z],
        margin: 0.0,
        groups: Groups::ALL,
    }
}

/// A body with a rotation in double, a quaternion of any non-zero norm: `rotation` gets the nearest
/// floats, and `rounded` says whether they are others. No pair of the exact pose is missed.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_body_turned(body: SdopBody, x: f64, y: f64, z: f64, w: f64) -> SdopBody {
    let Body { rotation, rounded, .. } = Body::default().turned([x, y, z, w]);
    SdopBody { rotation, rounded, ..body }
}

/// Makes a world without bodies. `shapes` may be null if there are none yet, `options` for the
/// defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_new(
    shapes: *const *const SdopShape,
    shape_count: usize,
    options: *const SdopOptions,
    out: *mut *mut SdopWorld,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let (shapes, builder) = unsafe { (self::shapes(shapes, shape_count)?, builder(options)?) };
        let world = World::with(shapes, &builder)?;
        Ok(SdopWorld(world))
    })
}

/// Frees a world; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_free(world: *mut SdopWorld) {
    // SAFETY: the caller's promise.
    unsafe { free(world) }
}

/// Adds a shape; `number` gets its number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_add_shape(
    world: *mut SdopWorld,
    shape: *const SdopShape,
    number: *mut u32,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(number) }, "number", || {
        // SAFETY: the caller's promise.
        let (it, shape) = unsafe { (handle(world, "world")?, shared(shape, "shape")?) };
        Ok(it.0.add_shape(shape.0.clone())?)
    })
}

/// Removes a shape that no body has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_remove_shape(world: *mut SdopWorld, shape: u32) -> SdopStatus {
    // SAFETY: the caller's promise.
    call(|| Ok(unsafe { handle(world, "world") }?.0.remove_shape(shape)?))
}

/// Adds a body; `id` gets its id, which stays until the body is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_insert(
    world: *mut SdopWorld,
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
pub unsafe extern "C" fn sdop_world_remove(world: *mut SdopWorld, id: u64) -> SdopStatus {
    // SAFETY: the caller's promise.
    call(|| Ok(unsafe { handle(world, "world") }?.0.remove(BodyId::from_bits(id))?))
}

/// Changes a body in any of its properties.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_set(
    world: *mut SdopWorld,
    id: u64,
    body: *const SdopBody,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, body) = unsafe { (handle(world, "world")?, *shared(body, "body")?) };
        Ok(it.0.set(BodyId::from_bits(id), Body::from(body))?)
    })
}

/// Moves bodies: columns of ids, rotations and translations. If one is rejected, those before it
/// have moved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_set_poses(
    world: *mut SdopWorld,
    ids: *const u64,
    rotation: *const [f32; 4],
    translation: *const [f64; 3],
    count: usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { set_poses(world, ids, rotation, translation, count, World::set_pose) }
}

/// Moves bodies as `sdop_world_set_poses` does, with rotations in double: no pair of the exact
/// poses is missed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_set_poses_f64(
    world: *mut SdopWorld,
    ids: *const u64,
    rotation: *const [f64; 4],
    translation: *const [f64; 3],
    count: usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { set_poses(world, ids, rotation, translation, count, World::set_pose_f64) }
}

/// Moves bodies by a method of the world.
///
/// # Safety
/// As `sdop_world_set_poses`.
unsafe fn set_poses<Q: Copy>(
    world: *mut SdopWorld,
    ids: *const u64,
    rotation: *const Q,
    translation: *const [f64; 3],
    count: usize,
    set_pose: impl Fn(&mut World, BodyId, Q, [f64; 3]) -> Result<(), WorldError>,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        // SAFETY: the caller's promise.
        let (ids, rotations, translations) = unsafe {
            (
                column(ids, count, "ids")?,
                column(rotation, count, "rotation")?,
                column(translation, count, "translation")?,
            )
        };
        for ((&id, &q), &t) in ids.iter().zip(rotations).zip(translations) {
            set_pose(&mut it.0, BodyId::from_bits(id), q, t)?;
        }
        Ok(())
    })
}

/// Never reports the pair of two bodies again, such as two links that share a joint, until it is
/// included or one of them is removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_exclude(world: *mut SdopWorld, a: u64, b: u64) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        it.0.exclude(BodyId::from_bits(a), BodyId::from_bits(b))?;
        Ok(())
    })
}

/// Reports the pair of two bodies again when it meets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_include(world: *mut SdopWorld, a: u64, b: u64) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(world, "world") }?;
        it.0.include(BodyId::from_bits(a), BodyId::from_bits(b))?;
        Ok(())
    })
}

/// Finds the pairs that might touch now. `pairs` gets their number; read them with
/// `sdop_world_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_cull(world: *mut SdopWorld, pairs: *mut usize) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, None, pairs) }
}

/// `sdop_world_cull`, if there are at most `limit` pairs; more are an error that
/// has their number, and memory for them is never allocated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_cull_up_to(
    world: *mut SdopWorld,
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(world, Some(limit), pairs) }
}

/// Copies the pairs of the last cull into `buffer`, sorted by slots. If they don't fit, `count`
/// says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_pairs(
    world: *mut SdopWorld,
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
pub unsafe extern "C" fn sdop_world_events(
    world: *mut SdopWorld,
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

/// Copies the world as bytes into `buffer`, for `sdop_world_restore`. If they don't fit, `count`
/// says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_snapshot(
    world: *mut SdopWorld,
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

/// Gives this world the state of a snapshot. It must have the same shapes under the same numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_world_restore(
    world: *mut SdopWorld,
    bytes: *const u8,
    count: usize,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, bytes) = unsafe { (handle(world, "world")?, column(bytes, count, "bytes")?) };
        Ok(it.0.restore(&read_back(bytes)?)?)
    })
}
