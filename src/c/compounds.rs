//! Bodies of several shapes, and the pairs of their parts.

use std::ffi::c_char;

use super::bodies::{SdopShape, shapes};
use super::border::{
    Buffer, Out, SdopIdPair, SdopStatus, answer, call, column, free, handle, list, make, shared,
    text,
};
use super::world::SdopWorld;
use crate::compound::{Compound, Part, PartCuller, PartPair};

/// Several shapes that move as one body.
#[derive(Debug)]
pub struct SdopCompound(Compound);

/// Finds the pairs of parts within the pairs of bodies that a world reports.
#[derive(Debug)]
pub struct SdopPartCuller(PartCuller);

/// Two parts of two bodies.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopPartPair {
    /// The bodies.
    pub bodies: SdopIdPair,
    /// The number of the first body's part; 0 if its shape is not a compound.
    pub first_part: u32,
    /// The number of the second body's part; 0 if its shape is not a compound.
    pub second_part: u32,
}

impl From<&PartPair> for SdopPartPair {
    fn from(pair: &PartPair) -> Self {
        let [first_part, second_part] = pair.parts;
        Self { bodies: pair.bodies.into(), first_part, second_part }
    }
}

/// A part with a rotation in double, a quaternion of any non-zero norm: `rotation` gets the nearest
/// floats, and `rounded` says whether they are others. No pair of the exact pose is missed.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_part_turned(part: Part, x: f64, y: f64, z: f64, w: f64) -> Part {
    part.turned([x, y, z, w])
}

/// Makes a compound of parts, whose shapes are numbered as in `shapes`. `name` is for errors, and
/// may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_compound_new(
    name: *const c_char,
    shapes: *const *const SdopShape,
    shape_count: usize,
    parts: *const Part,
    part_count: usize,
    out: *mut *mut SdopCompound,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let name = unsafe { text(name, "compound") }?;
        // SAFETY: the caller's promise.
        let shapes = unsafe { self::shapes(shapes, shape_count) }?;
        // SAFETY: the caller's promise.
        let parts = unsafe { column(parts, part_count, "parts") }?;
        let compound = Compound::build(name, &shapes, parts)?;
        Ok(SdopCompound(compound))
    })
}

/// Frees a compound; null is fine. Part cullers keep copies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_compound_free(compound: *mut SdopCompound) {
    // SAFETY: the caller's promise.
    unsafe { free(compound) }
}

/// Makes the shape that contains all parts: give it to a world like any other, and free it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_compound_shape(
    compound: *const SdopCompound,
    out: *mut *mut SdopShape,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let compound = unsafe { shared(compound, "compound") }?;
        Ok(SdopShape(compound.0.shape().clone()))
    })
}

/// Makes a culler of parts without compounds: every shape is one part.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_new(out: *mut *mut SdopPartCuller) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || Ok(SdopPartCuller(PartCuller::new())))
}

/// Frees a culler of parts; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_free(culler: *mut SdopPartCuller) {
    // SAFETY: the caller's promise.
    unsafe { free(culler) }
}

/// Sets the parts of a shape of the world. The world's shape of that number has to be the one that
/// `sdop_compound_shape` made. If `compound` is null, the shape is one part again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_set_parts(
    culler: *mut SdopPartCuller,
    shape: u32,
    compound: *const SdopCompound,
) -> SdopStatus {
    call(|| {
        // SAFETY: the caller's promise.
        let (it, compound) = unsafe { (handle(culler, "culler")?, compound.as_ref()) };
        match compound {
            Some(compound) => it.0.set_parts(shape, compound.0.clone()),
            None => it.0.remove_parts(shape),
        }
        Ok(())
    })
}

/// Finds the pairs of parts in the pairs of the world's last cull: call it after each cull, before
/// bodies change. `pairs` gets their number; read them with `sdop_part_culler_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_cull(
    culler: *mut SdopPartCuller,
    world: *const SdopWorld,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(pairs) }, "pairs", || {
        // SAFETY: the caller's promise.
        let (it, world) = unsafe { (handle(culler, "culler")?, shared(world, "world")?) };
        Ok(it.0.cull(&world.0)?.len())
    })
}

/// Copies the pairs of parts of the last cull into `buffer`, sorted by slots and then by parts. If
/// they don't fit, `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_pairs(
    culler: *const SdopPartCuller,
    buffer: *mut SdopPartPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { shared(culler, "culler") }?;
        Ok(it.0.pairs().iter().map(SdopPartPair::from))
    })
}

/// Copies the pairs of bodies of which some parts may touch into `buffer`, sorted by slots. If they
/// don't fit, `count` says how many there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_part_culler_body_pairs(
    culler: *const SdopPartCuller,
    buffer: *mut SdopIdPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { shared(culler, "culler") }?;
        let pairs: Vec<_> = it.0.body_pairs().map(SdopIdPair::from).collect();
        Ok(pairs.into_iter())
    })
}
