//! Neighbour lists: pairs within a skin of each other, found by the grid once and tested frame
//! after frame.
//!
//! Bodies that are near each other in one frame usually still are in the next. A list has the pairs
//! whose balls touch when each is grown by a skin. It is valid until some ball has drifted by its
//! skin ([`drift`]), which is measured in every frame and never extrapolated. Then the grid builds
//! a new list. While a list is valid, slots and places stay: nothing is sorted, and updates write
//! in the order in which the list reads. A body that jumps has drifted, too, so a new list is
//! built. Static bodies have no skin.
//!
//! A skin is a fraction of each ball's radius, or one length for all. If small bodies move as fast
//! as large ones, one length is better: a fraction of a small radius would be used up in the first
//! step, although large bodies make most pairs.
//!
//! The cubes around long boxes have many neighbours that the boxes don't have. Lists of long boxes
//! are therefore built from the boxes themselves, grown by a length, and are valid until an end of
//! a box leaves its grown box ([`EndSlots`]).
//!
//! Lists don't pay if bodies move by a large part of their radius per frame or have many
//! neighbours. Counts alone decide that ([`policy`]); the grid then handles the frame.

mod chunk;
mod collect;
mod drift;
mod effort;
mod list;
mod motion;
mod policy;

pub(super) use self::list::NeighbourList;
use self::list::{ListedVolume, SearchOutcome};
use self::motion::{LargestDrift, SizeSummary, are_specks, typical_radius};
use self::policy::{EndedList, Policy};
use super::{EndSlots, GivenBoxes, Grid, Reorder, Slots};
use crate::rounding::cube;
use crate::rounding::skin::{Reach, Skin};
use crate::threads::Executor;

/// The volume that a pair finder's balls stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volume {
    /// The balls themselves: for every reported pair the balls meet.
    #[default]
    Ball,
    /// The cubes around the balls: for every reported pair the cubes meet.
    Cube,
}

/// The finder: a grid, whose slots stay as they were when the list was built, and that list.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    grid: Grid,
    volume: Volume,
    list: NeighbourList,
    /// The grown boxes from which the list was built, if it was built from boxes.
    grown: EndSlots,
    state: ListState,
    policy: Policy,
    /// The grid's candidates without a skin.
    candidates: CandidateEstimate,
    /// Candidates tested in this frame to build a list.
    list_tests: u64,
}

/// A number of candidates, counted or estimated.
#[derive(Clone, Copy, Debug, Default)]
struct CandidateEstimate {
    number: u64,
    /// Whether the grid counted them in the previous frame.
    is_counted: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum ListState {
    /// There is no list: the grid finds pairs.
    #[default]
    Searching,
    /// The list was built in this frame; places don't have the order of slots yet.
    Made,
    /// Places have the order of slots, but slots don't have the new names yet.
    Ordered,
    /// The list is followed.
    Followed,
}

impl Neighbours {
    /// A finder for balls that stand for `volume`.
    pub fn new(volume: Volume) -> Self {
        Self { volume, ..Self::default() }
    }

    /// The volume that balls stand for.
    #[cfg(debug_assertions)]
    pub(super) fn volume(&self) -> Volume {
        self.volume
    }

    /// Whether there is a list that was built from boxes.
    #[cfg(debug_assertions)]
    pub(super) fn is_by_boxes(&self) -> bool {
        self.policy.is_by_boxes() && self.list().is_some()
    }

    /// Finds a better order of places: that of the slots after a list was built, otherwise the
    /// grid's.
    pub(super) fn reorder(
        &mut self,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        let replan = self.grid.needs_plan(balls.len());
        match self.state {
            _ if replan => self.state = ListState::Searching,
            ListState::Searching => {}
            ListState::Made => {
                self.state = ListState::Ordered;
                return self.grid.follow_slots(moving, names, order);
            }
            ListState::Ordered | ListState::Followed => {
                self.grid.rest();
                return Reorder::None;
            }
        }
        self.grid.reorder(moving, balls, names, order)
    }

    /// Changes the set of bodies as the grid does, and drops the list.
    pub(super) fn replace(&mut self, stays: &[bool], moving: usize, bodies: usize) -> bool {
        if self.state != ListState::Searching {
            self.policy.interrupted();
            self.state = ListState::Searching;
        }
        self.grid.replace(stays, moving, bodies)
    }

    /// Follows the list if it is valid. Otherwise lets the grid arrange the bodies, and builds a
    /// new list if that pays.
    pub(super) fn arrange(
        &mut self,
        executor: Executor<'_>,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        boxes: Option<GivenBoxes<'_>>,
    ) {
        self.list_tests = 0;
        let long = boxes.filter(|boxes| boxes.are_long);
        if matches!(self.state, ListState::Ordered | ListState::Followed) {
            let (now, then) = (&balls[..moving], &self.grid.slots().balls[..moving]);
            let stay = match boxes.filter(|_| self.policy.is_by_boxes()) {
                Some(boxes) => self.grown.hold(executor, &names[..moving], boxes.all),
                None => drift::all_stay(executor, self.policy.skin(), now, then),
            };
            if stay {
                if self.state == ListState::Ordered {
                    self.grid.slots_mut().names[..names.len()].copy_from_slice(names);
                    self.state = ListState::Followed;
                }
                self.policy.followed();
                return;
            }
            let sizes = sizes(balls, names, long);
            self.policy.ended(&EndedList {
                pairs: self.list.len(),
                candidates: self.list.tested(),
                bodies: balls.len(),
                motion: LargestDrift::of(executor, now, then, sizes.typical),
                sizes,
            });
        }
        self.state = ListState::Searching;
        self.policy.turn_to(long.is_some(), || sizes(balls, names, long));
        let Some(skin) = self.policy.next() else {
            return self.search(executor, balls, names);
        };
        if are_specks(balls[..moving].iter().map(|ball| ball[3])) {
            self.policy.overflowed();
            return self.search(executor, balls, names);
        }
        self.grid.set_reach(Reach::with_skin(skin));
        self.grid.arrange(executor, balls, names);
        let outcome = self.make(executor, (skin, moving), long);
        self.list_tests = self.list.tested();
        if outcome == SearchOutcome::Abandoned {
            // If the limit came from an estimate, try again with the count of this frame.
            if self.candidates.is_counted {
                self.policy.overflowed();
            }
            // The candidates that the skin has added would be tested in vain.
            return self.search(executor, balls, names);
        }
        self.state = ListState::Made;
        // The grid plans by the candidates that it would have without a skin.
        let number = (self.list_tests as f64 / self.policy.more_candidates()) as u64;
        self.grid.observe(number);
        self.candidates = CandidateEstimate { number, is_counted: false };
    }

    /// Lets the grid find the frame's pairs, without a list.
    fn search(&mut self, executor: Executor<'_>, balls: &[[f32; 4]], names: &[u32]) {
        self.grid.set_reach(Reach::NONE);
        self.grid.arrange(executor, balls, names);
    }

    /// Builds the list from the grid that has just been arranged.
    fn make(
        &mut self,
        executor: Executor<'_>,
        (skin, moving): (Skin, usize),
        long: Option<GivenBoxes<'_>>,
    ) -> SearchOutcome {
        let near = match long {
            None => ListedVolume::Balls(self.volume),
            Some(GivenBoxes { all, .. }) => {
                let Slots { names, balls, .. } = self.grid.slots();
                let (names, cubes) = (&names[..self.grid.bodies()], &balls[..moving]);
                (self.grown).fill_grown(executor, names, all, (cubes, skin));
                ListedVolume::Ends(&self.grown)
            }
        };
        let skin = (skin, self.policy.widest());
        let grid = (&self.grid, self.candidates.number);
        self.list.make(executor, grid, skin, near)
    }

    /// Candidates tested in this frame to build a list, in addition to the frame's own candidates.
    pub(super) fn list_tests(&self) -> u64 {
        self.list_tests
    }

    pub(super) fn bytes(&self) -> usize {
        self.grid.bytes() + self.list.bytes() + self.grown.bytes()
    }

    /// The slots of the frame in which they were arranged last.
    pub(super) fn slots(&self) -> &Slots {
        self.grid.slots()
    }

    /// Whether the frame follows a list and places have its order. The slots' balls are then those
    /// from which the list was built.
    pub(super) fn slots_are_places(&self) -> bool {
        self.state == ListState::Followed
    }

    /// The list, if this frame follows one.
    #[inline(always)]
    pub(super) fn list(&self) -> Option<&NeighbourList> {
        (self.state != ListState::Searching).then_some(&self.list)
    }

    /// The grid, which finds the pairs otherwise.
    #[inline(always)]
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Records the frame's number of candidates.
    pub(super) fn observe(&mut self, candidates: u64) {
        if self.state == ListState::Searching {
            self.grid.observe(candidates);
            self.candidates = CandidateEstimate { number: candidates, is_counted: true };
        }
    }
}

/// The sizes of balls, or of the long boxes in them.
fn sizes(balls: &[[f32; 4]], names: &[u32], long: Option<GivenBoxes<'_>>) -> SizeSummary {
    let of_balls = typical_radius(balls.len(), |place| [balls[place][3]; 3]);
    let of_boxes = long.map(|GivenBoxes { all, .. }| {
        typical_radius(balls.len(), |place| {
            let half_sides = all[names[place] as usize].half_sides();
            half_sides.map(|half| half / cube::SCALE)
        })
    });
    SizeSummary::new(of_boxes.unwrap_or(of_balls), of_balls)
}

#[cfg(test)]
mod tests;
