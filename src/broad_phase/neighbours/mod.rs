//! Neighbour lists: candidates within reach and a skin, found by the grid once, tested frame after
//! frame.
//!
//! Most pairs that are near each other in one frame are so in the next. A list of the pairs whose
//! balls, grown by a skin each, touch serves until some ball has drifted by its skin ([`drift`]),
//! which is measured in every frame and never extrapolated; then the grid makes a new one.
//! Meanwhile slots, and places with them, stay as they are: nothing is sorted, and updates write in
//! the order in which the list reads. A body that jumps has drifted, so that a new list is made;
//! static bodies have no skin.
//!
//! A skin is a share of each ball's radius, or the same length for all: where small bodies move as
//! fast as wide ones, a share of theirs is used up by the first step, while pairs are made by the
//! wide.
//!
//! The cubes about long boxes have many neighbours that the boxes don't have. Their lists are made
//! by the boxes themselves, grown by a length, and serve until an end of a box leaves its grown one
//! ([`EndSlots`]).
//!
//! Lists don't pay where bodies move by a good share of their radius a frame, or where each has
//! many neighbours. By counts alone ([`policy`]) such frames are the grid's.

mod collect;
mod drift;
mod effort;
mod list;
mod motion;
mod policy;

pub(super) use self::list::List;
use self::list::{Near, Outcome};
use self::motion::{Motion, Sizes, are_specks, typical_radius};
use self::policy::{Ended, Policy};
use super::{Boxes, EndSlots, Grid, Reorder, Slots};
use crate::rounding::cube;
use crate::rounding::skin::{Reach, Skin};
use crate::threads::Executor;

/// What a pair finder's balls stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volume {
    /// Themselves: what is reported has balls that meet.
    #[default]
    Ball,
    /// The cubes about them: what is reported has cubes that meet.
    Cube,
}

/// A grid, whose slots stay as they were when the list was made, and that list.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    grid: Grid,
    volume: Volume,
    list: List,
    /// The grown boxes that the list was made of, if it was made by boxes.
    grown: EndSlots,
    state: State,
    policy: Policy,
    /// Candidates of the grid without a skin.
    candidates: Known,
    /// Candidates tested in this frame in the search for a list.
    list_tests: u64,
}

/// A number of candidates, and how well it is known.
#[derive(Clone, Copy, Debug, Default)]
struct Known {
    number: u64,
    /// Whether the grid has counted them in the frame before.
    is_counted: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// No list: the grid finds pairs.
    #[default]
    Searching,
    /// The list was made in this frame; places aren't slots.
    Made,
    /// Places have taken the order of slots, and slots are yet to take their names.
    Ordered,
    /// The list is followed.
    Followed,
}

impl Neighbours {
    /// A finder of such volumes.
    pub fn new(volume: Volume) -> Self {
        Self {
            volume,
            ..Self::default()
        }
    }

    /// What balls stand for.
    #[cfg(debug_assertions)]
    pub(super) fn volume(&self) -> Volume {
        self.volume
    }

    /// Whether there is a list, and it was made by boxes.
    #[cfg(debug_assertions)]
    pub(super) fn is_by_boxes(&self) -> bool {
        self.policy.is_by_boxes() && self.list().is_some()
    }

    /// Looks for a better order of places: that of the slots after a list has been made, or what
    /// the grid says.
    pub(super) fn reorder(
        &mut self,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        let replan = self.grid.needs_plan(balls.len());
        match self.state {
            _ if replan => self.state = State::Searching,
            State::Searching => {}
            State::Made => {
                self.state = State::Ordered;
                return self.grid.follow_slots(moving, names, order);
            }
            State::Ordered | State::Followed => {
                self.grid.rest();
                return Reorder::None;
            }
        }
        self.grid.reorder(moving, balls, names, order)
    }

    /// Takes up another set of bodies as the grid does; the list is of the former ones.
    pub(super) fn replace(&mut self, stays: &[bool], moving: usize, bodies: usize) -> bool {
        if self.state != State::Searching {
            self.policy.interrupted();
            self.state = State::Searching;
        }
        self.grid.replace(stays, moving, bodies)
    }

    /// Follows the list if it may be, or lets the grid arrange the bodies and makes a new one if it
    /// pays.
    pub(super) fn arrange(
        &mut self,
        executor: Executor<'_>,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
        boxes: Option<Boxes<'_>>,
    ) {
        self.list_tests = 0;
        let long = boxes.filter(|boxes| boxes.are_long);
        if matches!(self.state, State::Ordered | State::Followed) {
            let (now, then) = (&balls[..moving], &self.grid.slots().balls[..moving]);
            let stay = match boxes.filter(|_| self.policy.is_by_boxes()) {
                Some(boxes) => self.grown.hold(executor, &names[..moving], boxes.all),
                None => drift::all_stay(executor, self.policy.skin(), now, then),
            };
            if stay {
                if self.state == State::Ordered {
                    self.grid.slots_mut().names[..names.len()].copy_from_slice(names);
                    self.state = State::Followed;
                }
                self.policy.followed();
                return;
            }
            let sizes = sizes(balls, names, long);
            self.policy.ended(&Ended {
                pairs: self.list.len(),
                candidates: self.list.tested(),
                bodies: balls.len(),
                motion: Motion::of(executor, now, then, sizes.typical),
                sizes,
            });
        }
        self.state = State::Searching;
        self.policy
            .turn_to(long.is_some(), || sizes(balls, names, long));
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
        if outcome == Outcome::Abandoned {
            // A limit by candidates that were a guess is tried again by those of this frame.
            if self.candidates.is_counted {
                self.policy.overflowed();
            }
            // What the skin has brought to the cells would be tested in vain.
            return self.search(executor, balls, names);
        }
        self.state = State::Made;
        // The grid plans by the candidates that it would have handed out without a skin.
        let number = (self.list_tests as f64 / self.policy.more_candidates()) as u64;
        self.grid.observe(number);
        self.candidates = Known {
            number,
            is_counted: false,
        };
    }

    /// Lets the grid find the frame's pairs, without a list.
    fn search(&mut self, executor: Executor<'_>, balls: &[[f32; 4]], names: &[u32]) {
        self.grid.set_reach(Reach::NONE);
        self.grid.arrange(executor, balls, names);
    }

    /// Makes the list of the grid that has just been arranged.
    fn make(
        &mut self,
        executor: Executor<'_>,
        (skin, moving): (Skin, usize),
        long: Option<Boxes<'_>>,
    ) -> Outcome {
        let near = match long {
            None => Near::Balls(self.volume),
            Some(Boxes { all, .. }) => {
                let Slots { names, balls, .. } = self.grid.slots();
                let (names, cubes) = (&names[..self.grid.bodies()], &balls[..moving]);
                (self.grown).fill_grown(executor, names, all, (cubes, skin));
                Near::Ends(&self.grown)
            }
        };
        let skin = (skin, self.policy.widest());
        let grid = (&self.grid, self.candidates.number);
        self.list.make(executor, grid, skin, near)
    }

    /// Candidates tested in this frame in the search for a list, beyond those that the frame hands
    /// out.
    pub(super) fn list_tests(&self) -> u64 {
        self.list_tests
    }

    pub(super) fn bytes(&self) -> usize {
        self.grid.bytes() + self.list.bytes() + self.grown.bytes()
    }

    /// Those of the frame in which they were arranged last.
    pub(super) fn slots(&self) -> &Slots {
        self.grid.slots()
    }

    /// Whether the frame follows a list in whose order places are; the slots' balls are then those
    /// that the list was made of.
    pub(super) fn slots_are_places(&self) -> bool {
        self.state == State::Followed
    }

    /// The list, in frames that follow one.
    #[inline(always)]
    pub(super) fn list(&self) -> Option<&List> {
        (self.state != State::Searching).then_some(&self.list)
    }

    /// The grid, whose frame it is otherwise.
    #[inline(always)]
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Notes how many candidates a frame had.
    pub(super) fn observe(&mut self, candidates: u64) {
        if self.state == State::Searching {
            self.grid.observe(candidates);
            self.candidates = Known {
                number: candidates,
                is_counted: true,
            };
        }
    }
}

/// The sizes of balls, or of long boxes in them.
fn sizes(balls: &[[f32; 4]], names: &[u32], long: Option<Boxes<'_>>) -> Sizes {
    let of_balls = typical_radius(balls.len(), |place| [balls[place][3]; 3]);
    let of_boxes = long.map(|Boxes { all, .. }| {
        typical_radius(balls.len(), |place| {
            let half_sides = all[names[place] as usize].half_sides();
            half_sides.map(|half| half / cube::SCALE)
        })
    });
    Sizes::new(of_boxes.unwrap_or(of_balls), of_balls)
}

#[cfg(test)]
mod tests;
