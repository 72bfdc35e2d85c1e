//! Neighbour lists: candidates within reach and a skin, found by the grid once, tested frame after frame.
//!
//! Most pairs that are near each other in one frame are so in the next. A list of the pairs whose balls, grown by a skin
//! each, touch serves until some ball has drifted by its skin ([`drift`]), which is measured in every frame and never
//! extrapolated; then the grid makes a new one. Meanwhile slots, and places with them, stay as they are: nothing is sorted,
//! and updates write in the order in which the list reads. A body that jumps has drifted, so that a new list is made; static
//! bodies have no skin.
//!
//! A skin is a share of each ball's radius, or the same length for all: where small bodies move as fast as wide ones, a share of
//! theirs is used up by the first step, while pairs are made by the wide.
//!
//! Lists don't pay where bodies move by a good share of their radius a frame, or where each has many neighbours. By counts
//! alone ([`policy`]) such frames are the grid's.

mod collect;
mod drift;
mod list;
mod motion;
mod policy;

pub(super) use self::list::List;
use self::motion::{Motion, typical_radius};
use self::policy::{Ended, Policy};
use super::{Grid, Reorder, Slots};
use crate::rounding::skin::Reach;
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
    state: State,
    policy: Policy,
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

    /// Looks for a better order of places: that of the slots after a list has been made, or what the grid says.
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

    /// Follows the list if it may be, or lets the grid arrange the bodies and makes a new one if it pays.
    pub(super) fn arrange(
        &mut self,
        executor: Executor<'_>,
        moving: usize,
        balls: &[[f32; 4]],
        names: &[u32],
    ) {
        if matches!(self.state, State::Ordered | State::Followed) {
            let (now, then) = (&balls[..moving], &self.grid.slots().balls[..moving]);
            if drift::all_stay(executor, self.policy.skin(), now, then) {
                if self.state == State::Ordered {
                    self.grid.slots_mut().names[..names.len()].copy_from_slice(names);
                    self.state = State::Followed;
                }
                self.policy.followed();
                return;
            }
            let typical = typical_radius(balls);
            self.policy.ended(&Ended {
                pairs: self.list.len(),
                candidates: self.list.seen(),
                bodies: balls.len(),
                motion: Motion::of(executor, now, then, typical),
                typical,
            });
        }
        self.state = State::Searching;
        let Some(skin) = self.policy.next() else {
            self.grid.set_reach(Reach::NONE);
            self.grid.arrange(executor, balls, names);
            return;
        };
        self.grid.set_reach(Reach::with_skin(skin));
        self.grid.arrange(executor, balls, names);
        let skin = (skin, self.policy.widest());
        if !self.list.make(executor, &self.grid, skin, self.volume) {
            self.policy.overflowed();
            return;
        }
        self.state = State::Made;
        // The grid plans by the candidates that it would have handed out without a skin.
        let seen = self.list.seen() as f64 / self.policy.wider();
        self.grid.observe(seen as u64);
    }

    pub(super) fn bytes(&self) -> usize {
        self.grid.bytes() + self.list.bytes()
    }

    /// Those of the frame in which they were arranged last.
    pub(super) fn slots(&self) -> &Slots {
        self.grid.slots()
    }

    /// Whether the frame follows a list in whose order places are; the slots' balls are then those that the list was made of.
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
        }
    }
}

#[cfg(test)]
mod tests;
