//! Neighbour lists: candidates within reach and a skin, found by the grid once, tested frame after frame.
//!
//! Most pairs that are near each other in one frame are so in the next. A list of the pairs whose balls, grown by a skin
//! each, touch serves until some ball has drifted by its skin ([`drift`]), which is measured in every frame and never
//! extrapolated; then the grid makes a new one. Meanwhile slots, and places with them, stay as they are: nothing is sorted,
//! and updates write in the order in which the list reads. A body that jumps has drifted, so that a new list is made; static
//! bodies have no skin.
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
use super::{Grid, Reorder, Slots, bytes};
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

/// A grid, and the list that was made of it last.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    grid: Grid,
    volume: Volume,
    list: List,
    /// The balls by slot when the list was made.
    then: Vec<[f32; 4]>,
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
            let slots = &mut self.grid.slots_mut().balls[..moving];
            let (now, then) = (&balls[..moving], &self.then[..moving]);
            if drift::follow(executor, self.policy.skin(), now, then, slots) {
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
                motion: Motion::of(executor, now, then, typical, slots),
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
        self.then.clear();
        self.then
            .extend_from_slice(&self.grid.slots().balls[..moving]);
        self.state = State::Made;
        // The grid plans by the candidates that it would have handed out without a skin.
        let seen = self.list.seen() as f64 / self.policy.wider();
        self.grid.observe(seen as u64);
    }

    pub(super) fn bytes(&self) -> usize {
        self.grid.bytes() + bytes(&self.then) + self.list.bytes()
    }

    pub(super) fn slots(&self) -> &Slots {
        self.grid.slots()
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
mod tests {
    use std::collections::BTreeMap;
    use std::ops::Range;

    use super::*;
    use crate::broad_phase::{Block, FirstTest};
    use crate::simd::{Kernel, Lanes, Tier, dispatch};
    use crate::threads::Threads;

    /// A finder with its bodies, the first of which move.
    struct Followed {
        finder: Neighbours,
        moving: usize,
        names: Vec<u32>,
        /// By name.
        balls: Vec<[f32; 4]>,
    }

    /// How often each pair of bodies is a candidate.
    struct Candidates<'a>(&'a Neighbours, BTreeMap<[u32; 2], u32>);

    impl FirstTest for &mut Candidates<'_> {
        fn run<L: Lanes>(&mut self, _: L, i: usize, run: Range<usize>) {
            let names = &self.0.slots().names;
            for j in run {
                let [a, b] = [names[i], names[j]];
                *self.1.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        fn block<L: Lanes>(&mut self, l: L, block: &Block<'_>) {
            for &code in block.codes() {
                let j = (code >> 4) as usize;
                self.run(l, block.first() + (code & 15) as usize, j..j + 1);
            }
        }
    }

    /// Of the list, or of the grid.
    struct Find<'a>(&'a Neighbours, bool);

    impl<'a> Kernel for Find<'a> {
        type Output = BTreeMap<[u32; 2], u32>;
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let Self(finder, of_list) = self;
            let mut found = Candidates(finder, BTreeMap::new());
            match finder.list().filter(|_| of_list) {
                Some(list) => list.find(l, 0..list.parts(), &mut &mut found),
                None => finder
                    .grid()
                    .find(l, 0..finder.grid().parts(), &mut &mut found),
            }
            found.1
        }
    }

    impl Followed {
        fn new(moving: usize, balls: Vec<[f32; 4]>) -> Self {
            Self {
                finder: Neighbours::default(),
                moving,
                names: (0..balls.len() as u32).collect(),
                balls,
            }
        }

        /// One more frame.
        fn step(&mut self) {
            let pool = Threads::default();
            let executor = pool.executor(Tier::SCALAR);
            let in_places = |names: &[u32]| -> Vec<_> {
                names
                    .iter()
                    .map(|&name| self.balls[name as usize])
                    .collect()
            };
            let mut order = Vec::new();
            let before = in_places(&self.names);
            let reorder = self
                .finder
                .reorder(self.moving, &before, &self.names, &mut order);
            if reorder != Reorder::None {
                self.names.copy_from_slice(&order);
            }
            let now = in_places(&self.names);
            self.finder
                .arrange(executor, self.moving, &now, &self.names);
        }

        fn candidates(&self, of_list: bool) -> BTreeMap<[u32; 2], u32> {
            dispatch(Tier::SCALAR, Find(&self.finder, of_list))
        }

        /// How deep two bodies overlap, each grown by `skin` if it moves; none if both stand still.
        fn overlap(&self, pair: [u32; 2], skin: f64) -> Option<f64> {
            let [a, b] = pair.map(|name| self.balls[name as usize].map(f64::from));
            let grows = pair.map(|name| (name as usize) < self.moving);
            let reach = |radius, grows| if grows { radius * (1.0 + skin) } else { radius };
            let apart: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
            let sum = reach(a[3], grows[0]) + reach(b[3], grows[1]);
            (grows != [false; 2]).then(|| sum - apart.sqrt())
        }
    }

    /// Unequal balls, in a cube or, so that the table is wrapped, along a diagonal; the last ones stand still.
    fn scattered(thin: bool) -> Followed {
        let place = |i: u32| {
            let [x, y, z] = [7919, 104_729, 1_299_709].map(|p| (i * p % 1000) as f32 * 0.011);
            let far = 300.0 * (i % 41) as f32;
            let [y, z] = if thin { [far, far] } else { [y, z] };
            let radius = if i % 50 == 7 {
                2.0
            } else {
                0.4 + 0.05 * (i % 5) as f32
            };
            [if thin { far + x } else { x }, y, z, radius]
        };
        Followed::new(500, (0..620).map(place).collect())
    }

    #[test]
    fn a_list_holds_the_pairs_whose_grown_balls_touch_and_each_once() {
        for thin in [false, true] {
            let mut bodies = scattered(thin);
            bodies.step();
            assert!(bodies.finder.list().is_none(), "before the first search");
            bodies.step();
            let (skin, list) = (f64::from(bodies.finder.policy.skin()), bodies.finder.list());
            let list = list.expect("bodies of which little is known are worth a list");
            let (listed, seen) = (bodies.candidates(true), bodies.candidates(false));
            assert_eq!(list.len(), listed.len());
            assert_eq!(list.seen(), seen.len() as u64);
            let wider = (1.0 + skin).powi(3);
            assert_eq!(
                bodies.finder.grid.age_and_candidates().1,
                (seen.len() as f64 / wider) as u64
            );
            assert!(listed.values().all(|&times| times == 1));
            let n = bodies.balls.len() as u32;
            let mut between = [0; 2];
            for pair in (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b])) {
                let overlap = bodies.overlap(pair, skin).unwrap_or(f64::NEG_INFINITY);
                if overlap.abs() > 1e-4 {
                    let is_listed = listed.contains_key(&pair);
                    assert_eq!(is_listed, overlap > 0.0, "{pair:?}: {overlap}");
                    between[usize::from(is_listed)] += 1;
                }
            }
            assert!(between[0] > 100_000 && between[1] > 500, "{between:?}");
        }
    }

    #[test]
    fn a_list_is_followed_until_a_body_has_drifted_by_its_skin() {
        let mut bodies = scattered(false);
        for frame in 0..6 {
            bodies.step();
            let state = bodies.finder.state;
            let expected = [State::Searching, State::Made, State::Followed];
            assert_eq!(state, expected[frame.min(2)], "frame {frame}");
            bodies.balls[3][0] += 0.02;
        }
        let listed = bodies.candidates(true);
        let age = bodies.finder.grid.age_and_candidates().0;
        bodies.finder.observe(1);
        assert!(
            bodies.finder.grid.age_and_candidates().1 > 1,
            "the list's candidates aren't the grid's"
        );
        bodies.step();
        assert_eq!(
            (
                bodies.candidates(true),
                bodies.finder.grid.age_and_candidates().0
            ),
            (listed, age + 1)
        );
        bodies.balls[9][1] += 0.25 * 0.6;
        bodies.step();
        assert!(bodies.finder.state != State::Followed, "a jump by a skin");
        // Bodies that jump in every frame are the grid's.
        for _ in 0..3 {
            bodies
                .balls
                .iter_mut()
                .take(500)
                .for_each(|ball| ball[2] = -ball[2]);
            bodies.step();
        }
        assert_eq!(bodies.finder.state, State::Searching);
        bodies.finder.observe(12);
        assert_eq!(bodies.finder.grid.age_and_candidates().1, 12);
    }

    /// Clusters of bodies in one place each, (n² − n)/2 pairs of n, in the first places and in the last ones; the others are alone.
    fn clusters(bodies: usize, first: &[usize], last: &[usize]) -> Followed {
        let many = |places: usize, sizes: &[usize]| -> Vec<usize> {
            (places..)
                .zip(sizes)
                .flat_map(|(place, &size)| vec![place; size])
                .collect()
        };
        let mut places = many(0, first);
        places.extend(many(bodies, last));
        places.extend(first.len()..first.len() + bodies - places.len());
        let ball = |place: usize| {
            [
                10.0 * (place % 10) as f32,
                10.0 * (place / 10) as f32,
                0.0,
                1.0,
            ]
        };
        Followed::new(bodies, places.into_iter().map(ball).collect())
    }

    #[test]
    fn a_list_of_four_pairs_a_body_with_the_widest_skin_is_made_and_no_longer_one() {
        // 4·1000/(1.375/1.25)³ + 256 = 3261.3, and twice as many bodies are in two parts of the grid's work.
        for (bodies, first, last, pairs, is_made) in [
            (1000, &[80, 14, 5][..], &[][..], 3261, true),
            (1000, &[80, 14, 5], &[2], 3262, false),
            (2000, &[112, 10, 3, 2], &[2], 6266, true),
            (2000, &[112, 10, 3, 2, 2], &[2], 6267, false),
        ] {
            let mut bodies = clusters(bodies, first, last);
            for _ in 0..2 {
                bodies.step();
            }
            assert_eq!(bodies.finder.list.len(), pairs);
            assert_eq!(bodies.finder.list().is_some(), is_made);
        }
    }

    #[test]
    fn bytes_are_those_of_the_grid_the_list_and_what_it_was_made_of() {
        let mut bodies = scattered(false);
        for _ in 0..2 {
            bodies.step();
        }
        let finder = &mut bodies.finder;
        let list = finder.list.bytes();
        finder.grid = Grid::default();
        finder.then = Vec::with_capacity(1000);
        assert!(list > 0 && finder.bytes() == 16_000 + list);
        finder.list = List::default();
        finder.grid = scattered(false).finder.grid;
        assert_eq!(finder.bytes(), 16_000);
    }
}
