use std::collections::BTreeMap;
use std::ops::Range;

use super::*;
use crate::broad_phase::{Block, FirstTest};
use crate::rounding::skin::Skin;
use crate::simd::{Kernel, Lanes, Tier, dispatch};
use crate::threads::Threads;

mod long;

/// A finder with its bodies, the first of which move.
struct TrackedBodies {
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

/// Finds the pairs of the list, or those of the grid.
struct FindPairs<'a>(&'a Neighbours, bool);

impl<'a> Kernel for FindPairs<'a> {
    type Output = BTreeMap<[u32; 2], u32>;
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let Self(finder, of_list) = self;
        let mut found = Candidates(finder, BTreeMap::new());
        match finder.list().filter(|_| of_list) {
            Some(list) => list.find(l, 0..list.parts(), &mut &mut found),
            None => finder.grid().find(l, 0..finder.grid().parts(), &mut &mut found),
        }
        found.1
    }
}

impl TrackedBodies {
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
        self.step_with(None);
    }

    /// One more frame, of balls about these boxes.
    fn step_with(&mut self, boxes: Option<GivenBoxes<'_>>) {
        let pool = Threads::default();
        let executor = pool.executor(Tier::SCALAR);
        let in_places = |names: &[u32]| -> Vec<_> {
            names.iter().map(|&name| self.balls[name as usize]).collect()
        };
        let mut order = Vec::new();
        let before = in_places(&self.names);
        let reorder = self.finder.reorder(self.moving, &before, &self.names, &mut order);
        if reorder != Reorder::None {
            self.names.copy_from_slice(&order);
        }
        let now = in_places(&self.names);
        self.finder.arrange(executor, self.moving, &now, &self.names, boxes);
        if self.finder.list().is_none() {
            let candidates = self.candidates(false).values().sum::<u32>();
            self.finder.observe(candidates.into());
        }
    }

    fn candidates(&self, of_list: bool) -> BTreeMap<[u32; 2], u32> {
        dispatch(Tier::SCALAR, FindPairs(&self.finder, of_list))
    }

    /// How deep two bodies overlap, each grown by a share of its radius and by a length if it
    /// moves; none if both stand still.
    fn overlap(&self, pair: [u32; 2], [share, length]: [f64; 2]) -> Option<f64> {
        let [a, b] = pair.map(|name| self.balls[name as usize].map(f64::from));
        let grows = pair.map(|name| (name as usize) < self.moving);
        let reach = |radius, grows| match grows {
            true => radius * (1.0 + share) + length,
            false => radius,
        };
        let apart: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
        let sum = reach(a[3], grows[0]) + reach(b[3], grows[1]);
        (grows != [false; 2]).then(|| sum - apart.sqrt())
    }
}

/// Unequal balls, in a cube or, so that the table is wrapped, along a diagonal; the last ones stand
/// still.
fn scattered(thin: bool) -> TrackedBodies {
    let place = |i: u32| {
        let [x, y, z] = [7919, 104_729, 1_299_709].map(|p| (i * p % 1000) as f32 * 0.011);
        let far = 300.0 * (i % 41) as f32;
        let [y, z] = if thin { [far, far] } else { [y, z] };
        let radius = if i % 50 == 7 { 2.0 } else { 0.4 + 0.05 * (i % 5) as f32 };
        [if thin { far + x } else { x }, y, z, radius]
    };
    TrackedBodies::new(500, (0..620).map(place).collect())
}

/// A list holds the pairs whose grown balls touch and each once.
#[test]
fn list_has_each_touching_pair_once() {
    // A skin of 0.25 radii, their own or typical ones of this size.
    let skins = [(Policy::default(), [0.25, 0.0]), (Policy::of_typical(0.8), [0.0, 0.2])];
    for thin in [false, true] {
        for (policy, skin) in skins.clone() {
            let mut bodies = scattered(thin);
            bodies.finder.policy = policy;
            bodies.step();
            assert!(bodies.finder.list().is_none(), "before the first search");
            bodies.step();
            holds_what_touches(&bodies, skin);
        }
    }
}

/// Checks a list that has just been made.
fn holds_what_touches(bodies: &TrackedBodies, skin: [f64; 2]) {
    let list = bodies.finder.list();
    let list = list.expect("bodies of which little is known are worth a list");
    let (listed, seen) = (bodies.candidates(true), bodies.candidates(false));
    assert_eq!(list.len(), listed.len());
    assert_eq!(list.tested(), seen.len() as u64);
    assert_eq!(
        bodies.finder.grid.age_and_candidates().1,
        (seen.len() as f64 / 1.25f64.powi(3)) as u64
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

/// A small ball moves by a skin of its radius in every frame, which is far less than one of a
/// typical radius.
#[test]
fn second_list_lasts_for_mixed_sizes() {
    let mut bodies = scattered(false);
    bodies.balls[9][3] = 0.1;
    let mut states = Vec::new();
    for _ in 0..8 {
        bodies.step();
        states.push(bodies.finder.state);
        bodies.balls[9][1] += 0.03;
    }
    use ListState::{Followed, Made, Searching};
    let wanted = [Searching, Made, Made, Followed, Followed, Followed, Followed, Followed];
    assert_eq!(states, wanted);
    let skin = bodies.finder.policy.skin();
    let is_share = |sixteenths: u8| skin == Skin::share(f32::from(sixteenths) / 16.0);
    assert!(!(0..=16).any(is_share), "{skin:?}");
}

/// A list is followed until a body has drifted by its skin.
#[test]
fn list_lasts_until_skin_drift() {
    let mut bodies = scattered(false);
    for frame in 0..6 {
        bodies.step();
        let state = bodies.finder.state;
        let expected = [ListState::Searching, ListState::Made, ListState::Followed];
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
        (bodies.candidates(true), bodies.finder.grid.age_and_candidates().0),
        (listed, age + 1)
    );
    bodies.balls[9][1] += 0.25 * 0.6;
    bodies.step();
    assert!(bodies.finder.state != ListState::Followed, "a jump by a skin");
    // Bodies that jump in every frame are the grid's.
    for _ in 0..3 {
        bodies.balls.iter_mut().take(500).for_each(|ball| ball[2] = -ball[2]);
        bodies.step();
    }
    assert_eq!(bodies.finder.state, ListState::Searching);
    bodies.finder.observe(12);
    assert_eq!(bodies.finder.grid.age_and_candidates().1, 12);
}

/// Clusters of bodies in one place each, (n² − n)/2 pairs of n, in the first places and in the last
/// ones; the others are alone.
fn clusters(bodies: usize, first: &[usize], last: &[usize]) -> TrackedBodies {
    let many = |places: usize, sizes: &[usize]| -> Vec<usize> {
        (places..).zip(sizes).flat_map(|(place, &size)| vec![place; size]).collect()
    };
    let mut places = many(0, first);
    places.extend(many(bodies, last));
    places.extend(first.len()..first.len() + bodies - places.len());
    let ball = |place: usize| [10.0 * (place % 10) as f32, 10.0 * (place / 10) as f32, 0.0, 1.0];
    TrackedBodies::new(bodies, places.into_iter().map(ball).collect())
}

/// A list may have eight pairs per body with the widest skin, and no more.
#[test]
fn list_length_has_a_limit() {
    // 8·1000/(1.375/1.25)³ + 256 = 6266.5, and twice as many bodies are in two parts of the grid's
    // work.
    for (bodies, first, last, pairs, is_made) in [
        (1000, &[112, 10, 3, 2, 2][..], &[][..], 6266, true),
        (1000, &[112, 10, 3, 2, 2], &[2], 6267, false),
        (2000, &[157, 8, 2, 2], &[2], 12_277, true),
        (2000, &[157, 8, 2, 2, 2], &[2], 12_278, false),
    ] {
        let mut bodies = clusters(bodies, first, last);
        for _ in 0..2 {
            bodies.step();
        }
        // One pair more ends the search, whose list is not counted.
        let list = bodies.finder.list().map(NeighbourList::len);
        assert_eq!(list, is_made.then_some(pairs));
    }
}

/// Bodies that come end a list and where it served one frame the next ones are the grids.
#[test]
fn new_bodies_end_a_list() {
    for (frames, makes) in [(2, false), (3, true), (6, true)] {
        let mut bodies = scattered(false);
        for _ in 0..frames {
            bodies.step();
        }
        assert!(bodies.finder.list().is_some());
        let all = bodies.balls.len();
        let finder = &mut bodies.finder;
        assert!(finder.replace(&vec![true; all], bodies.moving, all));
        assert!(finder.list().is_none());
        bodies.step();
        assert_eq!(bodies.finder.list().is_some(), makes, "{frames} frames");
    }
}
