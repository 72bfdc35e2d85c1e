//! Worlds in which few boxes change per frame: whatever the history, pairs and events are those of
//! the definition.

use std::collections::{BTreeMap, BTreeSet};

use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, BoxCuller, BoxWorld, Finder, Groups, Motion, Tier};

use crate::boxes::lives::{drawn, pairs, through_text};
use crate::boxes::scenes::{Kind, Random, boxes, expected, moved};

/// A world, what it should hold, and what events should be read against.
struct History {
    world: BoxWorld,
    bodies: BTreeMap<BodyId, BoxBody>,
    watched: BTreeSet<[BodyId; 2]>,
    kind: Kind,
    random: Random,
}

impl History {
    fn new(world: BoxWorld, kind: Kind, seed: u64, count: usize) -> Self {
        let mut history = Self {
            world,
            bodies: BTreeMap::new(),
            watched: BTreeSet::new(),
            kind,
            random: Random(seed),
        };
        for bounds in boxes(kind, count, &mut history.random) {
            let body = drawn(&mut history.random, kind);
            history.insert(BoxBody { bounds, ..body });
        }
        history
    }

    fn insert(&mut self, body: BoxBody) {
        let id = self.world.insert(body).unwrap();
        assert!(self.bodies.insert(id, body).is_none());
    }

    /// Changes one box in one way, or lets one come or go.
    fn change(&mut self) {
        let (random, other) = (&mut self.random, drawn(&mut Random(7), self.kind));
        let mut drawn = drawn(random, self.kind);
        let ids: Vec<BodyId> = self.bodies.keys().copied().collect();
        let id = ids[random.below(ids.len())];
        let mut body = self.bodies[&id];
        match random.below(12) {
            0 => return self.insert(drawn),
            1 if ids.len() > 40 => {
                self.world.remove(id).unwrap();
                self.bodies.remove(&id);
                return;
            }
            2 => body.groups = drawn.groups,
            3 => body.motion = drawn.motion,
            // Somewhere else, or just where another box is.
            4 => body.bounds = drawn.bounds,
            5 => body.bounds = self.bodies[&ids[random.below(ids.len())]].bounds,
            6 => (body, drawn) = (drawn, other),
            7 => {} // the same box again
            _ => moved(std::slice::from_mut(&mut body.bounds), 0.3, random),
        }
        let former = self.bodies.insert(id, body).unwrap();
        let (moves, rests) = (former.bounds != body.bounds, former.motion != body.motion);
        if former.groups != body.groups || (moves && rests) || drawn.motion == Motion::Fixed {
            self.world.set(id, body).unwrap();
        } else if rests {
            self.world.set_motion(id, body.motion).unwrap();
        } else {
            self.world.set_bounds(id, body.bounds).unwrap();
        }
    }

    fn assert_exact(&mut self, reads_events: bool, frame: usize) {
        let what = format!("{:?}, frame {frame}", self.kind);
        self.world.cull().unwrap();
        let wanted = pairs(&self.bodies);
        let listed: Vec<[BodyId; 2]> = self.world.pairs().collect();
        assert!(listed.iter().eq(&wanted), "{what}");
        assert_eq!(self.world.pairs().len(), wanted.len(), "{what}");
        for (&id, &body) in &self.bodies {
            assert_eq!(self.world.body(id).unwrap(), body, "{what}");
        }
        if reads_events {
            let events = self.world.events();
            let before = &self.watched;
            assert!(events.begun().eq(wanted.difference(before).copied()), "{what}");
            assert!(events.ended().eq(before.difference(&wanted).copied()), "{what}");
            let lasting = wanted.intersection(before).copied();
            assert!(events.persisting().eq(lasting), "{what}");
            assert_eq!(events.iter().count(), wanted.union(before).count(), "{what}");
            self.watched = wanted;
        }
    }

    /// Frames of few changes each; now and then of none, and of many. `before_frame` may put
    /// another world in the place of this one, if it makes no difference.
    fn live(&mut self, frames: usize, mut before_frame: impl FnMut(&mut BoxWorld, usize)) {
        for frame in 0..frames {
            before_frame(&mut self.world, frame);
            let changes = match self.random.below(20) {
                0 => 30,
                calls => calls % 5,
            };
            (0..changes).for_each(|_| self.change());
            let reads_events = self.random.below(3) > 0;
            self.assert_exact(reads_events, frame);
        }
    }
}

#[test]
fn few_movers_leave_exact_pairs() {
    for (kind, seed) in Kind::ALL.into_iter().zip(100..) {
        History::new(BoxWorld::new(), kind, seed, 100).live(150, |_, _| ());
        for &finder in Finder::ALL {
            let way = BoxCuller::builder().finder(finder).tier(Tier::SCALAR);
            let world = BoxWorld::with(&way.threads(2).worth_waking(0)).unwrap();
            History::new(world, kind, seed + 50, 60).live(60, |_, _| ());
        }
    }
}

/// Clones, worlds restored by another finder, worlds that have given their memory back, and those
/// that were culled otherwise.
#[test]
fn few_movers_in_random_histories() {
    for (kind, seed) in Kind::ALL.into_iter().zip(200..) {
        History::new(BoxWorld::new(), kind, seed, 80).live(150, |world, frame| match frame % 9 {
            1 => *world = world.clone(),
            3 => {
                let saved = through_text(world);
                let finder = Finder::ALL[frame % Finder::ALL.len()];
                let mut other = BoxWorld::with(&BoxCuller::builder().finder(finder)).unwrap();
                other.restore(&saved).unwrap();
                assert_eq!(other.snapshot(), saved);
                *world = other;
            }
            5 => world.shrink_to_fit(),
            6 => drop(world.cull_in_portions(|_| ())),
            8 => drop(world.cull_up_to(frame).map(|pairs| pairs.len())),
            _ => {}
        });
    }
}

/// Equal calls leave equal snapshots, whether a world was restored on the way or not.
#[test]
fn restored_movers_report_as_the_original() {
    for (kind, seed) in Kind::ALL.into_iter().zip(300..) {
        let mut one = History::new(BoxWorld::new(), kind, seed, 60);
        one.live(20, |_, _| ());
        let mut other = History {
            world: BoxWorld::new(),
            bodies: one.bodies.clone(),
            watched: one.watched.clone(),
            kind,
            random: Random(one.random.0),
        };
        other.world.restore(&through_text(&one.world)).unwrap();
        for _ in 0..30 {
            one.live(1, |_, _| ());
            other.live(1, |_, _| ());
            assert_eq!(one.world.snapshot(), other.world.snapshot());
        }
    }
}

fn cube(x: f32) -> Aabb {
    Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
}

/// A world of cubes in a row, each of which meets the next, culled.
fn row(count: u16, motion: Motion) -> (BoxWorld, Vec<BodyId>) {
    let mut world = BoxWorld::new();
    let of = |i: u16| BoxBody { motion, ..cube(f32::from(i)).into() };
    let ids = (0..count).map(|i| world.insert(of(i)).unwrap()).collect();
    world.cull().unwrap();
    assert_eq!(world.events().begun().count(), usize::from(count) - 1);
    (world, ids)
}

/// Pairs at rest stay until a box leaves.
#[test]
fn resting_pairs_end_with_a_box() {
    let (mut world, ids) = row(100, Motion::Dynamic);
    for &id in &ids {
        world.set_motion(id, Motion::Resting).unwrap();
    }
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 99);
    assert_eq!(world.events().ended().count(), 0);
    // Set where it is, moved and woken: its pairs stay as long as it touches.
    let before = world.counters().updates;
    world.set_bounds(ids[7], cube(7.0)).unwrap();
    world.set_motion(ids[7], Motion::Dynamic).unwrap();
    world.cull().unwrap();
    assert_eq!(world.counters().updates, before, "nothing has changed");
    assert_eq!(world.events().iter().count(), 99);
    world.set_bounds(ids[20], cube(20.5)).unwrap();
    world.cull().unwrap();
    assert_eq!(world.counters().updates, before + 1);
    assert!(world.events().ended().eq([[ids[19], ids[20]]]));
    assert_eq!(world.body(ids[20]).unwrap().motion, Motion::Resting);
    // Two fixed boxes are in no pair, one and another at rest are.
    world.set_motion(ids[50], Motion::Fixed).unwrap();
    world.cull().unwrap();
    assert_eq!(world.events().iter().count(), 98);
    world.set_motion(ids[51], Motion::Fixed).unwrap();
    world.cull().unwrap();
    assert!(world.events().ended().eq([[ids[50], ids[51]]]));
    world.set_motion(ids[50], Motion::Resting).unwrap();
    world.cull().unwrap();
    assert!(world.events().begun().eq([[ids[50], ids[51]]]));
}

/// The box was moved after the cull that the snapshot has the pairs of, and the world has seen that
/// since.
#[test]
fn rollback_finds_all_anew() {
    let (mut world, ids) = row(100, Motion::Dynamic);
    world.set_bounds(ids[20], cube(20.5)).unwrap();
    let saved = world.snapshot();
    for _ in 0..2 {
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), 98);
        world.restore(&saved).unwrap();
        assert_eq!(world.pairs().len(), 99);
    }
}

/// Groups change the pairs of boxes that stay.
#[test]
fn groups_change_resting_pairs() {
    let (mut world, ids) = row(100, Motion::Resting);
    let mut body = world.body(ids[30]).unwrap();
    body.groups = Groups { member: 1, mask: 2 };
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    assert_eq!(world.events().ended().count(), 0, "others are in all groups");
    body.groups = Groups { member: 1, mask: 0 };
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    let ended = [[ids[29], ids[30]], [ids[30], ids[31]]];
    assert!(world.events().ended().eq(ended));
    body.groups = Groups::ALL;
    world.set(ids[30], body).unwrap();
    world.cull().unwrap();
    assert!(world.events().begun().eq(ended));
}

/// Counted, not timed: what is looked at doesn't depend on how many boxes there are.
#[test]
fn a_frame_costs_what_changes() {
    let random = &mut Random(5);
    let tests_of = |count: usize, random: &mut Random| {
        let mut world = BoxWorld::new();
        let all = boxes(Kind::Cubes, count, random);
        let ids: Vec<BodyId> = all.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
        world.cull().unwrap();
        let before = *world.counters();
        for frame in 0..50 {
            let id = ids[random.below(ids.len())];
            let aabb = all[random.below(ids.len())];
            match frame % 3 {
                0 => world.set_bounds(id, aabb).unwrap(),
                1 => drop(world.insert(aabb).unwrap()),
                _ => world.set(id, BoxBody { motion: Motion::Fixed, ..aabb.into() }).unwrap(),
            }
            world.cull().unwrap();
        }
        let counted = world.counters().since(&before);
        assert_eq!(counted.updates, 50);
        counted.tests
    };
    let [few, many] = [500, 8000].map(|count| tests_of(count, random));
    assert!(few < 50 * 200 && many < 2 * few, "{few}, {many}");
}

/// Boxes that collide with none are compared with none.
#[test]
fn boxes_without_groups_are_not_compared() {
    let mut world = BoxWorld::new();
    let groups =
        |at: u32| [Groups { member: 1, mask: 0 }, Groups { member: 0, mask: 1 }][at as usize % 2];
    let ids: Vec<BodyId> = (0..3000)
        .map(|i| world.insert(BoxBody { groups: groups(i), ..cube(0.0).into() }).unwrap())
        .collect();
    for frame in 0..4 {
        ids.iter().for_each(|&id| world.set_bounds(id, cube(frame as f32)).unwrap());
        world.cull().unwrap();
        assert!(world.pairs().len() == 0 && world.counters().tests < 30_000);
    }
    for &id in &ids[..2] {
        world.set(id, cube(3.0)).unwrap();
    }
    world.cull().unwrap();
    assert!(world.pairs().eq([[ids[0], ids[1]]]));
}

/// Fixed boxes at one place, some of which are set per frame: no frame compares them with each
/// other, nor finds all pairs anew.
#[test]
fn parked_boxes_cost_their_changes() {
    let (mut world, count) = (BoxWorld::new(), 5000);
    let place = |step: usize| cube(1.0e-3 * (step % 100) as f32);
    let parked = |step| BoxBody { motion: Motion::Fixed, ..place(step).into() };
    let ids: Vec<BodyId> = (0..count).map(|i| world.insert(parked(i)).unwrap()).collect();
    let visitor = world.insert(cube(0.5)).unwrap();
    world.cull().unwrap();
    for frame in 0..20 {
        let before = (*world.counters(), world.rest_counters().queried);
        for i in (frame..count).step_by(17) {
            world.set_bounds(ids[i], place(i + frame + 1)).unwrap();
        }
        world.cull().unwrap();
        let changed = (frame..count).step_by(17).len() as u64;
        assert_eq!(world.rest_counters().queried - before.1, changed, "frame {frame}");
        // The cells near each box, and the visitor.
        let tests = world.counters().since(&before.0).tests;
        assert!(tests <= 64 * changed, "frame {frame}: {tests}");
        assert_eq!(world.pairs().len(), count);
        assert!(world.pairs().all(|pair| pair[1] == visitor));
    }
}

/// A giant that moves looks at more than all boxes are worth: then all pairs are found anew, and
/// they are the same.
#[test]
fn moving_giants_stay_cheap() {
    let random = &mut Random(6);
    let all = boxes(Kind::Cubes, 2000, random);
    let mut world = BoxWorld::new();
    let mut bounds: Vec<Aabb> = all;
    bounds.extend((0..40).map(|_| Aabb::new([-30.0; 3], [30.0; 3])));
    let ids: Vec<BodyId> = bounds.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
    world.cull().unwrap();
    for frame in 0..6 {
        for at in 2000..2000 + 10 * frame.min(4) {
            moved(std::slice::from_mut(&mut bounds[at]), 3.0, random);
            world.set_bounds(ids[at], bounds[at]).unwrap();
        }
        world.cull().unwrap();
        let wanted = expected(&bounds, |_| true, |_| Groups::ALL);
        let wanted = wanted.iter().map(|pair| pair.map(|i| ids[i as usize]));
        assert!(world.pairs().eq(wanted), "frame {frame}");
    }
}
