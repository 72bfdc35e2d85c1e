//! The bodies of a world by location, changed body by body.

use super::source::QuerySource;
use super::tree::Tree;
use super::volume::QueryError;
use crate::bodies::Aabb;
use crate::living::BodyId;
use crate::posed::{PosedBodies, PosedShape};
use crate::rounding::{down, up};
use crate::simd::{Tier, in_default_mode};
use crate::threads::{Threads, ThreadsError};

/// One tree for fixed bodies and one for the others.
pub(crate) const TREES: usize = 2;

/// No place in any tree.
const NOWHERE: u32 = u32::MAX;

/// The bodies of a world, prepared for queries. See the [module](super).
#[derive(Clone, Debug)]
pub struct QueryIndex {
    pub(crate) threads: Threads,
    pub(crate) tier: Tier,
    pub(super) trees: [Tree; TREES],
    /// The origin of the boxes in the trees: 0 if bodies are boxes.
    pub(crate) origin: [f64; 3],
    /// The place in the trees of the body in each row of the world. After the world has changed its
    /// rows, all bodies that have another row count as changed.
    homes: Vec<TreePlace>,
    pub(crate) ids: Vec<BodyId>,
    pub(crate) posed: Option<PosedBodies>,
    is_updated: bool,
    pub(crate) most_answers: usize,
}

/// The place of a row's box.
#[derive(Clone, Copy, Debug)]
struct TreePlace {
    tree: u8,
    place: u32,
}

/// A body in the form that is tested after the trees.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SolidBody<'a> {
    /// An exact box.
    Box(Aabb),
    /// A posed shape.
    Shape(PosedShape<'a>),
}

impl Default for QueryIndex {
    fn default() -> Self {
        Self::on(Threads::default())
    }
}

impl QueryIndex {
    /// An index without bodies, whose queries run on the caller's thread.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// An index without bodies, whose batches run on `threads` threads, the caller's included.
    /// Answers don't depend on the number.
    ///
    /// # Errors
    /// The system cannot start the threads.
    pub fn with_threads(threads: usize) -> Result<Self, ThreadsError> {
        Ok(Self::on(Threads::new(threads)?))
    }

    fn on(threads: Threads) -> Self {
        Self {
            threads,
            tier: Tier::detect(),
            trees: Default::default(),
            origin: [0.0; 3],
            homes: Vec::new(),
            ids: Vec::new(),
            posed: None,
            is_updated: false,
            most_answers: usize::MAX,
        }
    }

    /// This index with another SIMD tier. Answers don't depend on it.
    #[must_use]
    pub fn on_tier(self, tier: Tier) -> Self {
        Self { tier, ..self }
    }

    /// This index with a limit: if a call for many queries, or for the pairs of two sets, has more
    /// answers, it is an error that says how many, and memory for them is never allocated.
    #[must_use]
    pub fn most_answers(self, limit: usize) -> Self {
        Self { most_answers: limit, ..self }
    }

    /// Brings the index up to date with a world, [`World`](crate::World) or
    /// [`BoxWorld`](crate::BoxWorld): queries then see its bodies as they are now. It costs one
    /// comparison per body, and changes to the trees for those that have changed. If the world is
    /// not that of the last update, all bodies are new.
    pub fn update(&mut self, world: &impl QuerySource) {
        self.is_updated = true;
        self.threads.renew();
        in_default_mode(|| {
            world.bring(self);
            for tree in 0..TREES {
                if self.trees[tree].is_worn() {
                    self.build(tree);
                }
                self.trees[tree].settle();
            }
        });
    }

    /// Checks that there was an update: until then, an answer would be about no world.
    pub(crate) fn check_updated(&self) -> Result<(), QueryError> {
        if self.is_updated {
            return Ok(());
        }
        let problem = "has never been updated".to_owned();
        Err(QueryError::new(0, "index", problem, "call `update` with the world before any query"))
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.homes.iter().filter(|home| home.place != NOWHERE).count()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Removes all bodies, and sets the origin of the boxes.
    pub(crate) fn begin(&mut self, origin: [f64; 3], posed: Option<PosedBodies>) {
        self.trees = Default::default();
        self.homes.clear();
        self.ids.clear();
        (self.origin, self.posed) = (origin, posed);
    }

    /// The box in the trees of the body in a row, if it is this one, and its tree.
    pub(crate) fn bounds_of(&self, row: usize, id: BodyId) -> Option<(usize, Aabb)> {
        let home = self.homes.get(row).copied()?;
        let is_there = home.place != NOWHERE && self.ids[row] == id;
        is_there.then(|| {
            let tree = usize::from(home.tree);
            (tree, self.trees[tree].bounds(home.place))
        })
    }

    /// Puts the body in a row into a tree, with its present box.
    pub(crate) fn put(&mut self, row: usize, id: BodyId, tree: usize, bounds: &Aabb) {
        if self.homes.len() <= row {
            let nowhere = TreePlace { tree: 0, place: NOWHERE };
            self.homes.resize(row + 1, nowhere);
            self.ids.resize(row + 1, id);
        }
        self.ids[row] = id;
        let home = self.homes[row];
        if home.place != NOWHERE && usize::from(home.tree) == tree {
            return self.trees[tree].set(home.place, bounds);
        }
        self.take_out(row);
        self.homes[row] =
            TreePlace { tree: tree as u8, place: self.trees[tree].push(row as u32, bounds) };
    }

    /// Removes the bodies of these rows.
    pub(crate) fn take_out_all(&mut self, rows: std::ops::Range<usize>) {
        for row in rows.start..rows.end.min(self.homes.len()) {
            self.take_out(row);
        }
    }

    /// Removes the bodies of all rows from number `rows` on, and their memory if it is much.
    pub(crate) fn end(&mut self, rows: usize) {
        self.take_out_all(rows..self.homes.len());
        shorten(&mut self.homes, rows);
        shorten(&mut self.ids, rows);
        if let Some(posed) = &mut self.posed {
            posed.shorten(rows);
        }
    }

    fn take_out(&mut self, row: usize) {
        let home = &mut self.homes[row];
        let place = std::mem::replace(&mut home.place, NOWHERE);
        if place != NOWHERE {
            self.trees[usize::from(home.tree)].remove(place);
        }
    }

    fn build(&mut self, tree: usize) {
        let rows = self.homes.iter().enumerate();
        let own = rows.filter(|(_, home)| home.place != NOWHERE && usize::from(home.tree) == tree);
        let boxes = own.map(|(row, home)| (row as u32, self.trees[tree].bounds(home.place)));
        self.trees[tree] = Tree::build(boxes.collect());
        for (place, &row) in (0..).zip(self.trees[tree].numbers()) {
            self.homes[row as usize].place = place;
        }
    }

    /// The body in a place, for the tests.
    #[inline(always)]
    pub(crate) fn solid(&self, tree: usize, place: usize) -> SolidBody<'_> {
        let tree = &self.trees[tree];
        let posed = self.posed.as_ref();
        match posed.and_then(|posed| posed.at(tree.numbers()[place] as usize)) {
            Some(body) => SolidBody::Shape(body),
            None => SolidBody::Box(tree.bounds(place as u32)),
        }
    }

    /// The id of the body in a place.
    #[inline(always)]
    pub(crate) fn id_at(&self, tree: usize, place: usize) -> BodyId {
        self.ids[self.trees[tree].numbers()[place] as usize]
    }
}

/// Shortens a column, and frees its memory if most of it is not in use.
fn shorten<T>(column: &mut Vec<T>, len: usize) {
    column.truncate(len);
    if column.capacity() > 4 * len {
        column.shrink_to(2 * len);
    }
}

/// A box moved by `by` and rounded outward. If `by` is 0, the box stays the same to the bit.
pub(crate) fn moved(aabb: &Aabb, by: [f64; 3]) -> Aabb {
    if by == [0.0; 3] {
        return *aabb;
    }
    Aabb {
        min: std::array::from_fn(|axis| down(f64::from(aabb.min[axis]) + by[axis])),
        max: std::array::from_fn(|axis| up(f64::from(aabb.max[axis]) + by[axis])),
    }
}
