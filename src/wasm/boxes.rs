//! Boxes: the pairs of a list, and a world of boxes that come and go.

use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::{check_length, one, rows};
use crate::bodies::{Aabb, Motion};
use crate::boxes::{BoxBody, BoxCuller, BoxWorld as Boxes};
use crate::living::BodyId;

fn aabb([a, b, c, d, e, f]: [f32; 6]) -> Aabb {
    Aabb::new([a, b, c], [d, e, f])
}

/// Finds the pairs of boxes that meet, touching included. A box is six numbers: the lower corner
/// x, y, z, then the upper one. Returns two indices i < j for each pair, sorted.
#[wasm_bindgen(js_name = boxPairs)]
pub fn box_pairs(boxes: &[f32]) -> Result<Vec<u32>, JsError> {
    let boxes: Vec<Aabb> = rows(boxes, "boxes")?.iter().copied().map(aabb).collect();
    Ok(BoxCuller::new().cull(&boxes)?.sorted().into_flattened())
}

/// A long-lived set of boxes, with ids that stay until a box is removed.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct BoxWorld(Boxes);

/// How pairs have changed: two ids for each pair.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone, Debug)]
pub struct Events {
    /// Reported now and not before.
    #[wasm_bindgen(readonly)]
    pub begun: Vec<u64>,
    /// Reported now and before.
    #[wasm_bindgen(readonly)]
    pub persisting: Vec<u64>,
    /// Reported before and not now.
    #[wasm_bindgen(readonly)]
    pub ended: Vec<u64>,
}

#[wasm_bindgen]
impl BoxWorld {
    /// Makes a world without boxes.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a box of six numbers and returns its id. Two fixed boxes are never a pair.
    pub fn insert(&mut self, bounds: &[f32], fixed: Option<bool>) -> Result<u64, JsError> {
        let motion = Motion::of(!fixed.unwrap_or(false), false);
        let body = BoxBody { motion, ..aabb(one(bounds, "the box")?).into() };
        Ok(self.0.insert(body)?.to_bits())
    }

    /// Moves boxes: their ids, and six numbers for each.
    pub fn set(&mut self, ids: &[u64], boxes: &[f32]) -> Result<(), JsError> {
        let boxes: Vec<Aabb> = rows(boxes, "boxes")?.iter().copied().map(aabb).collect();
        check_length("boxes", boxes.len(), ids.len())?;
        let ids: Vec<BodyId> = ids.iter().map(|&id| BodyId::from_bits(id)).collect();
        Ok(self.0.set_many(&ids, &boxes)?)
    }

    /// Removes a box.
    pub fn remove(&mut self, id: u64) -> Result<(), JsError> {
        Ok(self.0.remove(BodyId::from_bits(id))?)
    }

    /// Finds the pairs of boxes that meet now: two ids for each pair.
    pub fn cull(&mut self) -> Result<Vec<u64>, JsError> {
        Ok(bits(self.0.cull()?.iter()))
    }

    /// The changes of pairs since the last call of this method.
    pub fn events(&mut self) -> Events {
        let events = self.0.events();
        Events {
            begun: bits(events.begun()),
            persisting: bits(events.persisting()),
            ended: bits(events.ended()),
        }
    }
}

fn bits(pairs: impl Iterator<Item = [BodyId; 2]>) -> Vec<u64> {
    pairs.flatten().map(BodyId::to_bits).collect()
}
