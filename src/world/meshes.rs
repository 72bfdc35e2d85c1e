//! The posed meshes of a world, and how their pairs are found.
//!
//! A pair's verdict is a function of its two bodies, each in a model and at a place, of their
//! groups and motion, of whether one of them is of interest, and of whether the pair is excluded. A
//! body counts as changed when any of these is set (for an excluded pair, one of its bodies), and
//! when its local place or its model changes because an origin has moved.

use super::local_origins::Origins;
use super::margins::{Margins, check_margin};
use super::shapes::{ShapeSlot, check_shape};
use super::{Body, Groups, Motion, UNTURNED, WorldError};
use crate::bodies::contract::{ContractError, check_pose};
use crate::bodies::{Aabb, Bodies};
use crate::broad_phase::{Candidates, IndexedBox, tags};
use crate::counters::RestCounters;
use crate::culler::Culler;
use crate::living::{
    BodyId, Ids, Members, PortionReader, VolumeSource, renumber_column, renumbered_pairs,
};
use crate::pairs::{FoundPartners, PairList};
use crate::settings::Interest;
use crate::simd::in_default_mode;
use crate::strategy::RefinementRanks;
use crate::volume::Shape;

/// The posed meshes of a [`World`](super::World), by row. Empty rows keep the values of their last
/// body.
#[derive(Clone, Debug)]
pub struct Meshes {
    pub(super) shapes: Vec<ShapeSlot>,
    /// The culler's number of each shape.
    pub(super) models: Vec<u32>,
    /// Bodies as the culler has them. Those that aren't fixed are dynamic.
    pub(super) bodies: Bodies,
    pub(super) shape: Vec<u32>,
    pub(super) translation: Vec<[f64; 3]>,
    pub(super) margin: Vec<f32>,
    /// Whether each rotation was rounded from f64.
    pub(super) rounded: Vec<bool>,
    pub(super) margins: Margins,
    pub(super) interest: Vec<BodyId>,
    /// Whether each row has a body of interest.
    pub(super) is_of_interest: Vec<bool>,
    pub(super) culler: Culler,
    pub(super) origins: Origins,
    /// Whether a body's model differs from that in the culler.
    pub(super) remodelled: bool,
}

impl Meshes {
    /// No bodies, of shapes that the culler has.
    pub(super) fn new(shapes: &[Shape], culler: Culler) -> Self {
        Self {
            models: (0..shapes.len() as u32).collect(),
            shapes: shapes.iter().map(ShapeSlot::new).collect(),
            bodies: Bodies::default(),
            shape: Vec::new(),
            translation: Vec::new(),
            margin: Vec::new(),
            rounded: Vec::new(),
            margins: Margins::default(),
            interest: Vec::new(),
            is_of_interest: Vec::new(),
            culler,
            origins: Origins::default(),
            remodelled: false,
        }
    }

    /// Whether the body in a row has this pose, bit by bit.
    pub(super) fn is_at(&self, row: usize, rotation: [f32; 4], translation: [f64; 3]) -> bool {
        rotation.map(f32::to_bits) == self.bodies.rotation[row].map(f32::to_bits)
            && translation.map(f64::to_bits) == self.translation[row].map(f64::to_bits)
    }

    /// Marks the present bodies of interest, and passes them to the culler.
    pub(super) fn look(&mut self, ids: &Ids) {
        let rows = self.interest.iter().filter_map(|id| ids.slot(*id).ok());
        let rows: Vec<u32> = rows.map(|row| row as u32).collect();
        for &row in &rows {
            self.is_of_interest[row as usize] = true;
        }
        self.culler.set_interest(Interest::Bodies(rows));
    }

    /// The body in a row, for the index: with its box, or without one if it was removed.
    fn indexed(&self, row: u32, groups: &[Groups], aabb: Option<Aabb>) -> IndexedBox {
        let at = row as usize;
        IndexedBox {
            slot: row,
            is_present: aabb.is_some(),
            tags: tags(self.bodies.dynamic[at], groups[at]),
            aabb: aabb.unwrap_or_default(),
        }
    }
}

impl VolumeSource for Meshes {
    type Body = Body;

    fn common(body: &Body) -> (Motion, Groups) {
        (body.motion, body.groups)
    }

    fn check(&self, slot: usize, body: &Body) -> Result<(), ContractError> {
        in_default_mode(|| {
            let reach = check_shape(slot, body.shape, &self.shapes)?;
            check_pose(slot, &body.rotation, &body.translation)?;
            check_margin(slot, reach, body.margin)
        })
    }

    fn push(&mut self) {
        self.bodies.push(0, true, UNTURNED, [0.0f32; 3]);
        self.rounded.push(false);
        self.is_of_interest.push(false);
        self.shape.push(0);
        self.translation.push([0.0; 3]);
        self.margin.push(0.0);
    }

    fn has(&self, row: usize, body: &Body) -> bool {
        self.is_at(row, body.rotation, body.translation)
            && body.rounded == self.rounded[row]
            && body.margin.to_bits() == self.margin[row].to_bits()
            && body.shape == self.shape[row]
    }

    fn put(&mut self, row: usize, body: &Body, is_new: bool) {
        if !is_new {
            self.shapes[self.shape[row] as usize].bodies -= 1;
        }
        self.shapes[body.shape as usize].bodies += 1;
        self.bodies.dynamic[row] = body.motion.is_dynamic();
        self.bodies.rotation[row] = body.rotation;
        self.rounded[row] = body.rounded;
        self.shape[row] = body.shape;
        self.translation[row] = body.translation;
        self.margin[row] = body.margin;
    }

    fn take_out(&mut self, row: usize) {
        self.shapes[self.shape[row] as usize].bodies -= 1;
        self.is_of_interest[row] = false;
    }

    fn body(&self, row: usize, motion: Motion, groups: Groups) -> Body {
        Body {
            shape: self.shape[row],
            motion,
            rotation: self.bodies.rotation[row],
            translation: self.translation[row],
            rounded: self.rounded[row],
            groups,
            margin: self.margin[row],
        }
    }

    fn dynamic(&self) -> &[bool] {
        &self.bodies.dynamic
    }

    fn renumber(&mut self, plan: &[u32]) {
        renumber_column(&mut self.bodies.shape, plan, 0);
        renumber_column(&mut self.bodies.dynamic, plan, true);
        renumber_column(&mut self.bodies.rotation, plan, UNTURNED);
        renumber_column(&mut self.bodies.translation, plan, [0.0; 3]);
        renumber_column(&mut self.is_of_interest, plan, false);
        renumber_column(&mut self.shape, plan, 0);
        renumber_column(&mut self.translation, plan, [0.0; 3]);
        renumber_column(&mut self.margin, plan, 0.0);
        renumber_column(&mut self.rounded, plan, false);
        let answers = renumbered_pairs(self.culler.answers().0, plan);
        self.culler.set_answers(&RefinementRanks(answers));
        self.origins = Origins::default();
        self.culler.forget();
    }

    fn drop_unused(&mut self, members: &mut Members) {
        if self.place(members).is_ok() {
            self.sweep_margins(members, false);
        }
        let shapes = self.shape_numbers();
        self.shapes.truncate(shapes);
        self.shapes.shrink_to_fit();
        self.models.truncate(shapes);
        self.models.shrink_to_fit();
        self.interest.shrink_to_fit();
        self.margins.shrink_to_fit();
    }

    fn judges_pairs_alone(&self) -> bool {
        self.culler.judges_pairs_alone()
    }

    fn make_index(&mut self, members: &mut Members) {
        let all: Vec<u32> = members.ids.filled().map(|row| row as u32).collect();
        let boxes = self.culler.boxes_of(&self.bodies, &all);
        let boxes = all.iter().zip(&boxes);
        let indexed = boxes.map(|(&row, &aabb)| self.indexed(row, &members.groups, Some(aabb)));
        let index = Candidates::of(indexed, all.len());
        members.movers.take_index(index);
    }

    fn find_changed(&mut self, members: &mut Members, most: usize) -> Option<FoundPartners> {
        self.place_changed(members).ok()?;
        if !members.movers.are_few() {
            return None;
        }
        if members.movers.need_index() {
            self.make_index(members);
            self.culler.count_sample_updates(members.ids.len());
        }
        let mut found = members.movers.take_changed(&members.ids);
        let boxes = self.culler.boxes_of(&self.bodies, found.present());
        self.culler.count_sample_updates(found.present);
        let mut boxes = boxes.into_iter();
        members.find(&mut found, most, |row, _, groups| self.indexed(row, groups, boxes.next()))?;
        self.culler.test_found(&self.bodies, &mut found, &self.is_of_interest);
        Some(found)
    }

    fn count_changed(&mut self, counted: RestCounters, pairs: usize, seconds: f64) {
        self.culler.count_sampled(counted, pairs, seconds);
    }

    fn end_changed(&mut self, members: &Members) {
        self.sweep_margins(members, true);
    }

    fn warm_up(&mut self, members: &Members) {
        self.read_bounds(members);
    }

    fn prepare(&mut self, members: &mut Members) -> Result<(), WorldError> {
        in_default_mode(|| self.place(members))?;
        self.sweep_margins(members, true);
        if std::mem::take(&mut members.replaced) {
            self.culler.exchange(&self.bodies, &members.ids.colliding(&members.groups));
            if !self.interest.is_empty() {
                self.look(&members.ids); // another body may have taken the row of one of interest
            }
        } else if self.remodelled {
            self.culler.reread_shapes(&self.bodies);
        }
        self.remodelled = false;
        Ok(())
    }

    fn list_all(
        &mut self,
        members: &Members,
        limit: Option<usize>,
        list: &mut PairList,
    ) -> Result<(), WorldError> {
        Ok(self.culler.list(&self.bodies, members.filter(), limit, list)?)
    }

    fn pass_on_all(
        &mut self,
        members: &Members,
        take: &mut PortionReader<'_>,
    ) -> Result<u64, WorldError> {
        Ok(self.culler.pass_on(&self.bodies, members.filter(), take)?)
    }

    fn pair_bytes(&self) -> usize {
        self.culler.pair_bytes()
    }
}
