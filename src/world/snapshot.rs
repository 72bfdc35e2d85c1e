//! Snapshots of a world, to save, restore and roll back: everything that decides its future pairs,
//! events and ids.
//!
//! Pairs and their order are a function of the bodies ([`World::cull`]), so no state of a pair
//! finder is saved. Numbers are saved as their bits, which no text format rounds. Meshes aren't
//! saved: a digest of each shape is.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::local_origins::Origins;
use super::shapes::{ShapeSlot, check_shape};
use super::{BodyId, SnapshotError, UNTURNED, World, check_margin, check_pose};
use crate::bodies::Bodies;
use crate::living::{
    Ids, IdsSnapshot, Members, PairsSnapshot, RestoredMembers, Version, damaged, excluded_slots,
    flag_column, flagged_slots, restored_column,
};
use crate::simd::in_default_mode;
use crate::strategy::RefinementRanks;

/// A [`World`] at one moment, to be stored or sent in any format of serde.
///
/// It has a version, and snapshots of other versions are rejected. Equal calls produce equal
/// snapshots, so that two peers can compare theirs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorldSnapshot {
    version: Version,
    shapes: Vec<Option<ShapeSnapshot>>,
    ids: IdsSnapshot,
    shape: Vec<u32>,
    dynamic: Vec<bool>,
    /// Slots of bodies at rest, sorted.
    #[serde(default)]
    resting: Vec<u32>,
    rotation: Vec<[u32; 4]>,
    translation: Vec<[u64; 3]>,
    margin: Vec<u32>,
    groups: Vec<[u32; 2]>,
    interest: Vec<BodyId>,
    pairs: PairsSnapshot,
    /// The origin about which the bodies were placed in the last cull, if it isn't the world's.
    origin: Option<[u64; 3]>,
    answers: Vec<([u32; 2], u32)>,
    #[serde(default)]
    excluded: Vec<[u32; 2]>,
    /// Slots of bodies whose rotation was rounded from f64, sorted.
    #[serde(default)]
    rounded: Vec<u32>,
}

/// A shape that a snapshot's bodies may have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct ShapeSnapshot {
    name: String,
    digest: u64,
}

impl World {
    /// The present state of the world, for [`Self::restore`]: bodies with ids, poses, margins and
    /// groups, excluded pairs, free slots, the bodies of interest, the pairs of the last cull and
    /// those of the last events, and, if a budget is spent on the oldest answers first, the times
    /// when pairs were refined. Counters and seconds are not in it.
    ///
    /// ```
    /// # use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};
    /// # let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build()?;
    /// let shapes = vec![Shape::build(&cube, &ShapeSpec::default())?];
    /// let mut world = World::new(shapes.clone())?;
    /// world.insert(Body::default())?;
    /// let saved = serde_json::to_string(&world.snapshot())?;
    /// world.insert(Body::default())?;
    ///
    /// let mut other = World::new(shapes)?;
    /// other.restore(&serde_json::from_str(&saved)?)?;
    /// assert_eq!(other.len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn snapshot(&self) -> WorldSnapshot {
        let bits = |number: f32| number.to_bits();
        let saved = |slot: &ShapeSlot| {
            slot.is_present.then(|| ShapeSnapshot { name: slot.name.clone(), digest: slot.digest })
        };
        let Self { members, volumes } = self;
        let Members { ids, groups, .. } = members;
        let rows = || ids.filled();
        let changed = members.movers.all_changed();
        let origin = volumes.origins.saved().filter(|_| changed.is_some());
        let slots = |pair: [u32; 2]| pair.map(|row| ids.id(row).slot() as u32);
        let answers = volumes.culler.answers().0.into_iter();
        WorldSnapshot {
            version: Version,
            shapes: volumes.shapes[..volumes.shape_numbers()].iter().map(saved).collect(),
            ids: IdsSnapshot::of(ids),
            shape: rows().map(|row| volumes.shape[row]).collect(),
            dynamic: rows().map(|row| volumes.bodies.dynamic[row]).collect(),
            resting: flagged_slots(&members.resting, ids),
            rotation: rows().map(|row| volumes.bodies.rotation[row].map(bits)).collect(),
            translation: rows().map(|row| volumes.translation[row].map(f64::to_bits)).collect(),
            margin: rows().map(|row| bits(volumes.margin[row])).collect(),
            groups: rows().map(|row| groups[row]).map(|g| [g.member, g.mask]).collect(),
            interest: volumes.interest.clone(),
            pairs: PairsSnapshot::of(&members.pairs, origin.and(changed), ids),
            origin: origin.flatten(),
            answers: answers.map(|(pair, rank)| (slots(pair), rank)).collect(),
            excluded: excluded_slots(&members.excluded, ids),
            rounded: flagged_slots(&volumes.rounded, ids),
        }
    }

    /// Replaces this world by that of a snapshot. From then on the same calls give the same ids,
    /// pairs and events, in the same order, as in the world from which it was taken, as long as
    /// both are culled by the same strategy with the same settings; finder, threads, tier and a
    /// budget of time may differ.
    ///
    /// The world must have the snapshot's shapes under the same numbers. Additional shapes stay.
    ///
    /// # Errors
    /// The world lacks a shape, or has another one under its number, or the snapshot is
    /// inconsistent. The world stays unchanged.
    pub fn restore(&mut self, snapshot: &WorldSnapshot) -> Result<(), SnapshotError> {
        let present = &self.volumes.shapes;
        check_shapes(&snapshot.shapes, present)?;
        let WorldSnapshot { ids, resting, groups, pairs, excluded, .. } = snapshot;
        let restored = RestoredMembers::of(ids, resting, groups, pairs, excluded)?;
        let RestoredMembers { mut members, plan, changed } = restored;
        let ids = &members.ids;
        let shape = restored_column("shape", snapshot.shape.iter().copied(), &plan, 0)?;
        let dynamic = restored_column("dynamic", snapshot.dynamic.iter().copied(), &plan, true)?;
        let rotation = snapshot.rotation.iter().map(|q| q.map(f32::from_bits));
        let rotation = restored_column("rotation", rotation, &plan, UNTURNED)?;
        let translation = snapshot.translation.iter().map(|t| t.map(f64::from_bits));
        let translation = restored_column("translation", translation, &plan, [0.0; 3])?;
        let margin = snapshot.margin.iter().copied().map(f32::from_bits);
        let margin = restored_column("margin", margin, &plan, 0.0)?;
        let mut counts = vec![0; present.len()];
        for row in ids.filled() {
            let (slot, shape) = (ids.id(row as u32).slot(), shape[row]);
            check_pose(slot, &rotation[row], &translation[row])?;
            if !matches!(snapshot.shapes.get(shape as usize), Some(Some(_))) {
                return damaged(format!("slot {slot} has shape {shape}, which isn't in it"));
            }
            let reach = check_shape(slot, shape, present)?;
            check_margin(slot, reach, margin[row])?;
            counts[shape as usize] += 1;
        }
        let rounded = flag_column(&snapshot.rounded, ids, "rounded")?;
        let answers = checked(&snapshot.answers, ids)?;

        let (rows, volumes) = (ids.rows(), &mut self.volumes);
        volumes.bodies =
            Bodies { shape: vec![0; rows], dynamic, rotation, translation: vec![[0.0; 3]; rows] };
        (volumes.shape, volumes.translation, volumes.margin) = (shape, translation, margin);
        volumes.rounded = rounded;
        for (shape, bodies) in volumes.shapes.iter_mut().zip(counts) {
            shape.bodies = bodies;
        }
        volumes.interest.clone_from(&snapshot.interest);
        volumes.is_of_interest = vec![false; rows];
        volumes.culler.set_answers(&answers);
        volumes.look(ids);
        volumes.origins = Origins::restored(snapshot.origin.filter(|_| changed.is_some()));
        let changed =
            changed.filter(|_| in_default_mode(|| volumes.place_again(&mut members)).is_ok());
        self.members = members;
        if let Some(changed) = changed {
            self.resume(&changed);
        }
        Ok(())
    }
}

fn check_shapes(
    wanted: &[Option<ShapeSnapshot>],
    present: &[ShapeSlot],
) -> Result<(), SnapshotError> {
    for (number, wanted) in wanted.iter().enumerate() {
        let Some(wanted) = wanted else { continue };
        let found = match present.get(number).filter(|slot| slot.is_present) {
            Some(slot) if slot.digest == wanted.digest => continue,
            Some(slot) => format!("this world has another shape in its place, `{}`", slot.name),
            None => "this world has none of that number".to_owned(),
        };
        return Err(SnapshotError::Shape {
            shape: number as u32,
            name: wanted.name.clone(),
            found,
        });
    }
    Ok(())
}

/// Answers of sorted pairs of slots, each once, with ranks up to the number of pairs.
fn checked(answers: &[([u32; 2], u32)], ids: &Ids) -> Result<RefinementRanks, SnapshotError> {
    let row = |slot| Some(ids.row_of(slot)).filter(|&row| row < ids.rows()).map(|row| row as u32);
    let by_row = answers.iter().map(|&([i, j], rank)| Some(([row(i)?, row(j)?], rank)));
    let by_row: Option<Vec<_>> = by_row.collect();
    let is_sound = |&([i, j], rank): &([u32; 2], u32)| i < j && rank as usize <= answers.len();
    let is_sorted = answers.is_sorted_by(|(a, _), (b, _)| a < b);
    // Ranks are 1, 2, 3 … without a gap, and 0 for pairs that were never refined.
    let ranks: BTreeSet<u32> = answers.iter().map(|&(_, rank)| rank).chain([0]).collect();
    let is_dense = ranks.iter().copied().eq(0..ranks.len() as u32);
    match by_row {
        Some(by_row) if is_sorted && is_dense && answers.iter().all(is_sound) => {
            Ok(RefinementRanks(by_row))
        }
        _ => damaged("answers of pairs that there can't be"),
    }
}
