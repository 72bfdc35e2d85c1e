//! Bodies of several shapes, and the pairs of their parts.

use super::bodies::{SdopShape, copies};
use super::border::{SdopIdPair, border};
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

border! {
compound: SdopCompound;

/// Makes a compound of parts, whose shapes are numbered as in `shapes`. `name` is for errors, and
/// may be null.
fn sdop_compound_new(
    ?text name = "compound",
    [*const shapes: Option<&SdopShape>; shape_count],
    [*const parts: Part; part_count],
) -> new SdopCompound {
    SdopCompound(Compound::build(name, &copies(shapes)?, parts)?)
}

/// Frees a compound; null is fine. Part cullers keep copies.
free sdop_compound_free;
/// Makes the shape that contains all parts: give it to a world like any other, and free it.
fn sdop_compound_shape(*const compound) -> new SdopShape { SdopShape(compound.0.shape().clone()) }
}

border! {
culler: SdopPartCuller;

/// Makes a culler of parts without compounds: every shape is one part.
fn sdop_part_culler_new() -> new SdopPartCuller { SdopPartCuller(PartCuller::new()) }
/// Frees a culler of parts; null is fine.
free sdop_part_culler_free;
/// Sets the parts of a shape of the world. The world's shape of that number has to be the one that
/// `sdop_compound_shape` made. If `compound` is null, the shape is one part again.
fn sdop_part_culler_set_parts(*mut culler, shape: u32, ?const compound: SdopCompound) {
    match compound {
        Some(compound) => culler.0.set_parts(shape, compound.0.clone()),
        None => culler.0.remove_parts(shape),
    }
}

/// Finds the pairs of parts in the pairs of the world's last cull: call it after each cull, before
/// bodies change. `pairs` gets their number; read them with `sdop_part_culler_pairs`.
fn sdop_part_culler_cull(*mut culler, *const world: SdopWorld) -> *mut pairs: usize {
    culler.0.cull(&world.0)?.len()
}

/// Copies the pairs of parts of the last cull into `buffer`, sorted by slots and then by parts. If
/// they don't fit, `count` says how many there are.
fn sdop_part_culler_pairs(*const culler) -> [SdopPartPair] { culler.0.pairs().iter() }
/// Copies the pairs of bodies of which some parts may touch into `buffer`, sorted by slots. If they
/// don't fit, `count` says how many there are.
fn sdop_part_culler_body_pairs(*const culler) -> [SdopIdPair] {
    culler.0.body_pairs().collect::<Vec<_>>()
}
}
