//! Long-lived worlds of boxes and of meshes in which space repeats along some axes.

use std::ffi::c_void;

use super::bodies::{SdopOptions, SdopShape, builder, copies};
use super::border::{SdopEventKind, SdopIdPair, bodies, border};
use super::boxes;
use super::world::SdopBody;
use crate::bodies::Groups;
use crate::living::BodyId;
use crate::periodic::{PeriodicBox, PeriodicBoxes, PeriodicEvents, PeriodicPair};
use crate::world::PeriodicWorld;

/// A long-lived set of boxes in space that repeats along some axes.
#[derive(Debug)]
pub struct SdopPeriodicBoxes(PeriodicBoxes);

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

bodies!(SdopPeriodicBox = PeriodicBox { min, max, groups });

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
fn of_axes(periods: &[f64; 3]) -> [Option<f64>; 3] {
    periods.map(|period| (period != 0.0).then_some(period))
}

/// All events, by their kinds.
fn all(events: &PeriodicEvents) -> impl Iterator<Item = SdopPeriodicEvent> {
    let kinds = [
        (SdopEventKind::Begun, events.begun()),
        (SdopEventKind::Persisting, events.persisting()),
        (SdopEventKind::Ended, events.ended()),
    ];
    kinds.into_iter().flat_map(|(kind, pairs)| {
        pairs.iter().map(move |pair| SdopPeriodicEvent { kind, pair: pair.into() })
    })
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
    PeriodicBox::new([min_x, min_y, min_z], [max_x, max_y, max_z]).into()
}

border! {
world: SdopPeriodicBoxes;

/// Makes a world without boxes. `periods` are three lengths along x, y and z, 0 for an axis without
/// a period. `finder` is "auto" if null; 0 threads are 1.
fn sdop_periodic_boxes_new(
    *const periods: [f64; 3],
    ?text finder = "auto",
    threads: usize,
) -> new SdopPeriodicBoxes {
    SdopPeriodicBoxes(PeriodicBoxes::with(&boxes::builder(finder, threads)?, of_axes(periods))?)
}

/// Frees a world; null is fine.
free sdop_periodic_boxes_free;
/// Changes the periods. Boxes stay where they were put. If one is too large for them, nothing
/// changes.
fn sdop_periodic_boxes_set_periods(*mut world, *const periods: [f64; 3]) {
    world.0.set_periods(of_axes(periods))?;
}

/// Adds a box; `id` gets its id, which stays until the box is removed.
fn sdop_periodic_boxes_insert(*mut world, *const body: SdopPeriodicBox) -> *mut id: u64 {
    world.0.insert(*body)?.to_bits()
}

/// Reads a box, as it was inserted or set.
fn sdop_periodic_boxes_body(*const world, #id) -> *mut body: SdopPeriodicBox {
    world.0.body(id)?.into()
}

/// Copies the ids of all boxes into `buffer`, sorted by slots. If they don't fit, `count` says how
/// many there are.
fn sdop_periodic_boxes_ids(*const world) -> [u64] {
    world.0.ids().map(BodyId::to_bits).collect::<Vec<_>>()
}

/// Removes a box.
fn sdop_periodic_boxes_remove(*mut world, #id) { world.0.remove(id)?; }
/// Moves boxes, or changes them in any of their properties: columns of ids and boxes. If one is
/// rejected, those before it have changed.
fn sdop_periodic_boxes_set(*mut world, [*const ids: u64, *const bodies: SdopPeriodicBox; count]) {
    for (&id, &body) in ids.iter().zip(bodies) {
        world.0.set(BodyId::from_bits(id), body)?;
    }
}

/// Never reports the pair of two boxes again, in any image, until it is included or one of them is
/// removed.
fn sdop_periodic_boxes_exclude(*mut world, #a, #b) { world.0.exclude(a, b)?; }
/// Reports the pair of two boxes again when it meets.
fn sdop_periodic_boxes_include(*mut world, #a, #b) { world.0.include(a, b)?; }
/// Finds the pairs of which an image meets. `pairs` gets their number; read them with
/// `sdop_periodic_boxes_pairs`.
fn sdop_periodic_boxes_cull(*mut world) -> *mut pairs: usize { world.0.cull()?.len() }
/// `sdop_periodic_boxes_cull`, if images have at most `limit` pairs; more are an error that has
/// their number. A pair across a corner of the period is found at several images, and counts as
/// often.
fn sdop_periodic_boxes_cull_up_to(*mut world, limit: usize) -> *mut pairs: usize {
    world.0.cull_up_to(limit)?.len()
}

/// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
/// `count` says how many there are.
fn sdop_periodic_boxes_pairs(*const world) -> [SdopPeriodicPair] { world.0.pairs().iter() }
/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function. Two boxes are one pair, in whatever image they meet.
fn sdop_periodic_boxes_events(*mut world, |take: SdopTakePeriodicEvent|) {
    take.each(all(&world.0.events()));
}
}

/// A long-lived set of bodies in space that repeats along some axes. Along a periodic axis, the
/// ball about a body, with its margin, has to be smaller than half of the period.
#[derive(Debug)]
pub struct SdopPeriodicWorld(PeriodicWorld);

border! {
world: SdopPeriodicWorld;

/// Makes a world without bodies. `periods` are three lengths along x, y and z, 0 for an axis
/// without a period. `options` may be null for the defaults.
fn sdop_periodic_world_new(
    [*const shapes: Option<&SdopShape>; shape_count],
    *const periods: [f64; 3],
    ?const options: SdopOptions,
) -> new SdopPeriodicWorld {
    // SAFETY: the caller's promise.
    let culler = unsafe { builder(options) }?;
    SdopPeriodicWorld(PeriodicWorld::with(copies(shapes)?, &culler, of_axes(periods))?)
}

/// Frees a world; null is fine.
free sdop_periodic_world_free;
/// Changes the periods. Bodies stay where they were put. If one is too large for them, nothing
/// changes.
fn sdop_periodic_world_set_periods(*mut world, *const periods: [f64; 3]) {
    world.0.set_periods(of_axes(periods))?;
}

/// Adds a body; `id` gets its id, which stays until the body is removed.
fn sdop_periodic_world_insert(*mut world, *const body: SdopBody) -> *mut id: u64 {
    world.0.insert(*body)?.to_bits()
}

/// Reads a body, as it was inserted or set.
fn sdop_periodic_world_body(*const world, #id) -> *mut body: SdopBody { world.0.body(id)?.into() }
/// Copies the ids of all bodies into `buffer`, sorted by slots. If they don't fit, `count` says how
/// many there are.
fn sdop_periodic_world_ids(*const world) -> [u64] {
    world.0.ids().map(BodyId::to_bits).collect::<Vec<_>>()
}

/// Removes a body.
fn sdop_periodic_world_remove(*mut world, #id) { world.0.remove(id)?; }
/// Moves bodies, or changes them in any of their properties: columns of ids and bodies. If one is
/// rejected, those before it have changed.
fn sdop_periodic_world_set(*mut world, [*const ids: u64, *const bodies: SdopBody; count]) {
    for (&id, &body) in ids.iter().zip(bodies) {
        world.0.set(BodyId::from_bits(id), body)?;
    }
}

/// Never reports the pair of two bodies again, in any image, until it is included or one of them is
/// removed.
fn sdop_periodic_world_exclude(*mut world, #a, #b) { world.0.exclude(a, b)?; }
/// Reports the pair of two bodies again when it meets.
fn sdop_periodic_world_include(*mut world, #a, #b) { world.0.include(a, b)?; }
/// Finds the pairs of which an image may touch. `pairs` gets their number; read them with
/// `sdop_periodic_world_pairs`.
fn sdop_periodic_world_cull(*mut world) -> *mut pairs: usize { world.0.cull()?.len() }
/// `sdop_periodic_world_cull`, if images have at most `limit` pairs; more are an error that has
/// their number. A pair across a corner of the period is found at several images, and counts as
/// often.
fn sdop_periodic_world_cull_up_to(*mut world, limit: usize) -> *mut pairs: usize {
    world.0.cull_up_to(limit)?.len()
}

/// Copies the pairs of the last cull into `buffer`, each once, sorted by slots. If they don't fit,
/// `count` says how many there are.
fn sdop_periodic_world_pairs(*const world) -> [SdopPeriodicPair] { world.0.pairs().iter() }
/// Calls `take` for each pair that has begun, persists or has ended since the previous call of this
/// function. Two bodies are one pair, in whatever image they touch.
fn sdop_periodic_world_events(*mut world, |take: SdopTakePeriodicEvent|) {
    take.each(all(&world.0.events()));
}
}
