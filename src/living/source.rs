//! What a set needs to know about the volumes of its bodies.

use std::fmt::Debug;

use super::{Groups, Members, Motion, WorldError};
use crate::bodies::contract::ContractError;
use crate::counters::RestCounters;
use crate::pairs::{FoundPartners, PairList};

/// A function that is given reported pairs in portions.
#[doc(hidden)]
pub type PortionReader<'a> = dyn FnMut(&PairList) + Send + 'a;

/// The volumes of a set's bodies, in rows, and how their pairs are found: `Meshes` or
/// [`Boxes`](crate::boxes::Boxes). Only this crate has any.
#[doc(hidden)]
pub trait VolumeSource: Clone + Debug {
    /// A body as the caller gives it.
    type Body: Copy + Debug + PartialEq;

    /// Whether a body is dynamic, resting or fixed, and its groups.
    fn common(body: &Self::Body) -> (Motion, Groups);

    /// Checks the numbers of a body for a slot.
    fn check(&self, slot: usize, body: &Self::Body) -> Result<(), ContractError>;

    /// Adds a row.
    fn push(&mut self);

    /// Whether the body in a row has the volume of this one, bit by bit.
    fn has(&self, row: usize, body: &Self::Body) -> bool;

    /// Puts a body into a row, in place of another one if it isn't new.
    fn put(&mut self, row: usize, body: &Self::Body, is_new: bool);

    /// Notes that the body in a row has been removed.
    fn take_out(&mut self, _row: usize) {}

    /// The body in a row, with this motion and these groups.
    fn body(&self, row: usize, motion: Motion, groups: Groups) -> Self::Body;

    /// Whether the body in each row is not fixed.
    fn dynamic(&self) -> &[bool];

    /// Moves the rows to those of a plan, and forgets what was known of former frames.
    fn renumber(&mut self, plan: &[u32]);

    /// Drops what no body uses.
    fn drop_unused(&mut self, _members: &mut Members) {}

    /// Whether a pair's verdict depends on its two bodies alone.
    fn judges_pairs_alone(&self) -> bool {
        true
    }

    /// Makes an index of all present bodies.
    fn make_index(&mut self, members: &mut Members);

    /// The partners of the bodies that have changed. `None` if finding all pairs would be faster,
    /// or if these bodies are near more than `most` others.
    fn find_changed(&mut self, members: &mut Members, most: usize) -> Option<FoundPartners>;

    /// Counts a cull in which only changed bodies were searched for.
    fn count_changed(&mut self, counted: RestCounters, pairs: usize, seconds: f64);

    /// Called after a cull that has kept the pairs of unchanged bodies, if any has changed.
    fn end_changed(&mut self, _members: &Members) {}

    /// Called when the next culls will probably search for few bodies.
    fn warm_up(&mut self, _members: &Members) {}

    /// Brings the finder up to date with the bodies, to find all pairs anew.
    fn prepare(&mut self, members: &mut Members) -> Result<(), WorldError>;

    /// Lists all pairs, if there are no more than the limit.
    fn list_all(
        &mut self,
        members: &Members,
        limit: Option<usize>,
        list: &mut PairList,
    ) -> Result<(), WorldError>;

    /// Finds all pairs and passes them on in portions. Returns their number.
    fn pass_on_all(
        &mut self,
        members: &Members,
        take: &mut PortionReader<'_>,
    ) -> Result<u64, WorldError>;

    /// Bytes of intermediate lists of pairs.
    fn pair_bytes(&self) -> usize;
}
