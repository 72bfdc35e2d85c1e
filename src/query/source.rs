//! The interface by which an index reads a world.

use super::QueryIndex;
use crate::bodies::Motion;
use crate::boxes::BoxWorld;

/// A set of bodies for queries: a `World` or a [`BoxWorld`].
pub trait QuerySource: sealed::Sealed {
    #[doc(hidden)]
    fn bring(&self, index: &mut QueryIndex);
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::boxes::BoxWorld {}
}

pub(crate) const FIXED_TREE: usize = 0;
pub(crate) const MOVING_TREE: usize = 1;

impl QuerySource for BoxWorld {
    fn bring(&self, index: &mut QueryIndex) {
        if index.posed.is_some() {
            index.begin([0.0; 3], None);
        }
        let mut next = 0;
        for (row, id, body) in self.rows() {
            index.take_out_all(next..row);
            next = row + 1;
            let tree = match body.motion {
                Motion::Fixed => FIXED_TREE,
                _ => MOVING_TREE,
            };
            let is_there = index
                .bounds_of(row, id)
                .is_some_and(|(former, bounds)| former == tree && bounds.has_bits_of(&body.bounds));
            if !is_there {
                index.put(row, id, tree, &body.bounds);
            }
        }
        index.end(next);
    }
}
